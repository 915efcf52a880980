// Develop: 8-bit twins of photographs that COLMAP cannot read, and the linear light of those
// with more than 8 bits (docs/reference/files.md, images_linear).
#ifndef ORL_PREPROCESS_DEVELOP_H
#define ORL_PREPROCESS_DEVELOP_H

#include "preprocess/job/job.h"

// By its extension: does COLMAP need an 8-bit twin of it?
bool orl_develop_wanted(const char *name);
// The twin's name, released with free().
char *orl_develop_name(const struct orl_log *log, const char *name);
// Makes the twins that are not there yet: source->path becomes the twin's. Sets
// job->linear_scale.
enum orl_result orl_develop(struct orl_job *job) ORL_CHECK_RESULT;
// The photograph as it was given, in linear light, F32 x3: 1 is its twin's white.
enum orl_result orl_develop_read(const struct orl_job *job, const struct orl_source *source,
                                 struct orl_image *image) ORL_CHECK_RESULT;

#endif
