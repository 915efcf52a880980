// Pictures by content: JPEG or PNG.
#include "io/picture.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "core/file.h"
#include "io/internal.h"

enum format { FORMAT_UNKNOWN, FORMAT_JPEG, FORMAT_PNG };

static const size_t max_file_bytes = (size_t)1 << 30;

static enum format format_of(const uint8_t *data, size_t size)
{
    static const uint8_t png[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    if (size >= 3 && data[0] == 0xff && data[1] == 0xd8 && data[2] == 0xff)
        return FORMAT_JPEG;
    if (size >= sizeof png && memcmp(data, png, sizeof png) == 0)
        return FORMAT_PNG;
    return FORMAT_UNKNOWN;
}

static enum orl_result fail_unknown(const struct orl_log *log, const char *path)
{
    return orl_fail(log, ORL_ERR_FORMAT, "%s: neither JPEG nor PNG", path);
}

enum orl_result orl_picture_check_size(const struct orl_log *log, const char *path,
                                       uint64_t width, uint64_t height)
{
    if (width < 1 || height < 1 || width > ORL_IMAGE_MAX_SIDE || height > ORL_IMAGE_MAX_SIDE ||
        width * height > ORL_PICTURE_MAX_PIXELS)
        return orl_fail(log, ORL_ERR_FORMAT, "%s: its header asks for %llux%llu pixels", path,
                        (unsigned long long)width, (unsigned long long)height);
    return ORL_OK;
}

static enum orl_result read_header(const struct orl_log *log, const char *path,
                                   struct orl_picture_header *header)
{
    memset(header, 0, sizeof *header);
    uint8_t magic[8];
    struct stat st;
    if (stat(path, &st) == 0 && !S_ISREG(st.st_mode))
        return orl_fail(log, ORL_ERR_IO, "%s: not a regular file", path);
    FILE *stream = fopen(path, "rb");
    if (!stream)
        return orl_fail(log, errno == ENOENT ? ORL_ERR_NOT_FOUND : ORL_ERR_IO, "%s: %s", path,
                        strerror(errno));
    size_t got = fread(magic, 1, sizeof magic, stream);
    rewind(stream);
    enum orl_result result;
    switch (format_of(magic, got)) {
    case FORMAT_JPEG:
        result = orl_jpeg_read_header(log, path, stream, header);
        break;
    case FORMAT_PNG:
        result = orl_png_read_header(log, path, stream, header);
        break;
    default:
        result = fail_unknown(log, path);
    }
    fclose(stream);
    if (result != ORL_OK) {
        free(header->exif);
        memset(header, 0, sizeof *header);
    }
    return result;
}

enum orl_result orl_picture_size(const struct orl_log *log, const char *path, int *width,
                                 int *height)
{
    struct orl_picture_header header;
    enum orl_result result = read_header(log, path, &header);
    *width = header.width;
    *height = header.height;
    free(header.exif);
    return result;
}

enum orl_result orl_picture_read(const struct orl_log *log, const char *path, int channels,
                                 struct orl_image *image)
{
    memset(image, 0, sizeof *image);
    ORL_REQUIRE(log, channels == 1 || channels == 3);
    uint8_t *data;
    size_t size;
    enum orl_result result = orl_file_read(log, path, max_file_bytes, &data, &size);
    if (result != ORL_OK)
        return result;
    switch (format_of(data, size)) {
    case FORMAT_JPEG:
        result = orl_jpeg_decode(log, path, data, size, channels, image);
        break;
    case FORMAT_PNG:
        result = orl_png_decode(log, path, data, size, channels, image);
        break;
    default:
        result = fail_unknown(log, path);
    }
    if (result != ORL_OK)
        orl_image_finish(image);
    free(data);
    return result;
}

static bool has_exif_head(const struct orl_picture_header *header)
{
    return header->exif_size > 6 && memcmp(header->exif, "Exif\0", 6) == 0;
}

enum orl_result orl_exif_read(const struct orl_log *log, const char *path, struct orl_exif *exif)
{
    memset(exif, 0, sizeof *exif);
    struct orl_picture_header header;
    enum orl_result result = read_header(log, path, &header);
    if (result == ORL_OK && has_exif_head(&header))
        result = orl_exif_decode(log, path, header.exif, header.exif_size, exif);
    free(header.exif);
    return result;
}

bool orl_exif_exposure_ev(const struct orl_exif *exif, double *ev)
{
    *ev = 0;
    if (!(exif->exposure_s > 0))
        return false;
    double exposure = exif->exposure_s;
    if (exif->iso > 0)
        exposure *= exif->iso / 100;
    if (exif->aperture > 0)
        exposure /= exif->aperture * exif->aperture;
    *ev = log2(exposure);
    return isfinite(*ev);
}
