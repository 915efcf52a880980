// Private to the densifier: choice of sources, one photograph's maps, clean-up.
#ifndef ORL_PREPROCESS_DENSIFY_INTERNAL_H
#define ORL_PREPROCESS_DENSIFY_INTERNAL_H

#include "shared/densify_block.h"
#include "preprocess/densify/densify.h"
#include "scene/colmap.h"

struct densify_source {
    size_t photo; // index into densify_photos
    double score; // sum over shared sparse points of how good their angle is
    double prior; // weight among the sources, (0, 1]
    int finer;    // levels by which it shows the scene finer than the reference, [0, 3]
};

// One photograph as reference.
struct densify_plan {
    struct densify_source sources[ORL_DENSIFY_SOURCES_MAX]; // best first
    int count;
    double w_min, w_max; // range of inverse depth
};

// The photographs taking part: those asked for that the model has.
struct densify_photos {
    const struct orl_colmap_model *model; // not owned
    size_t count;
    size_t *images;       // indices into model->images; owned
    struct orl_view *views; // owned
};

enum orl_result orl_densify_photos_init(const struct orl_log *log,
                                        const struct orl_colmap_model *model,
                                        const struct orl_names *names,
                                        struct densify_photos *photos);
void orl_densify_photos_finish(struct densify_photos *photos);
static inline const char *densify_photo_name(const struct densify_photos *photos, size_t photo)
{
    return photos->model->images[photos->images[photo]].name;
}
// Plans for all photographs, released with free(). Photographs without sources have
// count 0.
enum orl_result orl_densify_plans_make(const struct orl_log *log,
                                       const struct densify_photos *photos, int sources,
                                       struct densify_plan **plans);

// --- device memory ---

struct densify_need {
    int width, height; // greatest of any photograph
    int least_side;    // of any photograph
    int padding;       // texels around a source
    bool geometric;    // sources' depths are used
};
struct densify_budget {
    int sources, shrink; // shrink: halvings of the photographs
    uint64_t bytes;
};
// Bytes on the device at most, with one photograph and its sources on it.
uint64_t orl_densify_bytes(const struct densify_need *need, int sources, int shrink);
// The largest photographs, then the most sources up to `sources`, that fit into `max_bytes`
// (0: any number) and whose textures drivers accept; false: nothing does.
bool orl_densify_fit(const struct densify_need *need, int sources, uint64_t max_bytes,
                     struct densify_budget *budget);
// Takes the maps in WORKSPACE/stereo that were made from the same photographs and model
// with the same settings (params as used, photographs halved `shrink` times) as this run's,
// removes those of others, and leaves stereo/densify.json saying so. ORL_ERR_ARGUMENT:
// there are maps without it, which may be another program's.
enum orl_result orl_densify_claim_maps(const struct orl_log *log, const char *workspace,
                                       const struct densify_photos *photos,
                                       const struct orl_densify_params *params,
                                       int shrink) ORL_CHECK_RESULT;

// Texels around each source: patches are up to three times as large there.
int orl_densify_padding(const struct orl_densify_params *params);

// Rows of matrix (x, y, 1, w) -> to's homogeneous pixels, for a pixel of `from` with
// inverse depth w.
void orl_densify_transfer(const struct orl_view *to, const struct orl_view *from, float rows[3][4]);

// A photograph's luma at every level, halved by 2x2 boxes; an odd last row or column
// is left out, so that a coarse pixel k covers exactly the pixels 2k and 2k + 1.
enum { DENSIFY_LEVELS_MAX = 12 };
struct densify_pyramid {
    struct orl_image levels[DENSIFY_LEVELS_MAX];
    int count;
    struct orl_camera camera; // of level 0
};
enum orl_result orl_densify_pyramid_read(const struct orl_log *log, const char *path,
                                         const struct orl_camera *camera,
                                         struct densify_pyramid *pyramid);
void orl_densify_pyramid_finish(struct densify_pyramid *pyramid);
struct orl_camera orl_densify_level_camera(const struct orl_camera *camera, int level);

// Photographs decoded once while memory lasts. A pyramid stays until the next turn at
// least. `photos` and `images_dir` must outlive it.
struct densify_cache;
enum orl_result orl_densify_cache_create(const struct orl_log *log,
                                         const struct densify_photos *photos,
                                         const char *images_dir, struct densify_cache **out);
void orl_densify_cache_destroy(struct densify_cache **cache);
void orl_densify_cache_turn(struct densify_cache *cache);
enum orl_result orl_densify_cache_get(struct densify_cache *cache, size_t photo,
                                      const struct densify_pyramid **pyramid) ORL_CHECK_RESULT;

// --- one photograph on the device ---

struct densify_device;
enum orl_result orl_densify_device_create(struct orl_gpu *gpu,
                                          const struct orl_densify_params *params,
                                          struct densify_device **out);
void orl_densify_device_destroy(struct densify_device **device);

struct densify_maps {
    struct orl_image depth, normal; // one and three channels
    struct orl_image confidence;    // (0, 1] where there is depth
};
void orl_densify_maps_finish(struct densify_maps *maps);

struct densify_job {
    const char *name;
    uint32_t seed; // of this photograph
    struct orl_view view;
    const struct densify_plan *plan;
    struct orl_view source_views[ORL_DENSIFY_SOURCES_MAX];
    const struct densify_pyramid *reference, *sources[ORL_DENSIFY_SOURCES_MAX]; // not owned
    int levels;                                             // of the reference that are used
    struct orl_image mask;                                  // level 0; no data: none
    struct orl_image seeds;                                 // coarsest level: 1/z or 0
    int finest;                                             // level of the maps: 0 = full size
    const struct densify_maps *start;                       // geometric pass: own maps
    struct orl_image source_depths[ORL_DENSIFY_SOURCES_MAX]; // geometric pass
    int draw;  // keeps the random numbers of different passes apart
    bool last; // no pass goes on from these maps
    const struct orl_progress *progress;
    double done, total; // for the progress report; this job counts 1
};
// Does a pixel of a level belong to the subject? It does when any of its pixels does.
bool orl_densify_mask_at(const struct orl_image *mask, int level, int x, int y);

// From coarse to fine; keeps only what matches.
enum orl_result orl_densify_photometric(struct densify_device *device,
                                        const struct densify_job *job,
                                        struct densify_maps *maps);
// Refines job->start at its size, with the sources' depths; keeps only what matches
// well and agrees with a source.
enum orl_result orl_densify_geometric(struct densify_device *device, const struct densify_job *job,
                                      struct densify_maps *maps);

// Gives depth to holes in plain surfaces, which nothing can be matched on: where planes of
// several directions agree and the photograph shows no edge on the way. For the last pass.
enum orl_result orl_densify_complete(const struct orl_log *log, const struct densify_job *job,
                                     struct densify_maps *maps);

// Removes connected pieces of less than `least` pixels; neighbours are connected when one
// is off the other's plane by less than `tolerance` of its depth.
enum orl_result orl_densify_remove_speckles(const struct orl_log *log,
                                            const struct orl_camera *camera,
                                            struct densify_maps *maps, size_t least,
                                            float tolerance);

#endif
