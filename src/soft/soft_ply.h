// Soft splats as a PLY file in the layout of Kerbl 2023, which other programs read, too: positions, harmonics by
// channel, logits of opacities, logarithms of standard deviations, quaternions;
// and behind these the size of a photograph's pixel where the splat is.
#ifndef ORL_SOFT_PLY_H
#define ORL_SOFT_PLY_H

#include "soft/model.h"

enum orl_result orl_soft_write(const struct orl_log *log, const char *path,
                               const struct orl_soft_model *model) ORL_CHECK_RESULT;
// Reads a file that orl_soft_write wrote. ORL_ERR_FORMAT: it is another, or damaged.
enum orl_result orl_soft_read(const struct orl_log *log, const char *path,
                              struct orl_soft_model *model) ORL_CHECK_RESULT;
// Reads those of the scene in the folder. ORL_ERR_NOT_FOUND: it has none (oriel refine).
enum orl_result orl_soft_read_scene(const struct orl_log *log, const char *scene_dir,
                                    struct orl_soft_model *model) ORL_CHECK_RESULT;

#endif
