// Cameras of telephones with a depth sensor: Polycam's folder of keyframes and Record3D's
// metadata.json. Both have OpenGL's axes and the world of the telephone, y up.
#include <stdio.h>
#include <string.h>

#include "core/file.h"
#include "core/json.h"
#include "scene/json_views.h"
#include "scene/known_internal.h"

// --- Polycam: cameras/TIME.json beside images/TIME.jpg ---

static enum orl_result read_keyframe(const struct orl_known_source *source, const char *file,
                                     const char *picture, struct orl_known_unused *unused,
                                     struct orl_known_cameras *known)
{
    static const char *const lens[] = {"fx", "fy", "cx", "cy"};
    struct orl_known_camera camera = {.path = picture, .place = orl_path_name(file)};
    double f_c[4], rows[16] = {0};
    json_t *root = NULL;
    enum orl_result result = orl_json_read(source->log, file, &root);
    bool good = result == ORL_OK;
    for (int i = 0; good && i < 4; i++)
        good = orl_known_json_number(root, lens[i], &f_c[i]);
    for (int i = 0; good && i < 12; i++) {
        char key[32];
        snprintf(key, sizeof key, "t_%d%d", i / 4, i % 4);
        good = orl_known_json_number(root, key, &rows[i]);
    }
    if (result == ORL_OK && (!good || !orl_pose_from_opengl(rows, &camera.pose)))
        result = orl_known_bad(source, camera.place, "fx, fy, cx, cy or the rows t_00 to t_23 are missing or "
                                                     "not a pose");
    if (result == ORL_OK) {
        f_c[2] += source->shift;
        f_c[3] += source->shift;
        camera.width = orl_json_side(root, "width");
        camera.height = orl_json_side(root, "height");
        orl_known_set_lens(&camera, f_c, NULL, 0, false);
        result = orl_known_add(source, &camera, known);
    }
    orl_known_look_for_unused(unused, root);
    json_decref(root);
    return result;
}

// Folders of cameras, in order of preference, and of their pictures. Polycam corrects its cameras where
// it has closed loops.
static const char *const polycam[][2] = {
    {"keyframes/corrected_cameras", "keyframes/corrected_images"},
    {"keyframes/cameras", "keyframes/images"},
    {"corrected_cameras", "corrected_images"},
    {"cameras", "images"}};

enum orl_result orl_known_read_polycam(const struct orl_known_source *source,
                                       struct orl_known_cameras *known)
{
    static const char *const used[] = {"fx", "fy", "cx", "cy", "width", "height", "t_00", "t_01", "t_02",
                                       "t_03", "t_10", "t_11", "t_12", "t_13", "t_20", "t_21", "t_22",
                                       "t_23", NULL};
    struct orl_known_unused unused = {.used = used};
    struct orl_names names = {0};
    enum orl_result result = ORL_OK;
    size_t which = 0;
    while (which < ORL_COUNT(polycam) && !orl_path_is_dir(ORL_PATH(source->path, "%s", polycam[which][0])))
        which++;
    if (which < ORL_COUNT(polycam))
        result = orl_dir_list(source->log, ORL_PATH(source->path, "%s", polycam[which][0]), &names);
    for (size_t i = 0; result == ORL_OK && i < names.count; i++) {
        const char *name = names.items[i], *dot = strrchr(name, '.');
        if (*name == '.' || !dot || strcmp(dot, ".json") != 0)
            continue;
        result = read_keyframe(source, ORL_PATH(source->path, "%s/%s", polycam[which][0], name),
                               ORL_PATH(polycam[which][1], "%.*s", (int)(dot - name), name), &unused, known);
    }
    orl_known_say_unused(source, &unused);
    orl_names_finish(&names);
    return result;
}

// --- Record3D: "poses" of qx qy qz qw tx ty tz, and K column by column ---

enum orl_result orl_known_read_record3d(const struct orl_known_source *source,
                                        struct orl_known_cameras *known)
{
    static const char *const used[] = {"poses", "K", "w", "h", "perFrameIntrinsicCoeffs", NULL};
    const json_t *poses = json_object_get(source->root, "poses");
    // The folder of one or the other kind of export.
    const char *folder = orl_path_is_dir(ORL_PATH(known->folder, "rgb")) ? "rgb" : "rgbd";
    const json_t *lenses = json_object_get(source->root, "perFrameIntrinsicCoeffs");
    double k[9];
    if (!orl_json_read_numbers(json_object_get(source->root, "K"), 9, k))
        return orl_known_bad(source, "K", "not 9 numbers");
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < json_array_size(poses); i++) {
        char place[32], path[32];
        double v[7], of_frame[4], rows[16] = {0};
        struct orl_pose turn;
        snprintf(place, sizeof place, "pose %zu", i);
        snprintf(path, sizeof path, "%s/%zu", folder, i);
        struct orl_known_camera camera = {.path = path, .place = place, .width = orl_json_side(source->root, "w"),
                                          .height = orl_json_side(source->root, "h")};
        if (!orl_json_read_numbers(json_array_get(poses, i), 7, v) ||
            !orl_pose_from_quat((double[]){v[3], v[0], v[1], v[2]}, (double[3]){0}, &turn))
            return orl_known_bad(source, place, "not a quaternion and a position");
        for (int r = 0; r < 3; r++) {
            memcpy(rows + 4 * r, turn.r[r], sizeof turn.r[r]);
            rows[4 * r + 3] = v[4 + r];
        }
        if (!orl_pose_from_opengl(rows, &camera.pose))
            return orl_known_bad(source, place, "not a pose");
        // fx fy cx cy of each frame, where the telephone focuses anew.
        bool own = orl_json_read_numbers(json_array_get(lenses, i), 4, of_frame);
        const double f_c[4] = {own ? of_frame[0] : k[0], own ? of_frame[1] : k[4],
                               (own ? of_frame[2] : k[6]) + source->shift,
                               (own ? of_frame[3] : k[7]) + source->shift};
        orl_known_set_lens(&camera, f_c, NULL, 0, false);
        result = orl_known_add(source, &camera, known);
    }
    orl_known_say_unused_of(source, source->root, used, NULL);
    return result;
}
