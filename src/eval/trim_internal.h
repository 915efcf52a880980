// Private to oriel trim: the state of a trimmed scene, and the models made from states.
#ifndef ORL_EVAL_TRIM_INTERNAL_H
#define ORL_EVAL_TRIM_INTERNAL_H

#include "eval/validation.h"
#include "eval/trim.h"
#include "eval/trim_points.h"

// Levels of the parts, from the whole scene on.
enum { TRIM_POINT_LEVELS = 25, TRIM_DEPTH_LEVELS = 5 };
extern const double orl_trim_point_shares[TRIM_POINT_LEVELS];

// What is left of a scene.
struct trim_state {
    // How small each part is; 0: as in the scene. Of textures an enum orl_textures; of depth maps n for
    // half floats at 1/n of the size. So many of the photographs in the search's order were to go; few may
    // have come back.
    size_t level[ORL_TRIM_PART_COUNT];
    struct orl_render_params render;
    bool *removed; // owned, per photograph
    size_t removed_count;
};

// Everything that models are made from.
struct trim_source {
    struct orl_gpu *gpu;
    const struct orl_log *log;
    const struct orl_scene *scene;
    struct orl_point_ranking ranking;
};

// A scene in a state, ready to render.
struct trim_model {
    struct orl_scene scene; // shares what does not change with the source's scene
    struct orl_points points;
    struct orl_renderer *renderer;
    size_t point_bytes, photo_bytes; // on the device, with all photographs
};

enum orl_result orl_trim_state_copy(const struct orl_log *log, const struct trim_state *from,
                                    size_t photo_count,
                                    struct trim_state *to) ORL_CHECK_RESULT;
enum orl_result orl_trim_model_open(const struct trim_source *source,
                                    const struct trim_state *state,
                                    struct trim_model **out) ORL_CHECK_RESULT;
void orl_trim_model_close(struct trim_model **model);
// Bytes of points and photographs on the device, without those in use only while a photograph is
// loaded.
void orl_trim_count_bytes(const struct orl_gpu *gpu, size_t *points, size_t *photos);
// Bytes of the scene's points, cameras, photographs that are not held out and their masks, on disk.
size_t orl_trim_scene_file_bytes(const struct orl_scene *scene);
// Writes the model's scene to the folder `out`, without the photographs that `removed` marks, drawn by
// the choice's method.
enum orl_result orl_trim_write_scene(const struct orl_log *log, const struct orl_scene *scene,
                                     const bool *removed, const struct orl_choice *choice,
                                     const char *out) ORL_CHECK_RESULT;
// How the scene is drawn in this state. Texts are static or the source scene's.
struct orl_scene_defaults orl_trim_defaults(const struct trim_source *source,
                                            const struct trim_state *state);

#endif
