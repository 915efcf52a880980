// Synthetic monuments: photographs whose cameras, depth, normals and radiance are known exactly.
// World frame: metres, y up, the ground at y = 0.
#ifndef ORL_DATASETS_SYNTH_H
#define ORL_DATASETS_SYNTH_H

#include "oriel/image.h"
#include "oriel/option_row.h"
#include "oriel/progress.h"
#include "oriel/gpu.h"
#include "oriel/camera.h"

enum {
    ORL_SYNTH_COUNT_MAX = 999,
    ORL_SYNTH_SIDE_MIN = 64,
    ORL_SYNTH_SIDE_MAX = 8192,
    ORL_SYNTH_EXPOSURES_MAX = 16,
};

// How the camera turns light in [0, 1] into values in [0, 1]. FILM: the sRGB curve with a camera's
// contrast, darker shadows and soft highlights.
#define ORL_SYNTH_RESPONSES(NAME) NAME(ORL_SYNTH_SRGB, "srgb") NAME(ORL_SYNTH_FILM, "film")
enum orl_synth_response { ORL_SYNTH_RESPONSES(ORL_ENUMERATOR) };

// Contrast also makes the sun contrast_ev / 4 stops stronger. Noise is the standard deviation. Drift
// is of each photograph's exposure, and of the balance of each colour up to a quarter of it. Plain
// walls are in cubes of 1.2 m.
#define ORL_SYNTH_OPTIONS(ROW) \
    ROW(count, "count", INT(24, 2, ORL_SYNTH_COUNT_MAX, "N"), "photographs", "monument") \
    ROW(seed, "seed", SEED, "another set of cameras and stones", "monument") \
    ROW(contrast_ev, "contrast", NUMBER(0, 0, 16, "EV"), \
        "deepens the shade by this many stops, and strengthens the sun", "monument") \
    ROW(noise, "noise", NUMBER(0, 0, 0.5, "SIGMA"), "sensor noise at white, linear", "monument") \
    ROW(response, "response", CHOICE(orl_synth_response, ORL_SYNTH_RESPONSES, ORL_SYNTH_SRGB, \
                                     "NAME"), "the camera's curve", "monument") \
    ROW(vignette, "vignette", NUMBER(0, 0, 0.9, "SHARE"), "light lost in the corners", "monument") \
    ROW(drift_ev, "drift", NUMBER(0, 0, 2, "EV"), \
        "exposure and colour wander by up to this, untold by EXIF", "monument") \
    ROW(gloss, "gloss", NUMBER(0, 0, 1, "SHARE"), \
        "makes the monument shine; 1: as a mirror", "monument") \
    ROW(bars_m, "bars", NUMBER(0, 0, 1.5, "METRES"), \
        "upright bars of this diameter before the monument", "monument") \
    ROW(vehicle, "vehicle", FLAG, "a vehicle, a lamp and two wires before the monument", "monument") \
    ROW(plain, "plain", NUMBER(0, 0, 1, "SHARE"), \
        "share of the walls that has no texture", "monument")
struct orl_synth_params {
    ORL_SYNTH_OPTIONS(ORL_OPTION_MEMBER)
    const char *name;      // "monument"
    int width, height;     // pixels, [ORL_SYNTH_SIDE_MIN, ORL_SYNTH_SIDE_MAX]
    // Photograph i is taken at exposures_ev[i % exposure_count]. Neighbours on the path belong to
    // different series, and no two photographs share a viewpoint.
    double exposures_ev[ORL_SYNTH_EXPOSURES_MAX]; // [-12, 12]; 0: a normal exposure
    int exposure_count;    // 0: all photographs at 0 EV
    // `count` cameras of this size instead of the walk that orl_synth_views makes; NULL: the walk.
    const struct orl_view *views;
};
#define ORL_SYNTH_DEFAULTS \
    ORL_SYNTH_OPTIONS(ORL_OPTION_PRESET) .name = "monument", .width = 768, .height = 512

// ORL_ERR_ARGUMENT, logged, for an unknown name, a size or an exposure out of range. The rows above
// say what the other values may be.
enum orl_result orl_synth_check(const struct orl_log *log,
                                const struct orl_synth_params *params) ORL_CHECK_RESULT;

// Writes the params->count cameras: a walk along an arc in front of the monument at eye height, at
// varying distances, aimed by hand.
void orl_synth_views(const struct orl_synth_params *params, struct orl_view *views);

// EXIF's 35 mm equivalent focal length of every camera: fx = focal_35mm / 35 * larger side, as
// COLMAP reads it.
#define ORL_SYNTH_FOCAL_35MM 28

// --- one view ---

struct orl_synth; // programs and targets for one size
struct orl_synth_frame {
    struct orl_image radiance; // f32, 3 channels, linear, averaged over the pixel
    struct orl_image depth;    // f32, z in camera space at the pixel's centre; 0: sky
    struct orl_image normal;   // f32, 3 channels, camera frame, unit; 0 0 0: sky
    struct orl_image textured; // f32: 0 where a plain wall is; empty without plain walls
    struct orl_image vehicle;  // u8: 255 where the vehicle, the lamp or a wire is; empty without
};
enum orl_result orl_synth_create(struct orl_gpu *gpu, const struct orl_synth_params *params,
                                 struct orl_synth **out) ORL_CHECK_RESULT;
void orl_synth_destroy(struct orl_synth **synth);
// Draws `view`, which must have the size given at creation. Creates the frame's images; the caller
// releases them with orl_synth_frame_finish. Cancellation is polled between bands of rows.
enum orl_result orl_synth_draw(struct orl_synth *synth, const struct orl_progress *progress,
                               const struct orl_view *view,
                               struct orl_synth_frame *frame) ORL_CHECK_RESULT;
void orl_synth_frame_finish(struct orl_synth_frame *frame);
// The curve of a response and its inverse, from [0, 1] to [0, 1]. Arguments are clamped.
double orl_synth_encode(enum orl_synth_response response, double light);
double orl_synth_decode(enum orl_synth_response response, double value);
// "srgb", "film", terminated by NULL, in the order of the enum.
const char *orl_synth_response_name(enum orl_synth_response response);

// The sensor and lens of one photograph.
struct orl_synth_sensor {
    double exposure_ev;
    double drift_ev[3]; // added to exposure_ev, per colour
    double vignette;    // light lost in the corners, fraction
    double noise;       // standard deviation at white, linear
    uint32_t key;       // seed of the noise
    enum orl_synth_response response;
};
// The sensor of photograph `index`.
struct orl_synth_sensor orl_synth_sensor(const struct orl_synth_params *params, int index);
// The photograph that this sensor takes: linear radiance * 2^EV, with vignetting and noise,
// clipped, encoded with the response curve and rounded to 8 bits.
enum orl_result orl_synth_expose(const struct orl_log *log, const struct orl_image *radiance,
                                 const struct orl_synth_sensor *sensor,
                                 struct orl_image *photo) ORL_CHECK_RESULT;

// --- the whole set as files ---

// Writes the photographs to the folder `photos` and their ground truth to `truth`
// (docs/reference/synthetic.md). Both folders must be new or empty, and appear only when complete.
enum orl_result orl_synth_run(struct orl_gpu *gpu, const struct orl_progress *progress,
                              const struct orl_synth_params *params, const char *photos,
                              const char *truth) ORL_CHECK_RESULT;

#endif
