#include "oriel/image.h"

#include <stdlib.h>
#include <string.h>

#include "core/memory.h"

static size_t pixel_size(enum orl_pixel type)
{
    return type == ORL_PIXEL_F32 ? sizeof(float) : 1;
}

enum orl_result orl_image_init(const struct orl_log *log, struct orl_image *image, int width,
                               int height, int channels, enum orl_pixel type)
{
    memset(image, 0, sizeof *image);
    if (width < 1 || height < 1 || width > ORL_IMAGE_MAX_SIDE || height > ORL_IMAGE_MAX_SIDE ||
        channels < 1 || channels > 4)
        return orl_fail(log, ORL_ERR_ARGUMENT, "image of %dx%d pixels, %d channels", width,
                        height, channels);
    // At most 2^32 pixels of 16 bytes each, which fits 64 bits.
    void *data = orl_array(log, (size_t)width * (size_t)height,
                           (size_t)channels * pixel_size(type));
    ORL_TRY_MEMORY(data);
    *image = (struct orl_image){.width = width, .height = height, .channels = channels,
                                .type = type, .data = data};
    return ORL_OK;
}

void orl_image_finish(struct orl_image *image)
{
    if (!image)
        return;
    free(image->data);
    memset(image, 0, sizeof *image);
}

size_t orl_image_bytes(const struct orl_image *image)
{
    return (size_t)image->width * (size_t)image->height * (size_t)image->channels *
           pixel_size(image->type);
}
