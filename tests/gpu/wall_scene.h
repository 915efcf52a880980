// A wall and a plate before it, seen by photographs of one colour each.
#ifndef ORL_TESTS_WALL_SCENE_H
#define ORL_TESTS_WALL_SCENE_H

#include <string.h>

#include "gpu_test.h"
#include "io/picture.h"
#include "oriel/render.h"

enum { PHOTOS_MAX = 80 };

// Colours whose linear light is known: sRGB 255 is 1, 0 is 0.
static const uint8_t red[3] = {255, 0, 0}, green[3] = {0, 255, 0}, blue[3] = {0, 0, 255};

struct fixture {
    char *dir;
    struct orl_scene scene;
    struct orl_photo photos[PHOTOS_MAX];
};

// Looks along z, as the wall's normals look back.
static inline struct orl_view look_from(double x, double y, double z, int side, double focal)
{
    return (struct orl_view){.camera = {.width = side, .height = side, .fx = focal, .fy = focal,
                                        .cx = 0.5 * side, .cy = 0.5 * side},
                             .cam_from_world = {.r = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                                .t = {-x, -y, -z}}};
}

// A scene without points and photographs, `distance` from what they will see.
static inline void setup_empty(struct fixture *f, double distance)
{
    memset(f, 0, sizeof *f);
    f->dir = test_dir_make();
    f->scene.dir = f->dir;
    f->scene.photos = f->photos;
    f->scene.photo_distance = distance;
    char *images = orl_path_join(NULL, f->dir, "images");
    assert_int_equal(orl_dir_make(NULL, images), ORL_OK);
    free(images);
}

// `side` x `side` points around (x, 0, z), `size` units wide, from points[first] on.
static inline void set_square(struct orl_points *points, size_t first, size_t side, double size,
                              double x, float z, const uint8_t color[3])
{
    for (size_t k = 0, i = first; k < side * side; k++, i++) {
        double column = (double)(k % side), row = (double)(k / side);
        points->position[i][0] = (float)((column + 0.5) / (double)side * size - size / 2 + x);
        points->position[i][1] = (float)((row + 0.5) / (double)side * size - size / 2);
        points->position[i][2] = z;
        points->normal[i][2] = -1;
        points->radius[i] = (float)(1.5 * size / (double)side);
        memcpy(points->color[i], color, 3);
    }
}

// A wall at z = 4, 6 units wide, and, if asked for, a plate at z = 2 around x = 0.7.
static inline void setup(struct fixture *f, bool plate)
{
    enum { WALL = 120, PLATE = 20 };
    setup_empty(f, 4);
    struct orl_points *points = &f->scene.points;
    size_t count = WALL * WALL + (plate ? PLATE * PLATE : 0);
    assert_int_equal(orl_points_init(NULL, points, count), ORL_OK);
    set_square(points, 0, WALL, 6, 0, 4, red);
    if (plate)
        set_square(points, WALL * WALL, PLATE, 0.4, 0.7, 2, blue);
}

// The last photograph becomes this picture, which is freed.
static inline void repaint_photo(struct fixture *f, struct orl_image *image)
{
    char *path = strdup(orl_scene_file(&f->scene, f->scene.photo_count - 1, ORL_FILE_PHOTO).text);
    assert_int_equal(orl_png_write(NULL, path, image), ORL_OK);
    orl_image_finish(image);
    free(path);
}

static inline void add_photo(struct fixture *f, struct orl_view view, const uint8_t color[3])
{
    struct orl_photo *photo = &f->photos[f->scene.photo_count];
    photo->view = view;
    photo->gain[0] = photo->gain[1] = photo->gain[2] = 1;
    photo->response = -1;
    photo->name = malloc(16);
    snprintf(photo->name, 16, "%zu.png", f->scene.photo_count);
    struct orl_image image;
    assert_int_equal(orl_image_init(NULL, &image, view.camera.width, view.camera.height, 3,
                                    ORL_PIXEL_U8), ORL_OK);
    for (int i = 0; i < view.camera.width * view.camera.height; i++)
        memcpy(&image.u8[3 * i], color, 3);
    f->scene.photo_count++;
    repaint_photo(f, &image);
}

static inline void teardown(struct fixture *f)
{
    for (size_t i = 0; i < f->scene.photo_count; i++)
        free(f->photos[i].name);
    orl_points_finish(&f->scene.points);
    test_dir_remove(f->dir);
}

static inline struct orl_frame draw_by(struct orl_gpu *gpu, struct fixture *f,
                                       struct orl_view view,
                                       const struct orl_render_params *params,
                                       const struct orl_renderer_params *kind)
{
    struct orl_renderer *renderer;
    struct orl_frame frame;
    assert_int_equal(orl_renderer_create(gpu, &f->scene, kind, &renderer), ORL_OK);
    assert_int_equal(orl_renderer_draw(renderer, &view, params, NULL, &frame), ORL_OK);
    orl_renderer_destroy(&renderer);
    return frame;
}

static inline struct orl_frame draw(struct orl_gpu *gpu, struct fixture *f, struct orl_view view,
                                    const struct orl_render_params *params, size_t budget)
{
    return draw_by(gpu, f, view, params,
                   &(struct orl_renderer_params){.max_vram_bytes = budget});
}

static inline const float *color_at(const struct orl_frame *frame, int x, int y)
{
    return &frame->color.f32[3 * (y * frame->color.width + x)];
}

#endif
