#include "walk/settings.h"

#include <math.h>
#include <string.h>
#include <sys/stat.h>

#include "core/file.h"
#include "core/json.h"
#include "core/text.h"

enum { TOUR_SECONDS_MAX = 3601 };
static const char file_name[] = "walk.json";
static const double pi = 3.14159265358979323846;

// --- checks ---

static bool is_text(const json_t *value, size_t most)
{
    return json_is_string(value) && json_string_length(value) <= most;
}

static bool read_between(const json_t *json, const char *key, double least, double most,
                         double *value)
{
    const json_t *number = json_object_get(json, key);
    *value = json_number_value(number);
    return json_is_number(number) && *value > least && *value < most;
}

// The frame of a view, in units of its height: {"aspect", "fx", "x", "y"}, the last two the offset
// of the principal point from the middle. The camera's height and fy stay.
static bool read_frame(const json_t *json, struct orl_camera *camera)
{
    double aspect, fx, x, y, height = camera->height;
    if (!read_between(json, "aspect", 0.1, 10, &aspect) ||
        !read_between(json, "fx", 0.05, 50, &fx) || !read_between(json, "x", -2, 2, &x) ||
        !read_between(json, "y", -2, 2, &y))
        return false;
    camera->width = (int)ceil(aspect * height);
    camera->fx = fx * height;
    camera->cx = 0.5 * camera->width + x * height;
    camera->cy = (0.5 + y) * height;
    return true;
}

static bool read_view(const json_t *json, const struct orl_camera *camera, struct orl_view *view)
{
    const json_t *frame = json_object_get(json, "frame");
    double fov = orl_json_value(json, "fov_y_deg");
    if (!orl_json_pose(json_object_get(json, "cam_from_world"), &view->cam_from_world) ||
        !(fov > 1 && fov < 170))
        return false;
    view->camera = *camera;
    view->camera.fx = view->camera.fy = 0.5 * camera->height / tan(0.5 * fov * pi / 180);
    view->camera.cx = 0.5 * camera->width;
    view->camera.cy = 0.5 * camera->height;
    return (!frame || read_frame(frame, &view->camera)) && !orl_view_problem(view);
}

static bool is_view(const json_t *json)
{
    const struct orl_camera any = {.width = 1000, .height = 1000}; // large: little is rounded
    struct orl_view view;
    return read_view(json, &any, &view);
}

static bool are_modes(const json_t *modes)
{
    static const char *const names[] = {"walk", "fly", "orbit", NULL};
    size_t i;
    json_t *mode;
    json_array_foreach(modes, i, mode)
        if (!json_is_string(mode) || !orl_text_is_one_of(json_string_value(mode), names))
            return false;
    return json_array_size(modes) > 0;
}

static bool is_note(const json_t *note)
{
    double position[3];
    const json_t *view = json_object_get(note, "view"), *text = json_object_get(note, "text");
    return is_text(json_object_get(note, "title"), WALK_TITLE_MAX) && (!text || is_text(text, WALK_TEXT_MAX)) &&
           orl_json_read_numbers(json_object_get(note, "position"), 3, position) &&
           (!view || is_view(view));
}

static bool are_notes(const json_t *notes)
{
    size_t i;
    json_t *note;
    json_array_foreach(notes, i, note)
        if (!is_note(note))
            return false;
    return json_is_array(notes) && json_array_size(notes) <= WALK_NOTES_MAX;
}

// A path, as src/scene/path.c reads it, of views alone.
static bool is_tour(const json_t *tour)
{
    const json_t *keys = json_object_get(tour, "keyframes");
    size_t i;
    json_t *key;
    json_array_foreach(keys, i, key) {
        double seconds;
        if (!is_view(key) || (json_object_get(key, "seconds") &&
                              !read_between(key, "seconds", 0, TOUR_SECONDS_MAX, &seconds)))
            return false;
    }
    return json_array_size(keys) >= 2 && json_array_size(keys) <= WALK_TOUR_VIEWS_MAX;
}

static bool is_length(const json_t *value)
{
    return json_is_number(value) && json_number_value(value) > 0;
}

static bool is_line(const json_t *value)
{
    return is_text(value, WALK_TITLE_MAX);
}

enum orl_result orl_walk_settings_check(const struct orl_log *log, const char *where,
                                        const json_t *settings)
{
    static const struct {
        const char *key, *wanted;
        bool (*valid)(const json_t *value);
    } rows[] = {
        {"title", "a text of at most 500 bytes", is_line},
        {"attribution", "a text of at most 500 bytes", is_line},
        {"start", "a view: \"cam_from_world\", \"fov_y_deg\" and possibly \"frame\"", is_view},
        {"modes", "a list of \"walk\", \"fly\" and \"orbit\"", are_modes},
        {"notes", "a list of at most 200 annotations, each with \"title\" and \"position\"",
         are_notes},
        {"tour", "a path of 2 to 2000 views, each with at most 3600 \"seconds\"", is_tour},
        {"unit_m", "a length above 0", is_length},
    };
    const struct orl_json_place place = {log, where, NULL};
    const char *key;
    json_t *value;
    if (!json_is_object(settings))
        return orl_fail(log, ORL_ERR_FORMAT, "%s: is no JSON object", where);
    json_object_foreach((json_t *)settings, key, value) {
        size_t i = 0;
        while (i < ORL_COUNT(rows) && strcmp(rows[i].key, key) != 0)
            i++;
        if (i == ORL_COUNT(rows))
            return orl_fail(log, ORL_ERR_FORMAT, "%s: \"%s\" is not known", where, key);
        if (!rows[i].valid(value))
            return orl_json_refuse(&place, key, rows[i].wanted);
    }
    return ORL_OK;
}

// --- the file ---

enum orl_result orl_walk_check_inside(const struct orl_log *log, const struct orl_scene *scene, const char *path)
{
    struct stat there;
    return lstat(path, &there) != 0 || !S_ISLNK(there.st_mode) || orl_path_is_inside(scene->dir, path)
               ? ORL_OK
               : orl_fail(log, ORL_ERR_DATA, "%s: leads out of the scene through a symbolic link, and is not used",
                          path);
}

enum orl_result orl_walk_settings_read(const struct orl_log *log, const struct orl_scene *scene,
                                       json_t **settings)
{
    const char *path = ORL_PATH(scene->dir, "%s", file_name);
    ORL_TRY(orl_walk_check_inside(log, scene, path));
    if (!orl_path_is_file(path)) {
        *settings = json_object();
        return *settings ? ORL_OK : ORL_ERR_MEMORY;
    }
    ORL_TRY(orl_json_read(log, path, settings));
    return orl_walk_settings_check(log, path, *settings);
}

enum orl_result orl_walk_settings_write(const struct orl_log *log, const struct orl_scene *scene,
                                        const json_t *settings)
{
    const char *path = ORL_PATH(scene->dir, "%s", file_name);
    ORL_TRY(orl_walk_check_inside(log, scene, path));
    return orl_json_write(log, path, settings);
}

bool orl_walk_settings_start(const json_t *settings, const struct orl_camera *camera,
                             struct orl_view *view)
{
    const json_t *start = json_object_get(settings, "start");
    struct orl_view read;
    if (!start || !read_view(start, camera, &read))
        return false;
    *view = read;
    return true;
}
