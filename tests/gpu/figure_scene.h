// The figure of oriel synth figures, seen by cameras around it, with exact silhouettes.
#ifndef ORL_TESTS_FIGURE_SCENE_H
#define ORL_TESTS_FIGURE_SCENE_H

#include "datasets/figures.h"
#include "wall_scene.h"

// The last photograph gets this mask, which is freed.
static inline void mask_photo(struct fixture *f, struct orl_image *mask)
{
    size_t last = f->scene.photo_count - 1;
    char *path = strdup(orl_scene_file(&f->scene, last, ORL_FILE_MASK).text);
    char *masks = orl_path_join(NULL, f->dir, "masks");
    assert_int_equal(orl_dir_make(NULL, masks), ORL_OK);
    assert_int_equal(orl_png_write(NULL, path, mask), ORL_OK);
    f->photos[last].masked = true;
    orl_image_finish(mask);
    free(masks);
    free(path);
}

// A photograph of one colour whose subject is all within `radius` pixels of (x, y).
static inline void add_disc_photo(struct fixture *f, struct orl_view view, const uint8_t color[3],
                                  double x, double y, double radius)
{
    struct orl_image mask;
    int w = view.camera.width, h = view.camera.height;
    add_photo(f, view, color);
    assert_int_equal(orl_image_init(NULL, &mask, w, h, 1, ORL_PIXEL_U8), ORL_OK);
    for (int i = 0; i < w * h; i++)
        mask.u8[i] = hypot(i % w + 0.5 - x, i / w + 0.5 - y) < radius ? 255 : 0;
    mask_photo(f, &mask);
}

// A camera that looks at the origin from `distance`, `turn` radians around the y axis.
static inline struct orl_view look_around(double turn, double distance, int side, double focal)
{
    double c = cos(turn), s = sin(turn);
    return (struct orl_view){.camera = {.width = side, .height = side, .fx = focal, .fy = focal,
                                        .cx = 0.5 * side, .cy = 0.5 * side},
                             .cam_from_world = {.r = {{c, 0, s}, {0, 1, 0}, {-s, 0, c}},
                                                .t = {0, 0, distance}}};
}

// `cameras` photographs of the figure at its first time step.
static inline void setup_figure(struct fixture *f, int cameras, int width, int height)
{
    const struct orl_figures_params params = {cameras, 1, width, height};
    struct orl_view views[PHOTOS_MAX];
    struct orl_figure figure;
    setup_empty(f, 3);
    orl_figures_views(&params, views);
    orl_figure_pose(0, &figure);
    for (int i = 0; i < cameras; i++) {
        struct orl_figures_picture picture;
        assert_int_equal(orl_figures_draw(NULL, &figure, &views[i], &picture), ORL_OK);
        add_photo(f, views[i], red);
        repaint_photo(f, &picture.photo);
        mask_photo(f, &picture.mask);
        orl_figures_picture_finish(&picture);
    }
}

#endif
