// Private to src/eval.
#ifndef ORL_EVAL_INTERNAL_H
#define ORL_EVAL_INTERNAL_H

#include "eval/eval.h"

// Writes one view's pictures into params->image_dir, which exists.
enum orl_result orl_eval_write_images(const struct orl_log *log, const struct orl_scene *scene,
                                      const struct orl_eval_params *params, size_t photo,
                                      const struct orl_image *rendered,
                                      const struct orl_image *photograph) ORL_CHECK_RESULT;

#endif
