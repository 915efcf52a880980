// The formats of known cameras, and how each is recognised.
#include <fnmatch.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/json.h"
#include "core/memory.h"
#include "scene/colmap_internal.h"
#include "scene/known_internal.h"

// --- COLMAP ---

// Names of pictures as other systems write them.
static enum orl_result mend_names(const struct orl_known_source *source,
                                  struct orl_colmap_model *model)
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
            return orl_fail(source->log, ORL_ERR_FORMAT, "%s: picture %s: %s", source->path, name, problem);
    }
    return ORL_OK;
}

static enum orl_result read_colmap(const struct orl_known_source *source,
                                   struct orl_known_cameras *known)
{
    const char *dir = ORL_PATH("", "%.*s", (int)(orl_path_name(source->path) - source->path), source->path);
    ORL_TRY(orl_colmap_read(source->log, *dir ? dir : ".", &known->model));
    ORL_TRY(mend_names(source, &known->model));
    known->gaps = orl_array(source->log, known->model.camera_count, sizeof *known->gaps);
    return known->gaps ? ORL_OK : ORL_ERR_MEMORY;
}

// --- the table ---

// What a reader is given besides the path: of JSON its root, of text its lines, else all bytes.
enum content { PATH, FOLDER, JSON, TEXT, BYTES };

// A format. Files that are JSON, whatever their names, are recognised by their keys, others by the last
// part of a pattern.
struct format {
    const char *name;
    const char *files; // what a folder is searched for: patterns of names, separated by spaces
    enum content content; // FOLDER: the reader takes the folder, not the file found in it
    orl_known_reader *read;
    const char *arrays[2]; // JSON: the root has arrays of these names; of a list, its entries have objects
    bool is_list;          // JSON: the root is a list
    double centre;         // coordinate of the first pixel's centre, where neither the file nor the user states it
};

// A folder that has several is read as the first of them.
static const struct format formats[] = {
    {"COLMAP model", "cameras.bin cameras.txt images.bin images.txt", PATH, read_colmap, {0}, false, 0.5},
    {"Oriel's cameras.json", "cameras.json", JSON, orl_known_read_own, {"cameras"}, false, 0},
    {"OpenSfM", "reconstruction.json opensfm/reconstruction.json", JSON, orl_known_read_opensfm, {"shots"}, true, 0.5},
    {"Inria's cameras.json", "cameras.json", JSON, orl_known_read_inria, {0}, true, 0.5},
    {"transforms.json (nerfstudio, instant-ngp, Blender)", "transforms.json", JSON, orl_known_read_transforms,
     {"frames"}, false, 0.5},
    {"Blender's set", "transforms_train.json", FOLDER, orl_known_read_splits, {0}, false, 0.5},
    {"Bundler", "bundle/bundle.out bundle.out *.out", TEXT, orl_known_read_bundler, {0}, false, 0.5},
    {"LLFF", "poses_bounds.npy", BYTES, orl_known_read_llff, {0}, false, 0.5},
    {"Record3D", "metadata.json EXR_RGBD/metadata.json", JSON, orl_known_read_record3d, {"poses", "K"}, false, 0.5},
    {"Polycam", "keyframes/cameras keyframes/corrected_cameras cameras corrected_cameras", FOLDER,
     orl_known_read_polycam, {0}, false, 0.5},
    {"Middlebury", "*_par.txt", TEXT, orl_known_read_middlebury, {0}, false, 0},
    {"Meshroom", "*.sfm", JSON, orl_known_read_meshroom, {"views", "intrinsics"}, false, 0.5},
    {"VisualSFM", "*.nvm", TEXT, orl_known_read_nvm, {0}, false, 0.5},
    {"Metashape", "*.xml", BYTES, orl_known_read_metashape, {0}, false, 0.5},
    {"RealityScan", "*.csv", TEXT, orl_known_read_realityscan, {0}, false, 0.5},
};

char *orl_known_formats_text(const struct orl_log *log)
{
    char *text = orl_strdup(log, "");
    for (size_t i = 0; text && i < ORL_COUNT(formats); i++) {
        char *longer = orl_format(log, "%s  %-52s %s\n", text, formats[i].name, formats[i].files);
        free(text);
        text = longer;
    }
    return text;
}

enum { PATTERN_BYTES = 64 };

// Takes the next of a format's patterns; false: there are no more.
static bool next_pattern(const char **at, char pattern[PATTERN_BYTES])
{
    size_t length = strcspn(*at, " ");
    snprintf(pattern, PATTERN_BYTES, "%.*s", (int)length, *at);
    *at += length + strspn(*at + length, " ");
    return length > 0;
}

static bool matches(const struct format *format, const char *name)
{
    char pattern[PATTERN_BYTES];
    for (const char *at = format->files; format->content != FOLDER && next_pattern(&at, pattern);)
        if (fnmatch(orl_path_name(pattern), name, 0) == 0)
            return true;
    return false;
}

static enum orl_result unknown(const struct orl_log *log, const char *path)
{
    if (!orl_path_is_file(path))
        return orl_fail(log, ORL_ERR_NOT_FOUND, "%s: no such file or folder", path);
    return orl_fail(log, ORL_ERR_FORMAT, "%s: not a file of cameras that is known: oriel import --help "
                    "lists the formats", path);
}

// --- a file ---

enum orl_result orl_known_set_shift(struct orl_known_source *source, double custom)
{
    const json_t *told = json_object_get(source->root, "pixel_centre");
    double centre = source->pixel_centre >= 0 ? source->pixel_centre
                    : json_is_number(told)    ? json_number_value(told)
                                              : custom;
    source->shift = 0.5 - centre;
    return centre >= 0 && centre <= 0.5
               ? ORL_OK
               : orl_fail(source->log, ORL_ERR_FORMAT, "%s: \"pixel_centre\" is not from 0 to 0.5",
                          source->path);
}

static enum orl_result read_with(const struct format *format,
                                 const struct orl_known_source *source,
                                 struct orl_known_cameras *known)
{
    struct orl_known_source opened = *source;
    struct orl_text_lines lines = {0};
    uint8_t *data = NULL;
    enum orl_result result = ORL_OK;
    if (format->content == TEXT)
        result = orl_text_open(source->log, source->path, opened.lines = &lines);
    else if (format->content == BYTES)
        result = orl_file_read(source->log, source->path, ORL_KNOWN_FILE_MAX, &data, &opened.size);
    opened.data = data;
    ORL_THEN(result, orl_known_set_shift(&opened, format->centre));
    ORL_THEN(result, format->read(&opened, known));
    orl_text_close(&lines);
    free(data);
    ORL_TRY(result);
    orl_logf(source->log, ORL_LOG_INFO, "%s: %s: %zu cameras, %zu points", source->path,
             format->name, known->model.image_count, known->model.point_count);
    return ORL_OK;
}

static bool fits(const struct format *format, const json_t *root)
{
    const json_t *object = format->is_list ? json_array_get(root, 0) : root;
    bool good = format->content == JSON && json_is_array(root) == format->is_list;
    for (int i = 0; i < 2 && format->arrays[i]; i++) {
        const json_t *value = json_object_get(object, format->arrays[i]);
        good = good && (format->is_list ? json_is_object(value) : json_is_array(value));
    }
    return good;
}

static enum orl_result read_json(const struct orl_known_source *source,
                                 struct orl_known_cameras *known)
{
    struct orl_known_source with_root = *source;
    uint8_t *data = NULL;
    size_t size;
    json_t *root = NULL;
    enum orl_result result = orl_file_read(source->log, source->path, ORL_KNOWN_FILE_MAX, &data, &size);
    ORL_THEN(result, orl_json_parse(source->log, source->path, data, size, &root));
    free(data);
    ORL_TRY(result);
    const struct format *found = NULL;
    for (size_t i = 0; i < ORL_COUNT(formats) && !found; i++)
        if (fits(&formats[i], root))
            found = &formats[i];
    with_root.root = root;
    result = found ? read_with(found, &with_root, known) : unknown(source->log, source->path);
    json_decref(root);
    return result;
}

static enum orl_result read_file(const struct orl_known_source *source,
                                 struct orl_known_cameras *known)
{
    const char *path = source->path, *name = orl_path_name(path), *dot = strrchr(name, '.');
    orl_path_print(known->folder, "", "%.*s", name == path ? 1 : (int)(name - path), name == path ? "." : path);
    if (dot && (strcmp(dot, ".json") == 0 || strcmp(dot, ".sfm") == 0))
        return read_json(source, known);
    for (size_t i = 0; i < ORL_COUNT(formats); i++)
        if (matches(&formats[i], name))
            return read_with(&formats[i], source, known);
    return unknown(source->log, path);
}

// --- a folder ---

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

// Sets `file` to the path of a pattern's file in a folder, or leaves it "". ORL_ERR_DATA: there are several.
static enum orl_result find_pattern(const struct orl_log *log, const char *dir, const char *pattern,
                                    char file[ORL_PATH_SIZE])
{
    struct orl_names names = {0};
    if (!strchr(pattern, '*')) {
        orl_path_print(file, dir, "%s", pattern);
        if (!orl_path_is_file(file) && !orl_path_is_dir(file))
            *file = '\0';
        return ORL_OK;
    }
    enum orl_result result = orl_dir_list(log, dir, &names);
    for (size_t i = 0; result == ORL_OK && i < names.count; i++) {
        if (fnmatch(pattern, names.items[i], FNM_PERIOD) != 0)
            continue;
        if (*file)
            result = orl_fail(log, ORL_ERR_DATA, "%s: several files of cameras, %s and %s: name "
                              "one", dir, orl_path_name(file), names.items[i]);
        else
            orl_path_print(file, dir, "%s", names.items[i]);
    }
    orl_names_finish(&names);
    return result;
}

// Sets `file` to the path of the file of cameras in a folder, or leaves it "" when there is none.
static enum orl_result find_file(const struct orl_log *log, const char *dir, char file[ORL_PATH_SIZE],
                                 const struct format **format)
{
    char pattern[PATTERN_BYTES];
    enum orl_result result = find_model(log, dir, file);
    for (size_t i = 1; result == ORL_OK && !*file && i < ORL_COUNT(formats); i++) {
        *format = &formats[i];
        for (const char *at = formats[i].files; result == ORL_OK && !*file && next_pattern(&at, pattern);)
            result = find_pattern(log, dir, pattern, file);
    }
    return result;
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

static enum orl_result read_folder(const struct orl_known_source *source,
                                   struct orl_known_cameras *known)
{
    char file[ORL_PATH_SIZE] = "";
    const struct orl_log *log = source->log;
    const struct format *format = &formats[0];
    ORL_TRY(find_file(log, source->path, file, &format));
    if (!*file)
        return orl_fail(log, ORL_ERR_NOT_FOUND, "%s: no cameras here: oriel import --help lists the "
                        "files that are searched for", source->path);
    struct orl_known_source found = *source;
    found.path = file;
    enum orl_result result = format->content == FOLDER ? read_with(format, source, known) : read_file(&found, known);
    cut_to_base(source->path, file);
    memcpy(known->folder, file, sizeof file);
    return result;
}

enum orl_result orl_known_cameras_read(const struct orl_log *log, const char *path,
                                       double pixel_centre, struct orl_known_cameras *known)
{
    const struct orl_known_source source = {.log = log, .path = path, .pixel_centre = pixel_centre};
    memset(known, 0, sizeof *known);
    enum orl_result result = orl_path_is_dir(path) ? read_folder(&source, known)
                                                   : read_file(&source, known);
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
