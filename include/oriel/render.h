// Renders a view: depth from points, visibility, colour from photographs.
#ifndef ORIEL_RENDER_H
#define ORIEL_RENDER_H

#include "oriel/image.h"
#include "oriel/gpu.h"
#include "oriel/option_list.h"
#include "oriel/option_row.h"
#include "oriel/progress.h"
#include "oriel/scene.h"

// --- methods and options ---

// GROUND: as DEPTH, but no farther than the scene's ground. ROOM: photographs projected on the walls around.
#define ORL_FILLS(NAME) \
    NAME(ORL_FILL_NONE, "none") NAME(ORL_FILL_COLOR, "color") NAME(ORL_FILL_DEPTH, "depth") \
    NAME(ORL_FILL_GROUND, "ground") NAME(ORL_FILL_ROOM, "room")
enum orl_fill { ORL_FILLS(ORL_ENUMERATOR) ORL_FILL_COUNT };
#define ORL_ALIGNMENT_USES(NAME) NAME(ORL_ALIGNMENT_OFF, "off") NAME(ORL_ALIGNMENT_ON, "on")
enum orl_alignment_use { ORL_ALIGNMENT_USES(ORL_ENUMERATOR) };
#define ORL_ANTIALIASES(NAME) NAME(ORL_ANTIALIAS_OFF, "off") NAME(ORL_ANTIALIAS_ON, "on")
enum orl_antialias { ORL_ANTIALIASES(ORL_ENUMERATOR) };
#define ORL_MEDIANS(NAME) NAME(ORL_MEDIAN_OFF, "off") NAME(ORL_MEDIAN_HOLES, "holes") NAME(ORL_MEDIAN_ALL, "all")
enum orl_median { ORL_MEDIANS(ORL_ENUMERATOR) };
#define ORL_SAMPLINGS(NAME) NAME(ORL_SAMPLING_BILINEAR, "bilinear") NAME(ORL_SAMPLING_BICUBIC, "bicubic")
enum orl_sampling { ORL_SAMPLINGS(ORL_ENUMERATOR) };
// How photographs are sampled: colours as stored, or radiance (struct orl_renderer_params).
enum orl_sample { ORL_SAMPLE_SRGB, ORL_SAMPLE_RADIANCE };

// The images of a frame other than its colour, as bits.
enum orl_layer {
    ORL_LAYER_DEPTH = 1,
    ORL_LAYER_NORMAL = 2,
    ORL_LAYER_COVERAGE = 4,
    ORL_LAYER_CONFIDENCE = 8,
};

// Every key of --set, with range, unit, readers and help in option_list.h, and two fields that are
// no keys:
struct orl_render_params {
    unsigned leave_out;     // layers that are not read back, whose images stay empty
    enum orl_sample sample; // decides which options are read; set by the renderer
    ORL_RENDER_OPTIONS(ORL_OPTION_MEMBER)
};

// The rows of these, terminated by a NULL name.
const struct orl_option *orl_render_options(void);
// The option of "KEY" or "KEY=VALUE"; NULL: none.
const struct orl_option *orl_render_option_find(const char *key);
// True if any part of the frame reads this option with these choices.
bool orl_render_option_read(const struct orl_option *option, const struct orl_render_params *params);

// A method is a row of choices: its name, description, publication and parameters.
struct orl_method {
    const char *name, *description, *source;
    struct orl_render_params params;
    // The method that this one is a variant of: without values of its own in scene.json it takes
    // that one's, but for the options in which the two differ. NULL: none.
    const char *variant_of;
};
// All methods, terminated by a NULL name. The first is the default.
extern const struct orl_method orl_methods[];
// What of a scene the method draws, the most fitting first: points, a mesh, silhouettes.
const char *orl_method_asks(const struct orl_method *method);
// Writes what it reads for each pixel, as a phrase: photographs, how often, and their depth maps.
void orl_method_cost(const struct orl_method *method, char *text, size_t size);
// The name of the method that the scene states as its default, or else (or without a scene) of the
// first.
const char *orl_method_default(const struct orl_scene *scene);
// NULL if the name is unknown; the log then lists the names.
const struct orl_method *orl_method_find(const struct orl_log *log, const char *name);
// Applies each "key=value", then checks all of them. ORL_ERR_ARGUMENT, with the allowed values in
// the log, for an unknown key, a value out of range, a key that nothing reads with the resulting
// choices, or choices that do not go together.
enum orl_result orl_render_params_assign(const struct orl_log *log,
                                         struct orl_render_params *params,
                                         const char *const *assignments,
                                         size_t count) ORL_CHECK_RESULT;
// The same for a single assignment.
enum orl_result orl_render_params_set(const struct orl_log *log, struct orl_render_params *params,
                                      const char *assignment) ORL_CHECK_RESULT;
// Checks that the choices go together. Otherwise ORL_ERR_ARGUMENT; the log names the conflict.
enum orl_result orl_render_params_check(const struct orl_log *log,
                                        const struct orl_render_params *params) ORL_CHECK_RESULT;

// The method's parameters as they suit the scene: with the values that scene.json has for it or for
// the method that it is a variant of, and on a proxy that the scene has. Values that this program does not
// take, as of options that another version had, are ignored, with a warning.
void orl_render_params_tuned(const struct orl_log *log, const struct orl_method *method,
                             const struct orl_scene *scene, struct orl_render_params *params);

// Takes the proxy, its options and the fill of `from`, so that two methods' weights can be compared on the
// same depth and background. The fill stays where the weights cannot use the other one. False: this painter
// has a proxy of its own, and nothing is changed.
bool orl_render_params_take_proxy(const struct orl_render_params *from,
                                  struct orl_render_params *params);

// --- the renderer ---

struct orl_renderer;
struct orl_sensor;

// Texture format of photographs on the device. AUTO: FULL if they fit max_vram_bytes, else YCC.
// FULL: 4 bytes a pixel, lossless. YCC: luma, and chroma at half the size, 3/4 byte. BC1: half a byte.
#define ORL_TEXTURES(NAME) \
    NAME(ORL_TEXTURES_AUTO, "auto") NAME(ORL_TEXTURES_FULL, "full") NAME(ORL_TEXTURES_YCC, "ycc") \
    NAME(ORL_TEXTURES_BC1, "bc1")
enum orl_textures { ORL_TEXTURES(ORL_ENUMERATOR) ORL_TEXTURES_COUNT };
// By enum orl_textures, ended by NULL.
extern const char *const orl_textures_names[ORL_TEXTURES_COUNT + 1];
// True if the device can sample photographs of this format.
bool orl_textures_available(const struct orl_gpu *gpu, enum orl_textures textures);

struct orl_renderer_params {
    const bool *use;       // per photograph: may it be used? NULL: all that are not held out
    size_t max_vram_bytes; // device memory to stay within, bytes; 0: no limit
    // Radiance, and pixels that the device cannot compress, stay uncompressed.
    enum orl_textures textures; // AUTO: as the scene's defaults say, if they do
    int photo_divide;      // photographs are loaded at 1/n of their size or less, n a power
                           // of two up to 8; 0 counts as 1
    // Samples photographs as radiance: response, vignetting and exposure are undone, and each pixel
    // is weighted by how well exposed it is (radiance.h). For scenes with several exposures.
    bool radiance;
    const struct orl_sensor *sensor; // for radiance; NULL: ORL_SENSOR_DEFAULTS
    // Asked ahead of every photograph of a frame, which then ends with ORL_ERR_CANCELLED; NULL:
    // frames are not cancelled. Must outlive the renderer.
    const struct orl_progress *progress;
};

// Uploads the points and loads photographs. If they do not fit max_vram_bytes, it plans with
// compressed photographs (AUTO), then with fewer at once, then with smaller ones, and logs the
// plan.
// params may be NULL. The scene and gpu must outlive *out.
enum orl_result orl_renderer_create(struct orl_gpu *gpu, const struct orl_scene *scene,
                                    const struct orl_renderer_params *params,
                                    struct orl_renderer **out) ORL_CHECK_RESULT;
void orl_renderer_destroy(struct orl_renderer **renderer);

// Bytes of photographs and their masks that have gone to the device so far.
size_t orl_renderer_uploaded(const struct orl_renderer *renderer);

// One rendered view, in host memory. All images have the view's size.
struct orl_frame {
    struct orl_image color;    // F32 x3, scene-linear, Rec. 709 primaries
    struct orl_image depth;    // F32 x1, z in scene units; 0: none
    struct orl_image normal;   // F32 x3, camera frame; 0: none
    struct orl_image coverage; // F32 x1, 1 where both the proxy and a photograph cover, else 0
    // F32 x1, for a radiance renderer only: mean confidence (radiance.h) of the samples of a pixel,
    // with the weights of its colour; 0 if there is no sample.
    struct orl_image confidence;
};
void orl_frame_finish(struct orl_frame *frame);

// Renders and, unless `frame` is NULL, reads back, after which the device is idle. The same input
// gives the same bits. `skip[i]` leaves photograph i out of this view; NULL: none.
enum orl_result orl_renderer_draw(struct orl_renderer *renderer, const struct orl_view *view,
                                  const struct orl_render_params *params, const bool *skip,
                                  struct orl_frame *frame) ORL_CHECK_RESULT;

// Says that the view after the next one shows `time_step` of the scene. While the next one is
// drawn, files of that time step are read on another thread and its hull is made, if the method
// draws one.
// The pictures are the same.
void orl_renderer_expect(struct orl_renderer *renderer, int time_step);

// How a viewer's frame gets its photographs: it paints from those that are on the device, and from
// the points' own colours elsewhere. Files are read on another thread.
struct orl_progressive {
    double seconds; // the frame may spend on photographs; at least one step is always made
    bool at_rest;   // nothing moves: that step may be the long one that completes a photograph
    double spent;   // output: seconds that the frame has spent on photographs
    size_t missing; // output: photographs that are not there yet, or not in full quality
};
// As orl_renderer_draw, without waiting for photographs. With progress->missing 0, the frame has
// the bits of orl_renderer_draw; else a later frame of the same view is better. A photograph that
// cannot be read is logged, from another thread, and left out.
enum orl_result orl_renderer_draw_progressive(struct orl_renderer *renderer,
                                              const struct orl_view *view,
                                              const struct orl_render_params *params,
                                              struct orl_progressive *progress,
                                              struct orl_frame *frame) ORL_CHECK_RESULT;

// Converts a scene-linear image to sRGB-encoded 8-bit RGB. Values are clamped.
enum orl_result orl_tone_srgb(const struct orl_log *log, const struct orl_image *linear,
                              struct orl_image *srgb) ORL_CHECK_RESULT;

#endif
