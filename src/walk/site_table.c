#include "walk/site_table.h"

#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "walk/internal.h"
#include "walk/publish.h"

static const size_t FILE_MAX = (size_t)1 << 30;

static enum orl_result add(const struct orl_log *log, const char *dir, const char *path,
                           struct site_table *table)
{
    struct site_file file = {.path = orl_strdup(log, path)};
    enum orl_result result = orl_grow(log, (void **)&table->files, &table->capacity,
                                      table->count + 1, sizeof *table->files);
    if (result == ORL_OK)
        result = file.path ? orl_file_read(log, ORL_PATH(dir, "%s", path), FILE_MAX, &file.data, &file.size)
                           : ORL_ERR_MEMORY;
    if (result == ORL_OK)
        table->files[table->count++] = file;
    else
        free(file.path);
    return result;
}

static enum orl_result read_site(const struct orl_log *log, const char *dir,
                                 struct site_table *table)
{
    struct orl_names paths = {0};
    enum orl_result result = orl_site_files(log, dir, true, &paths);
    for (size_t i = 0; result == ORL_OK && i < paths.count; i++)
        result = add(log, dir, paths.items[i], table);
    orl_names_finish(&paths);
    return result;
}

enum orl_result orl_site_table_make(struct orl_gpu *gpu, struct orl_scene *scene,
                                    bool radiance, const struct orl_progress *progress, struct site_table *table)
{
    const struct orl_log *log = orl_gpu_log(gpu);
    struct orl_publish_report report;
    char *dir = NULL;
    *table = (struct site_table){0};
    ORL_TRY(orl_dir_make_temporary(log, "walk", &dir));
    const char *site = ORL_PATH(dir, "site");
    struct orl_publish_params params = {ORL_PUBLISH_DEFAULTS};
    params.out = site;
    params.radiance = radiance;
    params.progress = progress;
    enum orl_result result = orl_publish(gpu, scene, &params, &report);
    ORL_THEN(result, read_site(log, site, table));
    if (orl_dir_remove(log, dir) != ORL_OK && result == ORL_OK)
        result = ORL_ERR_IO;
    if (result != ORL_OK)
        orl_site_table_finish(table);
    free(dir);
    return result;
}

void orl_site_table_finish(struct site_table *table)
{
    for (size_t i = 0; i < table->count; i++) {
        free(table->files[i].path);
        free(table->files[i].data);
    }
    free(table->files);
    *table = (struct site_table){0};
}

const struct site_file *orl_site_table_find(const struct site_table *table, const char *path)
{
    for (size_t i = 0; i < table->count; i++)
        if (strcmp(table->files[i].path, path) == 0)
            return &table->files[i];
    return NULL;
}
