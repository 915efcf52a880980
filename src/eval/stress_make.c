// The unchanged scene: the synthetic monument with its truth, or a scene from its folder.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "core/vec3.h"
#include "eval/heldout.h"
#include "eval/stress_internal.h"
#include "io/picture.h"

enum {
    POINT_STEP = 3,      // pixels between the points that a true depth map gives
    POINTS_MAX = 120000, // of a real scene at this size
    WALK_FRAMES = 3,
};
static const double walk_step = 0.1; // of the way to the next photograph
static const double figure_distance = 3.1; // of the cameras from the walking figure, metres
static const double subject[3] = {0, 4.5, -0.8}; // middle of the monument, metres

// --- both kinds ---

static enum orl_result make_room(struct stress_case *c, size_t photos, size_t views)
{
    const struct orl_log *log = orl_gpu_log(c->gpu);
    c->scene.dir = orl_strdup(log, "");
    c->scene.frame = -1;
    c->scene.photos = orl_array(log, photos, sizeof *c->scene.photos);
    c->photos = orl_array(log, photos, sizeof *c->photos);
    c->masks = orl_array(log, photos, sizeof *c->masks);
    c->views = orl_array(log, views, sizeof *c->views);
    c->walk = orl_array(log, WALK_FRAMES, sizeof *c->walk);
    return c->scene.dir && c->scene.photos && c->photos && c->masks && c->views && c->walk
               ? ORL_OK : ORL_ERR_MEMORY;
}

static enum orl_result add_photo(struct stress_case *c, const struct orl_photo *like,
                                 const struct orl_view *view)
{
    size_t i = c->scene.photo_count;
    struct orl_photo *photo = &c->scene.photos[i];
    *photo = *like;
    photo->view = *view;
    photo->linear = false;
    photo->name = orl_format(orl_gpu_log(c->gpu), "%04zu.png", i);
    if (!photo->name)
        return ORL_ERR_MEMORY;
    c->scene.photo_count++;
    return ORL_OK;
}

// Neighbouring frames from the first held-out view towards the next photograph.
static enum orl_result make_walk(struct stress_case *c)
{
    const struct stress_view *from = &c->views[0];
    size_t next = from->photo;
    for (size_t step = 1; step < c->scene.photo_count && c->scene.photos[next].test; step++)
        next = (from->photo + step) % c->scene.photo_count;
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < WALK_FRAMES; i++) {
        struct stress_view *frame = &c->walk[c->walk_count++];
        frame->photo = from->photo;
        frame->view = orl_view_interpolate(&from->view, &c->scene.photos[next].view,
                                           walk_step * (double)i);
        if (c->synth)
            result = orl_stress_draw_truth(c, &frame->view, NULL, &frame->depth);
    }
    return result;
}

// --- the monument ---

struct orl_synth_params orl_stress_generator(const struct orl_stress_params *params)
{
    struct orl_synth_params generator = {ORL_SYNTH_DEFAULTS};
    generator.width = params->side;
    generator.height = params->side * 2 / 3;
    generator.count = params->photographs + (params->quick ? 1 : params->views);
    generator.seed = params->seed;
    return generator;
}

enum orl_result orl_stress_draw_truth(struct stress_case *c, const struct orl_view *view,
                                      struct orl_image *picture, struct orl_image *depth)
{
    const struct orl_synth_sensor sensor = {.response = ORL_SYNTH_SRGB};
    struct orl_synth_frame frame;
    enum orl_result result = orl_synth_draw(c->synth, NULL, view, &frame);
    if (result != ORL_OK)
        return result;
    if (picture) {
        orl_image_finish(picture);
        result = orl_synth_expose(orl_gpu_log(c->gpu), &frame.radiance, &sensor, picture);
    }
    if (depth) {
        orl_image_finish(depth);
        *depth = frame.depth;
        memset(&frame.depth, 0, sizeof frame.depth);
    }
    orl_synth_frame_finish(&frame);
    return result;
}

// Makes room for the points of all true depth maps.
static enum orl_result init_points(struct stress_case *c, int width, int height)
{
    size_t columns = (size_t)(width / POINT_STEP + 1), rows = (size_t)(height / POINT_STEP + 1);
    enum orl_result result = orl_points_init(orl_gpu_log(c->gpu), &c->scene.points,
                                             c->scene.photo_count * columns * rows);
    c->scene.points.count = 0;
    return result;
}

// Appends the points of a photograph's true depth. normal, textured: may be empty.
static void take_depth(struct stress_case *c, size_t i, const struct orl_image *depth,
                       const struct orl_image *normal, const struct orl_image *textured)
{
    const struct orl_view *view = &c->scene.photos[i].view;
    struct orl_points *points = &c->scene.points;
    int width = view->camera.width;
    for (int p = 0; p < width * view->camera.height; p++) {
        double world[3], z = (double)depth->f32[p];
        int x = p % width, y = p / width;
        // Where a wall has no texture, stereo finds nothing.
        bool plain = textured->data && !(textured->f32[p] > 0);
        if (!(z > 0) || x % POINT_STEP || y % POINT_STEP || plain)
            continue;
        orl_view_unproject(view, x + 0.5, y + 0.5, z, world);
        for (int k = 0; k < 3; k++) {
            double sum = 0;
            for (int r = 0; normal->data && r < 3; r++)
                sum += view->cam_from_world.r[r][k] * (double)normal->f32[3 * p + r];
            points->normal[points->count][k] = (float)sum;
            points->position[points->count][k] = (float)world[k];
        }
        memcpy(points->color[points->count++], &c->photos[i].u8[3 * p], 3);
    }
}

static enum orl_result draw_photo(struct stress_case *c, size_t i)
{
    const struct orl_log *log = orl_gpu_log(c->gpu);
    const struct orl_synth_sensor sensor = {.response = ORL_SYNTH_SRGB};
    struct orl_synth_frame frame;
    enum orl_result result = orl_synth_draw(c->synth, NULL, &c->scene.photos[i].view, &frame);
    if (result != ORL_OK)
        return result;
    result = orl_synth_expose(log, &frame.radiance, &sensor, &c->photos[i]);
    if (result == ORL_OK)
        take_depth(c, i, &frame.depth, &frame.normal, &frame.textured);
    orl_synth_frame_finish(&frame);
    return result;
}

// The photographs' cameras and the held-out views, evenly between them.
static enum orl_result place_cameras(struct stress_case *c, size_t photos, size_t views,
                                     const struct orl_view *all)
{
    static const struct orl_photo plain = {.gain = {1, 1, 1}, .response = -1};
    enum orl_result result = ORL_OK;
    double height = 0;
    for (size_t i = 0; result == ORL_OK && i < photos + views; i++) {
        double eye[3];
        result = add_photo(c, &plain, &all[i]);
        orl_pose_centre(&all[i].cam_from_world, eye);
        height += eye[1] / (double)(photos + views);
    }
    for (size_t k = 0; result == ORL_OK && k < views; k++) {
        struct stress_view *view = &c->views[c->view_count++];
        view->photo = (k + 1) * (photos + views) / (views + 1);
        view->view = all[view->photo];
        c->scene.photos[view->photo].test = true;
    }
    c->scene.ground = (struct orl_ground){.plane = {0, 1, 0, 0}, .height = height, .known = true};
    return result;
}

// Mean distance of the photographs from the middle of the subject.
static double subject_distance(const struct orl_scene *scene)
{
    double sum = 0;
    for (size_t i = 0; i < scene->photo_count; i++) {
        double eye[3], way[3];
        orl_pose_centre(&scene->photos[i].view.cam_from_world, eye);
        for (int k = 0; k < 3; k++)
            way[k] = eye[k] - subject[k];
        sum += sqrt(orl_dot3(way, way)) / (double)scene->photo_count;
    }
    return sum;
}

enum orl_result orl_stress_make_synth(struct orl_gpu *gpu, const struct orl_stress_params *params,
                                      const struct orl_synth_params *generator,
                                      struct stress_case *c)
{
    const struct orl_log *log = orl_gpu_log(gpu);
    size_t photos = (size_t)params->photographs, views = params->quick ? 1 : (size_t)params->views;
    size_t all = photos + views;
    *c = (struct stress_case){.gpu = gpu};
    struct orl_view *cameras = orl_array(log, all, sizeof *cameras);
    enum orl_result result = cameras ? orl_synth_create(gpu, generator, &c->synth)
                                     : ORL_ERR_MEMORY;
    if (result == ORL_OK)
        result = make_room(c, all, views);
    if (result == ORL_OK) {
        orl_synth_views(generator, cameras);
        result = place_cameras(c, photos, views, cameras);
    }
    if (result == ORL_OK)
        result = init_points(c, generator->width, generator->height);
    for (size_t i = 0; result == ORL_OK && i < all; i++)
        if (orl_progress_cancelled(params->progress))
            result = ORL_ERR_CANCELLED;
        else if (!c->scene.photos[i].test)
            result = draw_photo(c, i);
    for (size_t i = 0; result == ORL_OK && i < views; i++)
        result = orl_stress_draw_truth(c, &c->views[i].view, &c->views[i].picture,
                                       &c->views[i].depth);
    if (result == ORL_OK) {
        c->scene.photo_distance = subject_distance(&c->scene);
        result = make_walk(c);
    }
    if (result == ORL_OK)
        result = orl_stress_set_radii(c);
    if (result == ORL_OK)
        result = orl_stress_color_points(log, c->photos, &c->scene);
    free(cameras);
    return result;
}

// --- the figure ---

static enum orl_result draw_figure(struct stress_case *c, const struct orl_figure *figure, size_t i)
{
    static const struct orl_image none;
    struct orl_figures_picture drawn;
    enum orl_result result = orl_figures_draw(orl_gpu_log(c->gpu), figure,
                                              &c->scene.photos[i].view, &drawn);
    if (result != ORL_OK)
        return result;
    c->photos[i] = drawn.photo;
    c->masks[i] = drawn.mask;
    memset(&drawn.photo, 0, sizeof drawn.photo);
    memset(&drawn.mask, 0, sizeof drawn.mask);
    if (!c->scene.photos[i].test)
        take_depth(c, i, &drawn.depth, &none, &none);
    orl_figures_picture_finish(&drawn);
    return ORL_OK;
}

enum orl_result orl_stress_make_figure(struct orl_gpu *gpu, const struct orl_stress_params *params,
                                       struct stress_case *c)
{
    const struct orl_log *log = orl_gpu_log(gpu);
    size_t photos = (size_t)params->photographs, views = params->quick ? 1 : (size_t)params->views;
    const struct orl_figures_params figures = {
        .cameras = (int)(photos + views), .frames = 1, .width = params->side,
        .height = params->side * 2 / 3};
    struct orl_figure figure;
    *c = (struct stress_case){.gpu = gpu};
    struct orl_view *cameras = orl_array(log, photos + views, sizeof *cameras);
    enum orl_result result = cameras ? make_room(c, photos + views, views) : ORL_ERR_MEMORY;
    if (result == ORL_OK) {
        orl_figures_views(&figures, cameras);
        orl_figure_pose(0, &figure);
        result = place_cameras(c, photos, views, cameras);
    }
    if (result == ORL_OK)
        result = init_points(c, figures.width, figures.height);
    for (size_t i = 0; result == ORL_OK && i < photos + views; i++)
        result = draw_figure(c, &figure, i);
    for (size_t k = 0; result == ORL_OK && k < views; k++) {
        c->views[k].picture = c->photos[c->views[k].photo];
        memset(&c->photos[c->views[k].photo], 0, sizeof *c->photos);
    }
    c->scene.photo_distance = figure_distance;
    if (result == ORL_OK)
        result = make_walk(c);
    if (result == ORL_OK)
        result = orl_stress_set_radii(c);
    if (result == ORL_OK)
        result = orl_stress_color_points(log, c->photos, &c->scene);
    free(cameras);
    return result;
}

// --- a scene from its folder ---

static enum orl_result thin_points(const struct orl_log *log, const struct orl_points *from,
                                   struct orl_points *to)
{
    size_t step = (from->count + POINTS_MAX - 1) / POINTS_MAX;
    step = step ? step : 1;
    enum orl_result result = orl_points_init(log, to, (from->count + step - 1) / step);
    for (size_t i = 0; result == ORL_OK && i < to->count; i++)
        orl_points_copy(from, i * step, to, i);
    return result;
}

static enum orl_result read_mask(struct stress_case *c, const struct orl_scene *scene, size_t photo,
                                 size_t i)
{
    const struct orl_log *log = orl_gpu_log(c->gpu);
    const struct orl_camera *camera = &c->scene.photos[i].view.camera;
    struct orl_image full = {0}, *mask = &c->masks[i];
    if (!scene->photos[photo].masked)
        return ORL_OK;
    char *path = orl_scene_mask_path(log, scene, photo);
    enum orl_result result = path ? orl_picture_read(log, path, 1, &full) : ORL_ERR_MEMORY;
    if (result == ORL_OK)
        result = orl_image_init(log, mask, camera->width, camera->height, 1, ORL_PIXEL_U8);
    for (int p = 0; result == ORL_OK && p < camera->width * camera->height; p++) {
        int x = p % camera->width * full.width / camera->width;
        int y = p / camera->width * full.height / camera->height;
        mask->u8[p] = full.u8[y * full.width + x] >= 128 ? 255 : 0;
    }
    orl_image_finish(&full);
    free(path);
    return result;
}

// Takes a photograph of the scene at 1/divide of its size.
static enum orl_result take_photo(struct stress_case *c, const struct orl_scene *scene, size_t photo,
                                  int divide)
{
    struct orl_heldout read;
    size_t i = c->scene.photo_count;
    enum orl_result result =
        orl_heldout_load(orl_gpu_log(c->gpu), scene, photo, divide, &read);
    if (result == ORL_OK)
        result = add_photo(c, &scene->photos[photo], &read.view);
    if (result == ORL_OK) {
        c->photos[i] = read.picture;
        memset(&read.picture, 0, sizeof read.picture);
        result = read_mask(c, scene, photo, i);
    }
    orl_heldout_finish(&read);
    return result;
}

static int divide_for(const struct orl_scene *scene, int side)
{
    int longer = 1;
    for (size_t i = 0; i < scene->photo_count; i++) {
        const struct orl_camera *camera = &scene->photos[i].view.camera;
        longer = camera->width > longer ? camera->width : longer;
        longer = camera->height > longer ? camera->height : longer;
    }
    return (longer + side - 1) / side;
}

enum orl_result orl_stress_make_scene(struct orl_gpu *gpu, const struct orl_stress_params *params,
                                      const struct orl_scene *scene, struct stress_case *c)
{
    const struct orl_log *log = orl_gpu_log(gpu);
    struct orl_heldout *heldout = NULL;
    size_t count = 0;
    int divide = divide_for(scene, params->side);
    *c = (struct stress_case){.gpu = gpu};
    enum orl_result result = orl_heldout_load_some(log, scene, params->quick ? 1 : (size_t)params->views,
                                                   divide, &heldout, &count);
    if (result == ORL_OK)
        result = make_room(c, scene->photo_count, count);
    for (size_t i = 0; result == ORL_OK && i < scene->photo_count; i++) {
        if (!scene->photos[i].test) {
            result = take_photo(c, scene, i, divide);
            continue;
        }
        for (size_t k = 0; result == ORL_OK && k < count; k++) {
            if (heldout[k].photo != i)
                continue;
            struct stress_view *view = &c->views[c->view_count++];
            *view = (struct stress_view){.photo = c->scene.photo_count, .view = heldout[k].view,
                                         .picture = heldout[k].picture};
            memset(&heldout[k].picture, 0, sizeof heldout[k].picture);
            result = add_photo(c, &scene->photos[i], &view->view);
            if (result == ORL_OK)
                result = read_mask(c, scene, i, view->photo);
        }
    }
    c->scene.photo_distance = scene->photo_distance;
    c->scene.near_distance = scene->near_distance;
    c->scene.ground = scene->ground;
    if (result == ORL_OK)
        result = thin_points(log, &scene->points, &c->scene.points);
    if (result == ORL_OK)
        result = orl_stress_set_radii(c);
    if (result == ORL_OK)
        result = orl_stress_color_points(log, c->photos, &c->scene);
    if (result == ORL_OK)
        result = make_walk(c);
    for (size_t k = 0; k < count; k++)
        orl_heldout_finish(&heldout[k]);
    free(heldout);
    return result;
}
