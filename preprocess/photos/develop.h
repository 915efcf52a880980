// Develop: 8-bit sRGB copies of photographs that COLMAP cannot read, or whose colour profile it would
// drop, and the linear light of those with more than 8 bits (docs/reference/files.md, images_linear).
#ifndef ORL_PREPROCESS_DEVELOP_H
#define ORL_PREPROCESS_DEVELOP_H

#include "preprocess/job/job.h"

// Photographs that may be decoded at once, of which half of the memory that is left has room. Those without a size yet
// do not count.
size_t orl_develop_at_once(const struct orl_job *job);
// Makes missing copies and sets source->path to the copy's. Sets job->linear_scale.
enum orl_result orl_develop(struct orl_job *job) ORL_CHECK_RESULT;
// Reads the photograph as given, in linear light, F32 x3. 1 is its copy's white.
enum orl_result orl_develop_read(const struct orl_job *job, const struct orl_source *source,
                                 struct orl_image *image) ORL_CHECK_RESULT;
// Writes an 8-bit sRGB copy of it, brightened by `ev`.
enum orl_result orl_develop_write(const struct orl_job *job, const struct orl_source *source, double ev,
                                  const char *path) ORL_CHECK_RESULT;

#endif
