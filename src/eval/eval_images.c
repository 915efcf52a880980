// Pictures that accompany an evaluation's figures, and pictures of other programs.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bridge/bridge.h"
#include "core/file.h"
#include "eval/internal.h"
#include "io/picture.h"

enum { AMPLIFY = 4 };

// The photograph's name as a file name, without folders, and without its extension unless another
// photograph differs by that alone.
static void print_stem(const struct orl_scene *scene, size_t photo, char stem[ORL_PATH_SIZE])
{
    orl_path_print(stem, "", "%s", scene->photos[photo].name);
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
}

// Photograph, rendering and their difference times AMPLIFY, from left to right.
static enum orl_result beside(const struct orl_log *log, const struct orl_image *rendered,
                              const struct orl_image *photograph, struct orl_image *panels)
{
    ORL_TRY(orl_image_init(log, panels, rendered->width * 3, rendered->height, 3, ORL_PIXEL_U8));
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

enum orl_result orl_eval_write_images(const struct orl_log *log, const struct orl_eval *eval,
                                      const char *dir, size_t photo,
                                      const struct orl_image *rendered,
                                      const struct orl_image *photograph)
{
    struct orl_image panels = {0};
    char stem[ORL_PATH_SIZE];
    print_stem(eval->scene, photo, stem);
    enum orl_result result = beside(log, rendered, photograph, &panels);
    ORL_THEN(result, orl_png_write(log, ORL_PATH(dir, "%s.photo.png", stem), photograph));
    ORL_THEN(result, orl_png_write(log, ORL_PATH(dir, "%s.%s.png", stem, eval->method), rendered));
    ORL_THEN(result, orl_png_write(log, ORL_PATH(dir, "%s.%s.diff.png", stem, eval->method), &panels));
    orl_image_finish(&panels);
    return result;
}

// --- pictures of other programs ---

// False: there is none.
static bool find_picture(const struct orl_scene *scene, const char *dir, size_t photo, char path[ORL_PATH_SIZE])
{
    static const char *const extensions[] = {"png", "jpg", "jpeg", "JPG"};
    char stem[ORL_PATH_SIZE];
    bool found = false;
    print_stem(scene, photo, stem);
    for (size_t i = 0; !found && i < ORL_COUNT(extensions); i++)
        found = orl_path_is_file(orl_path_print(path, dir, "%s.%s", stem, extensions[i]));
    return found;
}

enum orl_result orl_eval_read_picture(const struct orl_log *log, const struct orl_scene *scene,
                                      const char *dir, const struct orl_heldout *heldout,
                                      struct orl_image *picture, struct orl_image *coverage)
{
    int width = heldout->picture.width, height = heldout->picture.height, n = heldout->divide;
    struct orl_image other = {0};
    char path[ORL_PATH_SIZE];
    if (!find_picture(scene, dir, heldout->photo, path))
        return orl_fail(log, ORL_ERR_NOT_FOUND, "%s: no picture of %s", dir,
                        scene->photos[heldout->photo].name);
    enum orl_result result = orl_picture_read(log, path, 3, &other);
    // The size may differ, but the shape must agree within a pixel or two.
    double skew = fabs((double)other.width * height - (double)other.height * width);
    if (result == ORL_OK && skew > 2 * fmax(other.width, other.height))
        result = orl_fail(log, ORL_ERR_DATA, "%s has %dx%d pixels, the photograph %dx%d", path,
                          other.width, other.height, width, height);
    bool as_photograph = other.width / n == width && other.height / n == height;
    ORL_THEN(result, as_photograph ? orl_heldout_shrink(log, &other, n, picture)
                                   : orl_bridge_resize(log, &other, width, height, picture));
    ORL_THEN(result, orl_image_init(log, coverage, width, height, 1, ORL_PIXEL_F32));
    for (int i = 0; result == ORL_OK && i < width * height; i++)
        coverage->f32[i] = 1;
    orl_image_finish(&other);
    return result;
}
