// web_pictures cameras SCENE: the cameras of a scene's photographs as the published page takes them.
// web_pictures compare A B: PSNR and SSIM of two pictures, by Oriel's own metrics.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <jansson.h>

#include "eval/metrics.h"
#include "io/picture.h"
#include "oriel/scene.h"

static json_t *camera_json(const struct orl_photo *photo)
{
    const struct orl_camera *c = &photo->view.camera;
    const struct orl_pose *pose = &photo->view.cam_from_world;
    double eye[3];
    orl_pose_centre(pose, eye);
    json_t *r = json_array();
    for (int i = 0; i < 9; i++)
        json_array_append_new(r, json_real(pose->r[i / 3][i % 3]));
    return json_pack("{s:s, s:b, s:i, s:i, s:f, s:f, s:f, s:f, s:o, s:[f,f,f]}", "name", photo->name,
                     "test", photo->test, "width", c->width, "height", c->height, "fx", c->fx, "fy",
                     c->fy, "cx", c->cx, "cy", c->cy, "r", r, "eye", eye[0], eye[1], eye[2]);
}

static enum orl_result print_cameras(const struct orl_log *log, const char *dir)
{
    struct orl_scene *scene = NULL;
    enum orl_result result = orl_scene_open(log, dir, &scene);
    if (result != ORL_OK)
        return result;
    json_t *cameras = json_array();
    for (size_t i = 0; i < scene->photo_count; i++)
        json_array_append_new(cameras, camera_json(&scene->photos[i]));
    if (json_dumpf(cameras, stdout, JSON_INDENT(1)) != 0)
        result = ORL_ERR_IO;
    json_decref(cameras);
    orl_scene_destroy(&scene);
    return result;
}

static enum orl_result compare(const struct orl_log *log, const char *a, const char *b)
{
    struct orl_image first = {0}, second = {0}, coverage = {0};
    struct orl_metrics metrics;
    enum orl_result result = orl_picture_read(log, a, 3, &first);
    if (result == ORL_OK)
        result = orl_picture_read(log, b, 3, &second);
    if (result == ORL_OK)
        result = orl_image_init(log, &coverage, first.width, first.height, 1, ORL_PIXEL_F32);
    if (result == ORL_OK)
        result = orl_metrics_compare(log, &first, &second, &coverage, &metrics);
    if (result == ORL_OK)
        printf("%.3f %.4f\n", metrics.psnr_db, metrics.ssim);
    orl_image_finish(&first);
    orl_image_finish(&second);
    orl_image_finish(&coverage);
    return result;
}

int main(int argc, char **argv)
{
    struct orl_log log = orl_log_stderr(ORL_LOG_WARNING);
    if (argc == 3 && strcmp(argv[1], "cameras") == 0)
        return print_cameras(&log, argv[2]) != ORL_OK;
    if (argc == 4 && strcmp(argv[1], "compare") == 0)
        return compare(&log, argv[2], argv[3]) != ORL_OK;
    fprintf(stderr, "usage: web_pictures cameras SCENE | compare A B\n");
    return 2;
}
