// Writes the source of programs to a folder, for other compilers and people to read.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

#include "core/file.h"
#include "core/memory.h"
#include "gpu/internal.h"

static const char *stage_suffix(GLenum type)
{
    return type == GL_VERTEX_SHADER ? "vert" : type == GL_FRAGMENT_SHADER ? "frag" : "comp";
}

// The source, and behind it the files that it consists of, which #line only numbers.
static char *make_text(const struct orl_log *log, const struct shader_source *source)
{
    char *text = orl_strdup(log, source->text.data);
    for (size_t i = 0; text && i < source->file_count; i++) {
        char *longer = orl_format(log, "%s// source %zu: %s\n", text, i, source->files[i]);
        free(text);
        text = longer;
    }
    return text;
}

bool orl_shader_dump(struct orl_gpu *gpu, GLenum type, const struct shader_source *source)
{
    const char *dir = getenv("ORIEL_SHADER_DUMP");
    if (!dir || !*dir)
        return true;
    char name[64];
    snprintf(name, sizeof name, "%016llx.%s",
             (unsigned long long)XXH3_64bits(source->text.data, source->text.size), stage_suffix(type));
    char *path = orl_path_join(gpu->log, dir, name), *text = make_text(gpu->log, source);
    bool ok = path && text && orl_dir_make(gpu->log, dir) == ORL_OK &&
              orl_file_write(gpu->log, path, text, strlen(text)) == ORL_OK;
    free(path);
    free(text);
    return ok;
}
