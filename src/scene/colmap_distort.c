// COLMAP's camera models, as documented in src/colmap/sensor/models.h of COLMAP 4.
#include <math.h>
#include <string.h>

#include "bridge/bridge.h"
#include "scene/colmap.h"
#include "scene/colmap_internal.h"

// Scales u, v by `radial` and adds OpenCV's tangential terms.
static void tangential(double radial, double p1, double p2, double uv[2])
{
    double u = uv[0], v = uv[1], r2 = u * u + v * v;
    uv[0] = u * radial + 2 * p1 * u * v + p2 * (r2 + 2 * u * u);
    uv[1] = v * radial + 2 * p2 * u * v + p1 * (r2 + 2 * v * v);
}

// k1 k2 p1 p2 k3 k4 k5 k6 of OpenCV, of which the simpler models have the first.
static void brown(const double *terms, int count, double uv[2])
{
    double k[8] = {0}, r2 = uv[0] * uv[0] + uv[1] * uv[1], r4 = r2 * r2;
    memcpy(k, terms, (size_t)count * sizeof *k);
    tangential((1 + k[0] * r2 + k[1] * r4 + k[4] * r4 * r2) / (1 + k[5] * r2 + k[6] * r4 + k[7] * r4 * r2), k[2], k[3],
               uv);
}

// Replaces the tangent of the angle t from the axis by t (1 + k0 t^2 + k1 t^4 + ...).
static void fisheye(const double *k, int count, double uv[2])
{
    double r = hypot(uv[0], uv[1]);
    if (!(r > 1e-12))
        return;
    double theta = atan(r), t2 = theta * theta, power = 1, sum = 1;
    for (int i = 0; i < count; i++) {
        power *= t2;
        sum += k[i] * power;
    }
    uv[0] *= theta * sum / r;
    uv[1] *= theta * sum / r;
}

static void fov(double omega, double uv[2])
{
    double r = hypot(uv[0], uv[1]);
    if (!(r > 1e-12) || !(fabs(omega) > 1e-9))
        return;
    double scale = atan(2 * r * tan(omega / 2)) / (r * omega);
    uv[0] *= scale;
    uv[1] *= scale;
}

static void thin_prism(const double *k, double uv[2])
{
    fisheye(NULL, 0, uv);
    double u = uv[0], v = uv[1], r2 = u * u + v * v, r4 = r2 * r2;
    tangential(1 + k[0] * r2 + k[1] * r4 + k[4] * r4 * r2 + k[5] * r4 * r4, k[2], k[3], uv);
    uv[0] += k[6] * r2;
    uv[1] += k[7] * r2;
}

// k0 to k5 of the angle, p0 p1, s0 to s3: Project Aria's Fisheye624.
static void rad_tan_thin_prism(const double *k, double uv[2])
{
    const double *p = k + 6, *s = k + 8;
    fisheye(k, 6, uv);
    double u = uv[0], v = uv[1], r2 = u * u + v * v, r4 = r2 * r2, across = 2 * (p[0] * u + p[1] * v);
    uv[0] += across * u + p[0] * r2 + s[0] * r2 + s[1] * r4;
    uv[1] += across * v + p[1] * r2 + s[2] * r2 + s[3] * r4;
}

// Inverts u = d / (1 + k |d|^2) for the smaller d; NaN where there is none.
static void division(double k, double uv[2])
{
    double r2 = uv[0] * uv[0] + uv[1] * uv[1], scale = 2 / (1 + sqrt(1 - 4 * k * r2));
    uv[0] *= scale;
    uv[1] *= scale;
}

// k0 alpha, k1 beta of the enhanced unified camera model (Khomutenko et al. 2016); NaN where there is no pixel.
static void unified(const double *k, double uv[2])
{
    double r2 = uv[0] * uv[0] + uv[1] * uv[1], depth = k[0] * sqrt(k[1] * r2 + 1) + 1 - k[0];
    double scale = depth > 0 ? 1 / depth : NAN;
    uv[0] *= scale;
    uv[1] *= scale;
}

void orl_colmap_camera_project(const struct orl_colmap_camera *camera, const double ray[2],
                               double pixel[2])
{
    const struct orl_camera *c = &camera->pinhole;
    const struct orl_colmap_lens lens = orl_colmap_model_lens(camera->model);
    // Distortion terms follow f cx cy or fx fy cx cy.
    const double *k = camera->params + lens.focal_lengths + 2;
    const int count = lens.params - lens.focal_lengths - 2;
    double uv[2] = {ray[0], ray[1]};
    switch (lens.kind) {
    case ORL_LENS_FLAT:
        brown(k, count, uv);
        break;
    case ORL_LENS_FISHEYE:
        fisheye(k, count, uv);
        break;
    case ORL_LENS_FOV:
        fov(k[0], uv);
        break;
    case ORL_LENS_THIN_PRISM:
        thin_prism(k, uv);
        break;
    case ORL_LENS_RAD_TAN_THIN_PRISM:
        rad_tan_thin_prism(k, uv);
        break;
    case ORL_LENS_DIVISION:
        division(k[0], uv);
        break;
    case ORL_LENS_EUCM:
        unified(k, uv);
        break;
    }
    pixel[0] = c->fx * uv[0] + c->cx;
    pixel[1] = c->fy * uv[1] + c->cy;
}

bool orl_colmap_camera_is_pinhole(const struct orl_colmap_camera *camera)
{
    const struct orl_colmap_lens lens = orl_colmap_model_lens(camera->model);
    if (lens.kind == ORL_LENS_FISHEYE || lens.kind == ORL_LENS_THIN_PRISM || lens.kind == ORL_LENS_RAD_TAN_THIN_PRISM)
        return false;
    for (int i = lens.focal_lengths + 2; i < camera->param_count; i++)
        if (camera->params[i] != 0)
            return false;
    return true;
}

// Follows rays from the axis outwards, up to a tangent of STEPS / 100, as long as their projections
// approach the corner.
static bool reaches(const struct orl_colmap_camera *camera, const double corner[2])
{
    enum { STEPS = 400 };
    const struct orl_camera *c = &camera->pinhole;
    double off[2] = {corner[0] - c->cx, corner[1] - c->cy};
    double ray[2] = {off[0] / c->fx, off[1] / c->fy}, length = hypot(ray[0], ray[1]);
    double distance2 = off[0] * off[0] + off[1] * off[1], last = 0;
    for (int i = 1; i <= STEPS && length > 0; i++) {
        double step = 0.01 * i / length, pixel[2];
        orl_colmap_camera_project(camera, (double[2]){ray[0] * step, ray[1] * step}, pixel);
        double along = ((pixel[0] - c->cx) * off[0] + (pixel[1] - c->cy) * off[1]) / distance2;
        if (along >= 1)
            return true;
        if (!(along > last))
            return false;
        last = along;
    }
    return !(length > 0);
}

bool orl_colmap_camera_reaches_corners(const struct orl_colmap_camera *camera)
{
    for (int i = 0; i < 4; i++) {
        const double corner[2] = {i & 1 ? camera->pinhole.width : 0,
                                  i & 2 ? camera->pinhole.height : 0};
        if (!reaches(camera, corner))
            return false;
    }
    return true;
}

// --- pictures without distortion ---

static enum orl_result make_map(const struct orl_log *log, const struct orl_colmap_camera *from,
                                const struct orl_camera *to, struct orl_image *map)
{
    enum orl_result result = orl_image_init(log, map, to->width, to->height, 2, ORL_PIXEL_F32);
    for (int y = 0; result == ORL_OK && y < to->height; y++) {
        float *at = map->f32 + 2 * (size_t)y * (size_t)to->width;
        for (int x = 0; x < to->width; x++, at += 2) {
            const double ray[2] = {(x + 0.5 - to->cx) / to->fx, (y + 0.5 - to->cy) / to->fy};
            double pixel[2];
            orl_colmap_camera_project(from, ray, pixel);
            at[0] = (float)(pixel[0] - 0.5);
            at[1] = (float)(pixel[1] - 0.5);
        }
    }
    return result;
}

enum orl_result orl_undistort(const struct orl_log *log, const struct orl_colmap_camera *from,
                              const struct orl_camera *to, const struct orl_image *image,
                              struct orl_image *undistorted)
{
    memset(undistorted, 0, sizeof *undistorted);
    struct orl_image map = {0}, warped = {0};
    const struct orl_camera *size = &from->pinhole;
    if (image->width != size->width || image->height != size->height)
        return orl_fail(log, ORL_ERR_DATA, "a picture of %dx%d pixels, but its camera has %dx%d",
                        image->width, image->height, size->width, size->height);
    // One resampling suffices unless the picture shrinks.
    bool shrinks = to->fx < 0.999 * size->fx || to->fy < 0.999 * size->fy;
    struct orl_camera full = shrinks ? orl_camera_resized(to, size->width, size->height) : *to;
    enum orl_result result = make_map(log, from, &full, &map);
    ORL_THEN(result, orl_bridge_remap(log, image, &map, &warped));
    if (result == ORL_OK && (to->width != full.width || to->height != full.height))
        result = orl_bridge_reduce(log, &warped, to->width, to->height, undistorted);
    else if (result == ORL_OK) {
        *undistorted = warped;
        memset(&warped, 0, sizeof warped);
    }
    orl_image_finish(&map);
    orl_image_finish(&warped);
    return result;
}
