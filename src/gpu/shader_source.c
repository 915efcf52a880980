// Finds shader sources, expands their includes and numbers the files for messages.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "gpu/internal.h"
#include "gpu/shader_table.h"

enum { SHADER_MAX_BYTES = 1 << 20, INCLUDE_DEPTH_MAX = 8 };

// The text of one file below shaders/ as it is written, and its name as a static string. The caller
// frees *owned.
static enum orl_result read_text(struct orl_gpu *gpu, const char *file, const char **name,
                                 const char **text, uint8_t **owned)
{
    *owned = NULL;
    *text = NULL;
    for (const struct orl_shader_file *row = orl_shader_table; row->name; row++) {
        if (strcmp(row->name, file) != 0)
            continue;
        *name = row->name;
        *text = row->text;
    }
    if (!*text)
        return orl_fail(gpu->log, ORL_ERR_NOT_FOUND, "shader %s is not known", file);
    if (!gpu->shader_dir)
        return ORL_OK;
    size_t size;
    enum orl_result result =
        orl_file_read(gpu->log, ORL_PATH(gpu->shader_dir, "%s", file), SHADER_MAX_BYTES, owned, &size);
    *text = (const char *)*owned;
    return result;
}

// #line only numbers the files; the name is for people and other compilers.
static enum orl_result append_line_mark(struct orl_gpu *gpu, struct shader_source *source, int line,
                                        size_t file_index)
{
    char mark[256];
    int length = snprintf(mark, sizeof mark, "// source %zu: %s\n#line %d %zu\n", file_index,
                          source->files[file_index], line, file_index);
    return orl_bytes_add(gpu->log, &source->text, mark, (size_t)length);
}

// The file that a line includes; NULL: none. `quoted` has room for a name.
static const char *included_file(const char *line, const struct orl_slot *slots, char quoted[128])
{
    char slot[64];
    if (sscanf(line, "#include \"%127[^\"\n]\"", quoted) == 1)
        return quoted;
    if (sscanf(line, "#include <%63[^>\n]>", slot) != 1)
        return NULL;
    for (const struct orl_slot *s = slots; s && s->name; s++)
        if (strcmp(s->name, slot) == 0)
            return s->file;
    snprintf(quoted, 128, "<%s>", slot); // an unknown slot, which the error message names
    return quoted;
}

static enum orl_result expand(struct orl_gpu *gpu, struct shader_source *source, const char *file,
                              const struct orl_slot *slots, int depth)
{
    const char *text, *name = file;
    uint8_t *owned;
    for (size_t i = 0; i < source->file_count; i++)
        if (strcmp(source->files[i], file) == 0)
            return ORL_OK; // already included
    if (depth > INCLUDE_DEPTH_MAX || source->file_count == ORL_COUNT(source->files))
        return orl_fail(gpu->log, ORL_ERR_FORMAT, "shader %s: includes too deep or too many", file);
    ORL_TRY(read_text(gpu, file, &name, &text, &owned));
    size_t index = source->file_count++;
    source->files[index] = name;
    enum orl_result result = append_line_mark(gpu, source, 1, index);
    int number = 1;
    for (const char *line = text; result == ORL_OK && *line; number++) {
        const char *end = strchr(line, '\n');
        size_t length = end ? (size_t)(end - line) + 1 : strlen(line);
        char quoted[128];
        const char *included = included_file(line, slots, quoted);
        if (included) {
            result = expand(gpu, source, included, slots, depth + 1);
            ORL_THEN(result, append_line_mark(gpu, source, number + 1, index));
        } else {
            result = orl_bytes_add(gpu->log, &source->text, line, length);
        }
        line += length;
    }
    ORL_THEN(result, orl_bytes_add(gpu->log, &source->text, "\n", 1));
    free(owned);
    return result;
}

enum orl_result orl_shader_source_load(struct orl_gpu *gpu, const char *file,
                                       const struct orl_slot *slots, const char *defines,
                                       struct shader_source *source)
{
    static const char head[] = "#version 450 core\n";
    *source = (struct shader_source){0};
    enum orl_result result = orl_bytes_add(gpu->log, &source->text, head, sizeof head - 1);
    for (const char *line = defines; result == ORL_OK && line && *line;) {
        size_t length = strcspn(line, "\n");
        result = orl_bytes_add(gpu->log, &source->text, "#define ", 8);
        ORL_THEN(result, orl_bytes_add(gpu->log, &source->text, line, length));
        ORL_THEN(result, orl_bytes_add(gpu->log, &source->text, "\n", 1));
        line += length + (line[length] == '\n');
    }
    ORL_THEN(result, expand(gpu, source, file, slots, 0));
    return result;
}

const char *orl_shader_file(const char *folder, size_t index)
{
    size_t length = strlen(folder);
    for (const struct orl_shader_file *row = orl_shader_table; row->name; row++)
        if (strncmp(row->name, folder, length) == 0 && row->name[length] == '/' && index-- == 0)
            return row->name;
    return NULL;
}

void orl_shader_source_finish(struct shader_source *source)
{
    free(source->text.data);
    memset(source, 0, sizeof *source);
}
