// Downsampling of supersampled frames.
#include <math.h>
#include <string.h>

#include "hdr/internal.h"

static enum orl_result reduce_mean(const struct orl_log *log, const struct orl_image *fine,
                                   int factor, struct orl_image *out)
{
    ORL_TRY(orl_image_init(log, out, fine->width / factor, fine->height / factor, fine->channels,
                           ORL_PIXEL_F32));
    size_t channels = (size_t)fine->channels, width = (size_t)fine->width;
    size_t side = (size_t)factor;
    float share = 1 / (float)(factor * factor);
    for (size_t y = 0; y < (size_t)out->height; y++)
        for (size_t x = 0; x < (size_t)out->width; x++)
            for (size_t c = 0; c < channels; c++) {
                float sum = 0;
                for (size_t k = 0; k < side * side; k++)
                    sum += fine->f32[((y * side + k / side) * width + x * side + k % side) *
                                         channels + c];
                out->f32[(y * (size_t)out->width + x) * channels + c] = sum * share;
            }
    return ORL_OK;
}

// Takes the median, since a mean of two depths at an edge would lie on neither surface.
static void reduce_depth(const struct orl_image *fine, int factor, struct orl_image *out)
{
    float found[16];
    for (int y = 0; y < out->height; y++)
        for (int x = 0; x < out->width; x++) {
            int count = 0;
            for (int k = 0; k < factor * factor; k++) {
                float z = fine->f32[(size_t)(y * factor + k / factor) * (size_t)fine->width +
                                    (size_t)(x * factor + k % factor)];
                int at = count;
                if (!(z > 0))
                    continue;
                for (; at > 0 && found[at - 1] > z; at--)
                    found[at] = found[at - 1];
                found[at] = z;
                count++;
            }
            out->f32[(size_t)y * (size_t)out->width + (size_t)x] =
                count ? found[(count - 1) / 2] : 0;
        }
}

static void normalize(struct orl_image *normals)
{
    size_t count = (size_t)normals->width * (size_t)normals->height;
    for (size_t i = 0; i < count; i++) {
        float *n = normals->f32 + 3 * i;
        float length = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        for (int c = 0; c < 3 && length > 0; c++)
            n[c] /= length;
    }
}

enum orl_result orl_frame_reduce(const struct orl_log *log, const struct orl_frame *fine,
                                 int factor, struct orl_frame *frame)
{
    memset(frame, 0, sizeof *frame);
    ORL_REQUIRE(log, factor >= 1 && factor <= 4);
    enum orl_result result = reduce_mean(log, &fine->color, factor, &frame->color);
    ORL_THEN(result, reduce_mean(log, &fine->depth, factor, &frame->depth));
    ORL_THEN(result, reduce_mean(log, &fine->normal, factor, &frame->normal));
    ORL_THEN(result, reduce_mean(log, &fine->coverage, factor, &frame->coverage));
    ORL_THEN(result, reduce_mean(log, &fine->confidence, factor, &frame->confidence));
    if (result == ORL_OK) {
        reduce_depth(&fine->depth, factor, &frame->depth);
        normalize(&frame->normal);
    } else {
        orl_frame_finish(frame);
    }
    return result;
}
