// Image filters from OpenCV behind a C interface. bridge.cpp is the only C++ file of Oriel. No C++
// exception leaves it.
#ifndef ORL_BRIDGE_BRIDGE_H
#define ORL_BRIDGE_BRIDGE_H

#include "oriel/image.h"

#ifdef __cplusplus
extern "C" {
#endif

// Gaussian filter of `taps` x `taps` pixels (odd, [1, 255]) with standard deviation sigma_px > 0,
// normalised. Border pixels are repeated outwards. F32, any number of channels.
enum orl_result orl_bridge_blur(const struct orl_log *log, const struct orl_image *image, int taps,
                                double sigma_px, struct orl_image *blurred) ORL_CHECK_RESULT;
// Median of the 5x5 pixels around each pixel. Border pixels are repeated outwards. F32 x1.
enum orl_result orl_bridge_median(const struct orl_log *log, const struct orl_image *image,
                                  struct orl_image *median) ORL_CHECK_RESULT;
// Resizes: averages pixel areas where the picture shrinks, interpolates bilinearly where it grows.
// U8 values are averaged as stored and rounded.
enum orl_result orl_bridge_resize(const struct orl_log *log, const struct orl_image *image,
                                  int width, int height,
                                  struct orl_image *resized) ORL_CHECK_RESULT;
// Reduces a photograph to at most its size, without aliasing: as wide a filter as the triangle of
// two new pixels that COLMAP's image_undistorter reduces with.
enum orl_result orl_bridge_reduce(const struct orl_log *log, const struct orl_image *image,
                                  int width, int height,
                                  struct orl_image *reduced) ORL_CHECK_RESULT;

// Tone mapping operators that depend on the whole picture, with OpenCV's defaults. The brightest
// hundredth of Mantiuk's result is clipped.
enum orl_tonemap { ORL_TONEMAP_DRAGO, ORL_TONEMAP_MANTIUK };
// Input: F32 x3, finite light >= 0 in any unit. Output: linear light in [0, 1].
enum orl_result orl_bridge_tonemap(const struct orl_log *log, const struct orl_image *image,
                                   enum orl_tonemap kind,
                                   struct orl_image *mapped) ORL_CHECK_RESULT;
// A camera's response curve by OpenCV. values: U8 x3; each row is one exposure, each column one place of
// the scene, all of which Debevec's matrix takes: some hundreds at most. exposures: of each row, > 0.
// The curve is linear light by channel and value, in any unit, and need not rise everywhere.
enum orl_calibration { ORL_CALIBRATION_DEBEVEC, ORL_CALIBRATION_ROBERTSON };
enum orl_result orl_bridge_response(const struct orl_log *log, enum orl_calibration kind,
                                    const struct orl_image *values, const double *exposures,
                                    float linear[3][256]) ORL_CHECK_RESULT;
// Resamples `image`. map: F32 x2, for each pixel of the result its position in `image`, in pixels
// with centres at whole numbers. Bilinear; black outside.
enum orl_result orl_bridge_remap(const struct orl_log *log, const struct orl_image *image,
                                 const struct orl_image *map,
                                 struct orl_image *remapped) ORL_CHECK_RESULT;

// Clean-up of a mask: U8 x1, 0 or 255.
struct orl_mask_cleaning {
    int open_px, close_px; // diameters of the discs that it is opened and closed with; 0: not
    int min_px;          // smaller pieces of the subject are removed, pixels
    int hole_px;           // smaller holes in it are filled, pixels
};
enum orl_result orl_bridge_clean_mask(const struct orl_log *log, const struct orl_image *mask,
                                      const struct orl_mask_cleaning *cleaning,
                                      struct orl_image *cleaned) ORL_CHECK_RESULT;

// Marks the pixels of a mask (U8 x1, 0: outside) within `reach` rows and columns of a marked one too.
enum orl_result orl_bridge_widen(const struct orl_log *log, const struct orl_image *mask, int reach,
                                 struct orl_image *widened) ORL_CHECK_RESULT;

// Pixels of the largest connected piece of a mask (U8 x1, 0: outside), and of the largest one that
// touches the picture's border; 0 if there is none.
enum orl_result orl_bridge_pieces(const struct orl_log *log, const struct orl_image *mask,
                                  int *largest, int *at_border) ORL_CHECK_RESULT;

// Numbers the connected pieces of a mask (U8 x1, 0: outside) from 1 on; neighbours share a side.
// labels: F32 x1, 0: outside. *count: of pieces.
enum orl_result orl_bridge_label(const struct orl_log *log, const struct orl_image *mask,
                                 struct orl_image *labels, size_t *count) ORL_CHECK_RESULT;

// Signed distance from each pixel's centre to the subject's outline, pixels: positive outside. A
// picture without subject, or of it alone, has its longer side everywhere. Mask: U8 x1, 0: outside;
// result: F32 x1.
enum orl_result orl_bridge_distance(const struct orl_log *log, const struct orl_image *mask,
                                    struct orl_image *distance) ORL_CHECK_RESULT;

#ifdef __cplusplus
}
#endif

#endif
