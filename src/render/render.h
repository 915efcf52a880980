// The frame: depth from points, visibility, colour from photographs.
#ifndef ORL_RENDER_RENDER_H
#define ORL_RENDER_RENDER_H

#include "core/image.h"
#include "gpu/gpu.h"
#include "scene/scene.h"

// --- methods and options ---

enum orl_visibility { ORL_VISIBILITY_NONE, ORL_VISIBILITY_HARD, ORL_VISIBILITY_COUNT };
enum orl_fill {
    ORL_FILL_NONE,
    ORL_FILL_COLOR,
    ORL_FILL_DEPTH,
    ORL_FILL_GROUND, // depth, but no farther than the scene's ground
    ORL_FILL_COUNT
};
enum orl_color_source { ORL_COLOR_POINTS, ORL_COLOR_PHOTOS, ORL_COLOR_SOURCE_COUNT };

enum orl_blend { ORL_BLEND_ALL, ORL_BLEND_BEST, ORL_BLEND_COUNT };
enum orl_alignment_use { ORL_ALIGNMENT_OFF, ORL_ALIGNMENT_ON, ORL_ALIGNMENT_COUNT };
enum orl_antialias { ORL_ANTIALIAS_OFF, ORL_ANTIALIAS_ON, ORL_ANTIALIAS_COUNT };
enum orl_sampling { ORL_SAMPLING_BILINEAR, ORL_SAMPLING_BICUBIC, ORL_SAMPLING_COUNT };

// Images of a frame beside its colour, as bits.
enum orl_layer {
    ORL_LAYER_DEPTH = 1,
    ORL_LAYER_NORMAL = 2,
    ORL_LAYER_COVERAGE = 4,
    ORL_LAYER_CONFIDENCE = 8,
};

// Every key of --set; the table in options.c gives range, unit, cost and help. And, no key:
struct orl_render_params {
    unsigned leave_out; // layers not to be read back: their images stay empty; 0: all are
    enum orl_color_source color;    // points: the splats' own colour; photos: blended photographs
    enum orl_visibility visibility; // of surface points in photographs
    enum orl_fill fill;             // of pixels that no splat covers
    enum orl_sampling sampling;     // of photographs
    enum orl_alignment_use alignment; // gains and vignetting of the scene are undone; a
                                    // renderer of radiance undoes them always
    enum orl_blend blend;           // all that see a pixel, or the best few
    enum orl_antialias antialias;   // of depth edges; not of radiance
    float depth_tolerance;          // same surface, fraction of depth, (0, 0.5]
    float splat_scale;              // multiplies splat radii, (0, 16]
    float front_layer;              // splats this close behind the nearest one are averaged
                                    // with it, fraction of depth, [0, 0.1]
    float silhouette;               // pixels by which depth from splats may reach past silhouettes:
                                    // photographs tell, with blend=best, [0, 4]
    float min_support;              // pixels of the 5x5 around with a surface at this depth
                                    // that a pixel needs to count as surface, [0, 25]
    float points_per_pixel;         // above which splats are thinned, [0, 64]; 0: never
    float distance_floor;           // of Airieau's delta, fraction of viewing distance, (0, 1]
    float border_px;                // photographs fade out over this width, [0, 1024] pixels
    float ghosts;                   // of a radiance renderer: samples that differ from the
                                    // others by this many stops beyond noise and what light
                                    // varies around them count half, [0, 16]; 0: all count
    float photos_per_pixel;         // blended by `best`, [1, 4]
    float candidates;               // of a tile, that each pixel asks, [1, 8]
    float outliers;                 // of `best`: a sample this far from the consensus counts
                                    // half, square root of light, [0, 1]; 0: all count
    float sharpness;                // of `best`: weight = (least penalty / penalty)^sharpness
    float guess_sharpness;          // the same where depth is guessed
    float guess_blur;               // of `best`: colour on guessed depth may lie this share of the
                                    // parallax from its place and is blurred as far, [0, 1]
    float unknown_trust;            // share of trust in photographs without depth there, [0, 1]
};

// One row of the option table.
struct orl_render_option {
    const char *key;
    size_t offset;             // in struct orl_render_params
    const char *const *names;  // of an enum, ended by NULL; NULL: a float
    double min, max;           // of a float
    const char *unit, *help;
};
// Ended by a NULL key.
extern const struct orl_render_option orl_render_options[];

// Values of an option that oriel tune tries, ascending; options without a row are left alone.
struct orl_render_tries {
    const char *key;
    int count;
    double values[6];
};
// Ended by a NULL key.
extern const struct orl_render_tries orl_render_tries[];

struct orl_method {
    const char *name, *description, *source;
    struct orl_render_params params;
};
// All methods, ended by a NULL name. The first is the default.
extern const struct orl_method orl_methods[];
// NULL, with the list of names in the log, when unknown.
const struct orl_method *orl_method_find(const struct orl_log *log, const char *name);
// "key=value"; ORL_ERR_ARGUMENT lists what is allowed.
enum orl_result orl_render_params_set(const struct orl_log *log, struct orl_render_params *params,
                                      const char *assignment) ORL_CHECK_RESULT;

// The method's parameters with what oriel tune found for the scene. ORL_ERR_FORMAT: the
// scene has settings that this program does not know.
enum orl_result orl_render_params_tuned(const struct orl_log *log, const struct orl_method *method,
                                        const struct orl_scene *scene,
                                        struct orl_render_params *params) ORL_CHECK_RESULT;

// --- the renderer ---

struct orl_renderer;
struct orl_sensor;

// How photographs are kept on the device. AUTO: as FULL, unless they do not fit
// max_vram_bytes; then as BC7, on software renderers as BC1.
enum orl_textures {
    ORL_TEXTURES_AUTO,
    ORL_TEXTURES_FULL, // 4 bytes per pixel, exact
    ORL_TEXTURES_BC7,  // 1 byte
    ORL_TEXTURES_BC1,  // half a byte
    ORL_TEXTURES_COUNT
};
// ORL_ERR_ARGUMENT lists what is allowed: auto, full, bc7, bc1.
enum orl_result orl_textures_find(const struct orl_log *log, const char *name,
                                  enum orl_textures *textures) ORL_CHECK_RESULT;

struct orl_renderer_params {
    const bool *use;       // per photograph: may it be used? NULL: all that are not held out
    size_t max_vram_bytes; // plan for this much device memory; 0: no limit
    // Radiance stays uncompressed, and so does all that the device cannot compress.
    enum orl_textures textures;
    int photo_divide;      // photographs at 1/n of their size at most, n a power of two up
                           // to 8; 0: as 1
    // Photographs as radiance: their response, vignetting and exposure undone, each pixel
    // weighing by how well exposed it is (radiance.h). For scenes of several exposures.
    bool radiance;
    const struct orl_sensor *sensor; // with radiance; NULL: ORL_SENSOR_DEFAULTS
};

// Uploads the points and loads photographs. When they do not fit max_vram_bytes it
// plans with compressed photographs (of AUTO), then with fewer at once, then with smaller ones,
// and says so in the log.
// params may be NULL. The scene and gpu must outlive it.
enum orl_result orl_renderer_create(struct orl_gpu *gpu, const struct orl_scene *scene,
                                    const struct orl_renderer_params *params,
                                    struct orl_renderer **out) ORL_CHECK_RESULT;
void orl_renderer_destroy(struct orl_renderer **renderer);

// One rendered view, in host memory. All images have the view's size.
struct orl_frame {
    struct orl_image color;    // F32 x3, scene-linear, Rec. 709 primaries
    struct orl_image depth;    // F32 x1, z in scene units, 0 = none
    struct orl_image normal;   // F32 x3, camera frame, 0 = none
    struct orl_image coverage; // F32 x1, 1 where the proxy and a photograph cover, else 0
    // F32 x1, only of a radiance renderer: mean trust (radiance.h) of the samples that made
    // the pixel, each weighing as in its colour; 0 where there were none.
    struct orl_image confidence;
};
void orl_frame_finish(struct orl_frame *frame);

// Renders and reads back, unless `frame` is NULL; the device is done then, too. The same input
// gives the same bits. `skip[i]` leaves a photograph out of this view; NULL: none.
enum orl_result orl_renderer_draw(struct orl_renderer *renderer, const struct orl_view *view,
                                  const struct orl_render_params *params, const bool *skip,
                                  struct orl_frame *frame) ORL_CHECK_RESULT;

// sRGB-encoded 8-bit RGB of a scene-linear image; values are clamped.
enum orl_result orl_tone_srgb(const struct orl_log *log, const struct orl_image *linear,
                              struct orl_image *srgb) ORL_CHECK_RESULT;

#endif
