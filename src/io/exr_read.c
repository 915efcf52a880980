// Reading OpenEXR: the first part, scanlines or tiles, any compression.
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include <OpenEXR/openexr.h>

#include "core/file.h"
#include "io/exr.h"
#include "io/internal.h"

// Tiles and chunks are decoded whole, so a few hostile bytes could make Oriel allocate much memory.
enum { EXR_MAX_TILE_SIDE = 4096, EXR_MAX_CHUNK_MIB = 2048 };

struct exr_reader {
    const struct orl_log *log;
    const char *path;
    const char *const *names;
    int count;
    exr_context_t context;
    exr_decode_pipeline_t pipe;
    bool pipe_ready;
    exr_attr_box2i_t window;
    struct orl_image *image;
    char message[512];
};

static void take_error(exr_const_context_t context, exr_result_t code, const char *message)
{
    void *priv = NULL;
    (void)code;
    if (!context || exr_get_user_data(context, &priv) != EXR_ERR_SUCCESS || !priv)
        return;
    struct exr_reader *reader = priv;
    snprintf(reader->message, sizeof reader->message, "%s", message);
}

static enum orl_result check(const struct exr_reader *reader, exr_result_t code)
{
    if (code == EXR_ERR_SUCCESS)
        return ORL_OK;
    return orl_fail(reader->log,
                    code == EXR_ERR_OUT_OF_MEMORY ? ORL_ERR_MEMORY : ORL_ERR_FORMAT,
                    "%s: OpenEXR: %s", reader->path,
                    *reader->message ? reader->message : exr_get_default_error_message(code));
}

// --- header ---

static enum orl_result find_channels(const struct exr_reader *reader)
{
    const exr_attr_chlist_t *list = NULL;
    enum orl_result result = check(reader, exr_get_channels(reader->context, 0, &list));
    for (int i = 0; i < reader->count && result == ORL_OK; i++) {
        const exr_attr_chlist_entry_t *found = NULL;
        for (int k = 0; k < list->num_channels && !found; k++)
            if (strcmp(list->entries[k].name.str, reader->names[i]) == 0)
                found = &list->entries[k];
        if (!found)
            result = orl_fail(reader->log, ORL_ERR_NOT_FOUND, "%s: has no channel %s",
                              reader->path, reader->names[i]);
        else if (found->x_sampling != 1 || found->y_sampling != 1)
            result = orl_fail(reader->log, ORL_ERR_FORMAT, "%s: channel %s is subsampled",
                              reader->path, reader->names[i]);
    }
    return result;
}

// A header may claim any size, but each chunk takes 8 bytes in the chunk table and at least 8
// bytes of its own, so the file must be large enough for them.
static enum orl_result check_window(struct exr_reader *reader, int *width_out, int *height_out)
{
    struct stat st;
    int32_t chunks = 0;
    ORL_TRY(check(reader, exr_get_data_window(reader->context, 0, &reader->window)));
    ORL_TRY(check(reader, exr_get_chunk_count(reader->context, 0, &chunks)));
    int64_t width = (int64_t)reader->window.max.x - reader->window.min.x + 1;
    int64_t height = (int64_t)reader->window.max.y - reader->window.min.y + 1;
    ORL_TRY(orl_picture_check_size(reader->log, reader->path, width > 0 ? (uint64_t)width : 0,
                                   height > 0 ? (uint64_t)height : 0));
    if (stat(reader->path, &st) != 0 || chunks < 1 || (int64_t)chunks * 16 > (int64_t)st.st_size)
        return orl_fail(reader->log, ORL_ERR_FORMAT, "%s: too short for %lldx%lld pixels",
                        reader->path, (long long)width, (long long)height);
    *width_out = (int)width;
    *height_out = (int)height;
    return ORL_OK;
}

// --- pixels ---

// Decodes one chunk whose first sample belongs at column x, row y of the image.
static enum orl_result read_chunk(struct exr_reader *reader, const exr_chunk_info_t *chunk, int x, int y)
{
    exr_decode_pipeline_t *pipe = &reader->pipe;
    struct orl_image *image = reader->image;
    // The limit covers the whole chunk: channels that are not read are decoded too.
    if (chunk->unpacked_size > (uint64_t)EXR_MAX_CHUNK_MIB << 20)
        return check(reader, EXR_ERR_OUT_OF_MEMORY);
    if (chunk->width > image->width - x || chunk->height > image->height - y)
        return check(reader, EXR_ERR_BAD_CHUNK_LEADER);
    bool first = !reader->pipe_ready;
    ORL_TRY(check(reader, first ? exr_decoding_initialize(reader->context, 0, chunk, pipe)
                                : exr_decoding_update(reader->context, 0, chunk, pipe)));
    reader->pipe_ready = true;
    size_t pixel = (size_t)y * (size_t)image->width + (size_t)x;
    for (int i = 0; i < pipe->channel_count; i++) {
        exr_coding_channel_info_t *to = &pipe->channels[i];
        to->decode_to_ptr = NULL;
        for (int k = 0; k < reader->count; k++) {
            if (strcmp(to->channel_name, reader->names[k]) != 0)
                continue;
            float *sample = image->f32 + pixel * (size_t)reader->count + (size_t)k;
            to->decode_to_ptr = (uint8_t *)sample;
            to->user_data_type = EXR_PIXEL_FLOAT;
            to->user_bytes_per_element = sizeof(float);
            to->user_pixel_stride = (int32_t)sizeof(float) * reader->count;
            to->user_line_stride = (int32_t)sizeof(float) * reader->count * image->width;
        }
    }
    if (first)
        ORL_TRY(check(reader, exr_decoding_choose_default_routines(reader->context, 0, pipe)));
    return check(reader, exr_decoding_run(reader->context, 0, pipe));
}

// Reads the tiles of the finest level, or chunks of scanlines, which are tiles as wide as the picture.
static enum orl_result read_chunks(struct exr_reader *reader, bool tiled)
{
    const struct orl_image *image = reader->image;
    int32_t width = image->width, height = 0;
    ORL_TRY(check(reader, tiled ? exr_get_tile_sizes(reader->context, 0, 0, 0, &width, &height)
                                : exr_get_scanlines_per_chunk(reader->context, 0, &height)));
    if (width < 1 || height < 1)
        return check(reader, EXR_ERR_BAD_CHUNK_LEADER);
    for (int y = 0, row = 0; y < image->height; y += height, row++)
        for (int x = 0, column = 0; x < image->width; x += width, column++) {
            exr_chunk_info_t chunk;
            ORL_TRY(check(reader, tiled ? exr_read_tile_chunk_info(reader->context, 0, column, row, 0, 0, &chunk)
                                        : exr_read_scanline_chunk_info(reader->context, 0,
                                                                       reader->window.min.y + y, &chunk)));
            ORL_TRY(read_chunk(reader, &chunk, x, y));
        }
    return ORL_OK;
}

static enum orl_result read_part(struct exr_reader *reader)
{
    exr_storage_t storage = EXR_STORAGE_LAST_TYPE;
    ORL_TRY(check(reader, exr_get_storage(reader->context, 0, &storage)));
    if (storage != EXR_STORAGE_SCANLINE && storage != EXR_STORAGE_TILED)
        return orl_fail(reader->log, ORL_ERR_UNSUPPORTED, "%s: deep pictures cannot be read",
                        reader->path);
    int width = 0, height = 0;
    ORL_TRY(find_channels(reader));
    ORL_TRY(check_window(reader, &width, &height));
    ORL_TRY(orl_picture_check_memory(reader->log, reader->path, (uint64_t)width, (uint64_t)height,
                                     (uint64_t)reader->count * sizeof(float)));
    ORL_TRY(orl_image_init(reader->log, reader->image, width, height, reader->count, ORL_PIXEL_F32));
    return read_chunks(reader, storage == EXR_STORAGE_TILED);
}

static enum orl_result start(struct exr_reader *reader)
{
    if (!orl_path_is_file(reader->path))
        return orl_fail(reader->log, ORL_ERR_NOT_FOUND, "%s: no such file", reader->path);
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    init.error_handler_fn = take_error;
    init.user_data = reader;
    init.max_image_width = ORL_IMAGE_MAX_SIDE;
    init.max_image_height = ORL_IMAGE_MAX_SIDE;
    init.max_tile_width = EXR_MAX_TILE_SIDE;
    init.max_tile_height = EXR_MAX_TILE_SIDE;
    // A truncated file must be refused rather than reconstructed.
    init.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    return check(reader, exr_start_read(&reader->context, reader->path, &init));
}

enum orl_result orl_exr_size(const struct orl_log *log, const char *path, int *width, int *height)
{
    *width = *height = 0;
    struct exr_reader reader = {.log = log, .path = path};
    enum orl_result result = start(&reader);
    ORL_THEN(result, check_window(&reader, width, height));
    if (reader.context)
        exr_finish(&reader.context);
    return result;
}

static bool near(const double a[2], const double b[2])
{
    return fabs(a[0] - b[0]) < 1e-3 && fabs(a[1] - b[1]) < 1e-3;
}

bool orl_exr_primaries(const char *path, struct orl_primaries *primaries)
{
    struct exr_reader reader = {.path = path};
    exr_attr_chromaticities_t c;
    bool told = start(&reader) == ORL_OK &&
                exr_attr_get_chromaticities(reader.context, 0, "chromaticities", &c) == EXR_ERR_SUCCESS;
    if (told)
        *primaries = (struct orl_primaries){
            .white = {(double)c.white_x, (double)c.white_y}, .red = {(double)c.red_x, (double)c.red_y},
            .green = {(double)c.green_x, (double)c.green_y}, .blue = {(double)c.blue_x, (double)c.blue_y}};
    if (reader.context)
        exr_finish(&reader.context);
    const struct orl_primaries *usual = &orl_primaries_rec709;
    return told && !(near(primaries->white, usual->white) && near(primaries->red, usual->red) &&
                     near(primaries->green, usual->green) && near(primaries->blue, usual->blue));
}

enum orl_result orl_exr_read(const struct orl_log *log, const char *path,
                             const char *const *channels, int count, struct orl_image *image)
{
    memset(image, 0, sizeof *image);
    ORL_REQUIRE(log, count >= 1 && count <= 4);
    struct exr_reader reader = {.log = log, .path = path, .names = channels, .count = count,
                                .image = image};
    enum orl_result result = start(&reader);
    ORL_THEN(result, read_part(&reader));
    if (reader.pipe_ready)
        exr_decoding_destroy(reader.context, &reader.pipe);
    if (reader.context)
        exr_finish(&reader.context);
    if (result != ORL_OK)
        orl_image_finish(image);
    return result;
}
