// Pictures that accompany an evaluation's figures.
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "eval/internal.h"
#include "io/picture.h"

enum { AMPLIFY = 4 };

char *orl_eval_file_stem(const struct orl_log *log, const struct orl_scene *scene, size_t photo)
{
    char *stem = orl_strdup(log, scene->photos[photo].name);
    if (!stem)
        return NULL;
    char *dot = strrchr(stem, '.');
    if (dot && dot != stem && !strchr(dot, '/')) {
        size_t alike = 0;
        size_t length = (size_t)(dot - stem) + 1;
        for (size_t i = 0; i < scene->photo_count; i++)
            alike += strncmp(scene->photos[i].name, stem, length) == 0;
        if (alike == 1)
            *dot = '\0';
    }
    for (char *slash = stem; (slash = strchr(slash, '/'));)
        *slash = '_';
    return stem;
}

// Photograph, rendering and their difference times AMPLIFY, from left to right.
static enum orl_result beside(const struct orl_log *log, const struct orl_image *rendered,
                              const struct orl_image *photograph, struct orl_image *panels)
{
    enum orl_result result = orl_image_init(log, panels, rendered->width * 3, rendered->height, 3,
                                            ORL_PIXEL_U8);
    if (result != ORL_OK)
        return result;
    size_t row = (size_t)rendered->width * 3;
    for (size_t y = 0; y < (size_t)rendered->height; y++) {
        const uint8_t *a = rendered->u8 + y * row, *b = photograph->u8 + y * row;
        uint8_t *to = panels->u8 + y * row * 3;
        memcpy(to, b, row);
        memcpy(to + row, a, row);
        for (size_t i = 0; i < row; i++) {
            int difference = AMPLIFY * abs(a[i] - b[i]);
            to[2 * row + i] = (uint8_t)(difference > 255 ? 255 : difference);
        }
    }
    return ORL_OK;
}

static enum orl_result write_as(const struct orl_log *log, const char *dir, const char *stem,
                                const char *middle, const char *end,
                                const struct orl_image *image)
{
    char *path = orl_format(log, "%s/%s.%s%s.png", dir, stem, middle, end);
    enum orl_result result = path ? orl_png_write(log, path, image) : ORL_ERR_MEMORY;
    free(path);
    return result;
}

enum orl_result orl_eval_write_images(const struct orl_log *log, const struct orl_scene *scene,
                                      const struct orl_eval_params *params, size_t photo,
                                      const struct orl_image *rendered,
                                      const struct orl_image *photograph)
{
    struct orl_image panels = {0};
    char *stem = orl_eval_file_stem(log, scene, photo);
    enum orl_result result = stem ? beside(log, rendered, photograph, &panels) : ORL_ERR_MEMORY;
    if (result == ORL_OK)
        result = write_as(log, params->image_dir, stem, "photo", "", photograph);
    if (result == ORL_OK)
        result = write_as(log, params->image_dir, stem, params->method, "", rendered);
    if (result == ORL_OK)
        result = write_as(log, params->image_dir, stem, params->method, ".diff", &panels);
    orl_image_finish(&panels);
    free(stem);
    return result;
}
