// Densify against the truth of the synthetic monument: depth, outliers, normals, confidence.
// gpu_test_densify_truth full: of all 24 photographs, at 768x512; minutes, and not part of the
// tests.
#include <math.h>
#include <string.h>
#include <time.h>

#include "gpu_test.h"

#include "datasets/synth.h"
#include "io/picture.h"
#include "preprocess/densify/densify.h"
#include "scene/colmap.h"

enum {
    SHOTS = 24,       // of the whole set
    CELL = 16,        // at most one sparse point per cell of this many pixels
    CONTRAST_MIN = 12, // of a pixel's neighbours for a sparse point
};

// Which photographs, how large, and what must come out.
struct trial {
    int first, count, width;
    double right, outliers, degrees; // shares; degrees of the median normal
};
// 82.1 %, 1.7 %, 10.1 degrees: at 768x512 relief is less often finer than a patch.
static const struct trial part = {8, 8, 384, 0.807, 0.021, 11.2};
static const struct trial full = {0, SHOTS, 768, 0.92, 0.01, 6.5}; // 92.9 %, 0.8 %, 5.8 degrees
static const struct trial *trial = &part;

struct truth {
    struct orl_view views[SHOTS];
    struct orl_synth_frame frames[SHOTS];
    struct orl_image photos[SHOTS];
};

static struct orl_gpu *gpu;

static void draw_truth(struct truth *truth, int width, int height)
{
    struct orl_synth_params params = {ORL_SYNTH_DEFAULTS};
    struct orl_view views[SHOTS];
    struct orl_synth *synth;
    params.width = width;
    params.height = height;
    params.count = SHOTS;
    orl_synth_views(&params, views);
    memcpy(truth->views, views + trial->first, (size_t)trial->count * sizeof *views);
    assert_int_equal(orl_synth_create(gpu, &params, &synth), ORL_OK);
    for (int i = 0; i < trial->count; i++) {
        assert_int_equal(orl_synth_draw(synth, NULL, &truth->views[i], &truth->frames[i]), ORL_OK);
        assert_int_equal(orl_synth_expose(NULL, &truth->frames[i].radiance,
                                          &(struct orl_synth_sensor){.key = 1},
                                          &truth->photos[i]), ORL_OK);
    }
    orl_synth_destroy(&synth);
}

static void free_truth(struct truth *truth)
{
    for (int i = 0; i < trial->count; i++) {
        orl_synth_frame_finish(&truth->frames[i]);
        orl_image_finish(&truth->photos[i]);
    }
}

// Does photograph `index` see the place? Its own depth there must be the same.
static bool sees(const struct truth *truth, int index, const double world[3], double pixel[2])
{
    const struct orl_image *map = &truth->frames[index].depth;
    double depth;
    if (!orl_view_project(&truth->views[index], world, pixel, &depth) || !(pixel[0] >= 0.0) ||
        !(pixel[1] >= 0.0) || pixel[0] >= map->width || pixel[1] >= map->height)
        return false;
    double seen = map->f32[(size_t)pixel[1] * (size_t)map->width + (size_t)pixel[0]];
    return seen > 0.0 && fabs(seen - depth) < 0.02 * depth;
}

// --- the workspace ---

// The pixel of a cell that a feature detector would take; false: none.
static bool find_corner(const struct orl_image *photo, int left, int top, int *x, int *y)
{
    int most = 0;
    size_t stride = 3 * (size_t)photo->width;
    for (int v = top > 0 ? top : 1; v < top + CELL && v < photo->height - 1; v++)
        for (int u = left > 0 ? left : 1; u < left + CELL && u < photo->width - 1; u++) {
            const uint8_t *green = photo->u8 + (size_t)v * stride + 3 * (size_t)u + 1;
            int across = abs(green[3] - green[-3]);
            int along = abs(*(green + stride) - *(green - stride));
            int contrast = across < along ? across : along;
            if (contrast > most) {
                most = contrast;
                *x = u;
                *y = v;
            }
        }
    return most >= CONTRAST_MIN;
}

// What structure from motion would find, its points exactly on the surface.
static void write_model(const struct truth *truth, const char *dir)
{
    FILE *cameras = test_create(dir, "sparse/cameras.txt");
    FILE *images = test_create(dir, "sparse/images.txt");
    FILE *points = test_create(dir, "sparse/points3D.txt");
    FILE *seen_by[SHOTS];
    const struct orl_camera *c = &truth->views[0].camera;
    int ids = 0, in_photo[SHOTS] = {0};
    fprintf(cameras, "1 PINHOLE %d %d %.9g %.9g %.9g %.9g\n", c->width, c->height, c->fx, c->fy,
            c->cx, c->cy);
    for (int i = 0; i < trial->count; i++)
        assert_non_null(seen_by[i] = tmpfile());
    for (int i = 0; i < trial->count; i++)
        for (int top = 0; top < c->height; top += CELL)
            for (int left = 0; left < c->width; left += CELL) {
                int x = 0, y = 0, views[SHOTS], count = 0;
                double world[3], pixels[SHOTS][2];
                if (!find_corner(&truth->photos[i], left, top, &x, &y))
                    continue;
                double depth = truth->frames[i].depth.f32[y * c->width + x];
                if (!(depth > 0.0))
                    continue;
                orl_view_unproject(&truth->views[i], x + 0.5, y + 0.5, depth, world);
                for (int k = 0; k < trial->count; k++)
                    if (sees(truth, k, world, pixels[count]))
                        views[count++] = k;
                if (count < 3)
                    continue;
                fprintf(points, "%d %.9g %.9g %.9g 90 90 90 0.5", ++ids, world[0], world[1],
                        world[2]);
                for (int k = 0; k < count; k++) {
                    fprintf(points, " %d %d", views[k] + 1, in_photo[views[k]]++);
                    fprintf(seen_by[views[k]], "%.9g %.9g %d ", pixels[k][0], pixels[k][1], ids);
                }
                fprintf(points, "\n");
            }
    for (int i = 0; i < trial->count; i++) {
        double q[4];
        const double *t = truth->views[i].cam_from_world.t;
        orl_pose_to_quat(&truth->views[i].cam_from_world, q);
        fprintf(images, "%d %.17g %.17g %.17g %.17g %.17g %.17g %.17g 1 %d.png\n", i + 1, q[0],
                q[1], q[2], q[3], t[0], t[1], t[2], i);
        rewind(seen_by[i]);
        for (int letter = fgetc(seen_by[i]); letter != EOF; letter = fgetc(seen_by[i]))
            fputc(letter, images);
        fputc('\n', images);
        fclose(seen_by[i]);
    }
    assert_int_equal(fclose(cameras) | fclose(images) | fclose(points), 0);
    assert_true(ids > 200);
}

static void make_workspace(const struct truth *truth, const char *dir)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/sparse", dir);
    assert_int_equal(orl_dir_make(NULL, path), ORL_OK);
    snprintf(path, sizeof path, "%s/images", dir);
    assert_int_equal(orl_dir_make(NULL, path), ORL_OK);
    write_model(truth, dir);
    for (int i = 0; i < trial->count; i++) {
        snprintf(path, sizeof path, "%s/images/%d.png", dir, i);
        assert_int_equal(orl_png_write(NULL, path, &truth->photos[i]), ORL_OK);
    }
}

// --- what came out ---

struct figures {
    size_t seen;    // pixels of a surface that another photograph sees too
    size_t right;   // of these, with depth within 1 %
    size_t kept;    // pixels with depth
    size_t sky;     // of these, where there is nothing but sky
    size_t outliers; // of the others, more than 5 % off
    size_t degrees[181]; // angles between normals, of pixels kept
    size_t sure[2], sure_right[2]; // pixels with depth and those within 1 %: confidence below
                                   // and above 0.75
};

static void add_pixel(const struct truth *truth, int index, size_t at, double depth,
                      const float *normal, struct figures *figures)
{
    int width = truth->views[index].camera.width, x = (int)at % width, y = (int)at / width;
    double expected = truth->frames[index].depth.f32[at], world[3], pixel[2];
    const float *facing = &truth->frames[index].normal.f32[3 * at];
    bool shared = false;
    if (expected > 0.0) {
        orl_view_unproject(&truth->views[index], x + 0.5, y + 0.5, expected, world);
        for (int k = 0; k < trial->count && !shared; k++)
            shared = k != index && sees(truth, k, world, pixel);
    }
    figures->seen += shared;
    if (!(depth > 0.0))
        return;
    figures->kept++;
    if (!(expected > 0.0)) {
        figures->sky++;
        return;
    }
    double error = fabs(depth - expected) / expected;
    figures->right += shared && error < 0.01;
    figures->outliers += error > 0.05;
    double cosine = normal[0] * facing[0] + normal[1] * facing[1] + normal[2] * facing[2];
    figures->degrees[(int)(acos(fmin(fmax(cosine, -1.0), 1.0)) * 57.29578)]++;
}

static void add_photo(const struct truth *truth, const char *dir, int index,
                      struct figures *figures)
{
    struct orl_image depth, normal, confidence;
    char path[4096];
    snprintf(path, sizeof path, "%s/stereo/depth_maps/%d.png.geometric.bin", dir, index);
    assert_int_equal(orl_colmap_map_read(NULL, path, &depth), ORL_OK);
    snprintf(path, sizeof path, "%s/stereo/normal_maps/%d.png.geometric.bin", dir, index);
    assert_int_equal(orl_colmap_map_read(NULL, path, &normal), ORL_OK);
    snprintf(path, sizeof path, "%s/stereo/confidence_maps/%d.png.geometric.bin", dir, index);
    assert_int_equal(orl_colmap_map_read(NULL, path, &confidence), ORL_OK);
    size_t count = (size_t)depth.width * (size_t)depth.height;
    assert_int_equal(depth.width, truth->views[index].camera.width);
    assert_int_equal(depth.height, truth->views[index].camera.height);
    for (size_t at = 0; at < count; at++) {
        float expected = truth->frames[index].depth.f32[at];
        bool sure = confidence.f32[at] > 0.75f;
        add_pixel(truth, index, at, depth.f32[at], &normal.f32[3 * at], figures);
        assert_true(confidence.f32[at] >= 0.0f && confidence.f32[at] <= 1.0f);
        assert_true((confidence.f32[at] > 0.0f) == (depth.f32[at] > 0.0f));
        figures->sure[sure] += depth.f32[at] > 0.0f;
        figures->sure_right[sure] += depth.f32[at] > 0.0f && expected > 0.0f &&
                                     fabsf(depth.f32[at] - expected) < 0.01f * expected;
    }
    orl_image_finish(&depth);
    orl_image_finish(&normal);
    orl_image_finish(&confidence);
}

// Median angle, interpolated within its degree.
static double median_degrees(const struct figures *figures)
{
    size_t total = 0, below = 0;
    for (int i = 0; i <= 180; i++)
        total += figures->degrees[i];
    for (int i = 0; i <= 180; i++) {
        if (2 * (below + figures->degrees[i]) >= total)
            return i + (0.5 * (double)total - (double)below) / (double)figures->degrees[i];
        below += figures->degrees[i];
    }
    return 180.0;
}

static void report(const char *what, const struct figures *f)
{
    size_t on_surface = f->kept - f->sky;
    print_message("%s: depth within 1 %% at %.1f %% of %zu, outliers %.2f %% of %zu, normals off "
                  "by %.1f degrees, depth in the sky at %zu\n", what,
                  100.0 * (double)f->right / (double)f->seen, f->seen,
                  100.0 * (double)f->outliers / (double)on_surface, on_surface,
                  median_degrees(f), f->sky);
    print_message("within 1 %% of the truth where confidence is above 0.75: %.1f %% of %zu, below: "
                  "%.1f %% of %zu\n", 100.0 * (double)f->sure_right[1] / (double)f->sure[1],
                  f->sure[1], 100.0 * (double)f->sure_right[0] / (double)f->sure[0], f->sure[0]);
}

static void test_monument(void **state)
{
    (void)state;
    struct truth truth = {0};
    struct figures figures = {0};
    const struct orl_densify_params params = {ORL_DENSIFY_DEFAULTS};
    char *dir = test_dir_make();
    draw_truth(&truth, trial->width, trial->width * 2 / 3);
    make_workspace(&truth, dir);
    struct timespec from, to;
    clock_gettime(CLOCK_MONOTONIC, &from);
    assert_int_equal(orl_densify(gpu, dir, NULL, &params, NULL), ORL_OK);
    clock_gettime(CLOCK_MONOTONIC, &to);
    print_message("stereo: %.2f s a photograph\n",
                  ((double)(to.tv_sec - from.tv_sec) + 1e-9 * (double)(to.tv_nsec - from.tv_nsec)) /
                      trial->count);
    for (int i = 0; i < trial->count; i++)
        add_photo(&truth, dir, i, &figures);
    report("monument", &figures);
    assert_true(figures.seen > 0 && figures.kept > figures.sky);
    assert_true((double)figures.right > trial->right * (double)figures.seen);
    assert_true((double)figures.outliers <
                trial->outliers * (double)(figures.kept - figures.sky));
    assert_true(median_degrees(&figures) < trial->degrees);
    assert_true((double)figures.sky < 0.055 * (double)figures.kept);
    // Confidence tells depths that are right from others.
    assert_true((double)figures.sure_right[1] * (double)figures.sure[0] >
                1.15 * (double)figures.sure_right[0] * (double)figures.sure[1]);
    free_truth(&truth);
    test_dir_remove(dir);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_monument),
    };
    if (argc > 1 && strcmp(argv[1], "full") == 0)
        trial = &full;
    gpu = gpu_test_device();
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    assert_int_equal(orl_gpu_finish(gpu), ORL_OK);
    orl_gpu_destroy(&gpu);
    return failed;
}
