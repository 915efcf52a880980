// Lists what was given: photographs, videos and folders of them.
#ifndef ORL_PREPROCESS_LIST_H
#define ORL_PREPROCESS_LIST_H

#include "preprocess/job/job.h"

// Sets the job's sources, not yet looked at, in the order of the input. Folders are searched with
// their sub-folders, except hidden ones, scenes, the folder of masks and the job's own. A
// photograph in a sub-folder is named after it: cam1/0001.jpg becomes cam1_0001.jpg. Frames are taken from
// videos that are named or lie in a folder without photographs. ORL_ERR_NOT_FOUND: an input is not
// there, or a folder holds neither.
enum orl_result orl_photos_list(struct orl_job *job) ORL_CHECK_RESULT;
// Records and reports a photograph that is not used.
void orl_photos_skip(struct orl_job *job, const char *name, const char *why);
// Closes the gaps that finished sources have left.
void orl_photos_close_up(struct orl_job *job);

#endif
