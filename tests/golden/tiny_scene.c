#include "tiny_scene.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "io/picture.h"
#include "test.h"

static const double wall_z = 4, box_z = 3, box_back_z = 3.6, box_x = 0.55, box_y = 0.4;

struct hit {
    double point[3], normal[3];
};

// Broad stripes and spots: detail that 64x48 pixels can hold.
static void paint(const struct hit *hit, uint8_t rgb[3])
{
    const double *p = hit->point;
    bool wall = hit->point[2] > box_back_z + 0.2;
    double stripes = sin(5 * p[0] + 2 * p[1] + 3 * p[2]), spots = sin(6 * p[0]) * sin(7 * p[1]);
    double base[3] = {wall ? 150 : 90, wall ? 130 : 120, wall ? 90 : 170};
    double value[3] = {base[0] + 50 * stripes, base[1] + 40 * spots,
                       base[2] + 30 * stripes * spots};
    double shade = 0.7 + 0.3 * fabs(hit->normal[2]);
    for (int c = 0; c < 3; c++)
        rgb[c] = (uint8_t)lround(shade * value[c]);
}

// Nearest surface along origin + t * ray with ray z > 0: slabs of the box, then the wall.
static void trace(const double origin[3], const double ray[3], struct hit *hit)
{
    const double low[3] = {-box_x, -box_y, box_z}, high[3] = {box_x, box_y, box_back_z};
    double enter = -INFINITY, leave = INFINITY;
    int axis = 2;
    for (int i = 0; i < 3; i++) {
        double a = (low[i] - origin[i]) / ray[i], b = (high[i] - origin[i]) / ray[i];
        if (ray[i] == 0) {
            bool inside = origin[i] > low[i] && origin[i] < high[i];
            a = inside ? -INFINITY : INFINITY;
            b = INFINITY;
        }
        if (fmin(a, b) > enter) {
            enter = fmin(a, b);
            axis = i;
        }
        leave = fmin(leave, fmax(a, b));
    }
    bool box = enter < leave && enter > 0;
    double t = box ? enter : (wall_z - origin[2]) / ray[2];
    memset(hit, 0, sizeof *hit);
    for (int i = 0; i < 3; i++)
        hit->point[i] = origin[i] + t * ray[i];
    hit->normal[box ? axis : 2] = box && ray[axis] < 0 ? 1 : -1;
}

void tiny_scene_trace(const struct orl_view *view, struct orl_image *color,
                      struct orl_image *depth)
{
    const struct orl_camera *c = &view->camera;
    const struct orl_pose *pose = &view->cam_from_world;
    double centre[3];
    orl_pose_centre(pose, centre);
    assert_int_equal(orl_image_init(NULL, color, c->width, c->height, 3, ORL_PIXEL_U8), ORL_OK);
    assert_int_equal(orl_image_init(NULL, depth, c->width, c->height, 1, ORL_PIXEL_F32), ORL_OK);
    for (int i = 0; i < c->width * c->height; i++) {
        double x = (i % c->width + 0.5 - c->cx) / c->fx, y = (i / c->width + 0.5 - c->cy) / c->fy;
        double ray[3], cam[3];
        for (int k = 0; k < 3; k++)
            ray[k] = pose->r[0][k] * x + pose->r[1][k] * y + pose->r[2][k];
        struct hit hit;
        trace(centre, ray, &hit);
        paint(&hit, color->u8 + 3 * i);
        orl_pose_apply(pose, hit.point, cam);
        depth->f32[i] = (float)cam[2];
    }
}

// Points on a grid of `step` over a rectangle spanned from corner by u and v.
static void add_grid(struct orl_points *points, const double corner[3], const double u[3],
                     const double v[3], const double normal[3], double step)
{
    double length_u = sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
    double length_v = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    int columns = (int)ceil(length_u / step), rows = (int)ceil(length_v / step);
    for (int i = 0; i < columns * rows; i++) {
        double a = (i % columns + 0.5) / columns, b = (i / columns + 0.5) / rows;
        struct hit hit;
        for (int k = 0; k < 3; k++) {
            hit.point[k] = corner[k] + a * u[k] + b * v[k];
            hit.normal[k] = normal[k];
            points->position[points->count][k] = (float)hit.point[k];
            points->normal[points->count][k] = (float)normal[k];
        }
        paint(&hit, points->color[points->count]);
        points->radius[points->count++] = (float)step;
    }
}

static void add_points(struct orl_points *points)
{
    const double step = 0.045, width = 2 * box_x, height = 2 * box_y, deep = box_back_z - box_z;
    assert_int_equal(orl_points_init(NULL, points, 40000), ORL_OK);
    points->count = 0;
    add_grid(points, (double[]){-4, -3, wall_z}, (double[]){8, 0, 0}, (double[]){0, 6, 0},
             (double[]){0, 0, -1}, step);
    add_grid(points, (double[]){-box_x, -box_y, box_z}, (double[]){width, 0, 0},
             (double[]){0, height, 0}, (double[]){0, 0, -1}, step);
    for (int side = -1; side <= 1; side += 2) {
        add_grid(points, (double[]){side * box_x, -box_y, box_z}, (double[]){0, 0, deep},
                 (double[]){0, height, 0}, (double[]){side, 0, 0}, step);
        add_grid(points, (double[]){-box_x, side * box_y, box_z}, (double[]){width, 0, 0},
                 (double[]){0, 0, deep}, (double[]){0, side, 0}, step);
    }
    assert_true(points->count < 40000);
}

void tiny_scene_make(const char *dir, struct orl_scene *scene)
{
    const double eyes[TINY_PHOTOS][3] = {
        {-0.7, 0.1, 0}, {-0.35, -0.25, 0.1}, {0.1, 0.05, 0.05}, {0.4, -0.2, 0}, {0.75, 0.2, 0.1}};
    memset(scene, 0, sizeof *scene);
    scene->dir = orl_strdup(NULL, dir);
    scene->photo_count = TINY_PHOTOS;
    scene->photo_distance = 3.5;
    scene->photos = orl_array(NULL, TINY_PHOTOS, sizeof *scene->photos);
    char *folder = orl_path_join(NULL, dir, "images");
    assert_int_equal(orl_dir_make(NULL, folder), ORL_OK);
    free(folder);
    for (size_t i = 0; i < TINY_PHOTOS; i++) {
        struct orl_photo *photo = &scene->photos[i];
        *photo = (struct orl_photo){.test = i == TINY_TEST_PHOTO, .gain = {1, 1, 1},
                                     .response = -1};
        photo->name = orl_format(NULL, "%zu.png", i);
        photo->view.camera = (struct orl_camera){TINY_WIDTH, TINY_HEIGHT, 60, 60,
                                                 TINY_WIDTH / 2.0, TINY_HEIGHT / 2.0};
        photo->view.cam_from_world =
            orl_pose_look_at(eyes[i], (double[]){0, 0, 3.5}, (double[]){0, -1, 0});
        struct orl_image color, depth;
        tiny_scene_trace(&photo->view, &color, &depth);
        char *path = strdup(orl_scene_file(scene, i, ORL_FILE_PHOTO).text);
        assert_int_equal(orl_png_write(NULL, path, &color), ORL_OK);
        free(path);
        orl_image_finish(&color);
        orl_image_finish(&depth);
    }
    add_points(&scene->points);
}

void tiny_scene_finish(struct orl_scene *scene)
{
    for (size_t i = 0; i < scene->photo_count; i++)
        free(scene->photos[i].name);
    free(scene->photos);
    free(scene->dir);
    orl_points_finish(&scene->points);
    memset(scene, 0, sizeof *scene);
}
