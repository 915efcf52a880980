#include "fuzz.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include "core/file.h"

const struct fuzz_target fuzz_targets[] = {
    {"colmap_binary", fuzz_colmap_binary}, {"colmap_text", fuzz_colmap_text},
    {"depth_map", fuzz_depth_map},         {"manifest", fuzz_manifest},
    {"ply", fuzz_ply},                     {"lod", fuzz_lod},
    {"stages", fuzz_stages},               {"path_json", fuzz_path_json},
    {"path_text", fuzz_path_text},         {"exposures", fuzz_exposures},
    {"exif", fuzz_exif},                   {"jpeg", fuzz_jpeg},
    {"png", fuzz_png},                     {"tiff", fuzz_tiff},
    {"heif", fuzz_heif},                   {"exr", fuzz_exr},
    {"raw", fuzz_raw},                     {"cameras_json", fuzz_cameras_json},
    {"stream", fuzz_stream},               {"workspace", fuzz_workspace},
    {"mesh", fuzz_mesh},                   {"database", fuzz_database},
    {"walk_message", fuzz_walk_message},   {"walk_settings", fuzz_walk_settings},
    {"options", fuzz_options},             {"shader", fuzz_shader},
    {0},
};

const struct fuzz_target *fuzz_target_find(const char *name)
{
    for (const struct fuzz_target *target = fuzz_targets; target->name; target++)
        if (strcmp(target->name, name) == 0)
            return target;
    fprintf(stderr, "no target %s\n", name);
    return NULL;
}

static void drop(void *priv, enum orl_log_level level, const char *message)
{
    (void)priv;
    (void)level;
    (void)message;
}

const struct orl_log fuzz_log = {.level = ORL_LOG_DEBUG, .print = drop};

void fuzz_limit_memory(void)
{
    const rlim_t room = (rlim_t)8 << 30; // on top of what sanitizers take of the address space
    unsigned long long pages = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    if (!file || fscanf(file, "%llu", &pages) != 1)
        pages = 0;
    if (file)
        fclose(file);
    struct rlimit limit = {.rlim_max = RLIM_INFINITY};
    limit.rlim_cur = (rlim_t)pages * (rlim_t)sysconf(_SC_PAGE_SIZE) + room;
    if (pages)
        setrlimit(RLIMIT_AS, &limit);
}

static char folder[64];

static void remove_folder(void)
{
    (void)!orl_dir_remove(NULL, folder);
}

const char *fuzz_path(const char *name)
{
    static char path[128];
    if (!*folder) {
        const char *base = orl_path_is_dir("/dev/shm") ? "/dev/shm" : "/tmp";
        snprintf(folder, sizeof folder, "%s/oriel-fuzz-XXXXXX", base);
        if (!mkdtemp(folder))
            abort();
        atexit(remove_folder);
    }
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

void fuzz_save(const char *name, const uint8_t *data, size_t size)
{
    FILE *file = fopen(fuzz_path(name), "wb");
    bool ok = file && fwrite(data, 1, size, file) == size;
    if (!file || fclose(file) != 0 || !ok)
        abort();
}

void fuzz_save_parts(const char *const *names, size_t count, const uint8_t *data, size_t size)
{
    for (size_t i = 0; i < count; i++) {
        size_t length = size;
        if (i + 1 < count) {
            length = size >= 2 ? (size_t)data[0] | (size_t)data[1] << 8 : 0;
            size_t head = size >= 2 ? 2 : size;
            data += head;
            size -= head;
            length = length < size ? length : size;
        }
        fuzz_save(names[i], data, length);
        data += length;
        size -= length;
    }
}

void fuzz_require(bool promise, const char *what)
{
    if (!promise) {
        fprintf(stderr, "broken promise: %s\n", what);
        abort();
    }
}
