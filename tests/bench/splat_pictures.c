// Draws exported splats at a scene's held-out cameras, as programs of 3D Gaussian splatting do
// (Kerbl et al. 2023), and compares them with the photographs: what a scene looks like elsewhere.
//     bench_splat_pictures SCENE SPLATS.ply OUT
// Each line: photograph, PSNR in dB over the whole picture on black and over what is covered, SSIM on
// luma, share that is covered.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "core/vec3.h"
#include "eval/metrics.h"
#include "exchange/gaussians.h"
#include "io/picture.h"
#include "oriel/scene.h"
#include "scene/ply.h"

static const double LOW_PASS = 0.3, CUT = 1.0 / 255;

struct splat {
    double at[3], cov[3][3], opacity, harmonics[ORL_HARMONICS_MAX][3];
};

struct splats {
    size_t count;
    int terms;
    struct splat *items;
};

struct drawn {
    double depth, pixel[2], inverse[3], rgb[3], opacity; // inverse: of the covariance, xx xy yy
    int reach;
};

static int index_of(const struct orl_ply_element *e, const char *format, int k)
{
    char name[32];
    snprintf(name, sizeof name, format, k);
    return orl_ply_property_index(e, name);
}

static void set_covariance(struct splat *s, const double q[4], const double scale[3])
{
    double n = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    double w = q[0] / n, x = q[1] / n, y = q[2] / n, z = q[3] / n;
    const double r[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                            {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                            {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++)
                s->cov[i][j] += r[i][k] * r[j][k] * scale[k] * scale[k];
}

static void set_splat(struct splat *s, const struct orl_ply_element *e, const double *v, int terms)
{
    double q[4], scale[3] = {0};
    for (int k = 0; k < 4; k++)
        q[k] = v[index_of(e, "rot_%d", k)];
    for (int k = 0; k < 3; k++) {
        int third = index_of(e, "scale_%d", k);
        s->at[k] = v[orl_ply_property_index(e, k == 0 ? "x" : k == 1 ? "y" : "z")];
        scale[k] = third < 0 ? 0 : exp(v[third]);
    }
    set_covariance(s, q, scale);
    s->opacity = 1 / (1 + exp(-v[index_of(e, "opacity", 0)]));
    for (int c = 0; c < 3; c++) {
        s->harmonics[0][c] = v[index_of(e, "f_dc_%d", c)];
        for (int k = 1; k < terms; k++)
            s->harmonics[k][c] = v[index_of(e, "f_rest_%d", c * (terms - 1) + k - 1)];
    }
}

static enum orl_result read_splats(const struct orl_log *log, const char *path, struct splats *all)
{
    struct orl_ply ply;
    const struct orl_ply_element *e = NULL;
    double record[ORL_PLY_PROPERTIES_MAX];
    enum orl_result result = orl_ply_open(log, path, &ply);
    if (result == ORL_OK)
        result = orl_ply_seek(&ply, "vertex", "no vertices", &e);
    if (result == ORL_OK) {
        int rest = 0;
        while (index_of(e, "f_rest_%d", rest) >= 0)
            rest++;
        all->terms = rest / 3 + 1;
        all->count = (size_t)e->count;
        all->items = orl_array(log, all->count, sizeof *all->items);
        result = all->items ? ORL_OK : ORL_ERR_MEMORY;
    }
    for (size_t i = 0; result == ORL_OK && i < all->count; i++) {
        result = orl_ply_record(&ply, e, record, -1, NULL);
        if (result == ORL_OK)
            set_splat(&all->items[i], e, record, all->terms);
    }
    orl_ply_close(&ply);
    return result;
}

// --- a picture ---

static bool project(const struct splats *all, const struct splat *s, const struct orl_view *view,
                    const double eye[3], struct drawn *d)
{
    const struct orl_camera *c = &view->camera;
    double p[3], to[3], y[ORL_HARMONICS_MAX], m[2][3], cov[3] = {LOW_PASS, 0, LOW_PASS};
    orl_pose_apply(&view->cam_from_world, s->at, p);
    if (p[2] < 0.01)
        return false;
    d->depth = p[2];
    d->pixel[0] = c->fx * p[0] / p[2] + c->cx;
    d->pixel[1] = c->fy * p[1] / p[2] + c->cy;
    // Far outside the picture the Jacobian is not to be trusted.
    double lx = 1.3 * c->width / 2 / c->fx, ly = 1.3 * c->height / 2 / c->fy;
    double tx = fmin(lx, fmax(-lx, p[0] / p[2])), ty = fmin(ly, fmax(-ly, p[1] / p[2]));
    for (int k = 0; k < 3; k++) {
        const double(*r)[3] = view->cam_from_world.r;
        m[0][k] = c->fx / p[2] * (r[0][k] - tx * r[2][k]);
        m[1][k] = c->fy / p[2] * (r[1][k] - ty * r[2][k]);
    }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            cov[0] += m[0][i] * s->cov[i][j] * m[0][j];
            cov[1] += m[0][i] * s->cov[i][j] * m[1][j];
            cov[2] += m[1][i] * s->cov[i][j] * m[1][j];
        }
    double det = cov[0] * cov[2] - cov[1] * cov[1];
    double mid = (cov[0] + cov[2]) / 2, root = sqrt(fmax(0, mid * mid - det));
    d->reach = (int)fmin(1e4, ceil(3 * sqrt(mid + root)));
    if (!(det > 0) || d->pixel[0] < -d->reach || d->pixel[1] < -d->reach ||
        d->pixel[0] > c->width + d->reach || d->pixel[1] > c->height + d->reach)
        return false;
    d->inverse[0] = cov[2] / det;
    d->inverse[1] = -cov[1] / det;
    d->inverse[2] = cov[0] / det;
    for (int k = 0; k < 3; k++)
        to[k] = s->at[k] - eye[k];
    orl_normalize3(to);
    orl_harmonics(to, all->terms, y);
    for (int ch = 0; ch < 3; ch++) {
        d->rgb[ch] = 0.5;
        for (int k = 0; k < all->terms; k++)
            d->rgb[ch] += y[k] * s->harmonics[k][ch];
        d->rgb[ch] = fmax(0, d->rgb[ch]);
    }
    d->opacity = s->opacity;
    return true;
}

static int nearer(const void *a, const void *b)
{
    double x = ((const struct drawn *)a)->depth, y = ((const struct drawn *)b)->depth;
    return (x > y) - (x < y);
}

static void blend(const struct drawn *d, int width, int height, double (*pixels)[4])
{
    int x0 = (int)fmax(0, floor(d->pixel[0]) - d->reach), y0 = (int)fmax(0, floor(d->pixel[1]) - d->reach);
    int x1 = (int)fmin(width - 1, floor(d->pixel[0]) + d->reach);
    int y1 = (int)fmin(height - 1, floor(d->pixel[1]) + d->reach);
    for (int y = y0; y <= y1; y++)
        for (int x = x0; x <= x1; x++) {
            double *to = pixels[(size_t)y * (size_t)width + (size_t)x];
            double u = x + 0.5 - d->pixel[0], v = y + 0.5 - d->pixel[1];
            double e = d->inverse[0] * u * u + 2 * d->inverse[1] * u * v + d->inverse[2] * v * v;
            double alpha = fmin(0.99, d->opacity * exp(-e / 2));
            if (alpha < CUT || to[3] < 1e-4)
                continue;
            for (int c = 0; c < 3; c++)
                to[c] += to[3] * alpha * d->rgb[c];
            to[3] *= 1 - alpha;
        }
}

static enum orl_result draw(const struct orl_log *log, const struct splats *all,
                            const struct orl_view *view, struct orl_image *out,
                            struct orl_image *coverage)
{
    int width = view->camera.width, height = view->camera.height;
    size_t pixels = (size_t)width * (size_t)height, count = 0;
    struct drawn *drawn = orl_array(log, all->count, sizeof *drawn);
    double(*sums)[4] = orl_array(log, pixels, sizeof *sums), eye[3];
    enum orl_result result = drawn && sums ? ORL_OK : ORL_ERR_MEMORY;
    if (result == ORL_OK)
        result = orl_image_init(log, out, width, height, 3, ORL_PIXEL_U8);
    if (result == ORL_OK)
        result = orl_image_init(log, coverage, width, height, 1, ORL_PIXEL_F32);
    orl_pose_centre(&view->cam_from_world, eye);
    for (size_t i = 0; result == ORL_OK && i < pixels; i++)
        sums[i][3] = 1;
    for (size_t i = 0; result == ORL_OK && i < all->count; i++)
        count += project(all, &all->items[i], view, eye, &drawn[count]);
    if (result == ORL_OK)
        qsort(drawn, count, sizeof *drawn, nearer);
    for (size_t i = 0; result == ORL_OK && i < count; i++)
        blend(&drawn[i], width, height, sums);
    for (size_t i = 0; result == ORL_OK && i < pixels; i++) {
        coverage->f32[i] = (float)(1 - sums[i][3]);
        for (size_t c = 0; c < 3; c++)
            out->u8[3 * i + c] = (uint8_t)lrint(255 * fmin(1, sums[i][c]));
    }
    free(drawn);
    free(sums);
    return result;
}

static enum orl_result compare(const struct orl_log *log, const struct orl_scene *scene, size_t i,
                               const struct splats *all, const char *out, struct orl_metrics *m)
{
    struct orl_image picture = {0}, photo = {0}, coverage = {0};
    char *path = strdup(orl_scene_file(scene, i, ORL_FILE_PHOTO).text);
    char *to = orl_format(log, "%s/%.*s.png", out, (int)strcspn(scene->photos[i].name, "."),
                          scene->photos[i].name);
    enum orl_result result = path && to ? ORL_OK : ORL_ERR_MEMORY;
    if (result == ORL_OK)
        result = orl_picture_read(log, path, 3, &photo);
    if (result == ORL_OK)
        result = draw(log, all, &scene->photos[i].view, &picture, &coverage);
    if (result == ORL_OK)
        result = orl_png_write(log, to, &picture);
    if (result == ORL_OK)
        result = orl_metrics_compare(log, &picture, &photo, &coverage, m);
    if (result == ORL_OK)
        printf("%s %.2f %.2f %.4f %.3f\n", scene->photos[i].name, m->psnr_db, m->psnr_covered_db,
               m->ssim, m->coverage);
    orl_image_finish(&coverage);
    orl_image_finish(&picture);
    orl_image_finish(&photo);
    free(path);
    free(to);
    return result;
}

int main(int argc, char **argv)
{
    const struct orl_log log = orl_log_stderr(ORL_LOG_WARNING);
    struct orl_scene *scene = NULL;
    struct splats all = {0};
    struct orl_metrics m, sum = {0};
    size_t count = 0;
    if (argc != 4) {
        fprintf(stderr, "usage: bench_splat_pictures SCENE SPLATS.ply OUT\n");
        return 2;
    }
    enum orl_result result = orl_scene_open_photos(&log, argv[1], &scene);
    if (result == ORL_OK)
        result = read_splats(&log, argv[2], &all);
    if (result == ORL_OK)
        result = orl_dir_make(&log, argv[3]);
    for (size_t i = 0; result == ORL_OK && i < scene->photo_count; i++)
        if (scene->photos[i].test) {
            result = compare(&log, scene, i, &all, argv[3], &m);
            sum.psnr_db += m.psnr_db;
            sum.psnr_covered_db += m.psnr_covered_db;
            sum.ssim += m.ssim;
            count++;
        }
    if (result == ORL_OK && count)
        printf("mean %.2f %.2f %.4f\n", sum.psnr_db / (double)count,
               sum.psnr_covered_db / (double)count, sum.ssim / (double)count);
    free(all.items);
    orl_scene_destroy(&scene);
    return result == ORL_OK ? 0 : 1;
}
