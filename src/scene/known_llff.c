// LLFF's poses_bounds.npy (Mildenhall et al. 2019, "Local light field fusion"): NumPy's array of 17
// numbers a picture, in the order of the pictures' names: 3 rows of 5, which are the camera's axes
// (down, right, backwards), its place, and height, width, focal length; then the nearest and farthest depth.
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "scene/known_internal.h"

enum { NUMBERS = 17, PICTURES_MAX = 100000 };

static enum orl_result bad(const struct orl_known_source *source, const char *why)
{
    return orl_fail(source->log, ORL_ERR_FORMAT, "%s: %s", source->path, why);
}

// The text after a key of NumPy's header, a Python dictionary; NULL: it is missing.
static const char *value_of(const char *header, const char *key)
{
    const char *at = strstr(header, key);
    at = at ? strchr(at, ':') : NULL;
    return at ? at + 1 + strspn(at + 1, " ") : NULL;
}

// Checks NumPy's header (format 1.0 to 3.0) and finds the numbers behind it.
static enum orl_result find_numbers(const struct orl_known_source *source, size_t *count, size_t *at)
{
    const uint8_t *data = source->data;
    const size_t size = source->size;
    char header[512] = "";
    if (size < 12 || memcmp(data, "\x93NUMPY", 6) != 0 || data[6] < 1 || data[6] > 3)
        return bad(source, "not NumPy's array");
    size_t start = data[6] == 1 ? 10 : 12, length = data[8] | (size_t)data[9] << 8;
    if (data[6] > 1)
        length |= (size_t)data[10] << 16 | (size_t)data[11] << 24;
    if (length >= sizeof header || length > size - start)
        return bad(source, "NumPy's header is too long");
    memcpy(header, data + start, length);
    const char *type = value_of(header, "'descr'"), *order = value_of(header, "'fortran_order'");
    const char *shape = value_of(header, "'shape'");
    char *end = NULL;
    if (!type || strncmp(type, "'<f8'", 5) != 0 || !order || strncmp(order, "False", 5) != 0)
        return bad(source, "not 64-bit numbers, row by row");
    unsigned long rows = shape && *shape == '(' ? strtoul(shape + 1, &end, 10) : 0;
    if (!rows || rows > PICTURES_MAX || !end || strncmp(end, ", 17)", 5) != 0)
        return bad(source, "not 17 numbers for each picture");
    *count = rows;
    *at = start + length;
    return *count * NUMBERS * sizeof(double) == size - *at
               ? ORL_OK : bad(source, "not as many numbers as its header says");
}

static enum orl_result read_pose(const struct orl_known_source *source, const double numbers[NUMBERS],
                                 const char *path, struct orl_known_cameras *known)
{
    struct orl_known_camera camera = {.path = path, .place = path};
    double axes[3][3], centre[3], height = numbers[4], width = numbers[9], focal = numbers[14];
    for (int i = 0; i < 3; i++) {
        axes[i][0] = numbers[5 * i + 1];  // right
        axes[i][1] = numbers[5 * i];      // down
        axes[i][2] = -numbers[5 * i + 2]; // forward
        centre[i] = numbers[5 * i + 3];
    }
    if (!(width >= 1 && width <= ORL_IMAGE_MAX_SIDE && height >= 1 && height <= ORL_IMAGE_MAX_SIDE) ||
        !orl_pose_from_axes(axes, centre, &camera.pose))
        return orl_fail(source->log, ORL_ERR_FORMAT, "%s: picture %s: no size, or its pose is not a rotation "
                        "and a place", source->path, path);
    camera.width = (int)width;
    camera.height = (int)height;
    const double f_c[4] = {focal, focal, 0.5 * camera.width, 0.5 * camera.height};
    orl_known_set_lens(&camera, f_c, NULL, 0, false);
    return orl_known_add(source, &camera, known);
}

// The file has no names: the pictures are those of images/ beside it, in order of name.
static enum orl_result list_pictures(const struct orl_known_source *source, const char *folder,
                                     struct orl_names *names)
{
    const char *dir = ORL_PATH(folder, "images");
    struct orl_names all = {0};
    enum orl_result result =
        orl_path_is_dir(dir) ? orl_dir_list(source->log, dir, &all)
                             : orl_fail(source->log, ORL_ERR_NOT_FOUND, "%s: its pictures must be in %s, since "
                                        "it does not name them", source->path, dir);
    for (size_t i = 0; result == ORL_OK && i < all.count; i++)
        if (*all.items[i] != '.' && strcmp(all.items[i], "Thumbs.db") != 0)
            result = orl_names_add(source->log, names, all.items[i]);
    orl_names_finish(&all);
    return result;
}

enum orl_result orl_known_read_llff(const struct orl_known_source *source,
                                    struct orl_known_cameras *known)
{
    size_t count = 0, at = 0;
    struct orl_names names = {0};
    enum orl_result result = find_numbers(source, &count, &at);
    ORL_THEN(result, list_pictures(source, known->folder, &names));
    if (result == ORL_OK && names.count != count)
        result = orl_fail(source->log, ORL_ERR_DATA, "%s: %zu cameras, but images/ has %zu files",
                          source->path, count, names.count);
    for (size_t i = 0; result == ORL_OK && i < count; i++) {
        double numbers[NUMBERS];
        memcpy(numbers, source->data + at + i * sizeof numbers, sizeof numbers);
        result = read_pose(source, numbers, ORL_PATH("images", "%s", names.items[i]), known);
    }
    orl_names_finish(&names);
    return result;
}
