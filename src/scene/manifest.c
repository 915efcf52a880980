#include "scene/manifest.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"

enum { JSON_MAX_BYTES = 64 << 20 };

enum orl_result orl_json_read(const struct orl_log *log, const char *path, json_t **out)
{
    *out = NULL;
    uint8_t *data = NULL;
    size_t size;
    enum orl_result result = orl_file_read(log, path, JSON_MAX_BYTES, &data, &size);
    if (result != ORL_OK)
        return result;
    json_error_t error;
    *out = json_loadb((const char *)data, size, JSON_REJECT_DUPLICATES, &error);
    free(data);
    if (!*out)
        return orl_fail(log, ORL_ERR_FORMAT, "%s: line %d (byte %d): %s", path, error.line,
                        error.position, error.text);
    if (json_is_object(*out))
        return ORL_OK;
    json_decref(*out);
    *out = NULL;
    return orl_fail(log, ORL_ERR_FORMAT, "%s: byte 0: not a JSON object", path);
}

enum orl_result orl_json_write(const struct orl_log *log, const char *path, const json_t *value)
{
    char *text = json_dumps(value, JSON_INDENT(1) | JSON_REAL_PRECISION(9));
    if (!text)
        return orl_fail(log, ORL_ERR_MEMORY, "%s: no memory for its text", path);
    enum orl_result result = orl_file_write(log, path, text, strlen(text));
    free(text);
    return result;
}

static enum orl_result bad(const struct orl_log *log, const char *path, const char *photo,
                           const char *what)
{
    return orl_fail(log, ORL_ERR_FORMAT, "%s: photograph %s: %s", path, photo, what);
}

static enum orl_result read_split(const struct orl_log *log, const char *path,
                                  const json_t *entry, struct orl_photo *photo)
{
    const char *split = json_string_value(json_object_get(entry, "split"));
    if (!split || (strcmp(split, "train") != 0 && strcmp(split, "test") != 0))
        return bad(log, path, photo->name, "\"split\" is neither \"train\" nor \"test\"");
    photo->test = strcmp(split, "test") == 0;
    return ORL_OK;
}

static enum orl_result read_exposure(const struct orl_log *log, const char *path,
                                     const json_t *entry, struct orl_photo *photo)
{
    const json_t *ev = json_object_get(entry, "exposure_ev");
    const json_t *series = json_object_get(entry, "series");
    const json_t *gain = json_object_get(entry, "gain");
    if (ev && !json_is_null(ev)) {
        photo->exposure_ev = json_number_value(ev);
        photo->has_exposure = true;
        if (!json_is_number(ev) || !(fabs(photo->exposure_ev) <= 64))
            return bad(log, path, photo->name, "\"exposure_ev\" is not a number within 64");
    }
    if (series) {
        json_int_t number = json_integer_value(series);
        if (!json_is_integer(series) || number < 0 || number > 65535)
            return bad(log, path, photo->name, "\"series\" is not a number from 0");
        photo->series = (int)number;
    }
    for (size_t i = 0; gain && i < 3; i++) {
        double value = json_number_value(json_array_get(gain, i));
        if (json_array_size(gain) != 3 || !(value > 0 && value < 1e6))
            return bad(log, path, photo->name, "\"gain\" is not three positive numbers");
        photo->gain[i] = (float)value;
    }
    return ORL_OK;
}

static enum orl_result read_optics(const struct orl_log *log, const char *path,
                                   const json_t *entry, const struct orl_scene *scene,
                                   struct orl_photo *photo)
{
    const json_t *vignette = json_object_get(entry, "vignette");
    const json_t *response = json_object_get(entry, "response");
    for (size_t i = 0; vignette && i < 3; i++) {
        const json_t *value = json_array_get(vignette, i);
        if (json_array_size(vignette) != 3 || !json_is_number(value) ||
            !(fabs(json_number_value(value)) <= 16))
            return bad(log, path, photo->name, "\"vignette\" is not three numbers within 16");
        photo->vignette[i] = (float)json_number_value(value);
    }
    if (response && !json_is_null(response)) {
        json_int_t number = json_integer_value(response);
        if (!json_is_integer(response) || number < 0 ||
            (size_t)number >= scene->response_count)
            return bad(log, path, photo->name, "\"response\" is not one of \"responses\"");
        photo->response = (int)number;
    }
    return ORL_OK;
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
    if (!scene->responses)
        return ORL_ERR_MEMORY;
    scene->response_count = count;
    enum orl_result result = ORL_OK;
    for (size_t i = 0; i < count; i++) {
        const json_t *curves = json_object_get(json_array_get(list, i), "linear");
        for (size_t c = 0; result == ORL_OK && c < 3; c++)
            result = read_curve(log, path, json_array_get(curves, c),
                                scene->responses[i].linear[c]);
    }
    return result;
}

static struct orl_photo *find_photo(struct orl_scene *scene, const char *name)
{
    for (size_t i = 0; name && i < scene->photo_count; i++)
        if (strcmp(scene->photos[i].name, name) == 0)
            return &scene->photos[i];
    return NULL;
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
    if (!seen)
        return ORL_ERR_MEMORY;
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < scene->photo_count; i++) {
        const json_t *entry = json_array_get(list, i);
        const char *name = json_string_value(json_object_get(entry, "name"));
        struct orl_photo *photo = find_photo(scene, name);
        if (!photo || seen[photo - scene->photos]) {
            result = bad(log, path, name ? name : "(without a name)",
                         photo ? "listed twice" : "not in the sparse model");
            break;
        }
        seen[photo - scene->photos] = true;
        result = read_split(log, path, entry, photo);
        if (result == ORL_OK)
            result = read_exposure(log, path, entry, photo);
        if (result == ORL_OK)
            result = read_optics(log, path, entry, scene, photo);
    }
    free(seen);
    return result;
}

// null: there is none. Absent: to be looked for.
static enum orl_result read_ground(const struct orl_log *log, const char *path,
                                   const json_t *root, struct orl_ground *ground)
{
    const json_t *told = json_object_get(root, "ground");
    const json_t *plane = json_object_get(told, "plane");
    ground->known = told != NULL;
    if (!told || json_is_null(told))
        return ORL_OK;
    double length2 = 0, height = json_number_value(json_object_get(told, "height"));
    bool numbers = json_array_size(plane) == 4;
    for (size_t k = 0; numbers && k < 4; k++) {
        ground->plane[k] = json_number_value(json_array_get(plane, k));
        numbers = json_is_number(json_array_get(plane, k)) && isfinite(ground->plane[k]);
        length2 += k < 3 ? ground->plane[k] * ground->plane[k] : 0;
    }
    if (!numbers || fabs(length2 - 1) > 1e-6 || !(height > 0 && isfinite(height)))
        return orl_fail(log, ORL_ERR_FORMAT,
                        "%s: \"ground\" is not a plane, its normal of length 1, and a height above "
                        "0", path);
    ground->height = height;
    return ORL_OK;
}

static enum orl_result check_points(const struct orl_log *log, const json_t *root,
                                    const char *points_path)
{
    const char *expected =
        json_string_value(json_object_get(json_object_get(root, "checksums"), "points.ply"));
    if (!expected)
        return ORL_OK;
    uint64_t hash;
    enum orl_result result = orl_file_hash(log, points_path, &hash);
    if (result != ORL_OK)
        return result;
    char text[32];
    snprintf(text, sizeof text, "xxh3:%016" PRIx64, hash);
    if (strcmp(text, expected) != 0)
        orl_logf(log, ORL_LOG_WARNING, "%s: changed since the scene was prepared", points_path);
    return ORL_OK;
}

enum orl_result orl_manifest_read(const struct orl_log *log, const char *path,
                                  const char *points_path, struct orl_scene *scene)
{
    json_t *root;
    enum orl_result result = orl_json_read(log, path, &root);
    if (result != ORL_OK)
        return result;
    const json_t *version = json_object_get(root, "version");
    if (!json_is_integer(version) || json_integer_value(version) < 1)
        result = orl_fail(log, ORL_ERR_FORMAT, "%s: not a scene's manifest (no \"version\")",
                          path);
    else if (json_integer_value(version) > ORL_MANIFEST_VERSION)
        result = orl_fail(log, ORL_ERR_FORMAT,
                          "%s: format version %lld is newer than this program knows (%d)", path,
                          (long long)json_integer_value(version), ORL_MANIFEST_VERSION);
    if (result == ORL_OK)
        result = read_responses(log, path, root, scene);
    if (result == ORL_OK)
        result = read_photos(log, path, root, scene);
    if (result == ORL_OK)
        result = orl_manifest_read_tuned(log, path, root, scene);
    if (result == ORL_OK)
        result = read_ground(log, path, root, &scene->ground);
    if (result == ORL_OK)
        result = check_points(log, root, points_path);
    json_decref(root);
    return result;
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
    char *path = orl_path_join(log, dir, ".oriel/stages.json");
    if (!path)
        return ORL_ERR_MEMORY;
    enum orl_result result = ORL_OK;
    json_t *root = NULL;
    const char *missing = "scene.json";
    if (!orl_path_is_file(path))
        goto end;
    if ((result = orl_json_read(log, path, &root)) != ORL_OK)
        goto end;
    const json_t *plan = json_object_get(root, "plan"), *done = json_object_get(root, "done");
    for (size_t i = 0; i < json_array_size(plan); i++) {
        const char *stage = json_string_value(json_array_get(plan, i));
        if (stage && !json_object_get(done, stage)) {
            missing = stage;
            break;
        }
    }
    result = orl_fail(log, ORL_ERR_DATA,
                      "%s: oriel prepare has not finished this scene (missing: %s); "
                      "run it again with --resume", dir, missing);
end:
    json_decref(root);
    free(path);
    return result;
}
