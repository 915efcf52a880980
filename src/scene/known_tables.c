// Cameras as tables: VisualSFM's NVM and RealityScan's "Internal/External camera parameters" in CSV.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "scene/colmap_internal.h"
#include "scene/known_internal.h"

// --- NVM (http://ccwu.me/vsfm/doc.html#nvm) ---

// Finds the last `count` words of a line, which are numbers, and ends the line ahead of them: names may
// have spaces.
static bool cut_numbers(char *line, double *values, size_t count)
{
    char *end = line + strlen(line);
    for (size_t i = count; i-- > 0;) {
        while (end > line && strchr(" \t", end[-1]))
            end--;
        *end = '\0';
        char *word = end, *stop;
        while (word > line && !strchr(" \t", word[-1]))
            word--;
        values[i] = strtod(word, &stop);
        if (word == line || stop == word || *stop)
            return false;
        end = word;
    }
    while (end > line && strchr(" \t", end[-1]))
        end--;
    *end = '\0';
    return end > line;
}

static enum orl_result read_nvm_camera(const struct orl_known_source *source, const double fixed[5],
                                       struct orl_known_cameras *known)
{
    struct orl_text_lines *l = source->lines;
    double v[10]; // focal length, quaternion w x y z, place, distortion, 0
    char place[64];
    snprintf(place, sizeof place, "line %zu", l->number);
    if (!cut_numbers(l->at, v, ORL_COUNT(v)))
        return orl_text_bad(l, "a camera needs a name and 10 numbers");
    for (char *c = l->at; *c; c++) // VisualSFM's way to write a space
        if (*c == '"')
            *c = ' ';
    struct orl_known_camera camera = {.path = l->at, .place = place,
                                      .gap = {.size = true, .centre = fixed[0] <= 0}};
    if (!orl_pose_from_quat(v + 1, (double[3]){0}, &camera.pose))
        return orl_text_bad(l, "a camera's quaternion is zero or not finite");
    orl_pose_move(&camera.pose, (double[]){-v[5], -v[6], -v[7]});
    const double f_c[4] = {fixed[0] > 0 ? fixed[0] : v[0], fixed[0] > 0 ? fixed[2] : v[0], fixed[1], fixed[3]};
    // VisualSFM's distortion maps the picture to the undistorted one: u = d (1 + r d^2). The series of the
    // inverse gives the terms of ours, which maps the other way: d = u (1 - r u^2 + 3 r^2 u^4 - 12 r^3 u^6 + ...).
    double r = fixed[0] > 0 ? fixed[4] : v[8];
    const double terms[] = {-r, 3 * r * r, 0, 0, -12 * r * r * r};
    orl_known_set_lens(&camera, f_c, terms, ORL_COUNT(terms), false);
    return orl_known_add(source, &camera, known);
}

static enum orl_result read_nvm_point(struct orl_text_lines *l, struct orl_colmap_model *model)
{
    double at[3], rgb[3];
    size_t before = model->point_count;
    if (!orl_text_numbers(l, at, 3) || !orl_text_numbers(l, rgb, 3))
        return orl_text_bad(l, "a point needs a position and a colour");
    ORL_TRY(orl_known_add_point(l->log, at, rgb, model));
    return orl_known_read_views(l, model->image_count, NULL, before, model);
}

// The first model of the file; others are of photographs that could not be placed with it.
enum orl_result orl_known_read_nvm(const struct orl_known_source *source,
                                   struct orl_known_cameras *known)
{
    struct orl_text_lines *l = source->lines;
    double fixed[5] = {0}; // f cx f cy r of all cameras, after "FixedK"
    uint64_t cameras = 0, points = 0;
    if (!orl_text_next(l) || strncmp(l->at, "NVM_V3", 6) != 0)
        return orl_text_bad(l, "not NVM_V3");
    const char *lens = strstr(l->at, "FixedK");
    if (lens) {
        l->at = (char *)lens + strlen("FixedK");
        if (!orl_text_numbers(l, fixed, 5) || !(fixed[0] > 0))
            return orl_text_bad(l, "FixedK needs 5 numbers");
    }
    if (!orl_text_next(l) || !orl_text_id(l, 1000000, &cameras))
        return orl_text_bad(l, "not the number of cameras");
    enum orl_result result = ORL_OK;
    for (uint64_t i = 0; result == ORL_OK && i < cameras; i++)
        result = orl_text_next(l) ? read_nvm_camera(source, fixed, known)
                                  : orl_text_bad(l, "fewer cameras than the file says");
    if (result == ORL_OK && orl_text_next(l) && !orl_text_id(l, UINT32_MAX - 1, &points))
        result = orl_text_bad(l, "not the number of points");
    for (uint64_t i = 0; result == ORL_OK && i < points; i++)
        result = orl_text_next(l) ? read_nvm_point(l, &known->model)
                                  : orl_text_bad(l, "fewer points than the file says");
    return result;
}

// --- RealityScan ---

enum column { NAME, X, Y, ALT, HEADING, PITCH, ROLL, F, PX, PY, K1, K2, K3, K4, T1, T2, COLUMNS };
static const char *const columns[COLUMNS] = {"#name", "x", "y", "alt", "heading", "pitch", "roll", "f",
                                             "px", "py", "k1", "k2", "k3", "k4", "t1", "t2"};
enum { FIELDS_MAX = 64 };

// The columns of a file, and what separates them: where that is a semicolon, numbers have commas.
struct heads {
    int at[COLUMNS]; // -1: there is none
    char separator;
};

static double number(const struct heads *heads, char *field)
{
    char *end, *comma = heads->separator == ';' ? strchr(field, ',') : NULL;
    if (comma)
        *comma = '.';
    double value = strtod(field, &end);
    return end != field && !*end ? value : NAN;
}

// The axes of a camera that looks down with its top to the north (y), turned by heading (clockwise), then
// pitch and roll: Rz(-heading) Rx(pitch) Ry(roll), OpenGL's axes.
static bool find_pose(const double value[COLUMNS], struct orl_pose *pose)
{
    const double degree = M_PI / 180;
    double ch = cos(-value[HEADING] * degree), sh = sin(-value[HEADING] * degree);
    double cp = cos(value[PITCH] * degree), sp = sin(value[PITCH] * degree);
    double cr = cos(value[ROLL] * degree), sr = sin(value[ROLL] * degree);
    const double rows[16] = {ch * cr - sh * sp * sr, -sh * cp, ch * sr + sh * sp * cr, value[X],
                             sh * cr + ch * sp * sr, ch * cp, sh * sr - ch * sp * cr, value[Y],
                             -cp * sr, sp, cp * cr, value[ALT]};
    return orl_pose_from_opengl(rows, pose);
}

// Lengths are those of a picture whose larger side is 36 mm, or 1 for the principal point, whatever its size.
static enum orl_result read_row(const struct orl_known_source *source, const struct heads *heads,
                                struct orl_known_cameras *known)
{
    struct orl_text_lines *l = source->lines;
    char *fields[FIELDS_MAX], place[64];
    double value[COLUMNS] = {0};
    const int *at = heads->at;
    size_t count = orl_text_split(l, heads->separator, fields, FIELDS_MAX);
    snprintf(place, sizeof place, "line %zu", l->number);
    for (int c = X; c < COLUMNS; c++) {
        if (at[c] < 0)
            continue;
        value[c] = at[c] < (int)count ? number(heads, fields[at[c]]) : NAN;
        if (!isfinite(value[c]))
            return orl_text_bad(l, "a camera has a value that is not a number");
    }
    if (value[K4] < 0 || value[K4] > 0)
        return orl_text_bad(l, "a lens with k4: export without it, or undistorted pictures");
    struct orl_known_camera camera = {.path = at[NAME] < (int)count ? fields[at[NAME]] : "", .place = place,
                                      .gap = {.size = true, .side = 1}};
    if (!find_pose(value, &camera.pose))
        return orl_text_bad(l, "a camera's place is absurdly far");
    const double f_c[4] = {value[F] / 36, value[F] / 36, value[PX], value[PY]};
    const double terms[] = {value[K1], value[K2], value[T1], value[T2], value[K3]};
    orl_known_set_lens(&camera, f_c, terms, ORL_COUNT(terms), false);
    return orl_known_add(source, &camera, known);
}

static enum orl_result read_heads(struct orl_text_lines *l, struct heads *heads)
{
    char *fields[FIELDS_MAX];
    while (orl_text_next_raw(l)) {
        if (strncasecmp(l->at, "#name", 5) == 0)
            break;
        if (*l->at && *l->at != '#')
            return orl_text_bad(l, "the line of column names, \"#name,x,y,alt,heading,...\", is missing");
    }
    int *at = heads->at;
    heads->separator = strchr(l->at, ';') ? ';' : ',';
    size_t count = orl_text_split(l, heads->separator, fields, FIELDS_MAX);
    for (int c = 0; c < COLUMNS; c++) {
        at[c] = -1;
        for (size_t i = 0; i < count && at[c] < 0; i++)
            if (strcasecmp(fields[i], columns[c]) == 0)
                at[c] = (int)i;
        if (c <= F && at[c] < 0)
            return orl_text_bad(l, "a column of name, x, y, alt, heading, pitch, roll or f is missing: "
                                   "export \"Internal/External camera parameters\"");
    }
    return ORL_OK;
}

enum orl_result orl_known_read_realityscan(const struct orl_known_source *source,
                                           struct orl_known_cameras *known)
{
    struct heads heads;
    ORL_TRY(read_heads(source->lines, &heads));
    while (orl_text_next(source->lines))
        ORL_TRY(read_row(source, &heads, known));
    return ORL_OK;
}
