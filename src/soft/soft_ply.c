#include "soft/soft_ply.h"

#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "scene/manifest.h"
#include "scene/ply.h"

enum { COLUMNS = 18 };

// The columns of the file in their order, and which value of a splat each is; -1: none, 0 in the file.
static const struct column {
    const char *name;
    int value;
} columns[COLUMNS] = {
    {"x", 0}, {"y", 1}, {"z", 2}, {"nx", -1}, {"ny", -1}, {"nz", -1},
    {"f_dc_0", ORL_SOFT_COLOR}, {"f_dc_1", ORL_SOFT_COLOR + 1}, {"f_dc_2", ORL_SOFT_COLOR + 2},
    {"opacity", ORL_SOFT_OPACITY},
    {"scale_0", ORL_SOFT_SIGMA}, {"scale_1", ORL_SOFT_SIGMA + 1}, {"scale_2", ORL_SOFT_SIGMA + 2},
    {"rot_0", ORL_SOFT_TURN}, {"rot_1", ORL_SOFT_TURN + 1}, {"rot_2", ORL_SOFT_TURN + 2},
    {"rot_3", ORL_SOFT_TURN + 3}, {"pixel", ORL_SOFT_PIXEL},
};

// Errors are found when the file is committed.
static void write_all(FILE *stream, const struct orl_soft_model *model)
{
    fprintf(stream, "ply\nformat binary_little_endian 1.0\nelement vertex %zu\n", model->count);
    for (int k = 0; k < COLUMNS; k++)
        fprintf(stream, "property float %s\n", columns[k].name);
    fprintf(stream, "end_header\n");
    for (size_t i = 0; i < model->count; i++) {
        float record[COLUMNS] = {0};
        for (int k = 0; k < COLUMNS; k++)
            record[k] = columns[k].value >= 0 ? model->splats[i][columns[k].value] : 0;
        fwrite(record, sizeof record, 1, stream);
    }
}

enum orl_result orl_soft_write(const struct orl_log *log, const char *path, const struct orl_soft_model *model)
{
    struct orl_atomic_file file;
    ORL_TRY(orl_atomic_open(log, path, &file));
    write_all(file.stream, model);
    return orl_atomic_commit(log, &file);
}

static enum orl_result read_all(const struct orl_log *log, struct orl_ply *ply, struct orl_soft_model *model)
{
    const struct orl_ply_element *element;
    double values[ORL_PLY_PROPERTIES_MAX];
    int at[COLUMNS];
    ORL_TRY(orl_ply_seek(ply, "vertex", "no splats", &element));
    for (int k = 0; k < COLUMNS; k++) {
        at[k] = orl_ply_property_index(element, columns[k].name);
        if (at[k] < 0 && columns[k].value >= 0)
            return orl_ply_bad(ply, "a property of soft splats is missing");
    }
    ORL_TRY(ORL_GROW(log, model->splats, model->capacity, element->count));
    for (uint64_t i = 0; i < element->count; i++) {
        ORL_TRY(orl_ply_record(ply, element, values, -1, NULL));
        float *s = model->splats[model->count++];
        memset(s, 0, sizeof *model->splats);
        for (int k = 0; k < COLUMNS; k++)
            if (columns[k].value >= 0)
                s[columns[k].value] = (float)values[at[k]];
    }
    return ORL_OK;
}

enum orl_result orl_soft_read(const struct orl_log *log, const char *path, struct orl_soft_model *model)
{
    struct orl_ply ply = {0};
    *model = (struct orl_soft_model){0};
    enum orl_result result = orl_ply_open(log, path, &ply);
    ORL_THEN(result, read_all(log, &ply, model));
    orl_ply_close(&ply);
    if (result == ORL_OK)
        orl_soft_drop(model, 0.5f / 255); // and what is not finite
    if (result == ORL_OK && model->count == 0)
        result = orl_fail(log, ORL_ERR_DATA, "%s: no splats", path);
    if (result != ORL_OK)
        orl_soft_finish(model);
    return result;
}

enum orl_result orl_soft_read_scene(const struct orl_log *log, const char *scene_dir, struct orl_soft_model *model)
{
    const char *path = ORL_PATH(scene_dir, ORL_SOFT_NAME);
    if (!orl_path_is_file(path))
        return orl_fail(log, ORL_ERR_NOT_FOUND, "%s: missing; oriel refine %s makes it, and --set soft=0 draws "
                        "without", path, scene_dir);
    return orl_soft_read(log, path, model);
}
