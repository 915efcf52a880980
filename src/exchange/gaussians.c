#include "exchange/gaussians.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/cholesky.h"
#include "core/color.h"
#include "core/memory.h"
#include "core/vec3.h"
#include "io/picture.h"
#include "scene/depth_buffer.h"
#include "scene/meter.h"
#include "scene/ply.h"

enum {
    BATCH = 1 << 19, // points whose sums are held at a time
    PACKED_MAX = ORL_HARMONICS_MAX * (ORL_HARMONICS_MAX + 1) / 2,
};
// Weights of the ridge, in photographs. The constant term is held by the point's own colour, and
// terms that depend on the direction are held near 0: few photographs say little of them.
static const double RIDGE_CONSTANT = 0.1, RIDGE_DIRECTION = 1.0;
// An sRGB colour this far from the point's own counts half: something else stood there.
static const double OUTLIER = 0.3;
// A surface is all but opaque: no program divides by the transparency of a Gaussian.
static const float OPAQUE = 0.99f;
// What is left of the doubt in a point for each photograph that agrees on it: found on held-out
// photographs (docs/measured/exchange.md).
static const float DOUBT = 0.5f;
// Standard deviation of a Gaussian that draws a disc, in radii of the disc: found on held-out
// photographs (docs/measured/exchange.md).
static const float SIGMA = 0.6f;
// The third axis as a part of the others, for programs that know ellipsoids alone.
static const float THIN = 0.01f;

void orl_harmonics(const double d[3], int terms, double out[ORL_HARMONICS_MAX])
{
    const double x = d[0], y = d[1], z = d[2];
    const double all[ORL_HARMONICS_MAX] = {
        ORL_HARMONIC_0,
        -0.4886025119029199 * y,
        0.4886025119029199 * z,
        -0.4886025119029199 * x,
        1.0925484305920792 * x * y,
        -1.0925484305920792 * y * z,
        0.31539156525252005 * (2 * z * z - x * x - y * y),
        -1.0925484305920792 * x * z,
        0.5462742152960396 * (x * x - y * y),
    };
    memcpy(out, all, (size_t)terms * sizeof *out);
}

// --- what photographs show ---

// The sums of a point's normal equations: the lower half of the matrix by rows, and three right
// sides.
struct sums {
    float matrix[PACKED_MAX], right[ORL_HARMONICS_MAX][3];
};

struct fit {
    const struct orl_log *log;
    const struct orl_scene *scene;
    struct orl_gaussians *out;
    struct sums *sums; // owned: of the points of a batch
    size_t first, end; // of the batch
};

struct picture {
    struct orl_image image, occluders;
    float linear[256];
};

// Brings linear light to the scene's exposure and white balance and undoes the vignetting.
static void align(const struct orl_photo *photo, const double pixel[2], double rgb[3])
{
    float light = orl_illumination(photo->vignette, &photo->view.camera, pixel[0], pixel[1]);
    for (int k = 0; k < 3; k++)
        rgb[k] = (double)orl_light_aligned(photo->gain[k] / light, (float)rgb[k]);
}

// A photograph's colour at a pixel, linear light, interpolated between pixels.
static void sample(const struct picture *p, const double pixel[2], double rgb[3])
{
    int left = (int)floor(pixel[0] - 0.5), top = (int)floor(pixel[1] - 0.5);
    double u = pixel[0] - 0.5 - left, v = pixel[1] - 0.5 - top;
    int width = p->image.width, height = p->image.height;
    rgb[0] = rgb[1] = rgb[2] = 0;
    for (int k = 0; k < 4; k++) {
        int x = left + (k & 1), y = top + (k >> 1);
        x = x < 0 ? 0 : x < width ? x : width - 1;
        y = y < 0 ? 0 : y < height ? y : height - 1;
        double w = (k & 1 ? u : 1 - u) * (k >> 1 ? v : 1 - v);
        const uint8_t *from = p->image.u8 + 3 * ((size_t)y * (size_t)width + (size_t)x);
        for (int c = 0; c < 3; c++)
            rgb[c] += w * (double)p->linear[from[c]];
    }
}

static bool is_occluded(const struct picture *p, const struct orl_camera *c, const double pixel[2])
{
    if (!p->occluders.u8)
        return false;
    int x = (int)(pixel[0] * p->occluders.width / c->width);
    int y = (int)(pixel[1] * p->occluders.height / c->height);
    return p->occluders.u8[(size_t)y * (size_t)p->occluders.width + (size_t)x] >= 128;
}

static void add(const struct fit *fit, const struct orl_photo *photo, const struct picture *p,
                const double eye[3], const struct orl_depth_buffer *buffer, size_t point)
{
    const struct orl_points *points = &fit->scene->points;
    const float *at = points->position[point], *n = points->normal[point];
    double pixel[2], depth, rgb[3], to[3], y[ORL_HARMONICS_MAX], far2 = 0;
    if (!orl_point_project(&photo->view, at, pixel, &depth) ||
        !orl_depth_buffer_shows(buffer, pixel, depth) ||
        is_occluded(p, &photo->view.camera, pixel))
        return;
    for (int k = 0; k < 3; k++)
        to[k] = (double)at[k] - eye[k];
    orl_normalize3(to);
    double facing = -(to[0] * (double)n[0] + to[1] * (double)n[1] + to[2] * (double)n[2]);
    bool known = n[0] != 0 || n[1] != 0 || n[2] != 0;
    if (known && facing <= 0)
        return;
    sample(p, pixel, rgb);
    align(photo, pixel, rgb);
    for (int c = 0; c < 3; c++) {
        rgb[c] = (double)orl_srgb_encode((float)rgb[c]);
        double off = (rgb[c] - points->color[point][c] / 255.0) / OUTLIER;
        far2 += off * off;
    }
    double w = (known ? facing : 1) / (1 + far2);
    orl_harmonics(to, fit->out->terms, y);
    struct sums *s = &fit->sums[point - fit->first];
    for (int i = 0, at_packed = 0; i < fit->out->terms; i++) {
        for (int j = 0; j <= i; j++, at_packed++)
            s->matrix[at_packed] += (float)(w * y[i] * y[j]);
        for (int c = 0; c < 3; c++)
            s->right[i][c] += (float)(w * y[i] * (rgb[c] - 0.5));
    }
}

static enum orl_result read_picture(const struct fit *fit, size_t photo, struct picture *p)
{
    const struct orl_photo *of = &fit->scene->photos[photo];
    const struct orl_file_path path = orl_scene_file(fit->scene, photo, ORL_FILE_PHOTO);
    ORL_TRY(orl_picture_read(fit->log, path.text, 3, &p->image));
    if (p->image.width != of->view.camera.width || p->image.height != of->view.camera.height)
        return orl_fail(fit->log, ORL_ERR_FORMAT, "%s: %dx%d pixels, but its camera has %dx%d",
                        path.text, p->image.width, p->image.height, of->view.camera.width,
                        of->view.camera.height);
    for (int v = 0; v < 256; v++)
        p->linear[v] = orl_srgb_decode((float)v / 255);
    return of->occluded > 0 ? orl_picture_read(fit->log, orl_scene_file(fit->scene, photo, ORL_FILE_OCCLUDERS).text, 1,
                                               &p->occluders)
                            : ORL_OK;
}

static enum orl_result add_photo(const struct fit *fit, size_t photo)
{
    const struct orl_photo *of = &fit->scene->photos[photo];
    struct orl_depth_buffer buffer = {0};
    struct picture p = {0};
    double eye[3];
    orl_pose_centre(&of->view.cam_from_world, eye);
    enum orl_result result = read_picture(fit, photo, &p);
    ORL_THEN(result, orl_depth_buffer_draw(fit->log, &of->view, &fit->scene->points, &buffer));
    for (size_t i = fit->first; result == ORL_OK && i < fit->end; i++)
        add(fit, of, &p, eye, &buffer, i);
    orl_depth_buffer_finish(&buffer);
    orl_image_finish(&p.image);
    orl_image_finish(&p.occluders);
    return result;
}

// --- the fit ---

static void solve(const struct fit *fit, size_t point)
{
    size_t terms = (size_t)fit->out->terms;
    const struct sums *s = &fit->sums[point - fit->first];
    float *to = fit->out->harmonics + point * terms * 3;
    const double y0 = ORL_HARMONIC_0;
    for (size_t c = 0; c < 3; c++) {
        double a[ORL_HARMONICS_MAX * ORL_HARMONICS_MAX], b[ORL_HARMONICS_MAX] = {0};
        double own = fit->scene->points.color[point][c] / 255.0 - 0.5;
        for (size_t i = 0, packed = 0; i < terms; i++) {
            for (size_t j = 0; j <= i; j++)
                a[i * terms + j] = (double)s->matrix[packed++];
            a[i * terms + i] += (i ? RIDGE_DIRECTION : RIDGE_CONSTANT) * y0 * y0;
            b[i] = (double)s->right[i][c];
        }
        b[0] += RIDGE_CONSTANT * y0 * own;
        if (!orl_cholesky_solve(a, b, terms)) { // only rounding can do that
            memset(b, 0, sizeof b);
            b[0] = own / y0;
        }
        for (size_t i = 0; i < terms; i++)
            to[i * 3 + c] = (float)b[i];
    }
}

static enum orl_result fit_batch(struct fit *fit, const struct orl_progress *progress)
{
    size_t photos = fit->scene->photo_count, all = fit->scene->points.count;
    memset(fit->sums, 0, (fit->end - fit->first) * sizeof *fit->sums);
    for (size_t i = 0; i < photos; i++) {
        if (orl_progress_cancelled(progress))
            return ORL_ERR_CANCELLED;
        if (!fit->scene->photos[i].test)
            ORL_TRY(add_photo(fit, i));
        double part = (double)(fit->end - fit->first) * (double)(i + 1) / (double)photos;
        orl_progress_report(progress, "colours", (double)fit->first + part, (double)all,
                            fit->scene->photos[i].name);
    }
    for (size_t i = fit->first; i < fit->end; i++)
        solve(fit, i);
    return ORL_OK;
}

enum orl_result orl_gaussians_fit(const struct orl_log *log, const struct orl_progress *progress,
                                  const struct orl_scene *scene, int degree,
                                  struct orl_gaussians *out)
{
    ORL_REQUIRE(log, degree >= 0 && degree <= ORL_DEGREE_MAX);
    size_t count = scene->points.count, terms = (size_t)((degree + 1) * (degree + 1));
    *out = (struct orl_gaussians){.points = &scene->points, .degree = degree, .terms = (int)terms,
                                  .harmonics = orl_array(log, count, terms * 3 * sizeof(float))};
    struct fit fit = {.log = log, .scene = scene, .out = out,
                      .sums = orl_array(log, count < BATCH ? count : BATCH, sizeof *fit.sums)};
    enum orl_result result = out->harmonics && fit.sums ? ORL_OK : ORL_ERR_MEMORY;
    while (result == ORL_OK && fit.end < count) {
        fit.first = fit.end;
        fit.end = count - fit.first < BATCH ? count : fit.first + BATCH;
        result = fit_batch(&fit, progress);
    }
    free(fit.sums);
    if (result != ORL_OK)
        orl_gaussians_finish(out);
    return result;
}

void orl_gaussians_finish(struct orl_gaussians *gaussians)
{
    free(gaussians->harmonics);
    memset(gaussians, 0, sizeof *gaussians);
}

// --- shape ---

void orl_gaussian_shape(const struct orl_gaussians *gaussians, size_t point,
                        struct orl_gaussian *shape)
{
    const float *n = gaussians->points->normal[point];
    float sigma = SIGMA * gaussians->points->radius[point];
    bool flat = n[0] != 0 || n[1] != 0 || n[2] != 0;
    // The shortest rotation from the third axis to the normal: (1 + z.n, z x n), normalised. Of a
    // disc either side will do, so n is turned away from -z, where that rotation is not defined.
    float sign = n[2] < 0 ? -1.0f : 1.0f;
    float q[4] = {1 + sign * n[2], -sign * n[1], sign * n[0], 0};
    float length = sqrtf(q[0] * q[0] + q[1] * q[1] + q[2] * q[2]);
    for (int k = 0; k < 4; k++)
        shape->rotation_wxyz[k] = q[k] / length;
    shape->scale[0] = shape->scale[1] = sigma;
    shape->scale[2] = flat ? THIN * sigma : sigma;
    uint8_t agree = gaussians->points->photographs[point];
    shape->opacity = agree ? fminf(OPAQUE, 1 - powf(DOUBT, agree)) : OPAQUE;
}
