// What developers and users type: options and shaders of their own.
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "core/file.h"
#include "fuzz.h"
#include "gpu/internal.h"
#include "gpu/shader_table.h"
#include "oriel/render.h"

// What was set prints, and sets the same again.
static void print_all(const struct orl_render_params *params)
{
    for (const struct orl_option *o = orl_render_options(); o->name; o++) {
        struct orl_render_params again = *params;
        char value[ORL_OPTION_TEXT], text[160];
        orl_option_print(o, params, value);
        snprintf(text, sizeof text, "%s=%s", o->name, value);
        if (orl_render_option_read(o, params))
            fuzz_require(orl_render_params_set(&fuzz_log, &again, text) == ORL_OK,
                         "options survive their text");
    }
}

// A line for each --set.
void fuzz_options(const uint8_t *data, size_t size)
{
    enum { LINES_MAX = 16 };
    char *text = calloc(1, size + 1);
    const char *lines[LINES_MAX];
    size_t count = 0;
    struct orl_render_params params = orl_methods[0].params;
    memcpy(text, data, size);
    for (char *line = strtok(text, "\n"); line && count < LINES_MAX; line = strtok(NULL, "\n"))
        lines[count++] = line;
    for (size_t i = 0; i < count; i++) {
        struct orl_render_params one = orl_methods[0].params;
        if (orl_render_params_set(&fuzz_log, &one, lines[i]) != ORL_OK)
            (void)orl_method_find(&fuzz_log, lines[i]);
    }
    if (orl_render_params_assign(&fuzz_log, &params, lines, count) == ORL_OK)
        print_all(&params);
    free(text);
}

// The input stands for every shader, so includes find it again.
void fuzz_shader(const uint8_t *data, size_t size)
{
    static char dir[128];
    if (!*dir) {
        snprintf(dir, sizeof dir, "%s", fuzz_path("shaders"));
        for (const struct orl_shader_file *row = orl_shader_table; row->name; row++) {
            char name[160];
            snprintf(name, sizeof name, "shaders/%s", row->name);
            *strrchr(name, '/') = '\0';
            if (orl_dir_make(&fuzz_log, fuzz_path(name)) != ORL_OK)
                abort();
        }
    }
    struct orl_gpu gpu = {.log = &fuzz_log, .shader_dir = dir};
    struct shader_source source;
    for (int i = 0; i < 3; i++) {
        char name[160];
        snprintf(name, sizeof name, "shaders/%s", orl_shader_table[i].name);
        fuzz_save(name, data, size);
    }
    const struct orl_slot slots[] = {{"slot", orl_shader_table[2].name}, {0}};
    const char *file = orl_shader_table[1].name;
    if (orl_shader_source_load(&gpu, file, slots, "A 1\nB", &source) == ORL_OK)
        fuzz_require(strlen(source.text.data) <= source.text.size, "the source is whole");
    orl_shader_source_finish(&source);
}
