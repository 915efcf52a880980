// Netpbm's binary pictures: PBM (P4), PGM (P5) and PPM (P6) of 8 bits, the formats of silhouettes
// and of video frames (netpbm.sourceforge.net/doc).
#include <ctype.h>
#include <stdlib.h>

#include "core/file.h"
#include "io/internal.h"

// Reads the next number of the header, after any comments and white space.
static bool take_number(FILE *stream, uint64_t *value)
{
    int c = getc(stream), digits = 0;
    while (isspace(c) || c == '#')
        if (c == '#')
            while (c != '\n' && c != EOF)
                c = getc(stream);
        else
            c = getc(stream);
    for (*value = 0; isdigit(c) && digits < 10; digits++, c = getc(stream))
        *value = 10 * *value + (uint64_t)(c - '0');
    ungetc(c, stream);
    return digits > 0;
}

// kind: 4, 5 or 6
static enum orl_result read_header(struct orl_picture_file *file, int *kind, uint64_t *white)
{
    uint64_t width = 0, height = 0;
    (void)getc(file->stream);
    *kind = getc(file->stream) - '0';
    *white = 1;
    bool whole = isspace(getc(file->stream)) && take_number(file->stream, &width) &&
                 take_number(file->stream, &height) && (*kind == 4 || take_number(file->stream, white)) &&
                 isspace(getc(file->stream));
    if (!whole)
        return orl_fail(file->log, ORL_ERR_FORMAT, "%s: byte %ld: a number of the PNM header is missing", file->path,
                        ftell(file->stream));
    if (*white < 1 || *white > 255)
        return orl_fail(file->log, ORL_ERR_FORMAT, "%s: byte %ld: white is %llu; only 8-bit PNM files are read",
                        file->path, ftell(file->stream), (unsigned long long)*white);
    file->info.bits = 8;
    return orl_picture_set_size(file, width, height);
}

// In a bitmap (P4) 1 is black.
static uint8_t sample(int kind, uint64_t white, const uint8_t *row, size_t i)
{
    if (kind == 4)
        return row[i / 8] >> (7 - i % 8) & 1 ? 0 : 255;
    uint64_t v = row[i] < white ? row[i] : white;
    return (uint8_t)((v * 255 + white / 2) / white);
}

enum orl_result orl_pnm_read(struct orl_picture_file *file, struct orl_image *image)
{
    int kind;
    uint64_t white;
    ORL_TRY(read_header(file, &kind, &white));
    if (!image)
        return ORL_OK;
    size_t width = (size_t)file->info.width, height = (size_t)file->info.height;
    size_t row_bytes = kind == 4 ? (width + 7) / 8 : kind == 5 ? width : 3 * width;
    uint64_t start = (uint64_t)ftell(file->stream);
    if (row_bytes * height > file->bytes - start)
        return orl_fail(file->log, ORL_ERR_FORMAT, "%s: byte %llu: %zu bytes of samples are needed, but "
                        "only %llu follow", file->path, (unsigned long long)start, row_bytes * height,
                        (unsigned long long)(file->bytes - start));
    uint8_t *row = orl_array(file->log, row_bytes, 1);
    ORL_TRY_MEMORY(row);
    enum orl_result result = orl_image_init(file->log, image, file->info.width, file->info.height, 3, ORL_PIXEL_U8);
    for (size_t y = 0; result == ORL_OK && y < height; y++) {
        if (fread(row, row_bytes, 1, file->stream) != 1)
            result = orl_file_failed(file->log, file->path);
        for (size_t i = 0; i < 3 * width; i++)
            image->u8[3 * width * y + i] = sample(kind, white, row, kind == 6 ? i : i / 3);
    }
    free(row);
    return result;
}
