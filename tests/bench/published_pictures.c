// Compares a scene's renderings with its held-out photographs as published tables do: on the
// photograph's own pixels, with the lens's distortion, at its own size.
//     bench_published_pictures SCENE PHOTOGRAPHS METHOD OUT
// PHOTOGRAPHS: the folder that the scene was made of. OUT: renderings as PNG. The last line is the
// mean: PSNR of RGB, SSIM on RGB (mean of the three channels), SSIM on luma. Where the scene was made
// with known cameras, photographs have no distortion.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "eval/choice.h"
#include "eval/heldout.h"
#include "io/picture.h"
#include "scene/colmap.h"

struct job {
    const struct orl_log *log;
    struct orl_gpu *gpu;
    struct orl_scene *scene;
    struct orl_renderer *renderer;
    struct orl_colmap_model lens; // no images: known cameras
    struct orl_choice choice;
    const char *photographs, *out;
};

struct figures {
    double psnr_db, ssim_rgb, ssim_luma;
};

// The ray of a pixel, by iteration: distortion is small.
static void unproject(const struct orl_colmap_camera *c, const double pixel[2], double ray[2])
{
    const struct orl_camera *p = &c->pinhole;
    double now[2];
    ray[0] = (pixel[0] - p->cx) / p->fx;
    ray[1] = (pixel[1] - p->cy) / p->fy;
    for (int i = 0; i < 20; i++) {
        orl_colmap_camera_project(c, ray, now);
        ray[0] += (pixel[0] - now[0]) / p->fx;
        ray[1] += (pixel[1] - now[1]) / p->fy;
    }
}

// The least camera without distortion that shows all that the photograph shows.
static struct orl_camera enclosing(const struct orl_colmap_camera *c)
{
    struct orl_camera all = c->pinhole;
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY}, ray[2];
    for (int y = 0; y <= all.height; y++)
        for (int x = 0; x <= all.width; x += y == 0 || y == all.height ? 1 : all.width) {
            unproject(c, (double[2]){x, y}, ray);
            for (int k = 0; k < 2; k++) {
                low[k] = fmin(low[k], ray[k]);
                high[k] = fmax(high[k], ray[k]);
            }
        }
    all.cx = ceil(-low[0] * all.fx) + 1;
    all.cy = ceil(-low[1] * all.fy) + 1;
    all.width = (int)(all.cx + ceil(high[0] * all.fx)) + 1;
    all.height = (int)(all.cy + ceil(high[1] * all.fy)) + 1;
    return all;
}

// Samples the picture of `from` where the photograph's pixels look.
static enum orl_result distort(const struct orl_log *log, const struct orl_colmap_camera *c,
                               const struct orl_camera *from, const struct orl_image *picture,
                               struct orl_image *out)
{
    enum orl_result result =
        orl_image_init(log, out, c->pinhole.width, c->pinhole.height, 3, ORL_PIXEL_U8);
    for (int y = 0; result == ORL_OK && y < out->height; y++)
        for (int x = 0; x < out->width; x++) {
            double ray[2], sum[3] = {0};
            unproject(c, (double[2]){x + 0.5, y + 0.5}, ray);
            double u = ray[0] * from->fx + from->cx - 0.5, v = ray[1] * from->fy + from->cy - 0.5;
            for (int k = 0; k < 4; k++) {
                int i = (int)floor(u) + (k & 1), j = (int)floor(v) + (k >> 1);
                double w = (1 - fabs(u - i)) * (1 - fabs(v - j));
                for (int ch = 0; ch < 3; ch++)
                    sum[ch] += w * picture->u8[3 * ((size_t)j * (size_t)picture->width + (size_t)i) +
                                               (size_t)ch];
            }
            for (int ch = 0; ch < 3; ch++)
                out->u8[3 * ((size_t)y * (size_t)out->width + (size_t)x) + (size_t)ch] =
                    (uint8_t)lrint(sum[ch]);
        }
    return result;
}

// SSIM of one channel: of two grey pictures.
static enum orl_result channel_ssim(const struct orl_log *log, const struct orl_image *a,
                                    const struct orl_image *b, size_t channel, double *ssim)
{
    struct orl_image grey[2] = {{0}, {0}};
    enum orl_result result = ORL_OK;
    for (int k = 0; k < 2 && result == ORL_OK; k++) {
        const struct orl_image *from = k ? b : a;
        result = orl_image_init(log, &grey[k], a->width, a->height, 3, ORL_PIXEL_U8);
        for (size_t i = 0; result == ORL_OK && i < orl_image_bytes(a); i++)
            grey[k].u8[i] = from->u8[i / 3 * 3 + channel];
    }
    if (result == ORL_OK)
        result = orl_metrics_ssim(log, &grey[0], &grey[1], ssim);
    orl_image_finish(&grey[0]);
    orl_image_finish(&grey[1]);
    return result;
}

static enum orl_result compare(const struct orl_log *log, const struct orl_image *picture,
                               const struct orl_image *photo, struct figures *f)
{
    f->psnr_db = orl_metrics_psnr_db(picture, photo);
    f->ssim_rgb = 0;
    enum orl_result result = orl_metrics_ssim(log, picture, photo, &f->ssim_luma);
    for (size_t c = 0; result == ORL_OK && c < 3; c++) {
        double ssim = 0;
        result = channel_ssim(log, picture, photo, c, &ssim);
        f->ssim_rgb += ssim / 3;
    }
    return result;
}

// Renders the held-out photograph `i` with its lens.
static enum orl_result draw(struct job *job, size_t i, struct orl_image *out)
{
    const struct orl_photo *photo = &job->scene->photos[i];
    struct orl_heldout heldout = {.photo = i, .divide = 1, .view = photo->view};
    struct orl_image picture = {0}, coverage = {0};
    const struct orl_colmap_image *image = orl_colmap_image_by_name(&job->lens, photo->name);
    const struct orl_colmap_camera *camera =
        image ? orl_colmap_camera_by_id(&job->lens, image->camera_id) : NULL;
    if (job->lens.image_count && !camera)
        return orl_fail(job->log, ORL_ERR_DATA, "%s has no calibrated camera", photo->name);
    if (camera)
        heldout.view.camera = enclosing(camera);
    enum orl_result result = orl_heldout_draw(job->log, job->renderer, job->scene, &heldout,
                                              &job->choice.params, NULL, &picture, &coverage);
    if (result == ORL_OK && camera) {
        result = distort(job->log, camera, &heldout.view.camera, &picture, out);
    } else if (result == ORL_OK) {
        *out = picture;
        memset(&picture, 0, sizeof picture);
    }
    orl_image_finish(&picture);
    orl_image_finish(&coverage);
    return result;
}

static enum orl_result measure(struct job *job, size_t i, struct figures *f)
{
    struct orl_image picture = {0}, photo = {0};
    const char *name = job->scene->photos[i].name;
    char *from = orl_path_join(job->log, job->photographs, name);
    char *to = orl_format(job->log, "%s/%.*s.png", job->out, (int)strcspn(name, "."), name);
    enum orl_result result = from && to ? ORL_OK : ORL_ERR_MEMORY;
    if (result == ORL_OK)
        result = orl_picture_read(job->log, from, 3, &photo);
    if (result == ORL_OK)
        result = draw(job, i, &picture);
    if (result == ORL_OK && (photo.width != picture.width || photo.height != picture.height))
        result = orl_fail(job->log, ORL_ERR_DATA, "%s: %dx%d pixels, but the scene was made at "
                          "%dx%d: make it with a larger --max-size", from, photo.width, photo.height,
                          picture.width, picture.height);
    if (result == ORL_OK)
        result = orl_png_write(job->log, to, &picture);
    if (result == ORL_OK)
        result = compare(job->log, &picture, &photo, f);
    if (result == ORL_OK)
        printf("%s %.2f %.4f %.4f\n", name, f->psnr_db, f->ssim_rgb, f->ssim_luma);
    orl_image_finish(&picture);
    orl_image_finish(&photo);
    free(from);
    free(to);
    return result;
}

static enum orl_result open_all(struct job *job, const char *dir, const char *method)
{
    struct orl_names settings = {0};
    char *model = orl_path_join(job->log, dir, ".oriel/calibrate/model");
    enum orl_result result = model ? orl_scene_open(job->log, dir, &job->scene) : ORL_ERR_MEMORY;
    if (result == ORL_OK && orl_path_is_dir(model))
        result = orl_colmap_read(job->log, model, &job->lens);
    if (result == ORL_OK)
        result = orl_choice_make(job->log, job->scene, ORL_SAMPLE_SRGB, method, &settings,
                                 &job->choice);
    if (result == ORL_OK)
        result = orl_gpu_create(job->log, &(struct orl_gpu_params){0}, &job->gpu);
    if (result == ORL_OK)
        result = orl_renderer_create(job->gpu, job->scene, &(struct orl_renderer_params){0},
                                     &job->renderer);
    if (result == ORL_OK)
        result = orl_dir_make(job->log, job->out);
    free(model);
    return result;
}

int main(int argc, char **argv)
{
    const struct orl_log log = orl_log_stderr(ORL_LOG_WARNING);
    struct figures f, sum = {0};
    double count = 0;
    if (argc != 5) {
        fprintf(stderr, "usage: bench_published_pictures SCENE PHOTOGRAPHS METHOD OUT\n");
        return 2;
    }
    struct job job = {.log = &log, .photographs = argv[2], .out = argv[4]};
    enum orl_result result = open_all(&job, argv[1], argv[3]);
    for (size_t i = 0; result == ORL_OK && i < job.scene->photo_count; i++)
        if (job.scene->photos[i].test) {
            result = measure(&job, i, &f);
            sum.psnr_db += f.psnr_db;
            sum.ssim_rgb += f.ssim_rgb;
            sum.ssim_luma += f.ssim_luma;
            count++;
        }
    if (result == ORL_OK && count > 0)
        printf("mean %.2f %.4f %.4f\n", sum.psnr_db / count, sum.ssim_rgb / count,
               sum.ssim_luma / count);
    orl_renderer_destroy(&job.renderer);
    orl_gpu_destroy(&job.gpu);
    orl_scene_destroy(&job.scene);
    orl_colmap_finish(&job.lens);
    return result == ORL_OK ? 0 : 1;
}
