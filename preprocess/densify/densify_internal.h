// Private to the densifier: choice of sources, maps of one photograph, clean-up of maps.
#ifndef ORL_PREPROCESS_DENSIFY_INTERNAL_H
#define ORL_PREPROCESS_DENSIFY_INTERNAL_H

#include "shared/densify_block.h"
#include "preprocess/densify/densify.h"
#include "scene/colmap.h"

struct densify_source {
    size_t photo; // index into densify_photos
    double score; // sum of angle scores over shared sparse points
    double prior; // weight among the sources, (0, 1]
    int finer;    // levels by which it shows the scene finer than the reference, [0, 3]
};

// One photograph as the reference.
struct densify_plan {
    struct densify_source sources[ORL_DENSIFY_SOURCES_MAX]; // best first
    int count;
    double w_min, w_max, w_typical; // inverse depth: range, and of most surfaces
};

// The photographs that take part: the requested ones that the model has.
struct densify_photos {
    const struct orl_colmap_model *model; // not owned
    size_t count;
    size_t *images;       // indices into model->images; owned
    struct orl_view *views; // owned
};

// On success and failure alike, the caller must call orl_densify_photos_finish.
enum orl_result orl_densify_photos_init(const struct orl_log *log,
                                        const struct orl_colmap_model *model,
                                        const struct orl_names *names,
                                        struct densify_photos *photos);
void orl_densify_photos_finish(struct densify_photos *photos);
static inline const char *densify_photo_name(const struct densify_photos *photos, size_t photo)
{
    return photos->model->images[photos->images[photo]].name;
}
// Makes the plans of all photographs, which the caller releases with free(), also after a failure.
// Photographs without sources have count 0.
enum orl_result orl_densify_plans_make(const struct orl_log *log,
                                       const struct densify_photos *photos, int sources,
                                       struct densify_plan **plans);

// --- device memory ---

struct densify_need {
    int width, height; // largest of any photograph
    int min_side;    // smallest of any photograph
    int padding;       // texels around a source
    bool geometric;    // sources' depths are used
};
struct densify_budget {
    int sources, shrink; // shrink: halvings of the photographs
    uint64_t bytes;
};
// Upper bound of device memory in bytes, with one photograph and its sources loaded.
uint64_t orl_densify_bytes(const struct densify_need *need, int sources, int shrink);
// Chooses the largest photographs, then the most sources up to `sources`, that fit into `max_bytes`
// (0: no limit) and whose textures every device accepts. Returns false when nothing fits; *budget is then the least
// that was tried.
bool orl_densify_fit(const struct densify_need *need, int sources, uint64_t max_bytes,
                     struct densify_budget *budget);
// Keeps the maps in WORKSPACE/stereo that were made from the same photographs and model with the
// same settings as this run's (params as used, photographs halved `shrink` times), removes maps
// with other settings, and writes stereo/densify.json. ORL_ERR_ARGUMENT: there are maps without
// that file, which another program may have made.
enum orl_result orl_densify_claim_maps(const struct orl_log *log, const char *workspace,
                                       const struct densify_photos *photos,
                                       const struct orl_densify_params *params,
                                       int shrink) ORL_CHECK_RESULT;

// For a part of a run: ORL_ERR_ARGUMENT unless stereo/densify.json has the settings of this run.
// The photographs are not compared, since each part would read all of them.
enum orl_result orl_densify_check_maps(const struct orl_log *log, const char *workspace,
                                       const struct orl_densify_params *params,
                                       int shrink) ORL_CHECK_RESULT;

// Texels of padding around each source. Patches in a source may be three times as large.
int orl_densify_padding(const struct orl_densify_params *params);

// Rows of the matrix that maps (x, y, 1, w) to homogeneous pixels of `to`, for a pixel (x, y) of
// `from` with inverse depth w.
void orl_densify_transfer(const struct orl_view *to, const struct orl_view *from, float rows[3][4]);

// A photograph's luma at every level, each halved by 2x2 boxes. An odd last row or column is left
// out, so that a coarse pixel k covers exactly the pixels 2k and 2k + 1. Where photographs are halved,
// level 0 is resized before to sides that halve without a rest: whoever reads a map takes it to cover
// the whole photograph.
enum { DENSIFY_LEVELS_MAX = 12 };
struct densify_pyramid {
    struct orl_image levels[DENSIFY_LEVELS_MAX];
    int count;
    struct orl_camera camera; // of level 0
};
// A side of level 0 of a photograph that is halved `shrink` times.
int orl_densify_side(int side, int shrink);
void orl_densify_pyramid_finish(struct densify_pyramid *pyramid);
struct orl_camera orl_densify_level_camera(const struct orl_camera *camera, int level);

// A cache of decoded photographs, filled while memory lasts; it begins with the first four members
// alone. A pyramid stays valid at least until `turn` is raised.
struct densify_cache {
    const struct orl_log *log;
    const struct densify_photos *photos;
    const char *images_dir;
    int shrink; // halvings of the photographs
    struct densify_cache_entry *entries; // owned; of each photograph
    uint64_t turn;
    size_t bytes;
};
void orl_densify_cache_finish(struct densify_cache *cache);
enum orl_result orl_densify_cache_get(struct densify_cache *cache, size_t photo,
                                      const struct densify_pyramid **pyramid) ORL_CHECK_RESULT;

// --- one photograph on the device ---

struct densify_maps {
    struct orl_image depth, normal; // one and three channels
    struct orl_image confidence;    // (0, 1] where there is depth
};
// On success and failure alike, the caller must call orl_densify_maps_finish.
enum orl_result orl_densify_maps_init(const struct orl_log *log, int width, int height,
                                      struct densify_maps *maps) ORL_CHECK_RESULT;
void orl_densify_maps_finish(struct densify_maps *maps);

struct densify_job {
    struct orl_gpu *gpu;
    const struct orl_densify_params *params;
    const char *name;
    uint32_t seed; // of this photograph
    struct orl_view view;
    const struct densify_plan *plan;
    struct orl_view source_views[ORL_DENSIFY_SOURCES_MAX];
    const struct densify_pyramid *reference, *sources[ORL_DENSIFY_SOURCES_MAX]; // not owned
    int levels;                                             // levels of the reference in use
    struct orl_image mask;                                  // level 0; no data: none
    struct orl_image seeds;                                 // coarsest level: 1/z or 0
    int finest;                                             // level of the maps, 0: full size
    const struct densify_maps *start;                       // geometric pass: own previous maps
    struct orl_image source_depths[ORL_DENSIFY_SOURCES_MAX]; // geometric pass
    int draw;  // separates the random numbers of passes
    bool last; // no later pass reads these maps
    const struct orl_progress *progress;
    double done, total; // for the progress report; this job counts 1
};
// True when any full-size pixel under a pixel of a level belongs to the subject.
bool orl_densify_mask_at(const struct orl_image *mask, int level, int x, int y);

// Matches from the coarsest to the finest level and keeps only the depths that match well.
enum orl_result orl_densify_photometric(const struct densify_job *job, struct densify_maps *maps);
// Refines job->start at its size with the sources' depths. Keeps only depths that match well and
// agree with a source.
enum orl_result orl_densify_geometric(const struct densify_job *job, struct densify_maps *maps);

// Fills holes in plain surfaces without texture, where the planes of several directions agree and
// the photograph shows no edge on the way. Belongs to the last pass.
enum orl_result orl_densify_complete(const struct orl_log *log, const struct densify_job *job,
                                     struct densify_maps *maps);

// Removes connected pieces of fewer than `least` pixels. Neighbours are connected when one is off
// the other's plane by less than a hundredth of its depth.
enum orl_result orl_densify_remove_speckles(const struct orl_log *log,
                                            const struct orl_camera *camera,
                                            struct densify_maps *maps, size_t least);

// Removes depth that reaches past an outline: near a step to something farther, of pixels of which
// the stereo is not sure and which look like what is farther. `camera`: of the maps' size; luma: the
// photograph at that size, U8 x1.
enum orl_result orl_densify_trim_outlines(const struct orl_log *log,
                                          const struct orl_camera *camera,
                                          const struct orl_image *luma, struct densify_maps *maps);

#endif
