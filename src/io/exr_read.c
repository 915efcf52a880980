// Reading OpenEXR: the first part, scanlines or tiles, any compression.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include <OpenEXR/openexr.h>

#include "core/file.h"
#include "io/exr.h"
#include "io/internal.h"

// Tiles and chunks are decoded whole, so a few hostile bytes could make Oriel allocate much memory.
enum { EXR_MAX_TILE_SIDE = 4096, EXR_MAX_CHUNK_MIB = 2048 };

struct exr_reader {
    struct orl_picture_file *file;
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
    return orl_fail(reader->file->log,
                    code == EXR_ERR_OUT_OF_MEMORY ? ORL_ERR_MEMORY : ORL_ERR_FORMAT,
                    "%s: OpenEXR: %s", reader->file->path,
                    *reader->message ? reader->message : exr_get_default_error_message(code));
}

// --- header ---

// NULL: the file has no such channel.
static const exr_attr_chlist_entry_t *find_channel(const struct exr_reader *reader, const char *name)
{
    const exr_attr_chlist_t *list = NULL;
    int count = exr_get_channels(reader->context, 0, &list) == EXR_ERR_SUCCESS ? list->num_channels : 0;
    for (int k = 0; k < count; k++)
        if (strcmp(list->entries[k].name.str, name) == 0)
            return &list->entries[k];
    return NULL;
}

static enum orl_result check_channels(const struct exr_reader *reader)
{
    for (int i = 0; i < reader->count; i++) {
        const exr_attr_chlist_entry_t *found = find_channel(reader, reader->names[i]);
        if (!found)
            return orl_fail(reader->file->log, ORL_ERR_NOT_FOUND, "%s: has no channel %s",
                            reader->file->path, reader->names[i]);
        if (found->x_sampling != 1 || found->y_sampling != 1)
            return orl_fail(reader->file->log, ORL_ERR_FORMAT, "%s: channel %s is subsampled",
                            reader->file->path, reader->names[i]);
    }
    return ORL_OK;
}

static enum orl_result start(struct exr_reader *reader)
{
    int32_t chunks = 0;
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    init.error_handler_fn = take_error;
    init.user_data = reader;
    init.max_image_width = ORL_IMAGE_MAX_SIDE;
    init.max_image_height = ORL_IMAGE_MAX_SIDE;
    init.max_tile_width = EXR_MAX_TILE_SIDE;
    init.max_tile_height = EXR_MAX_TILE_SIDE;
    // A truncated file must be refused rather than reconstructed.
    init.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    ORL_TRY(check(reader, exr_start_read(&reader->context, reader->file->path, &init)));
    ORL_TRY(check(reader, exr_get_data_window(reader->context, 0, &reader->window)));
    ORL_TRY(check(reader, exr_get_chunk_count(reader->context, 0, &chunks)));
    int64_t width = (int64_t)reader->window.max.x - reader->window.min.x + 1;
    int64_t height = (int64_t)reader->window.max.y - reader->window.min.y + 1;
    ORL_TRY(orl_picture_set_size(reader->file, width > 0 ? (uint64_t)width : 0, height > 0 ? (uint64_t)height : 0));
    // A header may claim any size, but each chunk takes 8 bytes in the chunk table and at least 8 bytes of its own.
    return orl_picture_check_bytes(reader->file, chunks < 1 ? UINT64_MAX : (uint64_t)chunks * 16);
}

static bool near(const double a[2], const double b[2])
{
    return fabs(a[0] - b[0]) < 1e-3 && fabs(a[1] - b[1]) < 1e-3;
}

// The profile of the primaries that the file states, unless they are those of Rec. 709.
static void read_profile(const struct exr_reader *reader)
{
    const struct orl_primaries *usual = &orl_primaries_rec709;
    struct orl_picture_file *file = reader->file;
    exr_attr_chromaticities_t c;
    if (exr_attr_get_chromaticities(reader->context, 0, "chromaticities", &c) != EXR_ERR_SUCCESS)
        return;
    const struct orl_primaries p = {
        .white = {(double)c.white_x, (double)c.white_y}, .red = {(double)c.red_x, (double)c.red_y},
        .green = {(double)c.green_x, (double)c.green_y}, .blue = {(double)c.blue_x, (double)c.blue_y}};
    if (!near(p.white, usual->white) || !near(p.red, usual->red) || !near(p.green, usual->green) ||
        !near(p.blue, usual->blue))
        file->profile = orl_profile_create_rgb(file->log, file->path, &p, 1);
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
            float *sample = image->f32 + pixel * (size_t)image->channels + (size_t)k;
            to->decode_to_ptr = (uint8_t *)sample;
            to->user_data_type = EXR_PIXEL_FLOAT;
            to->user_bytes_per_element = sizeof(float);
            to->user_pixel_stride = (int32_t)sizeof(float) * image->channels;
            to->user_line_stride = (int32_t)sizeof(float) * image->channels * image->width;
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

// Reads the named channels into as many of the image's, or more.
static enum orl_result read_part(struct exr_reader *reader, int channels)
{
    struct orl_picture_file *file = reader->file;
    exr_storage_t storage = EXR_STORAGE_LAST_TYPE;
    ORL_TRY(check(reader, exr_get_storage(reader->context, 0, &storage)));
    if (storage != EXR_STORAGE_SCANLINE && storage != EXR_STORAGE_TILED)
        return orl_fail(file->log, ORL_ERR_UNSUPPORTED, "%s: deep pictures cannot be read", file->path);
    ORL_TRY(check_channels(reader));
    ORL_TRY(orl_picture_check_memory(file, (uint64_t)channels * sizeof(float)));
    ORL_TRY(orl_image_init(file->log, reader->image, file->info.width, file->info.height, channels, ORL_PIXEL_F32));
    return read_chunks(reader, storage == EXR_STORAGE_TILED);
}

static void finish(struct exr_reader *reader)
{
    if (reader->pipe_ready)
        exr_decoding_destroy(reader->context, &reader->pipe);
    if (reader->context)
        exr_finish(&reader->context);
}

enum orl_result orl_exr_read_picture(struct orl_picture_file *file, struct orl_image *image)
{
    static const char *const rgb[] = {"R", "G", "B"}, *const luma[] = {"Y"};
    struct exr_reader reader = {.file = file, .names = rgb, .count = 3, .image = image};
    enum orl_result result = start(&reader);
    file->info.bits = 32;
    file->info.unbounded = file->light = true;
    bool gray = result == ORL_OK && find_channel(&reader, "Y") &&
                !(find_channel(&reader, "R") && find_channel(&reader, "G") && find_channel(&reader, "B"));
    // Luminance beside chroma is no grey picture; the chroma has half the size in each direction.
    if (gray && (find_channel(&reader, "RY") || find_channel(&reader, "BY")))
        result = orl_fail(file->log, ORL_ERR_UNSUPPORTED,
                          "%s: holds luminance and chroma (Y, RY, BY); Oriel reads RGB", file->path);
    if (result == ORL_OK && image) {
        if (gray) {
            reader.names = luma;
            reader.count = 1;
        } else {
            read_profile(&reader);
        }
        result = read_part(&reader, 3);
        size_t count = result == ORL_OK && gray ? orl_image_bytes(image) / sizeof(float) : 0;
        for (size_t i = 0; i < count; i++)
            image->f32[i] = image->f32[i / 3 * 3];
    }
    finish(&reader);
    return result;
}

enum orl_result orl_exr_read(const struct orl_log *log, const char *path,
                             const char *const *channels, int count, struct orl_image *image)
{
    memset(image, 0, sizeof *image);
    ORL_REQUIRE(log, count >= 1 && count <= 4);
    struct orl_picture_file file = {.log = log, .path = path};
    struct exr_reader reader = {.file = &file, .names = channels, .count = count, .image = image};
    ORL_TRY(orl_picture_open(&file));
    enum orl_result result = start(&reader);
    ORL_THEN(result, read_part(&reader, count));
    finish(&reader);
    fclose(file.stream);
    if (result != ORL_OK)
        orl_image_finish(image);
    return result;
}
