// Cameras as text: Bundler's bundle.out and Middlebury's NAME_par.txt.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "scene/known_internal.h"

// --- Middlebury: a count, then lines NAME K R t, row by row ---

static enum orl_result read_par(const struct orl_known_source *source, struct orl_known_cameras *known)
{
    struct orl_text_lines *l = source->lines;
    char place[64];
    double k[9];
    struct orl_known_camera camera = {.path = l->at, .place = place, .gap.size = true};
    l->at += strcspn(l->at, " \t");
    char *end = l->at; // of the name
    snprintf(place, sizeof place, "line %zu", l->number);
    if (!orl_text_numbers(l, k, 9) || !orl_text_numbers(l, &camera.pose.r[0][0], 9) ||
        !orl_text_numbers(l, camera.pose.t, 3))
        return orl_text_bad(l, "a camera needs a name and 21 numbers: K, R and t");
    if (k[1] != 0)
        return orl_text_bad(l, "its K has a skew, which is not supported");
    *end = '\0';
    orl_known_set_lens(&camera, (double[]){k[0], k[4], k[2] + source->shift, k[5] + source->shift}, NULL, 0, false);
    return orl_known_add(source, &camera, known);
}

enum orl_result orl_known_read_middlebury(const struct orl_known_source *source,
                                          struct orl_known_cameras *known)
{
    struct orl_text_lines *l = source->lines;
    uint64_t count = 0;
    if (!orl_text_next(l) || !orl_text_id(l, 1000000, &count) || *l->at)
        return orl_text_bad(l, "the first line is not the number of cameras");
    while (known->model.image_count < count && orl_text_next(l))
        ORL_TRY(read_par(source, known));
    return known->model.image_count == count
               ? ORL_OK
               : orl_fail(l->log, ORL_ERR_FORMAT, "%s: line %zu: the file ends after %zu cameras of %llu", l->path,
                          l->number, known->model.image_count, (unsigned long long)count);
}

// --- Bundler (bundle.out v0.3): cameras f k1 k2, R, t with OpenGL's axes; points ---

struct bundler {
    const struct orl_known_source *source;
    struct orl_text_lines *l;  // its lines
    struct orl_names pictures; // from list.txt
    uint64_t camera_count, point_count;
    // Index of each camera into the model's images; -1: not registered.
    int64_t *image_of; // owned
};

// Ends a line of the list after the picture's name, which may have spaces: Bundler writes " 0 FOCAL"
// after it, or nothing; other programs separate them by tabs.
static void cut_focal_length(char *line)
{
    for (char *at = line; *at; at++)
        if (*at == '\t')
            *at = ' ';
    char *focal = strrchr(line, ' '), *end;
    if (!focal || strtod(focal, &end) < 0 || end == focal || *end)
        return;
    *focal = '\0';
    char *zero = strrchr(line, ' ');
    if (zero && strcmp(zero, " 0") == 0)
        *zero = '\0';
    else
        *focal = ' '; // a name that ends with a number
}

// Reads the list of pictures, one a line.
static enum orl_result read_list(const struct orl_log *log, const char *folder,
                                 struct orl_names *pictures)
{
    static const char *const known[] = {"list.txt", "bundle/list.txt", "../list.txt",
                                        "imagelist.lst"}; // RealityCapture's
    struct orl_text_lines l;
    size_t i = 0;
    while (i < ORL_COUNT(known) && !orl_path_is_file(ORL_PATH(folder, "%s", known[i])))
        i++;
    if (i == ORL_COUNT(known))
        return orl_fail(log, ORL_ERR_NOT_FOUND, "%s: Bundler's cameras need list.txt, the names of "
                        "their pictures, beside them", folder);
    enum orl_result result = orl_text_open(log, ORL_PATH(folder, "%s", known[i]), &l);
    while (result == ORL_OK && orl_text_next(&l)) {
        cut_focal_length(l.at);
        result = orl_names_add(log, pictures, l.at);
    }
    orl_text_close(&l);
    return result;
}

static enum orl_result next_numbers(struct orl_text_lines *l, double *values, size_t count,
                                    const char *what)
{
    if (!orl_text_next(l) || !orl_text_numbers(l, values, count) || *l->at)
        return orl_text_bad(l, what);
    return ORL_OK;
}

static enum orl_result read_bundler_camera(struct bundler *b, size_t index,
                                           struct orl_known_cameras *known)
{
    double f_k[3], r[3][3], t[3];
    char place[64];
    struct orl_known_camera camera = {.path = b->pictures.items[index], .place = place,
                                      .gap = {.size = true, .centre = true}};
    enum orl_result result = next_numbers(b->l, f_k, 3, "a camera needs f k1 k2");
    snprintf(place, sizeof place, "line %zu: camera %zu", b->l->number, index);
    for (int i = 0; result == ORL_OK && i < 3; i++)
        result = next_numbers(b->l, r[i], 3, "a row of R needs 3 numbers");
    ORL_THEN(result, next_numbers(b->l, t, 3, "t needs 3 numbers"));
    b->image_of[index] = -1;
    if (result != ORL_OK || f_k[0] == 0) // not registered
        return result;
    // Converts from OpenGL's axes (y up, z backward).
    for (int i = 0; i < 3; i++) {
        double sign = i == 0 ? 1 : -1;
        for (int j = 0; j < 3; j++)
            camera.pose.r[i][j] = sign * r[i][j];
        camera.pose.t[i] = sign * t[i];
    }
    // The terms of radial distortion are equal in both frames.
    camera.model = ORL_COLMAP_RADIAL;
    camera.params[0] = f_k[0];
    camera.params[3] = f_k[1];
    camera.params[4] = f_k[2];
    b->image_of[index] = (int64_t)known->model.image_count;
    return orl_known_add(b->source, &camera, known);
}

enum orl_result orl_known_read_views(struct orl_text_lines *l, uint64_t camera_count,
                                     const int64_t *image_of, size_t points_before,
                                     struct orl_colmap_model *model)
{
    uint64_t count, camera, feature;
    double xy[2];
    if (!orl_text_id(l, UINT32_MAX, &count))
        return orl_text_bad(l, "a point needs the number of its views");
    for (uint64_t i = 0; i < count; i++) {
        if (!orl_text_id(l, UINT32_MAX, &camera) || !orl_text_id(l, UINT32_MAX, &feature) ||
            !orl_text_numbers(l, xy, 2) || camera >= camera_count)
            return orl_text_bad(l, "a view needs a camera that is there, a feature, x and y");
        int64_t image = image_of ? image_of[camera] : (int64_t)camera;
        if (image >= 0 && model->point_count > points_before)
            ORL_TRY(orl_known_add_view(l->log, (size_t)image, (uint32_t)points_before, model));
    }
    return ORL_OK;
}

static enum orl_result read_point(struct bundler *b, struct orl_colmap_model *model)
{
    double at[3], rgb[3];
    size_t before = model->point_count;
    ORL_TRY(next_numbers(b->l, at, 3, "a point's position needs 3 numbers"));
    ORL_TRY(next_numbers(b->l, rgb, 3, "a point's colour needs 3 numbers"));
    ORL_TRY(orl_known_add_point(b->l->log, at, rgb, model));
    if (!orl_text_next(b->l))
        return orl_text_bad(b->l, "a point needs the list of its views");
    return orl_known_read_views(b->l, b->camera_count, b->image_of, before, model);
}

static enum orl_result read_bundle(struct bundler *b, struct orl_known_cameras *known)
{
    struct orl_text_lines *l = b->l;
    struct orl_colmap_model *model = &known->model;
    size_t left = (size_t)(l->end - l->next);
    if (!orl_text_next(l) || !orl_text_id(l, 1000000, &b->camera_count) ||
        !orl_text_id(l, UINT32_MAX - 1, &b->point_count) || *l->at)
        return orl_text_bad(l, "not the numbers of cameras and points");
    // A camera takes at least 30 bytes, a point at least 14.
    if (b->camera_count > left / 30 || b->point_count > left / 14)
        return orl_text_bad(l, "more cameras or points than the file has room for");
    if (b->pictures.count != b->camera_count)
        return orl_fail(l->log, ORL_ERR_DATA, "%s: line %zu: %llu cameras, but list.txt names %zu "
                        "pictures", l->path, l->number, (unsigned long long)b->camera_count,
                        b->pictures.count);
    b->image_of = orl_array(l->log, b->camera_count, sizeof *b->image_of);
    ORL_TRY_MEMORY(b->image_of);
    for (size_t i = 0; i < b->camera_count; i++)
        ORL_TRY(read_bundler_camera(b, i, known));
    for (uint64_t i = 0; i < b->point_count; i++)
        ORL_TRY(read_point(b, model));
    return ORL_OK;
}

// The principal point is always the picture's centre, so that the custom of pixel centres is of no use.
enum orl_result orl_known_read_bundler(const struct orl_known_source *source,
                                       struct orl_known_cameras *known)
{
    struct bundler b = {.source = source, .l = source->lines};
    enum orl_result result = read_list(source->log, known->folder, &b.pictures);
    ORL_THEN(result, read_bundle(&b, known));
    orl_names_finish(&b.pictures);
    free(b.image_of);
    return result;
}
