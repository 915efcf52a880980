// Finds what the input holds instead of photographs of a scene, so that errors can give advice.
#ifndef ORL_PREPROCESS_ADVICE_H
#define ORL_PREPROCESS_ADVICE_H

#include "preprocess/job/job.h"

// `extensions` ends with NULL; case is ignored.
bool orl_has_extension(const char *name, const char *const *extensions);
// Decides by the extension.
bool orl_is_photo_name(const char *name);
bool orl_is_video_name(const char *name);
// ORL_ERR_DATA: a video was given as a photograph.
enum orl_result orl_fail_video(const struct orl_job *job, const char *path) ORL_CHECK_RESULT;
// ORL_ERR_NOT_FOUND, naming what else `dir` holds: folders of photographs, videos.
enum orl_result orl_fail_no_photos(const struct orl_job *job, const char *dir) ORL_CHECK_RESULT;
// Counts the views that the photographs show, up to `enough`. Photographs of a camera that stood
// still count as one view, at any exposure and with moving people.
enum orl_result orl_count_views(const struct orl_job *job, size_t enough,
                                size_t *views) ORL_CHECK_RESULT;

#endif
