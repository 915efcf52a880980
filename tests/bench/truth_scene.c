// truth_scene PHOTOS TRUTH SCENE STRIDE TEST_EVERY: a scene of synthetic photographs (oriel
// synth) with true cameras, exposures, and points on the true surface, every STRIDE-th pixel
// of every training photograph in its colour. What is measured on it is rendering and merging
// alone. Every TEST_EVERY-th photograph is held out, from the middle of the first such group; 0:
// none.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <jansson.h>

#include "core/file.h"
#include "core/memory.h"
#include "io/picture.h"
#include "scene/colmap.h"
#include "oriel/points.h"

struct job {
    struct orl_log log;
    const char *photos, *truth, *scene;
    int stride, test_every;
    struct orl_colmap_model model;
    struct orl_points points;
    json_t *summary; // of the truth
};

static enum orl_result copy_folder(const struct orl_log *log, const char *from, const char *to)
{
    struct orl_names names = {0};
    enum orl_result result = orl_dir_make(log, to);
    if (result == ORL_OK)
        result = orl_dir_list(log, from, &names);
    for (size_t i = 0; result == ORL_OK && i < names.count; i++) {
        char *source = orl_path_join(log, from, names.items[i]);
        char *target = orl_path_join(log, to, names.items[i]);
        result = orl_file_copy(log, source, target);
        free(source);
        free(target);
    }
    orl_names_finish(&names);
    return result;
}

static bool held_out(const struct job *job, int index)
{
    return job->test_every > 0 && index % job->test_every == job->test_every / 2;
}

static enum orl_result read_map(const struct job *job, const char *folder, const char *name,
                                struct orl_image *map)
{
    char *path = orl_format(&job->log, "%s/stereo/%s/%s.geometric.bin", job->truth, folder, name);
    enum orl_result result = path ? orl_colmap_map_read(&job->log, path, map) : ORL_ERR_MEMORY;
    free(path);
    return result;
}

static void add_point(struct job *job, const struct orl_view *view, int x, int y, double z,
                      const float normal[3], const uint8_t color[3])
{
    const struct orl_pose *pose = &view->cam_from_world;
    struct orl_points *points = &job->points;
    double world[3];
    orl_view_unproject(view, x + 0.5, y + 0.5, z, world);
    for (int i = 0; i < 3; i++) {
        points->position[points->count][i] = (float)world[i];
        for (int k = 0; k < 3; k++)
            points->normal[points->count][i] += (float)pose->r[k][i] * normal[k];
    }
    // Discs of slanted surfaces reach their neighbours; no more, or edges grow.
    double facing = fmax(fabs((double)normal[2]), 0.6);
    memcpy(points->color[points->count], color, 3);
    points->radius[points->count++] = (float)(0.6 * job->stride * z / view->camera.fx / facing);
}

static enum orl_result add_photo(struct job *job, const struct orl_colmap_image *image)
{
    struct orl_image depth = {0}, normal = {0}, color = {0};
    struct orl_view view = {orl_colmap_camera_by_id(&job->model, image->camera_id)->pinhole,
                            image->cam_from_world};
    enum orl_result result = read_map(job, "depth_maps", image->name, &depth);
    if (result == ORL_OK)
        result = read_map(job, "normal_maps", image->name, &normal);
    char *path = orl_path_join(&job->log, job->photos, image->name);
    if (result == ORL_OK)
        result = path ? orl_picture_read(&job->log, path, 3, &color) : ORL_ERR_MEMORY;
    free(path);
    for (int y = job->stride / 2; result == ORL_OK && y < depth.height; y += job->stride)
        for (int x = job->stride / 2; x < depth.width; x += job->stride) {
            size_t at = (size_t)y * (size_t)depth.width + (size_t)x;
            if (depth.f32[at] > 0)
                add_point(job, &view, x, y, (double)depth.f32[at], normal.f32 + 3 * at,
                          color.u8 + 3 * at);
        }
    orl_image_finish(&depth);
    orl_image_finish(&normal);
    orl_image_finish(&color);
    return result;
}

static json_t *photo_json(const struct job *job, const char *name, int index)
{
    const json_t *truth = json_array_get(json_object_get(job->summary, "photographs"),
                                         (size_t)index);
    double ev = json_number_value(json_object_get(truth, "exposure_ev")), gain = exp2(-ev);
    return json_pack("{s:s, s:s, s:f, s:i, s:[f,f,f]}", "name", name, "split",
                     held_out(job, index) ? "test" : "train", "exposure_ev", ev, "series",
                     (int)lround(ev) + 12, "gain", gain, gain, gain);
}

static enum orl_result make(struct job *job)
{
    json_t *photos = json_array();
    const struct orl_camera *c = &job->model.cameras[0].pinhole;
    enum orl_result result =
        orl_points_init(&job->log, &job->points,
                        job->model.image_count * (size_t)c->width * (size_t)c->height);
    job->points.count = 0;
    for (size_t i = 0; result == ORL_OK && i < job->model.image_count; i++) {
        const struct orl_colmap_image *image = &job->model.images[i];
        int index = atoi(image->name) - 1;
        json_array_append_new(photos, photo_json(job, image->name, index));
        if (!held_out(job, index))
            result = add_photo(job, image);
    }
    char *points = orl_path_join(&job->log, job->scene, "points.ply");
    char *manifest = orl_path_join(&job->log, job->scene, "scene.json");
    if (result == ORL_OK)
        result = orl_points_write(&job->log, points, &job->points, false, NULL);
    json_t *root = json_pack("{s:s, s:i, s:o}", "format", "oriel scene", "version", 1,
                             "photographs", photos);
    if (result == ORL_OK && json_dump_file(root, manifest, JSON_INDENT(1)) != 0)
        result = orl_fail(&job->log, ORL_ERR_IO, "%s: cannot be written", manifest);
    json_decref(root);
    free(points);
    free(manifest);
    return result;
}

static enum orl_result run(struct job *job)
{
    json_error_t error;
    char *summary = orl_path_join(&job->log, job->truth, "synth.json");
    char *sparse = orl_path_join(&job->log, job->truth, "sparse");
    char *images = orl_path_join(&job->log, job->scene, "images");
    char *model = orl_path_join(&job->log, job->scene, "sparse");
    job->summary = json_load_file(summary, 0, &error);
    enum orl_result result = job->summary ? copy_folder(&job->log, job->photos, images)
                                          : orl_fail(&job->log, ORL_ERR_NOT_FOUND, "%s: %s",
                                                     summary, error.text);
    if (result == ORL_OK)
        result = copy_folder(&job->log, sparse, model);
    if (result == ORL_OK)
        result = orl_colmap_read(&job->log, sparse, &job->model);
    if (result == ORL_OK)
        result = make(job);
    orl_colmap_finish(&job->model);
    orl_points_finish(&job->points);
    json_decref(job->summary);
    free(summary);
    free(sparse);
    free(images);
    free(model);
    return result;
}

int main(int argc, char **argv)
{
    if (argc != 6 || atoi(argv[4]) < 1) {
        fprintf(stderr, "usage: truth_scene PHOTOS TRUTH SCENE STRIDE TEST_EVERY\n");
        return 2;
    }
    struct job job = {.log = orl_log_stderr(ORL_LOG_WARNING), .photos = argv[1],
                      .truth = argv[2], .scene = argv[3], .stride = atoi(argv[4]),
                      .test_every = atoi(argv[5])};
    return run(&job) == ORL_OK ? 0 : 1;
}
