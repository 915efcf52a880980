// Where known cameras are found: COLMAP's models and Oriel's cameras.json, else the script looks for them.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/json.h"
#include "core/memory.h"
#include "core/text.h"
#include "scene/colmap_internal.h"
#include "scene/known_internal.h"

// --- COLMAP ---

// Names of pictures as other systems write them.
static enum orl_result mend_names(const struct orl_log *log, const char *path, struct orl_colmap_model *model)
{
    for (size_t i = 0; i < model->image_count; i++) {
        char *name = model->images[i].name;
        if (!strchr(name, '\\'))
            continue;
        for (char *at = name; *at; at++)
            if (*at == '\\')
                *at = '/';
        // What a drive's letter begins is a place of another machine.
        if (name[1] == ':' && name[2] == '/')
            memmove(name, name + 3, strlen(name + 3) + 1);
        const char *problem = orl_colmap_name_problem(name);
        if (problem)
            return orl_fail(log, ORL_ERR_FORMAT, "%s: picture %s: %s", path, name, problem);
    }
    return ORL_OK;
}

static enum orl_result read_colmap(const struct orl_log *log, const char *path, struct orl_known_cameras *known)
{
    const char *dir = ORL_PATH("", "%.*s", (int)(orl_path_name(path) - path), path);
    ORL_TRY(orl_colmap_read(log, *dir ? dir : ".", &known->model));
    ORL_TRY(mend_names(log, path, &known->model));
    const char *fused = ORL_PATH(known->folder, "fused.ply"); // where a workspace has its cloud
    if (orl_path_is_file(fused))
        orl_path_print(known->points_file, "", "%s", fused);
    known->gaps = orl_array(log, known->model.camera_count, sizeof *known->gaps);
    ORL_TRY_MEMORY(known->gaps);
    orl_known_say_read(log, path, "COLMAP model", known);
    return ORL_OK;
}

// Number of photographs of the COLMAP model in a folder; 0: there is none, or it cannot be told.
static size_t count_images(const char *dir)
{
    struct orl_colmap_model model;
    size_t count = 0;
    uint64_t told = 0;
    FILE *stream = NULL;
    const char *binary = ORL_PATH(dir, "images.bin"), *text = ORL_PATH(dir, "images.txt");
    if (orl_path_is_file(binary)) {
        if (orl_file_open(NULL, binary, &stream) == ORL_OK) {
            count = fread(&told, sizeof told, 1, stream) == 1 && told < SIZE_MAX ? (size_t)told : 0;
            fclose(stream);
        }
    } else if (orl_path_is_file(text) && orl_colmap_read_poses(NULL, text, &model) == ORL_OK) {
        count = model.image_count;
        orl_colmap_finish(&model);
    }
    return count;
}

// The models that a folder is searched for.
struct models {
    const struct orl_log *log;
    char best[ORL_PATH_SIZE]; // folder of the largest
    size_t most, count;
};

static void try_model(struct models *models, const char *dir)
{
    if (!orl_colmap_has(dir, "cameras.bin") && !orl_colmap_has(dir, "cameras.txt"))
        return;
    size_t images = count_images(dir);
    if (!models->count++ || images > models->most) {
        orl_path_print(models->best, "", "%s", dir);
        models->most = images;
    }
}

// Looks into the folders in a folder, then into the folder itself.
static enum orl_result try_models(struct models *models, const char *dir)
{
    struct orl_names names = {0};
    enum orl_result result = orl_dir_list(models->log, dir, &names);
    for (size_t i = 0; i < names.count; i++) {
        const char *sub = ORL_PATH(dir, "%s", names.items[i]);
        if (orl_path_is_dir(sub))
            try_model(models, sub);
    }
    orl_names_finish(&names);
    try_model(models, dir);
    return result;
}

// Sets `file` to the cameras of the largest COLMAP model, or leaves it when there is none. COLMAP makes
// several when not all photographs could be placed together.
static enum orl_result find_model(const struct orl_log *log, const char *dir, char file[ORL_PATH_SIZE])
{
    static const char *const bases[] = {"sparse", "colmap/sparse", "distorted/sparse", "dense", "dense/0",
                                        "."};
    struct models models = {.log = log};
    for (size_t i = 0; !models.count && i < ORL_COUNT(bases); i++) {
        const char *base = strcmp(bases[i], ".") == 0 ? dir : ORL_PATH(dir, "%s", bases[i]);
        if (orl_path_is_dir(base))
            ORL_TRY(try_models(&models, base));
    }
    if (models.count > 1)
        orl_logf(log, ORL_LOG_WARNING, "%s: %zu COLMAP models; taking the largest, %s, with %zu "
                 "photographs", dir, models.count, models.best, models.most);
    if (models.count)
        orl_path_print(file, models.best, "%s",
                       orl_colmap_has(models.best, "cameras.bin") ? "cameras.bin" : "cameras.txt");
    return ORL_OK;
}

// Cuts the path of the file of cameras to the folder that pictures are relative to: the nearest one around
// the file with images/ in it, else the one that the user named.
static void cut_to_base(const char *dir, char path[ORL_PATH_SIZE])
{
    for (char *end; (end = strrchr(path, '/')) && (size_t)(end - path) > strlen(dir);) {
        *end = '\0';
        if (orl_path_is_dir(ORL_PATH(path, "images")))
            return;
    }
    orl_path_print(path, "", "%s", dir);
}

void orl_known_set_folder(const char *path, const char *found, struct orl_known_cameras *known)
{
    const char *name = orl_path_name(found);
    char *folder = known->folder;
    if (orl_path_is_dir(path)) {
        orl_path_print(folder, "", "%s", found);
        cut_to_base(path, folder);
    } else {
        orl_path_print(folder, "", "%.*s", name == found ? 1 : (int)(name - found), name == found ? "." : found);
    }
}

// --- all ---

char *orl_known_formats_text(const struct orl_log *log)
{
    static const char mark[] = "FORMATS = \"\"\"\\\n"; // ahead of the script's table
    const char *begin = strstr(orl_known_script, mark), *end = begin ? strstr(begin + strlen(mark), "\"\"\"") : NULL;
    return end ? orl_format(log, "%.*s", (int)(end - begin - (ptrdiff_t)strlen(mark)), begin + strlen(mark)) : NULL;
}

void orl_known_say_read(const struct orl_log *log, const char *file, const char *format,
                        const struct orl_known_cameras *known)
{
    orl_logf(log, ORL_LOG_INFO, "%s: %s: %zu cameras, %zu points", file, format, known->model.image_count,
             known->model.point_count);
}

// Reads a file that is Oriel's own, else leaves *own false.
static enum orl_result read_if_own(const struct orl_log *log, const char *file, double pixel_centre, bool *own,
                                   struct orl_known_cameras *known)
{
    json_t *root;
    enum orl_result result = orl_json_load(log, file, ORL_KNOWN_FILE_MAX, &root);
    *own = orl_known_is_own(root);
    if (result == ORL_OK && *own)
        result = orl_known_read_own(log, file, pixel_centre, root, known);
    json_decref(root);
    return result;
}

static enum orl_result read_any(const struct orl_log *log, const char *path, double pixel_centre,
                                struct orl_known_cameras *known)
{
    static const char *const models[] = {"cameras.bin", "cameras.txt", "images.bin", "images.txt", NULL};
    char file[ORL_PATH_SIZE] = "";
    bool is_dir = orl_path_is_dir(path), own = false;
    if (!is_dir)
        orl_path_print(file, "", "%s", path);
    else
        ORL_TRY(find_model(log, path, file));
    if (!*file && !orl_path_is_file(orl_path_print(file, path, "cameras.json")))
        *file = '\0';
    const char *name = orl_path_name(file), *dot = strrchr(name, '.');
    orl_known_set_folder(path, file, known);
    if (orl_text_is_one_of(name, models) && (is_dir || orl_path_is_file(file)))
        return read_colmap(log, file, known);
    if (dot && strcmp(dot, ".json") == 0)
        ORL_TRY(read_if_own(log, file, pixel_centre, &own, known));
    return own ? ORL_OK : orl_known_read_converted(log, path, pixel_centre, known);
}

enum orl_result orl_known_cameras_read(const struct orl_log *log, const char *path,
                                       double pixel_centre, struct orl_known_cameras *known)
{
    memset(known, 0, sizeof *known);
    enum orl_result result = read_any(log, path, pixel_centre, known);
    if (result == ORL_OK && !known->model.image_count)
        result = orl_fail(log, ORL_ERR_DATA, "%s: no camera in it", path);
    if (result == ORL_OK && known->pictures)
        result = orl_known_name_images(log, path, known);
    ORL_THEN(result, orl_colmap_check(log, path, &known->model));
    ORL_THEN(result, orl_known_place(log, known));
    if (result != ORL_OK)
        orl_known_cameras_finish(known);
    return result;
}
