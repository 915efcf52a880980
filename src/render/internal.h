// Private to src/render: one struct per pass, each in a file of its own.
#ifndef ORL_RENDER_INTERNAL_H
#define ORL_RENDER_INTERNAL_H

#include "shared/render_blocks.h"
#include "render/radiance.h"
#include "render/render.h"

// --- the point cloud on the device (cloud.c) ---

// Points in chunks, so that no buffer is larger than a device takes. A chunk is blocks of
// ORL_BLOCK_POINTS points that are near one another. Each buffer has a view as texels.
struct point_chunk {
    struct orl_buf *positions, *attributes, *blocks, *enlarged, *items, *args;
    struct orl_tex *position_texels;  // RGBA32F: world xyz, radius
    struct orl_tex *attribute_texels; // RG32UI: octahedral normal, colour
    struct orl_tex *block_texels;     // RGBA32F: shaders/proxy/splat_cull.comp
    // Of the last cull; floats, then words:
    struct orl_tex *enlarged_texels, *item_texels, *arg_texels;
    int first, count, block_count;    // count: padded to whole blocks
};

struct cloud {
    struct orl_prog *cull;
    struct point_chunk *chunks;
    size_t chunk_count;
};

// Sorts and uploads; points that are not finite are left out.
enum orl_result orl_cloud_init(struct orl_gpu *gpu, const struct orl_points *points,
                               struct cloud *cloud);
void orl_cloud_finish(struct orl_gpu *gpu, struct cloud *cloud);
// Lists what to draw of each chunk; sizes in `block` are overwritten.
void orl_cloud_cull(struct orl_gpu *gpu, const struct cloud *cloud, struct splat_block *block);

// --- depth from points (proxy.c) ---

enum { PYRAMID_LEVELS_MAX = 9 };

// Depth of one view, rebuilt from the points: splat, pull, push.
struct proxy {
    struct orl_prog *splat_depth, *splat_index, *pull, *push, *support, *color;
    struct orl_prog *resolve[2], *resolve_chunk[2], *push_last[2]; // [1]: with normals
    struct cloud cloud;
};

// What the proxy writes for one picture size.
struct proxy_target {
    int width, height, levels;
    struct orl_tex *splat_depth;  // R32UI: bits of the nearest depth; all ones: empty
    struct orl_tex *splat_index;  // R32UI: the nearest point; all ones: empty
    struct orl_tex *splat_layer;  // R32UI: shaders/proxy/splat.glsl
    struct orl_tex *splats;       // RG32UI: level 0 of the pyramid: shaders/proxy/surfel.glsl; used
                                  // where normals are asked for
    struct orl_tex *chunk_splats; // RGBA32UI: what it was made from; NULL: points are one chunk
    struct orl_tex *surfel_a[PYRAMID_LEVELS_MAX]; // from level 1 on
    struct orl_tex *surfel_b[PYRAMID_LEVELS_MAX];
    struct orl_tex *pushed_depth; // before stray points are dropped; photos.c: with holes guessed
    struct orl_tex *depth;        // R32F: z, 0: none
    struct orl_tex *normal;       // RGBA16F: camera frame, 0: none; w: 1 where a splat shows
};

enum orl_result orl_proxy_init(struct orl_gpu *gpu, const struct orl_points *points,
                               struct proxy *proxy);
void orl_proxy_finish(struct orl_gpu *gpu, struct proxy *proxy);
// For drawing `proxy` into it. Does nothing when the target has this size already.
enum orl_result orl_proxy_target_resize(struct orl_gpu *gpu, const struct proxy *proxy,
                                        struct proxy_target *target, int width, int height);
void orl_proxy_target_finish(struct orl_gpu *gpu, struct proxy_target *target);
// Bytes of a target of this size.
size_t orl_proxy_target_bytes(const struct proxy *proxy, int width, int height);
// How the proxy is made, from the method's parameters.
struct proxy_options {
    float splat_scale, front_layer, min_support, points_per_pixel;
};
// `normals`: else target->normal is left as it was, which saves a tenth of a software renderer's
// time.
void orl_proxy_draw(struct orl_gpu *gpu, const struct proxy *proxy, const struct orl_view *view,
                    const struct proxy_options *options, bool normals,
                    struct proxy_target *target);
// Colours of the splats that show in a drawn target, linear, 1 as weight, into `color`
// (GL_RGBA32F); other pixels stay as they are.
void orl_proxy_color(struct orl_gpu *gpu, const struct proxy *proxy, const struct orl_view *view,
                     const struct proxy_target *target, struct orl_tex *color);

// Work groups that cover width x height pixels.
void orl_pixel_groups(int width, int height, unsigned groups[3]);

// --- photographs on the device (photos.c) ---

// Where a photograph is kept. All photographs share two arrays: one layer is one slot, the
// photograph in its top left corner.
struct photo_state {
    bool usable;
    int slot; // -1: not resident
    bool has_depth;
    struct proxy_options depth_options; // that its depth was made with
    unsigned last_use;
    float white;  // of radiance: what its colours on the device are multiplied by
    bool rounded; // to 8 bits
    struct orl_camera color_camera, depth_camera; // as resident, in pixels of level 0
};

struct photos {
    const struct orl_scene *scene;
    struct photo_state *states; // per photograph of the scene
    struct orl_tex *color;      // mipmapped: sRGB, or radiance * trust and trust
    GLenum format;              // of color
    struct orl_tex *loading;    // a photograph before it is compressed; NULL: format is not
    struct orl_tex *depth;      // z; < 0: guessed in a hole, 0: none
    int slot_count, divide;     // photographs are loaded at 1/divide of their size
    unsigned clock;
    struct proxy_target target; // for depth maps
    struct orl_prog *guess_holes;
    bool radiance;              // see struct orl_renderer_params
    struct orl_sensor sensor;
    float ev_darkest, ev_brightest; // of the photographs in use
};

// The format that is asked for, if the device and the pixels allow it (textures.c).
GLenum orl_textures_format(const struct orl_gpu *gpu, bool radiance, enum orl_textures textures);
enum orl_result orl_photos_init(struct orl_gpu *gpu, const struct orl_scene *scene,
                                const struct orl_renderer_params *params, size_t budget_bytes,
                                struct photos *photos);
void orl_photos_finish(struct orl_gpu *gpu, struct photos *photos);
// Makes colour resident, and depth (depth_options not NULL); evicts the least recently
// used when all slots are taken.
enum orl_result orl_photos_require(struct orl_gpu *gpu, struct photos *photos,
                                   const struct proxy *proxy, size_t photo,
                                   const struct proxy_options *depth_options);

// --- filling (fill.c) ---

struct fill {
    struct orl_prog *seed_depth, *seed_color, *pull, *push, *apply_depth;
    struct orl_prog *seed_least, *seed_brighter, *lift; // of radiance
    int width, height, levels;
    struct image_block block; // of its passes
    // value * weight, weight; level 0 has half the size
    struct orl_tex *level[PYRAMID_LEVELS_MAX + 8];
};

enum orl_result orl_fill_init(struct orl_gpu *gpu, float depth_scale, bool radiance,
                              struct fill *fill);
enum orl_result orl_fill_resize(struct orl_gpu *gpu, struct fill *fill, int width, int height);
void orl_fill_finish(struct orl_gpu *gpu, struct fill *fill);
// Guesses background depth, as negative values, where `depth` is 0; no farther than the
// ground, if not NULL.
void orl_fill_depth(struct orl_gpu *gpu, struct fill *fill, const struct orl_view *view,
                    const struct orl_ground *ground, struct orl_tex *depth);
// Spreads `accumulated` (colour * weight, weight) over fill->level[0]; NULL: what that holds, 2x2
// pixels of colour, 1 summed. Of radiance: what `accumulated` says clips takes light from around
// it first, and its weight's sign with it.
void orl_fill_color(struct orl_gpu *gpu, struct fill *fill, struct orl_tex *accumulated);
// Does this fill guess depth?
bool orl_fill_guesses(const struct orl_render_params *params);

// --- what the blur of guesses takes in (soften.c) ---

struct soften {
    struct orl_prog *seed;   // of radiance
    struct orl_tex *guesses; // mipmapped: shaders/fill/compose.comp
};

enum orl_result orl_soften_init(struct orl_gpu *gpu, bool radiance, struct soften *soften);
// For pictures of this size; does nothing when they had it already.
enum orl_result orl_soften_resize(struct orl_gpu *gpu, struct soften *soften, int width,
                                  int height);
void orl_soften_finish(struct orl_gpu *gpu, struct soften *soften);
// Sums and mipmaps of what is painted on guessed depth. gather_best.comp has written the sums; of
// radiance they are made of `accumulated`, where `trusted` says so.
void orl_soften_prepare(struct orl_gpu *gpu, const struct soften *soften,
                        const struct orl_tex *accumulated, const struct orl_tex *trusted);

// --- depth edges (edges.c) ---

struct edges {
    struct orl_prog *find, *judge, *cut; // shaders/silhouette_*.comp
    struct orl_prog *find_steps, *average[2], *write[2]; // shaders/antialias*.comp; [1]: HALF
    struct orl_buf *list;  // shaders/edges/edge_list.glsl
    struct orl_tex *votes; // R32F, of listed pixels
};

enum orl_result orl_edges_init(struct orl_gpu *gpu, struct edges *edges);
// For pictures of this size; does nothing when they had it already.
enum orl_result orl_edges_resize(struct orl_gpu *gpu, struct edges *edges, int width, int height);
void orl_edges_finish(struct orl_gpu *gpu, struct edges *edges);
// Takes the target's depth back from where it reaches past silhouettes; no normal is left there.
// `choice`: the dispatch of shaders/gather/choose.comp, which has run.
void orl_edges_cut(struct orl_gpu *gpu, const struct edges *edges,
                   const struct orl_dispatch *choice, const struct proxy_target *target);
// Averages the finished colours across the steps of `depth`.
void orl_edges_antialias(struct orl_gpu *gpu, const struct edges *edges,
                         const struct orl_tex *depth, struct orl_tex *color);

// --- blending (gather.c) ---

enum { PHOTOS_PER_FRAME_MAX = 48 }; // of blend=best
enum { KEPT_PROGRAMS = 2 };         // for pixels of two photographs and of more

struct gather {
    struct orl_prog *choose;
    struct orl_prog *all[ORL_SAMPLING_COUNT], *best[ORL_SAMPLING_COUNT][KEPT_PROGRAMS];
    // Instead of these three in a renderer of radiance.
    struct orl_prog *choose_radiance[ORL_BLEND_COUNT], *radiance[ORL_BLEND_COUNT];
    struct photo_data *list; // of the photographs of one dispatch
    size_t *chosen;          // their indices in the scene
    struct orl_buf *photos;  // struct photo_data
    struct orl_tex *photo_rows; // its view, RGBA32F
    struct orl_buf *tile_lists; // choose.comp, choose_radiance.comp
    struct orl_buf *unfinished; // of the last gather_best.comp: shaders/gather/unfinished.glsl
};

enum orl_result orl_gather_init(struct orl_gpu *gpu, size_t photo_count, bool radiance,
                                struct gather *gather);
// The at most `most` usable photographs that can paint this view best, ascending (preselect.c).
enum orl_result orl_preselect(const struct orl_log *log, const struct photos *photos,
                              const struct orl_view *view, const bool *skip, size_t most,
                              size_t *chosen, size_t *count) ORL_CHECK_RESULT;

void orl_gather_finish(struct orl_gpu *gpu, struct gather *gather);
// Does orl_gather leave finished pixels? By blend=best, but of radiance.
bool orl_blends_at_once(const struct orl_renderer *r, const struct orl_render_params *params);
// Colour from the usable photographs as colour * weight, weight into r->accumulated. Blended at
// once: as colour, coverage, but for r->gather.unfinished, and summed for orl_fill_color into the
// fill's finest level.
enum orl_result orl_gather(struct orl_renderer *r, const struct orl_view *view,
                           const struct orl_render_params *params, const bool *skip);

struct orl_renderer {
    struct orl_gpu *gpu;
    const struct orl_scene *scene;
    struct proxy proxy;
    struct photos photos;
    struct fill fill;
    struct soften soften;
    struct edges edges;
    struct gather gather;
    struct orl_prog *compose, *compose_rest;
    struct proxy_target target;
    struct orl_tex *accumulated; // colour * weight, weight; composed in place. Half floats where
                                 // blended at once
    struct orl_tex *trusted;     // of radiance: weight * trust, weight, blur of guesses
    struct orl_image staging; // read_back.c
};

// renderer.c
struct proxy_options orl_proxy_options(const struct orl_render_params *params);
// Nothing accumulated, and no trust.
void orl_accumulated_clear(struct orl_renderer *r);

// read_back.c: the last draw; leave_out as of struct orl_render_params.
enum orl_result orl_read_back(struct orl_renderer *r, unsigned leave_out, struct orl_frame *frame);

#endif
