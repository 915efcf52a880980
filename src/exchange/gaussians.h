// A scene's points as Gaussians whose colour depends on the direction of view, as programs of
// Gaussian splatting draw them (Kerbl et al. 2023, "3D Gaussian splatting for real-time radiance
// field rendering"; Huang et al. 2024, "2D Gaussian splatting").
#ifndef ORL_EXCHANGE_GAUSSIANS_H
#define ORL_EXCHANGE_GAUSSIANS_H

#include "oriel/progress.h"
#include "oriel/scene.h"

enum { ORL_HARMONICS_MAX = 9, ORL_DEGREE_MAX = 2 };

struct orl_gaussians {
    const struct orl_points *points;
    int degree;      // of the spherical harmonics, [0, ORL_DEGREE_MAX]
    int terms;       // (degree + 1)^2
    float *harmonics; // owned: [point][term][channel], of sRGB colour less a half
};

// Fits the colours of the scene's points to the training photographs that see them, by least
// squares with a ridge towards the point's own colour. A point that no photograph sees keeps its
// own colour. The scene must outlive *out, whose owner calls orl_gaussians_finish.
enum orl_result orl_gaussians_fit(const struct orl_log *log, const struct orl_progress *progress,
                                  const struct orl_scene *scene, int degree,
                                  struct orl_gaussians *out) ORL_CHECK_RESULT;
void orl_gaussians_finish(struct orl_gaussians *gaussians);

// Real spherical harmonics in the order and with the signs of Kerbl et al., of a unit vector from
// the camera to the point.
void orl_harmonics(const double direction[3], int terms, double out[ORL_HARMONICS_MAX]);

// One Gaussian, whose third axis is the point's normal.
struct orl_gaussian {
    float rotation_wxyz[4];
    float scale[3];    // standard deviations, scene units
    float opacity;     // (0, 1)
};
void orl_gaussian_shape(const struct orl_gaussians *gaussians, size_t point,
                        struct orl_gaussian *shape);

#endif
