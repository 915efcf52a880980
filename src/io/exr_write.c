// Writing OpenEXR: one part, scanlines, ZIP or PIZ.
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <OpenEXR/openexr.h>

#include "core/file.h"
#include "core/memory.h"
#include "io/exr.h"

static const float half_max = 65504;

struct exr_writer {
    const struct orl_log *log;
    const char *path;
    const struct orl_exr_params *params;
    exr_context_t context;
    exr_encode_pipeline_t pipe;
    bool pipe_ready;
    exr_result_t (*compress)(exr_encode_pipeline_t *); // OpenEXRCore's own
    float *rows; // samples of one chunk, channel after channel
};

// OpenEXR holds the context's lock while it reports a write error, so any call that uses the
// context, even for our own data, would deadlock. The result code is reported instead.
static void drop_error(exr_const_context_t context, exr_result_t code, const char *message)
{
    (void)context;
    (void)code;
    (void)message;
}

static enum orl_result check(const struct exr_writer *writer, exr_result_t code)
{
    if (code == EXR_ERR_SUCCESS)
        return ORL_OK;
    return orl_fail(writer->log, code == EXR_ERR_OUT_OF_MEMORY ? ORL_ERR_MEMORY : ORL_ERR_IO,
                    "%s: cannot write OpenEXR: %s", writer->path,
                    code == EXR_ERR_WRITE_IO && errno ? strerror(errno)
                                                      : exr_get_default_error_message(code));
}

// --- camera attributes ---

// OpenEXR multiplies row vectors from the left, and its camera space has y up,
// whereas ours has y down (ImfStandardAttributes.h, worldToCamera).
static exr_attr_m44f_t world_to_camera(const struct orl_pose *pose)
{
    exr_attr_m44f_t m = {{0}};
    const double sign[3] = {1, -1, 1};
    for (int out = 0; out < 3; out++) {
        for (int in = 0; in < 3; in++)
            m.m[4 * in + out] = (float)(sign[out] * pose->r[out][in] + 0.0); // -0 becomes 0
        m.m[12 + out] = (float)(sign[out] * pose->t[out] + 0.0);
    }
    m.m[15] = 1;
    return m;
}

// (0, 0) to (1, 1) from the upper left to the lower right corner. The standard
// leaves NDC z free: 1 - 1/z, from the plane at distance 1 to infinity.
static exr_attr_m44f_t world_to_ndc(const struct orl_view *view)
{
    const struct orl_camera *c = &view->camera;
    const struct orl_pose *pose = &view->cam_from_world;
    exr_attr_m44f_t m = {{0}};
    for (int row = 0; row < 4; row++) {
        double x = row < 3 ? pose->r[0][row] : pose->t[0];
        double y = row < 3 ? pose->r[1][row] : pose->t[1];
        double z = row < 3 ? pose->r[2][row] : pose->t[2];
        m.m[4 * row + 0] = (float)((c->fx * x + c->cx * z) / c->width);
        m.m[4 * row + 1] = (float)((c->fy * y + c->cy * z) / c->height);
        m.m[4 * row + 2] = (float)(row < 3 ? z : z - 1);
        m.m[4 * row + 3] = (float)z;
    }
    return m;
}

// --- header ---

// The part of the plane at distance 1 that the picture shows, with y up.
static enum orl_result set_screen_window(const struct exr_writer *writer, const struct orl_camera *c)
{
    const exr_attr_v2f_t centre = {.x = (float)((0.5 * c->width - c->cx) / c->fx),
                                   .y = (float)((c->cy - 0.5 * c->height) / c->fy)};
    ORL_TRY(check(writer, exr_set_screen_window_width(writer->context, 0, (float)(c->width / c->fx))));
    return check(writer, exr_set_screen_window_center(writer->context, 0, &centre));
}

static enum orl_result set_attributes(const struct exr_writer *writer)
{
    const struct orl_exr_view_attributes *a = &writer->params->attributes;
    exr_context_t context = writer->context;
    ORL_TRY(check(writer, exr_attr_set_string(context, 0, "software", "Oriel " ORL_VERSION)));
    if (a->view) {
        exr_attr_m44f_t camera = world_to_camera(&a->view->cam_from_world);
        ORL_TRY(check(writer, exr_attr_set_m44f(context, 0, "worldToCamera", &camera)));
    }
    if (a->view && !a->latlong) {
        exr_attr_m44f_t ndc = world_to_ndc(a->view);
        ORL_TRY(check(writer, exr_attr_set_m44f(context, 0, "worldToNDC", &ndc)));
        ORL_TRY(set_screen_window(writer, &a->view->camera));
    }
    if (a->latlong)
        ORL_TRY(check(writer, exr_attr_set_envmap(context, 0, "envmap", EXR_ENVMAP_LATLONG)));
    if (a->srgb_primaries) {
        const exr_attr_chromaticities_t rec709 = {
            .red_x = 0.64f, .red_y = 0.33f, .green_x = 0.3f, .green_y = 0.6f,
            .blue_x = 0.15f, .blue_y = 0.06f, .white_x = 0.3127f, .white_y = 0.329f};
        ORL_TRY(check(writer, exr_attr_set_chromaticities(context, 0, "chromaticities", &rec709)));
    }
    if (a->comments && *a->comments)
        ORL_TRY(check(writer, exr_attr_set_string(context, 0, "comments", a->comments)));
    return ORL_OK;
}

static enum orl_result write_header(const struct exr_writer *writer)
{
    const struct orl_exr_params *params = writer->params;
    int part;
    ORL_TRY(check(writer, exr_add_part(writer->context, NULL, EXR_STORAGE_SCANLINE, &part)));
    ORL_TRY(check(writer, exr_initialize_required_attr_simple(
                              writer->context, part, params->width, params->height,
                              params->compression == ORL_EXR_PIZ ? EXR_COMPRESSION_PIZ : EXR_COMPRESSION_ZIP)));
    for (int i = 0; i < params->channel_count; i++) {
        const struct orl_exr_channel *channel = &params->channels[i];
        ORL_TRY(check(writer, exr_add_channel(writer->context, part, channel->name,
                                              channel->half ? EXR_PIXEL_HALF : EXR_PIXEL_FLOAT,
                                              EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1)));
    }
    ORL_TRY(set_attributes(writer));
    return check(writer, exr_write_header(writer->context));
}

// --- pixels ---

static const struct orl_exr_channel *find_channel(const struct orl_exr_params *params,
                                                  const char *name)
{
    for (int i = 0; i < params->channel_count; i++)
        if (strcmp(params->channels[i].name, name) == 0)
            return &params->channels[i];
    return NULL;
}

// Copies the chunk's samples to `to`. Values outside the range of half are clamped to it,
// since infinities would spread through any filter that reads the file.
static void gather(const struct orl_exr_params *params, const struct orl_exr_channel *channel,
                   int first_row, int rows, float *to)
{
    size_t width = (size_t)params->width, count = width * (size_t)rows;
    const float *from = channel->data + (size_t)first_row * width * channel->stride;
    for (size_t i = 0; i < count; i++) {
        float value = from[i * channel->stride];
        if (channel->half && isfinite(value))
            value = fminf(fmaxf(value, -half_max), half_max);
        to[i] = value;
    }
}

// When the compressed chunk is exactly as large as its samples, OpenEXRCore before 3.2 stores it
// compressed, but every reader takes a chunk of that size as uncompressed.
static exr_result_t compress(exr_encode_pipeline_t *pipe)
{
    const struct exr_writer *writer = pipe->encoding_user_data;
    exr_result_t code = writer->compress(pipe);
    if (code == EXR_ERR_SUCCESS && pipe->compressed_bytes >= pipe->packed_bytes &&
        pipe->compressed_alloc_size >= pipe->packed_bytes) {
        memcpy(pipe->compressed_buffer, pipe->packed_buffer, pipe->packed_bytes);
        pipe->compressed_bytes = pipe->packed_bytes;
    }
    return code;
}

static enum orl_result choose_routines(struct exr_writer *writer)
{
    exr_encode_pipeline_t *pipe = &writer->pipe;
    ORL_TRY(check(writer, exr_encoding_choose_default_routines(writer->context, 0, pipe)));
    if (pipe->compress_fn) {
        writer->compress = pipe->compress_fn;
        pipe->compress_fn = compress;
        pipe->encoding_user_data = writer;
    }
    return ORL_OK;
}

static enum orl_result write_chunk(struct exr_writer *writer, int y)
{
    exr_chunk_info_t chunk;
    exr_encode_pipeline_t *pipe = &writer->pipe;
    bool first = !writer->pipe_ready;
    ORL_TRY(check(writer, exr_write_scanline_chunk_info(writer->context, 0, y, &chunk)));
    ORL_TRY(check(writer, first ? exr_encoding_initialize(writer->context, 0, &chunk, pipe)
                                : exr_encoding_update(writer->context, 0, &chunk, pipe)));
    writer->pipe_ready = true;
    size_t samples = (size_t)chunk.width * (size_t)chunk.height;
    for (int i = 0; i < pipe->channel_count; i++) {
        exr_coding_channel_info_t *to = &pipe->channels[i];
        const struct orl_exr_channel *from = find_channel(writer->params, to->channel_name);
        float *rows = writer->rows + (size_t)i * samples;
        if (!from)
            return check(writer, EXR_ERR_INVALID_ARGUMENT);
        gather(writer->params, from, y, chunk.height, rows);
        to->user_data_type = EXR_PIXEL_FLOAT;
        to->user_bytes_per_element = sizeof(float);
        to->user_pixel_stride = sizeof(float);
        to->user_line_stride = (int32_t)((size_t)chunk.width * sizeof(float));
        to->encode_from_ptr = (const uint8_t *)rows;
    }
    if (first)
        ORL_TRY(choose_routines(writer));
    return check(writer, exr_encoding_run(writer->context, 0, pipe));
}

static enum orl_result write_all(struct exr_writer *writer)
{
    const struct orl_exr_params *params = writer->params;
    int32_t lines = 0;
    ORL_TRY(write_header(writer));
    ORL_TRY(check(writer, exr_get_scanlines_per_chunk(writer->context, 0, &lines)));
    writer->rows = orl_array(writer->log,
                             (size_t)params->width * (size_t)lines * (size_t)params->channel_count,
                             sizeof *writer->rows);
    ORL_TRY_MEMORY(writer->rows);
    for (int y = 0; y < params->height; y += lines)
        ORL_TRY(write_chunk(writer, y));
    return ORL_OK;
}

static bool params_valid(const struct orl_exr_params *params)
{
    if (params->width < 1 || params->width > ORL_IMAGE_MAX_SIDE || params->height < 1 ||
        params->height > ORL_IMAGE_MAX_SIDE || params->channel_count < 1 ||
        params->channel_count > ORL_EXR_CHANNELS_MAX)
        return false;
    for (int i = 0; i < params->channel_count; i++) {
        const struct orl_exr_channel *channel = &params->channels[i];
        if (!channel->data || !channel->stride || !channel->name[0] ||
            !memchr(channel->name, '\0', sizeof channel->name) ||
            find_channel(params, channel->name) != channel)
            return false;
    }
    const struct orl_view *view = params->attributes.view;
    return !view || orl_camera_valid(&view->camera);
}

bool orl_exr_add_channel(struct orl_exr_params *params, const char *name, bool half,
                         const struct orl_image *image, int index)
{
    if (params->channel_count >= ORL_EXR_CHANNELS_MAX)
        return false;
    struct orl_exr_channel *channel = &params->channels[params->channel_count];
    if (strlen(name) >= sizeof channel->name)
        return false;
    snprintf(channel->name, sizeof channel->name, "%s", name);
    channel->half = half;
    channel->data = image->f32 + index;
    channel->stride = (size_t)image->channels;
    params->channel_count++;
    return true;
}

enum orl_result orl_exr_write(const struct orl_log *log, const char *path,
                              const struct orl_exr_params *params)
{
    ORL_REQUIRE(log, params_valid(params));
    struct exr_writer writer = {.log = log, .path = path, .params = params};
    struct orl_atomic_file file = {0};
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    init.error_handler_fn = drop_error;
    ORL_TRY(orl_atomic_begin(log, path, &file));
    errno = 0; // it tells why OpenEXR cannot write
    enum orl_result result =
        check(&writer, exr_start_write(&writer.context, file.temp, EXR_WRITE_FILE_DIRECTLY, &init));
    ORL_THEN(result, write_all(&writer));
    if (writer.pipe_ready)
        exr_encoding_destroy(writer.context, &writer.pipe);
    if (writer.context) {
        exr_result_t code = exr_finish(&writer.context); // writes the chunk table
        ORL_THEN(result, check(&writer, code));
    }
    ORL_THEN(result, orl_atomic_commit(log, &file));
    orl_atomic_abort(&file);
    free(writer.rows);
    return result;
}

enum orl_result orl_linear_write(const struct orl_log *log, const char *path,
                                 const struct orl_image *image)
{
    ORL_REQUIRE(log, image->data && image->type == ORL_PIXEL_F32 && image->channels == 3);
    static const char *const rgb[] = {"R", "G", "B"};
    struct orl_exr_params exr = {
        .width = image->width, .height = image->height, .compression = ORL_EXR_PIZ,
        .attributes = {.srgb_primaries = true,
                       .comments = "linear light; 1 is white of the 8-bit picture"}};
    for (int c = 0; c < 3; c++)
        ORL_REQUIRE(log, orl_exr_add_channel(&exr, rgb[c], true, image, c));
    return orl_exr_write(log, path, &exr);
}
