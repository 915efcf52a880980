// Photographs, as every reader of them sees them.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "fuzz.h"
#include "io/exr.h"
#include "io/internal.h"
#include "io/picture.h"
#include "io/stream.h"

static void write_again(const struct orl_image *image)
{
    static const struct orl_exif exif = {.make = "Oriel", .exposure_s = 0.004, .iso = 70000};
    uint8_t *jpeg;
    size_t size;
    if (orl_image_bytes(image) > 1 << 16)
        return;
    fuzz_require(orl_jpeg_encode(&fuzz_log, image, 75, &jpeg, &size) == ORL_OK,
                 "a picture can be sent");
    free(jpeg);
    fuzz_require(orl_png_write(&fuzz_log, fuzz_path("again.png"), image) == ORL_OK &&
                     orl_jpeg_write(&fuzz_log, fuzz_path("again.jpg"), image, 90, &exif) == ORL_OK,
                 "a picture can be written");
}

static void read_picture(const char *name)
{
    struct orl_picture_info info;
    struct orl_image image;
    double ev;
    int width = 0, height = 0;
    const char *path = fuzz_path(name);
    bool known = orl_picture_inspect(&fuzz_log, path, &info) == ORL_OK;
    if (known)
        (void)orl_exif_exposure_ev(&info.exif, &ev);
    (void)!orl_picture_size(&fuzz_log, path, &width, &height);
    for (int channels = 1; channels <= 3; channels += 2) {
        path = fuzz_path(name);
        if (orl_picture_read(&fuzz_log, path, channels, &image) == ORL_OK) {
            fuzz_require(known && image.width == info.width && image.height == info.height,
                         "the header says the picture's size");
            write_again(&image);
        }
        orl_image_finish(&image);
    }
    (void)!orl_picture_read_linear(&fuzz_log, fuzz_path(name), &image);
    orl_image_finish(&image);
}

// Inputs of one kind only: the others have targets of their own.
static void read_if(bool kind, const char *name, const uint8_t *data, size_t size)
{
    if (!kind)
        return;
    fuzz_save(name, data, size);
    read_picture(name);
}

void fuzz_jpeg(const uint8_t *data, size_t size)
{
    read_if(size > 2 && data[0] == 0xff && data[1] == 0xd8, "a.jpg", data, size);
}

void fuzz_png(const uint8_t *data, size_t size)
{
    read_if(size > 2 && data[0] == 0x89, "a.png", data, size);
}

// As a pipe brings it: pictures are the same however many bytes are there at a time.
void fuzz_stream(const uint8_t *data, size_t size)
{
    size_t begin, length, first, first_length;
    for (size_t at = 0; at < size; at += begin + length) {
        bool found = orl_stream_find_picture(data + at, size - at, &begin, &length);
        fuzz_require(found == (length > 0) && begin + length <= size - at, "a picture lies within the bytes");
        if (!found)
            break;
        fuzz_require(orl_stream_find_picture(data + at, begin + length, &first, &first_length) &&
                         first == begin && first_length == length,
                     "no more than its bytes are needed");
        fuzz_require(!orl_stream_find_picture(data + at, begin + length - 1, &first, &first_length) &&
                         first == begin,
                     "and no fewer");
    }
}

void fuzz_tiff(const uint8_t *data, size_t size)
{
    read_if(size > 2 && (data[0] == 'I' || data[0] == 'M'), "a.tif", data, size);
}

void fuzz_heif(const uint8_t *data, size_t size)
{
    read_if(size > 12 && memcmp(data + 4, "ftyp", 4) == 0, "a.heic", data, size);
}

void fuzz_raw(const uint8_t *data, size_t size)
{
    read_if(true, "a.dng", data, size);
}

void fuzz_exr(const uint8_t *data, size_t size)
{
    static const char *const names[] = {"R", "depth.Z"};
    struct orl_image image;
    read_if(size > 2 && data[0] == 0x76, "a.exr", data, size);
    fuzz_save("a.exr", data, size);
    (void)!orl_exr_read(&fuzz_log, fuzz_path("a.exr"), names, 2, &image);
    orl_image_finish(&image);
}

void fuzz_exif(const uint8_t *data, size_t size)
{
    struct orl_exif exif, again;
    uint8_t *block;
    size_t length;
    // What follows "Exif\0\0" is decoded.
    if (size < 6 || orl_exif_decode(&fuzz_log, "exif", data + 6, size - 6, &exif) != ORL_OK)
        return;
    fuzz_require(isfinite(exif.exposure_s) && isfinite(exif.aperture) && isfinite(exif.iso) &&
                     isfinite(exif.bias_ev) && exif.orientation >= 0 && exif.orientation <= 8,
                 "EXIF's numbers are numbers");
    fuzz_require(orl_exif_encode(&fuzz_log, &exif, &block, &length) == ORL_OK &&
                     orl_exif_decode(&fuzz_log, "exif", block + 6, length - 6, &again) == ORL_OK,
                 "EXIF can be written");
    free(block);
}
