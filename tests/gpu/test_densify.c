// Densify on photographs of a textured plane, drawn here: known depth and normals.
#include <math.h>
#include <string.h>
#include <unistd.h>

#include "gpu_test.h"

#include "core/lock.h"
#include "io/picture.h"
#include "preprocess/densify/densify.h"
#include "scene/colmap.h"

enum { VIEWS_MAX = 4, GRID = 6 };

// A plane seen by cameras side by side, looking along z.
struct plane_scene {
    double point[3], normal[3];
    double texel; // finest detail's scale, in world units
    struct orl_view views[VIEWS_MAX];
    int view_count;
    int shared_views; // the others see no sparse point
};

static struct orl_gpu *gpu;

static const char *const names[VIEWS_MAX] = {"a.png", "b.png", "c.png", "d.png"};

static struct plane_scene make_scene(int width, int height, double tilt_x, double tilt_y)
{
    struct plane_scene scene = {.point = {0, 0, 5}, .texel = 5 / (1.2 * width),
                                .view_count = VIEWS_MAX, .shared_views = VIEWS_MAX};
    scene.normal[0] = sin(tilt_y);
    scene.normal[1] = sin(tilt_x);
    scene.normal[2] = -sqrt(1 - scene.normal[0] * scene.normal[0] -
                            scene.normal[1] * scene.normal[1]);
    static const double eyes[VIEWS_MAX][2] = {{-0.3, -0.2}, {0.3, -0.2}, {-0.3, 0.2}, {0.3, 0.2}};
    for (int i = 0; i < VIEWS_MAX; i++) {
        const double eye[3] = {eyes[i][0], eyes[i][1], 0};
        const double target[3] = {0, 0, 5}, up[3] = {0, -1, 0};
        scene.views[i].camera = (struct orl_camera){.width = width, .height = height,
                                                    .fx = 1.2 * width, .fy = 1.2 * width,
                                                    .cx = 0.5 * width, .cy = 0.5 * height};
        scene.views[i].cam_from_world = orl_pose_look_at(eye, target, up);
    }
    return scene;
}

static double hash_value(int x, int y)
{
    uint32_t h = (uint32_t)x * 374761393u + (uint32_t)y * 668265263u;
    h = (h ^ h >> 13) * 1274126177u;
    return (double)((h ^ h >> 16) & 0xffff) / 65535.0;
}

// Smooth random values on a grid.
static double noise(double x, double y)
{
    int ix = (int)floor(x), iy = (int)floor(y);
    double fx = x - ix, fy = y - iy;
    fx *= fx * (3 - 2 * fx);
    fy *= fy * (3 - 2 * fy);
    double top = hash_value(ix, iy) * (1 - fx) + hash_value(ix + 1, iy) * fx;
    double bottom = hash_value(ix, iy + 1) * (1 - fx) + hash_value(ix + 1, iy + 1) * fx;
    return top * (1 - fy) + bottom * fy;
}

// Depth (z in the camera) of the plane at a pixel; `hit` is the point in the world.
static double plane_depth(const struct plane_scene *scene, const struct orl_view *view, double u,
                          double v, double hit[3])
{
    const struct orl_pose *pose = &view->cam_from_world;
    double ray[3] = {(u - view->camera.cx) / view->camera.fx,
                     (v - view->camera.cy) / view->camera.fy, 1};
    double eye[3], world[3], along = 0, across = 0;
    orl_pose_centre(pose, eye);
    for (int i = 0; i < 3; i++) {
        world[i] = pose->r[0][i] * ray[0] + pose->r[1][i] * ray[1] + pose->r[2][i] * ray[2];
        along += scene->normal[i] * (scene->point[i] - eye[i]);
        across += scene->normal[i] * world[i];
    }
    for (int i = 0; i < 3; i++)
        hit[i] = eye[i] + along / across * world[i];
    return along / across;
}

static void draw(const struct plane_scene *scene, const struct orl_view *view, const char *path)
{
    struct orl_image image;
    assert_int_equal(orl_image_init(NULL, &image, view->camera.width, view->camera.height, 1,
                                    ORL_PIXEL_U8), ORL_OK);
    for (int y = 0; y < image.height; y++)
        for (int x = 0; x < image.width; x++) {
            double hit[3], texel = scene->texel;
            plane_depth(scene, view, x + 0.5, y + 0.5, hit);
            double value = 130 * noise(hit[0] / (4 * texel), hit[1] / (4 * texel)) +
                           100 * noise(hit[0] / (17 * texel) + 50, hit[1] / (17 * texel));
            image.u8[y * image.width + x] = (uint8_t)(value + 10);
        }
    assert_int_equal(orl_png_write(NULL, path, &image), ORL_OK);
    orl_image_finish(&image);
}

static void write_model(const struct plane_scene *scene, const char *dir)
{
    FILE *cameras = test_create(dir, "sparse/cameras.txt");
    FILE *images = test_create(dir, "sparse/images.txt");
    FILE *points = test_create(dir, "sparse/points3D.txt");
    double position[GRID * GRID][3];
    for (int k = 0; k < GRID * GRID; k++) {
        const struct orl_view *view = &scene->views[0];
        plane_depth(scene, view, view->camera.width * (0.2 + 0.6 * (k % GRID) / (GRID - 1)),
                    view->camera.height * (0.2 + 0.6 * (k / GRID) / (double)(GRID - 1)),
                    position[k]);
        fprintf(points, "%d %.9g %.9g %.9g 90 90 90 0.5", k + 1, position[k][0], position[k][1],
                position[k][2]);
        for (int i = 0; i < scene->shared_views; i++)
            fprintf(points, " %d %d", i + 1, k);
        fprintf(points, "\n");
    }
    for (int i = 0; i < scene->view_count; i++) {
        const struct orl_view *view = &scene->views[i];
        const double *t = view->cam_from_world.t;
        double q[4];
        orl_pose_to_quat(&view->cam_from_world, q);
        fprintf(cameras, "%d PINHOLE %d %d %.9g %.9g %.9g %.9g\n", i + 1, view->camera.width,
                view->camera.height, view->camera.fx, view->camera.fy, view->camera.cx,
                view->camera.cy);
        fprintf(images, "%d %.17g %.17g %.17g %.17g %.17g %.17g %.17g %d %s\n", i + 1, q[0], q[1],
                q[2], q[3], t[0], t[1], t[2], i + 1, names[i]);
        for (int k = 0; i < scene->shared_views && k < GRID * GRID; k++) {
            double pixel[2], depth;
            assert_true(orl_view_project(view, position[k], pixel, &depth));
            fprintf(images, "%.9g %.9g %d ", pixel[0], pixel[1], k + 1);
        }
        fprintf(images, "\n");
    }
    assert_int_equal(fclose(cameras) | fclose(images) | fclose(points), 0);
}

static char *make_workspace(const struct plane_scene *scene)
{
    char *dir = test_dir_make();
    char path[4096];
    snprintf(path, sizeof path, "%s/sparse", dir);
    assert_int_equal(orl_dir_make(NULL, path), ORL_OK);
    snprintf(path, sizeof path, "%s/images", dir);
    assert_int_equal(orl_dir_make(NULL, path), ORL_OK);
    write_model(scene, dir);
    for (int i = 0; i < scene->view_count; i++) {
        snprintf(path, sizeof path, "%s/images/%s", dir, names[i]);
        draw(scene, &scene->views[i], path);
    }
    return dir;
}

static char *map_path(const char *dir, const char *kind, int view, const char *pass)
{
    static char path[4096];
    snprintf(path, sizeof path, "%s/stereo/%s_maps/%s.%s.bin", dir, kind, names[view], pass);
    return path;
}

static struct orl_image read_map(const char *dir, const char *kind, int view, const char *pass)
{
    struct orl_image map;
    assert_int_equal(orl_colmap_map_read(NULL, map_path(dir, kind, view, pass), &map), ORL_OK);
    return map;
}

static const struct orl_densify_params quick = {.sources = 3, .iterations = 2,
                                                .geometric_passes = 2, .window_radius = 5,
                                                .window_step = 2, .seed = 7};

// Share of all pixels whose depth is right within 1 %, and of those, of normals right
// within five degrees.
static void measure(const struct plane_scene *scene, const char *dir, int index, double *depth_ok,
                    double *normal_ok)
{
    const struct orl_view *view = &scene->views[index];
    struct orl_image depth = read_map(dir, "depth", index, "geometric");
    struct orl_image normal = read_map(dir, "normal", index, "geometric");
    assert_int_equal(depth.width, view->camera.width);
    assert_int_equal(depth.height, view->camera.height);
    assert_int_equal(normal.channels, 3);
    int good = 0, facing = 0;
    double expected[3];
    for (int i = 0; i < 3; i++) {
        const double *row = view->cam_from_world.r[i];
        expected[i] = row[0] * scene->normal[0] + row[1] * scene->normal[1] +
                      row[2] * scene->normal[2];
    }
    for (int i = 0; i < depth.width * depth.height; i++) {
        double hit[3];
        double truth = plane_depth(scene, view, i % depth.width + 0.5, i / depth.width + 0.5, hit);
        const float *n = &normal.f32[3 * i];
        if (fabs(depth.f32[i] - truth) > 0.01 * truth)
            continue;
        good++;
        facing += n[0] * expected[0] + n[1] * expected[1] + n[2] * expected[2] > cos(5 / 57.2958);
    }
    *depth_ok = (double)good / (depth.width * depth.height);
    *normal_ok = good ? (double)facing / good : 0;
    orl_image_finish(&depth);
    orl_image_finish(&normal);
}

static void assert_recovered(const struct plane_scene *scene, const char *dir)
{
    for (int i = 0; i < scene->view_count; i++) {
        double depth_ok, normal_ok;
        measure(scene, dir, i, &depth_ok, &normal_ok);
        print_message("%s: depth right in %.3f, normal in %.3f of these\n", names[i], depth_ok,
                      normal_ok);
        assert_true(depth_ok > 0.9);
        assert_true(normal_ok > 0.95);
    }
}

// Two levels, each with an odd side somewhere.
static void test_fronto_parallel_plane(void **state)
{
    (void)state;
    struct plane_scene scene = make_scene(215, 202, 0, 0);
    char *dir = make_workspace(&scene);
    assert_int_equal(orl_densify(gpu, dir, NULL, &quick, NULL), ORL_OK);
    assert_recovered(&scene, dir);
    test_dir_remove(dir);
}

static void test_slanted_plane(void **state)
{
    (void)state;
    struct plane_scene scene = make_scene(160, 120, 0.3, 0.6);
    char *dir = make_workspace(&scene);
    assert_int_equal(orl_densify(gpu, dir, NULL, &quick, NULL), ORL_OK);
    assert_recovered(&scene, dir);
    test_dir_remove(dir);
}

static void test_mixed_sizes(void **state)
{
    (void)state;
    struct plane_scene scene = make_scene(140, 110, 0.2, -0.3);
    struct orl_view *odd = &scene.views[1];
    odd->camera = (struct orl_camera){.width = 201, .height = 151, .fx = 230, .fy = 234,
                                      .cx = 97, .cy = 78};
    char *dir = make_workspace(&scene);
    assert_int_equal(orl_densify(gpu, dir, NULL, &quick, NULL), ORL_OK);
    assert_recovered(&scene, dir);
    test_dir_remove(dir);
}

static void assert_same_file(const char *path_a, const char *path_b)
{
    uint64_t a, b;
    assert_int_equal(orl_file_hash(NULL, path_a, &a), ORL_OK);
    assert_int_equal(orl_file_hash(NULL, path_b, &b), ORL_OK);
    assert_int_equal(a, b);
}

static void test_same_seed_same_bytes(void **state)
{
    (void)state;
    struct plane_scene scene = make_scene(97, 64, 0.1, 0.2);
    char *one = make_workspace(&scene), *two = make_workspace(&scene);
    char *other = make_workspace(&scene);
    struct orl_densify_params reseeded = quick;
    reseeded.seed = 8;
    assert_int_equal(orl_densify(gpu, one, NULL, &quick, NULL), ORL_OK);
    assert_int_equal(orl_densify(gpu, two, NULL, &quick, NULL), ORL_OK);
    assert_int_equal(orl_densify(gpu, other, NULL, &reseeded, NULL), ORL_OK);
    static const char *const kinds[] = {"depth", "normal"};
    static const char *const passes[] = {"photometric", "geometric"};
    for (int i = 0; i < VIEWS_MAX; i++)
        for (int k = 0; k < 4; k++) {
            char path[4096];
            snprintf(path, sizeof path, "%s", map_path(one, kinds[k & 1], i, passes[k >> 1]));
            assert_same_file(path, map_path(two, kinds[k & 1], i, passes[k >> 1]));
        }
    uint64_t a, b;
    assert_int_equal(orl_file_hash(NULL, map_path(one, "depth", 0, "geometric"), &a), ORL_OK);
    assert_int_equal(orl_file_hash(NULL, map_path(other, "depth", 0, "geometric"), &b), ORL_OK);
    assert_true(a != b);
    test_dir_remove(one);
    test_dir_remove(two);
    test_dir_remove(other);
}

// The held-out photograph's file cannot even be decoded.
static void test_held_out_is_never_read(void **state)
{
    (void)state;
    struct plane_scene scene = make_scene(80, 64, 0, 0);
    char *dir = make_workspace(&scene);
    FILE *held_out = test_create(dir, "images/c.png");
    fputs("not a picture", held_out);
    fclose(held_out);
    char *items[] = {"a.png", "b.png", "d.png"};
    struct orl_names photos = {.count = 3, .items = items};
    assert_int_equal(orl_densify(gpu, dir, &photos, &quick, NULL), ORL_OK);
    assert_true(orl_path_is_file(map_path(dir, "depth", 0, "geometric")));
    assert_false(orl_path_is_file(map_path(dir, "depth", 2, "geometric")));
    assert_false(orl_path_is_file(map_path(dir, "normal", 2, "photometric")));
    // The same without it in the folder at all, so that it changed nothing.
    char *without = make_workspace(&scene), path[4096];
    snprintf(path, sizeof path, "%s/images/c.png", without);
    assert_int_equal(unlink(path), 0);
    assert_int_equal(orl_densify(gpu, without, &photos, &quick, NULL), ORL_OK);
    snprintf(path, sizeof path, "%s", map_path(dir, "depth", 1, "geometric"));
    assert_same_file(path, map_path(without, "depth", 1, "geometric"));
    test_dir_remove(dir);
    test_dir_remove(without);
}

static void test_resume_keeps_finished_maps(void **state)
{
    (void)state;
    struct plane_scene scene = make_scene(80, 64, 0, 0);
    char *dir = make_workspace(&scene);
    assert_int_equal(orl_densify(gpu, dir, NULL, &quick, NULL), ORL_OK);
    assert_false(orl_path_is_file(map_path(dir, "depth", 1, "agreed-1")));
    uint64_t before, after;
    assert_int_equal(orl_file_hash(NULL, map_path(dir, "depth", 1, "geometric"), &before), ORL_OK);
    struct orl_image marked;
    assert_int_equal(orl_image_init(NULL, &marked, 80, 64, 1, ORL_PIXEL_F32), ORL_OK);
    marked.f32[17] = 42;
    assert_int_equal(orl_colmap_map_write(NULL, map_path(dir, "depth", 0, "geometric"), &marked),
                     ORL_OK);
    orl_image_finish(&marked);
    assert_int_equal(unlink(map_path(dir, "depth", 1, "geometric")), 0);
    assert_int_equal(orl_densify(gpu, dir, NULL, &quick, NULL), ORL_OK);
    marked = read_map(dir, "depth", 0, "geometric");
    assert_true(marked.f32[17] == 42 && marked.f32[18] == 0);
    orl_image_finish(&marked);
    assert_int_equal(orl_file_hash(NULL, map_path(dir, "depth", 1, "geometric"), &after), ORL_OK);
    assert_int_equal(before, after);
    test_dir_remove(dir);
}

// Marks the first photograph's map, runs again, and says whether the mark is gone.
static bool is_made_again(const char *dir, const struct orl_names *photos,
                          const struct orl_densify_params *params)
{
    struct orl_image map = read_map(dir, "depth", 0, "geometric");
    map.f32[17] = 42;
    assert_int_equal(orl_colmap_map_write(NULL, map_path(dir, "depth", 0, "geometric"), &map),
                     ORL_OK);
    orl_image_finish(&map);
    assert_int_equal(orl_densify(gpu, dir, photos, params, NULL), ORL_OK);
    map = read_map(dir, "depth", 0, "geometric");
    bool again = map.f32[17] != 42;
    orl_image_finish(&map);
    return again;
}

static void test_other_settings_make_maps_again(void **state)
{
    (void)state;
    struct plane_scene scene = make_scene(40, 32, 0, 0);
    char *dir = make_workspace(&scene), *fresh = make_workspace(&scene), path[4096];
    struct orl_densify_params params = quick;
    assert_int_equal(orl_densify(gpu, dir, NULL, &params, NULL), ORL_OK);
    assert_false(is_made_again(dir, NULL, &params));
    params.max_vram_bytes = (size_t)1 << 30; // enough: nothing changes
    assert_false(is_made_again(dir, NULL, &params));
    params.iterations++;
    assert_true(is_made_again(dir, NULL, &params));
    params.seed++;
    assert_true(is_made_again(dir, NULL, &params));
    char *items[] = {"a.png", "b.png", "c.png"};
    struct orl_names photos = {.count = 3, .items = items};
    assert_true(is_made_again(dir, &photos, &params));
    assert_false(orl_path_is_file(map_path(dir, "depth", 3, "geometric")));
    // Another picture under the same name, and a record that was cut.
    snprintf(path, sizeof path, "%s/images/b.png", dir);
    draw(&scene, &scene.views[3], path);
    assert_true(is_made_again(dir, &photos, &params));
    snprintf(path, sizeof path, "%s/stereo/densify.json", dir);
    assert_int_equal(orl_file_write(NULL, path, "{", 1), ORL_OK);
    assert_true(is_made_again(dir, &photos, &params));
    // Made again, they are as if made at once.
    snprintf(path, sizeof path, "%s/images/b.png", dir);
    draw(&scene, &scene.views[1], path);
    assert_int_equal(orl_densify(gpu, dir, NULL, &params, NULL), ORL_OK);
    assert_int_equal(orl_densify(gpu, fresh, NULL, &params, NULL), ORL_OK);
    snprintf(path, sizeof path, "%s", map_path(dir, "normal", 2, "geometric"));
    assert_same_file(path, map_path(fresh, "normal", 2, "geometric"));
    test_dir_remove(dir);
    test_dir_remove(fresh);
}

// Maps are written below the workspace, by one densify at a time.
static void test_links_and_locks(void **state)
{
    (void)state;
    struct plane_scene scene = make_scene(40, 32, 0, 0);
    static const char *const folders[] = {"stereo", "stereo/depth_maps",
                                          "stereo/confidence_maps"};
    for (size_t i = 0; i < ORL_COUNT(folders); i++) {
        char *dir = make_workspace(&scene), *other = test_dir_make(), path[4096];
        struct orl_names found;
        snprintf(path, sizeof path, "%s/stereo", dir);
        assert_int_equal(i ? orl_dir_make(NULL, path) : ORL_OK, ORL_OK);
        snprintf(path, sizeof path, "%s/%s", dir, folders[i]);
        assert_int_equal(symlink(other, path), 0);
        assert_int_equal(orl_densify(gpu, dir, NULL, &quick, NULL), ORL_ERR_ARGUMENT);
        assert_int_equal(orl_dir_list(NULL, other, &found), ORL_OK);
        assert_int_equal(found.count, 0);
        orl_names_finish(&found);
        test_dir_remove(dir);
        test_dir_remove(other);
    }
    char *dir = make_workspace(&scene);
    int fd = -1;
    bool taken;
    assert_int_equal(orl_lock(NULL, dir, false, &fd, &taken), ORL_OK);
    assert_int_equal(orl_densify(gpu, dir, NULL, &quick, NULL), ORL_ERR_ARGUMENT);
    orl_unlock(&fd);
    assert_int_equal(orl_densify(gpu, dir, NULL, &quick, NULL), ORL_OK);
    test_dir_remove(dir);
}

// COLMAP's own maps took hours: neither taken for ours nor removed.
static void test_maps_of_others_stay(void **state)
{
    (void)state;
    struct plane_scene scene = make_scene(40, 32, 0, 0);
    char *dir = make_workspace(&scene), path[4096];
    assert_int_equal(orl_densify(gpu, dir, NULL, &quick, NULL), ORL_OK);
    snprintf(path, sizeof path, "%s/stereo/densify.json", dir);
    assert_int_equal(unlink(path), 0);
    for (int i = 1; i < VIEWS_MAX; i++)
        assert_int_equal(unlink(map_path(dir, "depth", i, "geometric")), 0);
    assert_int_equal(orl_densify(gpu, dir, NULL, &quick, NULL), ORL_ERR_ARGUMENT);
    // Nor without the photograph that has them: the next run would take the folder for ours.
    char *items[] = {"b.png", "c.png", "d.png"};
    struct orl_names others = {.count = 3, .items = items};
    assert_int_equal(orl_densify(gpu, dir, &others, &quick, NULL), ORL_ERR_ARGUMENT);
    assert_true(orl_path_is_file(map_path(dir, "depth", 0, "geometric")));
    assert_false(orl_path_is_file(map_path(dir, "depth", 1, "geometric")));
    test_dir_remove(dir);
}

// colmap stereo_fusion needs a list of the photographs. One that is there stays.
static void test_fusion_list(void **state)
{
    (void)state;
    struct plane_scene scene = make_scene(40, 32, 0, 0);
    char *dir = make_workspace(&scene), path[4096], *items[] = {"a.png", "b.png", "c.png"};
    struct orl_names photos = {.count = 3, .items = items}, listed = {0};
    snprintf(path, sizeof path, "%s/stereo/fusion.cfg", dir);
    assert_int_equal(orl_densify(gpu, dir, &photos, &quick, NULL), ORL_OK);
    assert_int_equal(orl_file_read_names(NULL, path, &listed), ORL_OK);
    assert_int_equal(listed.count, 3);
    for (size_t i = 0; i < listed.count; i++)
        assert_string_equal(listed.items[i], items[i]);
    orl_names_finish(&listed);
    assert_int_equal(orl_file_write(NULL, path, "b.png\n", 6), ORL_OK);
    assert_int_equal(orl_densify(gpu, dir, NULL, &quick, NULL), ORL_OK);
    assert_int_equal(orl_file_read_names(NULL, path, &listed), ORL_OK);
    assert_int_equal(listed.count, 1);
    orl_names_finish(&listed);
    test_dir_remove(dir);
}

static void test_masks(void **state)
{
    (void)state;
    struct plane_scene scene = make_scene(80, 64, 0, 0);
    char *dir = make_workspace(&scene);
    char masks[4096], path[4200];
    snprintf(masks, sizeof masks, "%s/masks", dir);
    assert_int_equal(orl_dir_make(NULL, masks), ORL_OK);
    struct orl_image mask;
    assert_int_equal(orl_image_init(NULL, &mask, 80, 64, 1, ORL_PIXEL_U8), ORL_OK);
    for (int i = 0; i < 80 * 64; i++)
        mask.u8[i] = i % 80 < 40 ? 0 : 255;
    for (int i = 0; i < VIEWS_MAX; i++) {
        snprintf(path, sizeof path, "%s/%s.png", masks, names[i]);
        assert_int_equal(orl_png_write(NULL, path, &mask), ORL_OK);
    }
    orl_image_finish(&mask);
    struct orl_densify_params params = quick;
    params.masks_dir = masks;
    assert_int_equal(orl_densify(gpu, dir, NULL, &params, NULL), ORL_OK);
    struct orl_image depth = read_map(dir, "depth", 3, "geometric");
    int inside = 0, outside = 0;
    for (int i = 0; i < 80 * 64; i++)
        *(i % 80 < 40 ? &outside : &inside) += depth.f32[i] > 0;
    assert_int_equal(outside, 0);
    assert_true(inside > 40 * 64 * 3 / 4);
    orl_image_finish(&depth);
    test_dir_remove(dir);
}

static void test_lonely_photographs(void **state)
{
    (void)state;
    struct plane_scene scene = make_scene(80, 64, 0, 0);
    scene.shared_views = 3;
    char *dir = make_workspace(&scene);
    assert_int_equal(orl_densify(gpu, dir, NULL, &quick, NULL), ORL_OK);
    struct orl_image depth = read_map(dir, "depth", 3, "geometric");
    for (int i = 0; i < 80 * 64; i++)
        assert_true(depth.f32[i] == 0);
    orl_image_finish(&depth);
    test_dir_remove(dir);

    scene.shared_views = 1;
    dir = make_workspace(&scene);
    assert_int_equal(orl_densify(gpu, dir, NULL, &quick, NULL), ORL_ERR_DATA);
    test_dir_remove(dir);
}

static void test_bad_settings(void **state)
{
    (void)state;
    const struct orl_densify_params good = {ORL_DENSIFY_DEFAULTS};
    struct orl_densify_params bad[] = {good, good, good, good, good, good};
    bad[0].sources = 0;
    bad[1].sources = 17;
    bad[2].iterations = 0;
    bad[3].geometric_passes = -1;
    bad[4].window_radius = 16;
    bad[5].window_step = 5;
    struct plane_scene scene = make_scene(80, 64, 0, 0);
    char *dir = make_workspace(&scene);
    for (size_t i = 0; i < ORL_COUNT(bad); i++)
        assert_int_equal(orl_densify(gpu, dir, NULL, &bad[i], NULL), ORL_ERR_ARGUMENT);
    test_dir_remove(dir);
}

static void watch_memory(void *priv, const char *step, double done, double total,
                         const char *detail)
{
    (void)step, (void)done, (void)total, (void)detail;
    size_t *most = priv, now = orl_gpu_bytes(gpu);
    *most = now > *most ? now : *most;
}

// Half the size: maps of half the size, as right as before, and not a byte too many.
static void test_little_memory(void **state)
{
    (void)state;
    struct plane_scene scene = make_scene(215, 202, 0.2, 0.1);
    char *dir = make_workspace(&scene);
    struct orl_densify_params params = quick;
    params.max_vram_bytes = (size_t)2 << 20;
    size_t most = 0;
    const struct orl_progress progress = {.report = watch_memory, .priv = &most};
    assert_int_equal(orl_densify(gpu, dir, NULL, &params, &progress), ORL_OK);
    assert_between(most, params.max_vram_bytes / 4, params.max_vram_bytes);
    for (int i = 0; i < scene.view_count; i++)
        scene.views[i].camera = (struct orl_camera){.width = 107, .height = 101,
                                                    .fx = 1.2 * 107, .fy = 0.6 * 215,
                                                    .cx = 0.5 * 107, .cy = 0.5 * 101};
    assert_recovered(&scene, dir);
    params.max_vram_bytes = 1000;
    assert_int_equal(orl_densify(gpu, dir, NULL, &params, NULL), ORL_ERR_GPU);
    assert_true(orl_path_is_file(map_path(dir, "depth", 1, "geometric")));
    // Whoever changes the size must not mix maps of both.
    assert_int_equal(unlink(map_path(dir, "depth", 1, "geometric")), 0);
    assert_int_equal(orl_densify(gpu, dir, NULL, &quick, NULL), ORL_OK);
    struct orl_image depth = read_map(dir, "depth", 0, "geometric");
    assert_int_equal(depth.width, 215);
    orl_image_finish(&depth);
    test_dir_remove(dir);
}

struct stopper {
    double stop_at;
    bool stopped;
};

static void watch(void *priv, const char *step, double done, double total, const char *detail)
{
    struct stopper *stopper = priv;
    assert_string_equal(step, "densify");
    assert_non_null(detail);
    assert_true(done >= 0 && done <= total);
    stopper->stopped = stopper->stopped || done >= stopper->stop_at;
}

static bool is_stopped(void *priv)
{
    return ((struct stopper *)priv)->stopped;
}

static void test_cancel_and_go_on(void **state)
{
    (void)state;
    struct plane_scene scene = make_scene(80, 64, 0, 0);
    char *dir = make_workspace(&scene), *straight = make_workspace(&scene), path[4096];
    struct stopper stopper = {.stop_at = 1.5};
    struct orl_progress progress = {.report = watch, .cancelled = is_stopped, .priv = &stopper};
    assert_int_equal(orl_densify(gpu, dir, NULL, &quick, &progress), ORL_ERR_CANCELLED);
    assert_true(orl_path_is_file(map_path(dir, "depth", 0, "photometric")));
    assert_false(orl_path_is_file(map_path(dir, "depth", 1, "photometric")));
    assert_int_equal(orl_densify(gpu, dir, NULL, &quick, NULL), ORL_OK);
    assert_int_equal(orl_densify(gpu, straight, NULL, &quick, NULL), ORL_OK);
    snprintf(path, sizeof path, "%s", map_path(dir, "depth", 2, "geometric"));
    assert_same_file(path, map_path(straight, "depth", 2, "geometric"));
    test_dir_remove(dir);
    test_dir_remove(straight);
}

static struct stopper reset = {.stop_at = 1.5};

static GLenum GLAPIENTRY reset_status(void)
{
    return reset.stopped ? GL_GUILTY_CONTEXT_RESET : GL_NO_ERROR;
}

// The device is reset in the middle of the second photograph.
static void test_reset_device_leaves_no_map(void **state)
{
    (void)state;
    struct plane_scene scene = make_scene(80, 64, 0, 0);
    char *dir = make_workspace(&scene);
    struct orl_progress progress = {.report = watch, .priv = &reset};
    PFNGLGETGRAPHICSRESETSTATUSPROC real = epoxy_glGetGraphicsResetStatus;
    epoxy_glGetGraphicsResetStatus = reset_status;
    assert_int_equal(orl_densify(gpu, dir, NULL, &quick, &progress), ORL_ERR_GPU);
    epoxy_glGetGraphicsResetStatus = real;
    assert_true(orl_path_is_file(map_path(dir, "depth", 0, "photometric")));
    assert_false(orl_path_is_file(map_path(dir, "depth", 1, "photometric")));
    // A lost device stays lost; another goes on.
    assert_int_equal(orl_densify(gpu, dir, NULL, &quick, NULL), ORL_ERR_GPU);
    assert_false(orl_path_is_file(map_path(dir, "depth", 1, "photometric")));
    orl_gpu_destroy(&gpu);
    gpu = gpu_test_device();
    assert_int_equal(orl_densify(gpu, dir, NULL, &quick, NULL), ORL_OK);
    assert_recovered(&scene, dir);
    test_dir_remove(dir);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_fronto_parallel_plane),
        cmocka_unit_test(test_slanted_plane),
        cmocka_unit_test(test_mixed_sizes),
        cmocka_unit_test(test_same_seed_same_bytes),
        cmocka_unit_test(test_held_out_is_never_read),
        cmocka_unit_test(test_resume_keeps_finished_maps),
        cmocka_unit_test(test_other_settings_make_maps_again),
        cmocka_unit_test(test_links_and_locks),
        cmocka_unit_test(test_maps_of_others_stay), cmocka_unit_test(test_fusion_list),
        cmocka_unit_test(test_masks),
        cmocka_unit_test(test_lonely_photographs),
        cmocka_unit_test(test_bad_settings),
        cmocka_unit_test(test_little_memory),
        cmocka_unit_test(test_cancel_and_go_on),
        cmocka_unit_test(test_reset_device_leaves_no_map),
    };
    gpu = gpu_test_device();
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    assert_int_equal(orl_gpu_finish(gpu), ORL_OK);
    orl_gpu_destroy(&gpu);
    return failed;
}
