#include "scene/manifest.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/json.h"
#include "core/memory.h"
#include "core/text.h"
#include "core/vec3.h"
#include "scene/point_lod.h"
#include "scene/tuned_settings.h"

static enum orl_result read_split(const struct orl_json_place *place, const json_t *entry,
                                  struct orl_photo *photo)
{
    const char *split = orl_json_text(entry, "split");
    if (!split || (strcmp(split, "train") != 0 && strcmp(split, "test") != 0))
        return orl_json_refuse(place, "split", "\"train\" or \"test\"");
    photo->test = strcmp(split, "test") == 0;
    return ORL_OK;
}

static enum orl_result read_exposure(const struct orl_json_place *place, const json_t *entry,
                                     struct orl_photo *photo)
{
    double gain[3] = {1, 1, 1}, ev = NAN, metering[2] = {0};
    ORL_TRY(orl_json_number(place, entry, "exposure_ev", -64, 64, &ev));
    ORL_TRY(orl_json_integer(place, entry, "series", 0, 65535, &photo->series));
    ORL_TRY(orl_json_numbers(place, entry, "gain", 3, 1e-6, 1e6, gain));
    ORL_TRY(orl_json_numbers(place, entry, "metering", 2, -16, 16, metering));
    photo->has_exposure = !isnan(ev);
    photo->exposure_ev = photo->has_exposure ? ev : 0;
    for (int i = 0; i < 3; i++)
        photo->gain[i] = (float)gain[i];
    photo->metering = (float)metering[0];
    photo->metered_ev = (float)metering[1];
    return ORL_OK;
}

static enum orl_result read_optics(const struct orl_json_place *place, const json_t *entry,
                                   const struct orl_scene *scene, struct orl_photo *photo)
{
    double vignette[3] = {0};
    ORL_TRY(orl_json_numbers(place, entry, "vignette", 3, -16, 16, vignette));
    for (int i = 0; i < 3; i++)
        photo->vignette[i] = (float)vignette[i];
    if (!scene->response_count && json_is_integer(json_object_get(entry, "response")))
        return orl_json_refuse(place, "response", "one of \"responses\", which are none");
    return orl_json_integer(place, entry, "response", 0, (int)scene->response_count - 1, &photo->response);
}

// Refuses a photograph without the file that scene.json promises.
static enum orl_result need_file(const struct orl_json_place *place, const struct orl_scene *scene,
                                 const struct orl_photo *photo, enum orl_photo_file kind, const char *what)
{
    const struct orl_file_path path = orl_scene_file(scene, (size_t)(photo - scene->photos), kind);
    return orl_path_is_file(path.text)
               ? ORL_OK : orl_fail(place->log, ORL_ERR_NOT_FOUND, "%s: %s missing", path.text, what);
}

static enum orl_result read_occluders(const struct orl_json_place *place, const json_t *entry,
                                      const struct orl_scene *scene, struct orl_photo *photo)
{
    double share = 0;
    ORL_TRY(orl_json_number(place, entry, "occluded", 0, 1, &share));
    photo->occluded = (float)share;
    return photo->occluded > 0 ? need_file(place, scene, photo, ORL_FILE_OCCLUDERS, "these occluders are") : ORL_OK;
}

static enum orl_result read_radiance(const struct orl_json_place *place, const json_t *entry,
                                     struct orl_photo *photo)
{
    ORL_TRY(orl_json_bool(place, entry, "radiance", &photo->radiance));
    if (photo->radiance && !photo->linear)
        return orl_fail(place->log, ORL_ERR_NOT_FOUND,
                        "%s: %s is radiance, but its file in images_linear is missing",
                        place->path, place->what);
    return ORL_OK;
}

static enum orl_result read_photo(const struct orl_json_place *place, const json_t *entry,
                                  const struct orl_scene *scene, struct orl_photo *photo)
{
    ORL_TRY(read_split(place, entry, photo));
    ORL_TRY(orl_json_integer(place, entry, "orientation", 0, 8, &photo->orientation));
    ORL_TRY(read_exposure(place, entry, photo));
    ORL_TRY(read_optics(place, entry, scene, photo));
    ORL_TRY(read_radiance(place, entry, photo));
    ORL_TRY(read_occluders(place, entry, scene, photo));
    ORL_TRY(orl_json_bool(place, entry, "mask", &photo->masked));
    return photo->masked ? need_file(place, scene, photo, ORL_FILE_MASK, "this mask is") : ORL_OK;
}

static enum orl_result read_curve(const struct orl_log *log, const char *path,
                                  const json_t *curve, float linear[256])
{
    double last = -INFINITY;
    for (size_t v = 0; v < 256; v++) {
        const json_t *number = json_array_get(curve, v);
        double value = json_number_value(number);
        if (json_array_size(curve) != 256 || !json_is_number(number) || !(value >= 0) ||
            !(value > last) || (v == 255 && fabs(value - 1) > 1e-6))
            return orl_fail(log, ORL_ERR_FORMAT,
                            "%s: \"responses\": a curve is not 256 numbers that rise to 1", path);
        linear[v] = (float)value;
        last = value;
    }
    return ORL_OK;
}

static enum orl_result read_responses(const struct orl_log *log, const char *path,
                                      const json_t *root, struct orl_scene *scene)
{
    const json_t *list = json_object_get(root, "responses");
    size_t count = json_array_size(list);
    if (!count)
        return ORL_OK;
    scene->responses = orl_array(log, count, sizeof *scene->responses);
    ORL_TRY_MEMORY(scene->responses);
    scene->response_count = count;
    for (size_t i = 0; i < count; i++) {
        const json_t *curves = json_object_get(json_array_get(list, i), "linear");
        for (size_t c = 0; c < 3; c++)
            ORL_TRY(read_curve(log, path, json_array_get(curves, c), scene->responses[i].linear[c]));
    }
    return ORL_OK;
}

static int compare_photo(const void *name, const void *photo)
{
    return strcmp(name, ((const struct orl_photo *)photo)->name);
}

static enum orl_result read_photos(const struct orl_log *log, const char *path,
                                   const json_t *root, struct orl_scene *scene)
{
    const json_t *list = json_object_get(root, "photographs");
    if (!json_is_array(list) || json_array_size(list) != scene->photo_count)
        return orl_fail(log, ORL_ERR_FORMAT,
                        "%s: \"photographs\" lists %zu, but the sparse model has %zu", path,
                        json_array_size(list), scene->photo_count);
    bool *seen = orl_array(log, scene->photo_count, sizeof *seen);
    ORL_TRY_MEMORY(seen);
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < scene->photo_count; i++) {
        const json_t *entry = json_array_get(list, i);
        const char *name = orl_json_text(entry, "name");
        // Photographs are sorted by name, like the images of the sparse model.
        struct orl_photo *photo = !name ? NULL
                                        : bsearch(name, scene->photos, scene->photo_count,
                                                  sizeof *scene->photos, compare_photo);
        if (!photo || seen[photo - scene->photos]) {
            result = orl_fail(log, ORL_ERR_FORMAT, "%s: photograph %s: %s", path,
                              name ? name : "(without a name)",
                              photo ? "listed twice" : "not in the sparse model");
            break;
        }
        seen[photo - scene->photos] = true;
        char what[512];
        snprintf(what, sizeof what, "photograph %s", name);
        result = read_photo(&(struct orl_json_place){log, path, what}, entry, scene, photo);
    }
    free(seen);
    return result;
}

// A null value means that there is no ground; an absent value, that it must be searched for.
static enum orl_result read_ground(const struct orl_log *log, const char *path,
                                   const json_t *root, struct orl_ground *ground)
{
    const json_t *told = json_object_get(root, "ground");
    const json_t *plane = json_object_get(told, "plane");
    ground->known = told != NULL;
    if (!told || json_is_null(told))
        return ORL_OK;
    double height = json_number_value(json_object_get(told, "height"));
    if (!orl_json_read_numbers(plane, 4, ground->plane) ||
        fabs(orl_dot3(ground->plane, ground->plane) - 1) > 1e-6 || !(height > 0 && isfinite(height)))
        return orl_json_refuse(&(struct orl_json_place){log, path, NULL}, "ground",
                               "a plane, its normal of length 1, and a height above 0");
    ground->height = height;
    return ORL_OK;
}

static const char *const backdrops[] = {"moves", "rests"};

json_t *orl_manifest_backdrop(bool rests)
{
    return json_string(backdrops[rests]);
}

// Absent in scenes that were made before there was such a stage: it moves.
static enum orl_result read_backdrop(const struct orl_log *log, const char *path,
                                     const json_t *root, bool *rests)
{
    const json_t *told = json_object_get(root, "backdrop");
    const char *name = json_string_value(told);
    *rests = name && strcmp(name, backdrops[true]) == 0;
    if (told && !*rests && !(name && strcmp(name, backdrops[false]) == 0))
        return orl_fail(log, ORL_ERR_FORMAT, "%s: \"backdrop\" is neither \"moves\" nor \"rests\"",
                        path);
    return ORL_OK;
}

enum orl_result orl_manifest_read_room(const struct orl_log *log, const char *path,
                                       const json_t *root, struct orl_room *room)
{
    const json_t *told = json_object_get(root, "room");
    if (!told || json_is_null(told))
        return ORL_OK;
    bool good = json_array_size(told) == 2 &&
                orl_json_read_numbers(json_array_get(told, 0), 3, room->low) &&
                orl_json_read_numbers(json_array_get(told, 1), 3, room->high);
    for (int k = 0; good && k < 3; k++)
        good = room->low[k] < room->high[k];
    if (!good)
        return orl_json_refuse(&(struct orl_json_place){log, path, NULL}, "room",
                               "its lowest and its highest corner, of 3 numbers each");
    room->known = true;
    return ORL_OK;
}

json_t *orl_manifest_room(const struct orl_room *room)
{
    const double *a = room->low, *b = room->high;
    return room->known ? json_pack("[[f,f,f],[f,f,f]]", a[0], a[1], a[2], b[0], b[1], b[2])
                       : json_null();
}

// Logs and counts each file of DIR that does not match its checksum in the manifest `root`. Checks
// only the files in the NULL-terminated list `names`, or all files when `names` is NULL.
static void check_files(const struct orl_log *log, const char *dir, const json_t *root, const char *const *names,
                        enum orl_log_level level, size_t *bad)
{
    const char *name;
    json_t *value;
    json_object_foreach(json_object_get(root, "checksums"), name, value) {
        char sum[ORL_CHECKSUM_SIZE];
        const char *told = json_string_value(value);
        if (!told || (names && !orl_text_is_one_of(name, names)))
            continue;
        const char *path = ORL_PATH(dir, "%s", name);
        // An untrusted manifest may name any file, so only files inside the scene are read.
        bool read = orl_path_is_inside(dir, path) && orl_path_is_file(path) &&
                    orl_file_checksum(NULL, path, sum) == ORL_OK;
        if (!read || strcmp(sum, told) != 0) {
            orl_logf(log, level, "%s: %s", path,
                     read ? "changed since the scene was made" : "missing or cannot be read");
            ++*bad;
        }
    }
}

enum orl_result orl_manifest_take(const struct orl_log *log, const char *path, const json_t *root,
                                  struct orl_scene *scene)
{
    const json_t *version = json_object_get(root, "version");
    if (!json_is_integer(version) || json_integer_value(version) < 1)
        return orl_fail(log, ORL_ERR_FORMAT, "%s: not a scene's manifest (no \"version\")", path);
    if (json_integer_value(version) > ORL_MANIFEST_VERSION)
        return orl_fail(log, ORL_ERR_FORMAT,
                        "%s: format version %lld is newer than this program knows (%d)", path,
                        (long long)json_integer_value(version), ORL_MANIFEST_VERSION);
    ORL_TRY(read_responses(log, path, root, scene));
    ORL_TRY(read_photos(log, path, root, scene));
    ORL_TRY(orl_tuned_read(log, path, root, scene));
    ORL_TRY(read_ground(log, path, root, &scene->ground));
    ORL_TRY(read_backdrop(log, path, root, &scene->backdrop_rests));
    ORL_TRY(orl_manifest_read_room(log, path, root, &scene->room));
    // Absent: nothing was taken off.
    return orl_json_numbers(&(struct orl_json_place){log, path, NULL}, root, "origin", 3, -ORL_WORLD_MAX, ORL_WORLD_MAX,
                            scene->origin);
}

enum orl_result orl_manifest_read(const struct orl_log *log, const char *path, bool points,
                                  struct orl_scene *scene)
{
    // Checking pictures takes too long here; oriel info --check does it.
    static const char *const read_on_opening[] = {"points.ply", "sparse/cameras.bin",
                                                  "sparse/images.bin", "sparse/points3D.bin", NULL};
    size_t changed = 0;
    json_t *root;
    ORL_TRY(orl_json_read(log, path, &root));
    enum orl_result result = orl_manifest_take(log, path, root, scene);
    if (result == ORL_OK)
        check_files(log, scene->dir, root, points ? read_on_opening : read_on_opening + 1, ORL_LOG_WARNING, &changed);
    json_decref(root);
    return result;
}

enum orl_result orl_manifest_check(const struct orl_log *log, const char *dir, size_t *bad,
                                   size_t *files)
{
    json_t *root = NULL;
    *bad = *files = 0;
    const char *levels = ORL_PATH(dir, ORL_LOD_NAME);
    ORL_TRY(orl_json_read(log, ORL_PATH(dir, "scene.json"), &root));
    // points.ply may be removed where there are levels of detail.
    if (orl_path_is_file(levels) && !orl_path_is_file(ORL_PATH(dir, "points.ply")))
        json_object_del(json_object_get(root, "checksums"), "points.ply");
    *files = json_object_size(json_object_get(root, "checksums"));
    check_files(log, dir, root, NULL, ORL_LOG_ERROR, bad);
    if (orl_path_is_file(levels)) {
        *files += 1;
        *bad += orl_lod_check(log, levels) != ORL_OK;
    }
    json_decref(root);
    return ORL_OK;
}

json_t *orl_manifest_ground(const struct orl_ground *ground)
{
    const double *p = ground->plane;
    return ground->height > 0 ? json_pack("{s:[f,f,f,f], s:f}", "plane", p[0], p[1], p[2], p[3],
                                          "height", ground->height)
                              : json_null();
}

enum orl_result orl_manifest_check_unfinished(const struct orl_log *log, const char *dir)
{
    const char *path = ORL_PATH(dir, ".oriel/stages.json"), *missing = "scene.json";
    if (!orl_path_is_file(path))
        return ORL_OK;
    json_t *root = NULL;
    ORL_TRY(orl_json_read(log, path, &root));
    const json_t *plan = json_object_get(root, "plan"), *done = json_object_get(root, "done");
    for (size_t i = 0; i < json_array_size(plan); i++) {
        const char *stage = json_string_value(json_array_get(plan, i));
        if (stage && !json_object_get(done, stage)) {
            missing = stage;
            break;
        }
    }
    enum orl_result result = orl_fail(log, ORL_ERR_DATA, "%s: oriel prepare has not finished this scene (missing: %s); "
                                      "run it again with --resume", dir, missing);
    json_decref(root);
    return result;
}
