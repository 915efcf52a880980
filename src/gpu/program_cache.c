// A cache of linked programs that persists between runs. A failure here only means that a program
// is compiled again, so nothing is reported above debug level.
#include <stdlib.h>
#include <string.h>
#include <sys/statvfs.h>
#include <xxhash.h>

#include "core/file.h"
#include "core/memory.h"
#include "gpu/internal.h"

enum {
    FORMATS_MAX = 64,
    BINARY_MAX_BYTES = 64 << 20,
    ENTRIES_MAX = 512, // entries of old drivers and shaders are never used again
};

// Header of a cache file; the driver's binary follows.
struct header {
    char magic[8];
    uint64_t hash; // of the bytes after the header
    uint32_t size, format;
};
static const char magic[8] = "ORLPRG1";

// Sets the cache folder: `asked`, else $XDG_CACHE_HOME/oriel, else ~/.cache/oriel; "": no cache.
static void find_cache(const char *asked, char dir[ORL_PATH_SIZE])
{
    const char *setting = getenv("ORIEL_CACHE"), *xdg = getenv("XDG_CACHE_HOME");
    const char *home = getenv("HOME");
    if (setting && strcmp(setting, "off") == 0)
        return;
    if (asked)
        orl_path_print(dir, "", "%s", asked);
    else if (xdg && *xdg == '/') // relative paths must be ignored (XDG Base Directory Specification)
        orl_path_print(dir, xdg, "oriel");
    else if (home && *home)
        orl_path_print(dir, home, ".cache/oriel");
}

// --- Mesa's own cache ---

void orl_mesa_cache_guard(const struct orl_log *log)
{
    static const unsigned long long min_bytes = 64 << 20;
    const char *set = getenv("MESA_SHADER_CACHE_DIR"), *xdg = getenv("XDG_CACHE_HOME");
    const char *home = getenv("HOME");
    struct statvfs disk;
    char dir[ORL_PATH_SIZE] = "";
    if ((set && *set) || (xdg && *xdg))
        orl_path_print(dir, "", "%s", set && *set ? set : xdg);
    else if (home)
        orl_path_print(dir, home, ".cache");
    // The nearest folder above that there is.
    for (char *slash; !orl_path_is_dir(dir) && (slash = strrchr(dir, '/')) && slash > dir;)
        *slash = '\0';
    if (*dir && statvfs(dir, &disk) == 0 &&
        (unsigned long long)disk.f_bavail * disk.f_frsize < min_bytes) {
        orl_logf(log, ORL_LOG_DEBUG, "%s: little room, so that Mesa keeps no programs there", dir);
        setenv("MESA_SHADER_CACHE_DISABLE", "true", 0);
    }
}

// --- Oriel's cache ---

void orl_program_cache_open(struct orl_gpu *gpu, const char *dir)
{
    GLint count = 0;
    glGetIntegerv(GL_NUM_PROGRAM_BINARY_FORMATS, &count);
    if (count > 0)
        find_cache(dir, gpu->program_cache);
}

// Names the entry by a hash of everything that determines the linked program. NULL: out of memory.
static const char *entry_path(const struct orl_gpu *gpu, const struct shader_source *source,
                              char path[ORL_PATH_SIZE])
{
    const struct orl_gpu_caps *caps = &gpu->caps;
    char *all = orl_format(NULL, "%s\n%s\n%s\n%s\n%s", caps->vendor, caps->renderer, caps->version, ORL_VERSION,
                           source->text.data);
    if (!all)
        return NULL;
    XXH128_hash_t hash = XXH3_128bits(all, strlen(all));
    free(all);
    return orl_path_print(path, gpu->program_cache, "programs/%016llx%016llx",
                          (unsigned long long)hash.high64, (unsigned long long)hash.low64);
}

static bool format_known(GLenum format)
{
    GLint count = 0, formats[FORMATS_MAX];
    glGetIntegerv(GL_NUM_PROGRAM_BINARY_FORMATS, &count);
    if (count > FORMATS_MAX)
        return false;
    glGetIntegerv(GL_PROGRAM_BINARY_FORMATS, formats);
    for (GLint i = 0; i < count; i++)
        if ((GLenum)formats[i] == format)
            return true;
    return false;
}

// Loads the program if the file is complete and undamaged.
static bool load_binary(const uint8_t *data, size_t size, GLuint program)
{
    struct header header;
    if (size <= sizeof header)
        return false;
    memcpy(&header, data, sizeof header);
    const uint8_t *binary = data + sizeof header;
    if (memcmp(header.magic, magic, sizeof magic) != 0 || header.size != size - sizeof header ||
        header.hash != XXH3_64bits(binary, header.size) || !format_known(header.format))
        return false;
    GLint ok = 0;
    glProgramBinary(program, header.format, binary, (GLsizei)header.size);
    while (glGetError() != GL_NO_ERROR)
        ; // a refused binary is compiled from source instead
    glGetProgramiv(program, GL_LINK_STATUS, &ok);
    return ok;
}

bool orl_program_cache_load(struct orl_gpu *gpu, const struct shader_source *source,
                            GLuint program)
{
    uint8_t *data = NULL;
    size_t size;
    char path[ORL_PATH_SIZE];
    bool hit = *gpu->program_cache && entry_path(gpu, source, path) && orl_path_is_file(path) &&
               orl_file_read(NULL, path, BINARY_MAX_BYTES, &data, &size) == ORL_OK &&
               load_binary(data, size, program);
    free(data);
    return hit;
}

// Creates the folder for entries if it is missing, and empties it if it holds too many.
static bool prepare_folder(const char *dir)
{
    struct orl_names names = {0};
    const char *programs = ORL_PATH(dir, "programs");
    bool ok = orl_dir_make(NULL, programs) == ORL_OK && orl_dir_list(NULL, programs, &names) == ORL_OK;
    if (ok && names.count >= ENTRIES_MAX)
        ok = orl_dir_remove(NULL, programs) == ORL_OK && orl_dir_make(NULL, programs) == ORL_OK;
    orl_names_finish(&names);
    return ok;
}

void orl_program_cache_store(struct orl_gpu *gpu, const struct shader_source *source,
                             GLuint program)
{
    GLint length = 0;
    if (!*gpu->program_cache)
        return;
    glGetProgramiv(program, GL_PROGRAM_BINARY_LENGTH, &length);
    if (length <= 0 || length > BINARY_MAX_BYTES - (GLint)sizeof(struct header))
        return;
    struct header header = {0};
    GLenum format = 0;
    char path[ORL_PATH_SIZE];
    uint8_t *data = orl_array(NULL, sizeof header + (size_t)length, 1);
    if (!entry_path(gpu, source, path) || !data || !prepare_folder(gpu->program_cache))
        goto end;
    glGetProgramBinary(program, length, &length, &format, data + sizeof header);
    memcpy(header.magic, magic, sizeof magic);
    header.size = (uint32_t)length;
    header.format = format;
    header.hash = XXH3_64bits(data + sizeof header, header.size);
    memcpy(data, &header, sizeof header);
    if (orl_file_write(NULL, path, data, sizeof header + header.size) != ORL_OK)
        orl_logf(gpu->log, ORL_LOG_DEBUG, "%s cannot be written: programs are not kept", path);
end:
    free(data);
}
