#include "preprocess/results.h"
#include "core/file.h"

#include <string.h>

static enum orl_result add_file(const struct orl_job *job, const char *path, json_t *files)
{
    char sum[ORL_CHECKSUM_SIZE];
    enum orl_result result = orl_flush(job->log, path); // COLMAP does not
    ORL_THEN(result, orl_file_checksum(job->log, path, sum));
    if (result == ORL_OK &&
        json_object_set_new(files, path + strlen(job->dir) + 1, json_string(sum)) != 0)
        result = orl_fail(job->log, ORL_ERR_MEMORY, "no memory for a checksum");
    return result;
}

static enum orl_result add_folder(const struct orl_job *job, const char *dir, json_t *files)
{
    struct orl_names names;
    enum orl_result result = orl_dir_list(job->log, dir, &names);
    for (size_t i = 0; result == ORL_OK && i < names.count; i++) {
        const char *path = ORL_PATH(dir, "%s", names.items[i]);
        if (orl_progress_cancelled(job->progress))
            result = ORL_ERR_CANCELLED;
        else if (orl_path_is_file(path))
            result = add_file(job, path, files);
    }
    orl_names_finish(&names);
    return result;
}

enum orl_result orl_results_sum(const struct orl_job *job, const char *const *names,
                                json_t *files)
{
    for (; *names; names++) {
        const char *path = ORL_PATH(job->dir, "%s", *names);
        if (orl_path_is_dir(path))
            ORL_TRY(add_folder(job, path, files));
        else if (orl_path_is_file(path))
            ORL_TRY(add_file(job, path, files));
    }
    return ORL_OK;
}

const char *orl_results_check(const struct orl_job *job, const json_t *files, const char **why)
{
    const char *name;
    json_t *value;
    json_object_foreach((json_t *)(uintptr_t)files, name, value) {
        char sum[ORL_CHECKSUM_SIZE];
        const char *told = json_string_value(value), *path = ORL_PATH(job->dir, "%s", name);
        bool read = orl_path_is_file(path) && orl_file_checksum(NULL, path, sum) == ORL_OK;
        if (read && told && strcmp(sum, told) == 0)
            continue;
        *why = read ? "changed since it was made" : "missing";
        return name;
    }
    return NULL;
}
