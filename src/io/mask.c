#include "io/mask.h"

#include <string.h>

#include "io/picture.h"

enum {
    LABELS_BELOW = 32, // files that are nowhere brighter hold labels
    COLOURED = 32,     // least difference of the channels of a colour that is no noise
};

static uint8_t brightest_channel(const uint8_t *pixel)
{
    uint8_t most = pixel[0] > pixel[1] ? pixel[0] : pixel[1];
    return most > pixel[2] ? most : pixel[2];
}

static uint8_t darkest_channel(const uint8_t *pixel)
{
    uint8_t least = pixel[0] < pixel[1] ? pixel[0] : pixel[1];
    return least < pixel[2] ? least : pixel[2];
}

// Least value that counts in a file with this greatest value.
static int threshold_of(int greatest)
{
    return greatest < LABELS_BELOW ? 1 : (greatest + 1) / 2;
}

static bool alpha_varies(const struct orl_image *rgba)
{
    size_t count = orl_image_bytes(rgba);
    for (size_t i = 7; i < count; i += 4)
        if (rgba->u8[i] != rgba->u8[3])
            return true;
    return false;
}

// By alpha, or by the colours.
static void mark(const struct orl_image *rgba, bool alpha, struct orl_image *mask)
{
    int greatest = 0;
    size_t count = orl_image_bytes(mask);
    for (size_t i = 0; i < count; i++) {
        const uint8_t *pixel = rgba->u8 + 4 * i;
        mask->u8[i] = alpha ? pixel[3] : brightest_channel(pixel);
        greatest = mask->u8[i] > greatest ? mask->u8[i] : greatest;
    }
    int threshold = threshold_of(greatest);
    for (size_t i = 0; i < count; i++) {
        bool coloured = !alpha && mask->u8[i] - darkest_channel(rgba->u8 + 4 * i) >= COLOURED;
        mask->u8[i] = mask->u8[i] >= threshold || coloured ? 255 : 0;
    }
}

enum orl_result orl_mask_read(const struct orl_log *log, const char *path, bool alpha_only,
                              struct orl_image *mask)
{
    struct orl_image rgba = {0};
    memset(mask, 0, sizeof *mask);
    enum orl_result result = orl_picture_read(log, path, 4, &rgba);
    bool alpha = result == ORL_OK && alpha_varies(&rgba);
    if (result == ORL_OK && (alpha || !alpha_only))
        result = orl_image_init(log, mask, rgba.width, rgba.height, 1, ORL_PIXEL_U8);
    if (result == ORL_OK && (alpha || !alpha_only))
        mark(&rgba, alpha, mask);
    orl_image_finish(&rgba);
    return result;
}

size_t orl_mask_count(const struct orl_image *mask)
{
    size_t marked = 0, count = orl_image_bytes(mask);
    for (size_t i = 0; i < count; i++)
        marked += mask->u8[i] != 0;
    return marked;
}

bool orl_mask_find(const char *dir, const char *name, char path[ORL_PATH_SIZE])
{
    static const char *const extensions[] = {"png", "PNG", "jpg", "JPG", "jpeg", "JPEG", "tif",
                                             "tiff", "pbm", "pgm", "ppm", "exr"};
    static const char *const endings[] = {"", "_mask", ".mask"};
    const int lengths[] = {(int)strlen(name), (int)orl_path_stem(name)};
    enum { TRIES = ORL_COUNT(lengths) * ORL_COUNT(endings) * ORL_COUNT(extensions) };
    for (size_t i = 0; i < TRIES; i++) {
        const char *extension = extensions[i / (ORL_COUNT(lengths) * ORL_COUNT(endings))];
        const char *ending = endings[i / ORL_COUNT(lengths) % ORL_COUNT(endings)];
        orl_path_print(path, dir, "%.*s%s.%s", lengths[i % ORL_COUNT(lengths)], name, ending, extension);
        if (orl_path_is_file(path))
            return true;
    }
    return false;
}
