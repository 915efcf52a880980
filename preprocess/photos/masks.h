// The masks of photographs that a user gives, brought to one form.
#ifndef ORL_PREPROCESS_MASKS_H
#define ORL_PREPROCESS_MASKS_H

#include "preprocess/job/job.h"

// Drops the sources that are masks of others by their names, with a word unless masks are asked for.
void orl_masks_set_aside(struct orl_job *job);
// Finds the mask of each source in the folder of masks and sets source->mask to a copy that every
// reader, COLMAP's too, takes alike: PNG, one channel, 255 for pixels that count and 0 for others. Without
// such a folder it says whether photographs have alpha.
enum orl_result orl_masks_find(struct orl_job *job) ORL_CHECK_RESULT;

#endif
