// The frame: depth from points, visibility, colour from photographs.
#ifndef ORL_RENDER_RENDER_H
#define ORL_RENDER_RENDER_H

#include "core/image.h"
#include "gpu/gpu.h"
#include "render/option_list.h"
#include "scene/scene.h"

// --- methods and options ---

enum orl_fill {
    ORL_FILL_NONE,
    ORL_FILL_COLOR,
    ORL_FILL_DEPTH,
    ORL_FILL_GROUND, // depth, but no farther than the scene's ground
    ORL_FILL_COUNT
};
enum orl_alignment_use { ORL_ALIGNMENT_OFF, ORL_ALIGNMENT_ON };
enum orl_antialias { ORL_ANTIALIAS_OFF, ORL_ANTIALIAS_ON };
enum orl_median { ORL_MEDIAN_OFF, ORL_MEDIAN_HOLES, ORL_MEDIAN_ALL };
enum orl_sampling { ORL_SAMPLING_BILINEAR, ORL_SAMPLING_BICUBIC };
// What photographs give: colours as they are, or radiance (struct orl_renderer_params).
enum orl_sample { ORL_SAMPLE_SRGB, ORL_SAMPLE_RADIANCE };

// Images of a frame beside its colour, as bits.
enum orl_layer {
    ORL_LAYER_DEPTH = 1,
    ORL_LAYER_NORMAL = 2,
    ORL_LAYER_COVERAGE = 4,
    ORL_LAYER_CONFIDENCE = 8,
};

enum { ORL_OPTION_NAME_BYTES = 32 };

// Every key of --set; option_list.h gives range, unit, readers and help. And, no keys:
struct orl_render_params {
    unsigned leave_out;     // layers not to be read back: their images stay empty; 0: all are
    enum orl_sample sample; // tells which options are read; a renderer knows its own
#define ORL_SLOT_FIELD(field, preset, readers, help) char field[ORL_OPTION_NAME_BYTES];
#define ORL_CHOICE_FIELD(field, type, names, preset, readers, help) enum type field;
#define ORL_NUMBER_FIELD(field, preset, least, most, unit, readers, tries, help) float field;
    ORL_RENDER_OPTIONS(ORL_SLOT_FIELD, ORL_CHOICE_FIELD, ORL_NUMBER_FIELD)
#undef ORL_SLOT_FIELD
#undef ORL_CHOICE_FIELD
#undef ORL_NUMBER_FIELD
};

enum orl_option_kind { ORL_OPTION_SLOT, ORL_OPTION_CHOICE, ORL_OPTION_NUMBER };
enum { ORL_TRIES_MAX = 6 };

// One row of the option table.
struct orl_render_option {
    const char *key;
    enum orl_option_kind kind;
    size_t offset;       // in struct orl_render_params
    const char *names;   // of a choice, separated by spaces, in the order of its enum
    double least, most;  // of a number
    const char *unit;    // of a number
    const char *readers; // option_list.h
    const char *help;
    double tries[ORL_TRIES_MAX]; // of a number: what oriel tune tries, ascending
    int try_count;               // 0: it is left alone
};
// Ended by a NULL key.
extern const struct orl_render_option orl_render_options[];
// The option of this key; NULL: there is none.
const struct orl_render_option *orl_render_option_find(const char *key);
// The `index`-th name that a slot or a choice may have; false: there are no more.
bool orl_render_option_name(const struct orl_render_option *option, size_t index,
                            char name[ORL_OPTION_NAME_BYTES]);
// Does anything read this option, with these choices?
bool orl_render_option_read(const struct orl_render_option *option,
                            const struct orl_render_params *params);
// The option's value as --set takes it.
void orl_render_option_print(const struct orl_render_option *option,
                             const struct orl_render_params *params, char *text, size_t size);

// A method is a row of choices. Its name and what was published of it, and its parameters.
struct orl_method {
    const char *name, *description, *source;
    struct orl_render_params params;
};
// All methods, ended by a NULL name. The first is the default.
extern const struct orl_method orl_methods[];
// NULL, with the list of names in the log, when unknown.
const struct orl_method *orl_method_find(const struct orl_log *log, const char *name);
// Sets each of "key=value", then checks all of them. ORL_ERR_ARGUMENT, which lists what is
// allowed: an unknown key, a value out of range, a key that nothing reads with the choices that
// result, choices that do not go together.
enum orl_result orl_render_params_assign(const struct orl_log *log,
                                         struct orl_render_params *params,
                                         const char *const *assignments,
                                         size_t count) ORL_CHECK_RESULT;
// The same of one.
enum orl_result orl_render_params_set(const struct orl_log *log, struct orl_render_params *params,
                                      const char *assignment) ORL_CHECK_RESULT;
// Do the choices go together? ORL_ERR_ARGUMENT says which do not.
enum orl_result orl_render_params_check(const struct orl_log *log,
                                        const struct orl_render_params *params) ORL_CHECK_RESULT;

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
// By enum orl_textures, ended by NULL.
extern const char *const orl_textures_names[ORL_TEXTURES_COUNT + 1];

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
