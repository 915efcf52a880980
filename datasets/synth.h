// Synthetic monuments: photographs with cameras, depth, normals and radiance
// that are known exactly. World: metres, y up, the ground at y = 0.
#ifndef ORL_DATASETS_SYNTH_H
#define ORL_DATASETS_SYNTH_H

#include "core/image.h"
#include "core/progress.h"
#include "gpu/gpu.h"
#include "scene/camera.h"

enum {
    ORL_SYNTH_COUNT_MAX = 999,
    ORL_SYNTH_SIDE_MIN = 64,
    ORL_SYNTH_SIDE_MAX = 8192,
    ORL_SYNTH_EXPOSURES_MAX = 16,
};

// How the camera turns light in [0, 1] into values in [0, 1].
enum orl_synth_response {
    ORL_SYNTH_SRGB,
    ORL_SYNTH_FILM, // the sRGB curve with a camera's contrast: darker shadows, soft highlights
};

struct orl_synth_params {
    const char *name;      // one of orl_synth_names
    int width, height;     // pixels, [ORL_SYNTH_SIDE_MIN, ORL_SYNTH_SIDE_MAX]
    int count;             // photographs, [2, ORL_SYNTH_COUNT_MAX]
    uint32_t seed;         // of cameras, stones and sensor noise
    // Photograph i is taken at exposures_ev[i % exposure_count]: neighbours on the
    // path belong to different series, no two photographs share a viewpoint.
    double exposures_ev[ORL_SYNTH_EXPOSURES_MAX]; // [-12, 12], 0: as the eye would
    int exposure_count;    // 0: all at 0 EV
    // A sun this / 4 stops stronger, and the passage and the far side of the square up to
    // this many stops darker; [0, 16].
    double contrast_ev;
    double noise;          // sensor noise: standard deviation at white, linear, [0, 0.5]
    enum orl_synth_response response;
    double vignette;       // light lost in the corners, fraction, [0, 0.9]
    // Each photograph's exposure is off by up to this much, and each colour's by up to a
    // quarter of it, without EXIF saying so; EV, [0, 2].
    double drift_ev;
};
#define ORL_SYNTH_DEFAULTS .name = "monument", .width = 768, .height = 512, .count = 24, .seed = 1

// All names, ended by NULL, and what each shows.
const char *const *orl_synth_names(void);
const char *orl_synth_summary(const char *name); // NULL when unknown

// ORL_ERR_ARGUMENT, logged, for an unknown name or a value out of range.
enum orl_result orl_synth_check(const struct orl_log *log,
                                const struct orl_synth_params *params) ORL_CHECK_RESULT;

// The cameras, params->count of them: a walk along an arc before the monument, at
// eye height, now closer, now farther, aimed by hand.
void orl_synth_views(const struct orl_synth_params *params, struct orl_view *views);

// What EXIF says a camera with this focal length has: fx = focal_35mm / 35 * larger side,
// as COLMAP reads it.
#define ORL_SYNTH_FOCAL_35MM 28

// --- one view ---

struct orl_synth; // programs and targets for one size
struct orl_synth_frame {
    struct orl_image radiance; // f32, 3 channels, linear, averaged over the pixel
    struct orl_image depth;    // f32, z in camera space at the pixel's centre; 0: sky
    struct orl_image normal;   // f32, 3 channels, camera frame, unit; 0 0 0: sky
};
enum orl_result orl_synth_create(struct orl_gpu *gpu, const struct orl_synth_params *params,
                                 struct orl_synth **out) ORL_CHECK_RESULT;
void orl_synth_destroy(struct orl_synth **synth);
// `view` has the size given at creation. The frame's images are created here and
// released with orl_synth_frame_finish. Cancellation is polled between bands of rows.
enum orl_result orl_synth_draw(struct orl_synth *synth, const struct orl_progress *progress,
                               const struct orl_view *view,
                               struct orl_synth_frame *frame) ORL_CHECK_RESULT;
void orl_synth_frame_finish(struct orl_synth_frame *frame);
// The curve of a response and its inverse, [0, 1] to [0, 1]; arguments are clamped.
double orl_synth_encode(enum orl_synth_response response, double light);
double orl_synth_decode(enum orl_synth_response response, double value);
// "srgb", "film", ended by NULL, in the order of the enum.
const char *const *orl_synth_response_names(void);

// One photograph's camera.
struct orl_synth_sensor {
    double exposure_ev;
    double drift_ev[3]; // added to exposure_ev, per colour
    double vignette;    // light lost in the corners, fraction
    double noise;       // standard deviation at white, linear
    uint32_t key;       // chooses the noise
    enum orl_synth_response response;
};
// The sensor of photograph `index`.
struct orl_synth_sensor orl_synth_sensor(const struct orl_synth_params *params, int index);
// The photograph that it would take: linear radiance * 2^EV, darkened towards the corners,
// with noise, clipped, encoded, 8 bit.
enum orl_result orl_synth_expose(const struct orl_log *log, const struct orl_image *radiance,
                                 const struct orl_synth_sensor *sensor,
                                 struct orl_image *photo) ORL_CHECK_RESULT;

// --- all of them, as files ---

// Writes photographs to `photos` and what is true of them to `truth` (docs/synth.md).
// Both are new or empty folders, and appear only when whole.
enum orl_result orl_synth_run(struct orl_gpu *gpu, const struct orl_progress *progress,
                              const struct orl_synth_params *params, const char *photos,
                              const char *truth) ORL_CHECK_RESULT;

#endif
