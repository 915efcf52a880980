// Netpbm's binary pictures: PBM (P4), PGM (P5) and PPM (P6) of 8 bits, the formats of silhouettes
// and of video frames (netpbm.sourceforge.net/doc).
#include <ctype.h>

#include "io/internal.h"

struct pnm {
    int kind; // 4, 5 or 6
    uint64_t width, height, white;
    size_t start; // byte offset of the samples
};

// Reads the next number of the header, after any comments and white space.
static bool take_number(const uint8_t *data, size_t size, size_t *at, uint64_t *value)
{
    while (*at < size && (isspace(data[*at]) || data[*at] == '#')) {
        if (data[*at] == '#')
            while (*at < size && data[*at] != '\n')
                ++*at;
        else
            ++*at;
    }
    size_t first = *at;
    for (*value = 0; *at < size && isdigit(data[*at]) && *at - first < 10; ++*at)
        *value = 10 * *value + (uint64_t)(data[*at] - '0');
    return *at > first;
}

static enum orl_result parse_header(const struct orl_log *log, const char *path,
                                    const uint8_t *data, size_t size, struct pnm *pnm)
{
    size_t at = 2;
    pnm->kind = data[1] - '0';
    pnm->white = 1;
    if (!take_number(data, size, &at, &pnm->width) || !take_number(data, size, &at, &pnm->height) ||
        (pnm->kind != 4 && !take_number(data, size, &at, &pnm->white)) || at >= size ||
        !isspace(data[at]))
        return orl_fail(log, ORL_ERR_FORMAT, "%s: byte %zu: a number of the PNM header is missing",
                        path, at);
    pnm->start = at + 1;
    if (pnm->white < 1 || pnm->white > 255)
        return orl_fail(log, ORL_ERR_FORMAT, "%s: byte %zu: white is %llu; only 8-bit PNM files "
                        "are read", path, at, (unsigned long long)pnm->white);
    return orl_picture_check_size(log, path, pnm->width, pnm->height);
}

bool orl_pnm_is(const uint8_t *data, size_t size)
{
    return size >= 3 && data[0] == 'P' && data[1] >= '4' && data[1] <= '6' && isspace(data[2]);
}

enum orl_result orl_pnm_read_header(const struct orl_log *log, const char *path, FILE *stream,
                                    struct orl_picture_header *header)
{
    uint8_t data[4096];
    size_t size = fread(data, 1, sizeof data, stream);
    struct pnm pnm;
    if (!orl_pnm_is(data, size))
        return orl_fail(log, ORL_ERR_FORMAT, "%s: byte 0: not a binary PNM file", path);
    ORL_TRY(parse_header(log, path, data, size, &pnm));
    header->info = (struct orl_picture_info){.width = (int)pnm.width, .height = (int)pnm.height, .bits = 8};
    return ORL_OK;
}

// In a bitmap (P4) 1 is black.
static uint8_t sample(const struct pnm *pnm, const uint8_t *row, size_t i)
{
    if (pnm->kind == 4)
        return row[i / 8] >> (7 - i % 8) & 1 ? 0 : 255;
    uint64_t v = row[i] < pnm->white ? row[i] : pnm->white;
    return (uint8_t)((v * 255 + pnm->white / 2) / pnm->white);
}

enum orl_result orl_pnm_decode(const struct orl_log *log, const char *path, const uint8_t *data,
                               size_t size, struct orl_image *image)
{
    struct pnm pnm;
    ORL_TRY(parse_header(log, path, data, size, &pnm));
    size_t samples = (size_t)pnm.width * (pnm.kind == 6 ? 3 : 1);
    size_t row_bytes = pnm.kind == 4 ? (samples + 7) / 8 : samples;
    if (row_bytes * pnm.height > size - pnm.start)
        return orl_fail(log, ORL_ERR_FORMAT, "%s: byte %zu: %zu bytes of samples are needed, but "
                        "only %zu follow", path, pnm.start, row_bytes * (size_t)pnm.height,
                        size - pnm.start);
    ORL_TRY(orl_image_init(log, image, (int)pnm.width, (int)pnm.height, 3, ORL_PIXEL_U8));
    uint8_t *out = image->u8;
    for (size_t y = 0; y < pnm.height; y++) {
        const uint8_t *row = data + pnm.start + y * row_bytes;
        for (size_t i = 0; i < 3 * pnm.width; i++)
            *out++ = sample(&pnm, row, pnm.kind == 6 ? i : i / 3);
    }
    return ORL_OK;
}
