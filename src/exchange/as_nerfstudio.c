// nerfstudio's folder: transforms.json with the cameras and the split, photographs, masks, points.
// The world is the one that was imported; only a camera's own axes are OpenGL's.
#include <jansson.h>
#include <string.h>

#include "core/file.h"
#include "core/json.h"
#include "core/new_dir.h"
#include "exchange/kinds.h"
#include "io/picture.h"
#include "scene/upright.h"

// world_from_camera, with y up and z backward in the camera.
static json_t *pack_matrix(const struct orl_pose *pose, const double origin[3])
{
    double eye[3];
    orl_pose_centre(pose, eye);
    json_t *rows = json_array();
    for (int i = 0; i < 3; i++)
        json_array_append_new(rows, json_pack("[f, f, f, f]", pose->r[0][i], -pose->r[1][i],
                                              -pose->r[2][i], eye[i] + origin[i]));
    json_array_append_new(rows, json_pack("[i, i, i, i]", 0, 0, 0, 1));
    return rows;
}

// Of a photograph that has no mask: all of it counts.
static enum orl_result write_whole_mask(const struct orl_log *log, const char *path, const struct orl_camera *size)
{
    struct orl_image white;
    ORL_TRY(orl_image_init(log, &white, size->width, size->height, 1, ORL_PIXEL_U8));
    memset(white.u8, 255, orl_image_bytes(&white));
    enum orl_result result = orl_file_make_folder(log, path);
    ORL_THEN(result, orl_png_write(log, path, &white));
    orl_image_finish(&white);
    return result;
}

static enum orl_result add_frame(const struct orl_log *log, const struct orl_scene *scene,
                                 size_t photo, bool masks, const char *dir, json_t *root)
{
    const struct orl_photo *p = &scene->photos[photo];
    const struct orl_camera *c = &p->view.camera;
    const char *image = ORL_PATH("images", "%s", p->name);
    const char *mask = masks ? ORL_PATH("masks", "%s.png", p->name) : NULL;
    json_t *frame = json_pack(
        "{s:o, s:i, s:i, s:f, s:f, s:f, s:f, s:o}", "file_path", orl_json_string(image), "w",
        c->width, "h", c->height, "fl_x", c->fx, "fl_y", c->fy, "cx", c->cx, "cy", c->cy,
        "transform_matrix", pack_matrix(&p->view.cam_from_world, scene->origin));
    if (mask)
        json_object_set_new(frame, "mask_path", orl_json_string(mask));
    json_array_append_new(json_object_get(root, "frames"), frame);
    json_array_append_new(json_object_get(root, p->test ? "test_filenames" : "train_filenames"),
                          orl_json_string(image));
    if (p->test) // nerfstudio evaluates on these
        json_array_append_new(json_object_get(root, "val_filenames"), orl_json_string(image));
    ORL_TRY(orl_file_copy(log, orl_scene_file(scene, photo, ORL_FILE_PHOTO).text, ORL_PATH(dir, "%s", image)));
    if (mask && !p->masked)
        return write_whole_mask(log, ORL_PATH(dir, "%s", mask), c);
    return mask ? orl_file_copy(log, orl_scene_file(scene, photo, ORL_FILE_MASK).text, ORL_PATH(dir, "%s", mask))
                : ORL_OK;
}

static enum orl_result fill(const struct orl_log *log, const struct orl_progress *progress,
                            const struct orl_scene *scene, const char *dir)
{
    double up[3]; // instant-ngp and the script for Blender read it
    orl_scene_mean_up(scene, up);
    json_t *root = json_pack("{s:s, s:[f, f, f], s:[], s:[], s:[], s:[]}", "camera_model", "PINHOLE",
                             "up", up[0], up[1], up[2], "train_filenames", "val_filenames", "test_filenames", "frames");
    enum orl_result result = root ? ORL_OK : ORL_ERR_MEMORY;
    bool masks = false; // nerfstudio wants masks of all photographs or of none
    for (size_t i = 0; i < scene->photo_count; i++)
        masks = masks || scene->photos[i].masked;
    for (size_t i = 0; result == ORL_OK && i < scene->photo_count; i++) {
        if (orl_progress_cancelled(progress))
            result = ORL_ERR_CANCELLED;
        else
            result = add_frame(log, scene, i, masks, dir, root);
        orl_progress_report(progress, "export", (double)(i + 1), (double)scene->photo_count,
                            scene->photos[i].name);
    }
    // nerfstudio cannot evaluate on an empty list. Without lists it holds photographs out by itself.
    static const char *const lists[] = {"test_filenames", "val_filenames", "train_filenames"};
    bool held_out = json_array_size(json_object_get(root, lists[0])) > 0;
    for (size_t i = 0; !held_out && i < ORL_COUNT(lists); i++)
        json_object_del(root, lists[i]);
    if (result == ORL_OK && scene->points.count) { // a cloud of none is no start for training
        json_object_set_new(root, "ply_file_path", json_string("points.ply"));
        result = orl_points_write(log, ORL_PATH(dir, "points.ply"), &scene->points, false, scene->origin);
    }
    // Survey coordinates have seven digits ahead of the point, and millimetres count.
    ORL_THEN(result, orl_json_write_digits(log, ORL_PATH(dir, "transforms.json"), root, ORL_JSON_ALL_DIGITS));
    json_decref(root);
    return result;
}

ORL_EXPORT_WRITER(orl_export_nerfstudio)
{
    struct orl_new_dir dir;
    enum orl_result result = orl_new_dir_begin(log, params->out, false, &dir);
    ORL_THEN(result, fill(log, progress, scene, dir.path));
    ORL_THEN(result, orl_new_dir_finish(log, &dir));
    orl_new_dir_abort(log, &dir);
    return result;
}
