// What was given in place of photographs of a scene, so that errors can say what to do.
#ifndef ORL_PREPROCESS_ADVICE_H
#define ORL_PREPROCESS_ADVICE_H

#include "preprocess/job/job.h"

// `extensions` ends with NULL; case does not matter.
bool orl_has_extension(const char *name, const char *const *extensions);
// By extension.
bool orl_is_photo_name(const char *name);
bool orl_is_video_name(const char *name);
// ORL_ERR_DATA: a video was named as a photograph.
enum orl_result orl_fail_video(const struct orl_job *job, const char *path) ORL_CHECK_RESULT;
// ORL_ERR_NOT_FOUND, with what else is in `dir`: folders of photographs, videos.
enum orl_result orl_fail_no_photos(const struct orl_job *job, const char *dir) ORL_CHECK_RESULT;
// How many views the photographs show, those of a camera that stood still being one whatever
// their exposure and whoever walked by. Counts up to `enough`.
enum orl_result orl_count_views(const struct orl_job *job, size_t enough,
                                size_t *views) ORL_CHECK_RESULT;

#endif
