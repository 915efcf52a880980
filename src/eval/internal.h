// Private to src/eval.
#ifndef ORL_EVAL_INTERNAL_H
#define ORL_EVAL_INTERNAL_H

#include "eval/eval.h"
#include "eval/heldout.h"

// Writes one view's pictures into the existing folder `dir`.
enum orl_result orl_eval_write_images(const struct orl_log *log, const struct orl_eval *eval,
                                      const char *dir, size_t photo,
                                      const struct orl_image *rendered,
                                      const struct orl_image *photograph) ORL_CHECK_RESULT;
// Reads another program's picture of the view, from `dir`, at the photograph's size. All of it counts
// as covered, F32 x1. ORL_ERR_NOT_FOUND, logged: there is none.
enum orl_result orl_eval_read_picture(const struct orl_log *log, const struct orl_scene *scene,
                                      const char *dir, const struct orl_heldout *heldout,
                                      struct orl_image *picture,
                                      struct orl_image *coverage) ORL_CHECK_RESULT;

#endif
