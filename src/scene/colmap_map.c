// COLMAP's depth and normal maps (src/mvs/mat.h): "W&H&C&" and planes of float32.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "scene/colmap.h"

// Length of the header, 0 when it is damaged. A zero byte follows the data.
static size_t parse_header(const uint8_t *data, unsigned long dims[3])
{
    char number[3][16];
    int length = 0;
    if (sscanf((const char *)data, "%15[0-9]&%15[0-9]&%15[0-9]&%n", number[0], number[1], number[2], &length) < 3)
        return 0;
    for (int i = 0; i < 3; i++)
        dims[i] = strtoul(number[i], NULL, 10);
    return (size_t)length;
}

enum orl_result orl_colmap_map_read(const struct orl_log *log, const char *path,
                                    struct orl_image *image)
{
    memset(image, 0, sizeof *image);
    uint8_t *data = NULL;
    size_t size;
    ORL_TRY(orl_file_read(log, path, SIZE_MAX / 2, &data, &size));
    unsigned long dims[3] = {0};
    size_t header = parse_header(data, dims);
    bool sound = header && dims[0] >= 1 && dims[1] >= 1 && dims[2] >= 1 && dims[0] <= ORL_IMAGE_MAX_SIDE &&
                 dims[1] <= ORL_IMAGE_MAX_SIDE && dims[2] <= 4;
    size_t pixels = sound ? dims[0] * dims[1] : 0, expected = pixels * dims[2] * sizeof(float); // at most 2^36
    enum orl_result result = ORL_OK;
    if (!sound)
        result = orl_fail(log, ORL_ERR_FORMAT,
                          "%s: byte 0: not the WIDTH&HEIGHT&CHANNELS& of a COLMAP map", path);
    else if (size - header != expected)
        result = orl_fail(log, ORL_ERR_FORMAT,
                          "%s: byte %zu: %lux%lux%lu values need %zu bytes, but %zu follow", path,
                          header, dims[0], dims[1], dims[2], expected, size - header);
    ORL_THEN(result, orl_image_init(log, image, (int)dims[0], (int)dims[1], (int)dims[2], ORL_PIXEL_F32));
    const uint8_t *sample = data + header;
    for (size_t c = 0; result == ORL_OK && c < dims[2]; c++)
        for (size_t i = 0; i < pixels; i++, sample += sizeof(float))
            memcpy(&image->f32[i * dims[2] + c], sample, sizeof(float));
    free(data);
    return result;
}

enum orl_result orl_colmap_map_write(const struct orl_log *log, const char *path,
                                     const struct orl_image *image)
{
    ORL_REQUIRE(log, image->type == ORL_PIXEL_F32 && image->data);
    size_t channels = (size_t)image->channels;
    struct orl_atomic_file file;
    ORL_TRY(orl_atomic_open(log, path, &file));
    fprintf(file.stream, "%d&%d&%d&", image->width, image->height, image->channels);
    for (size_t c = 0; c < channels; c++)
        for (size_t i = c; i < orl_image_bytes(image) / sizeof(float); i += channels)
            fwrite(&image->f32[i], sizeof(float), 1, file.stream);
    return orl_atomic_commit(log, &file);
}
