#include "preprocess/expose/samples.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/color.h"
#include "core/file.h"
#include "core/memory.h"
#include "core/order.h"
#include "io/picture.h"
#include "scene/depth_buffer.h"
#include "scene/meter.h"

enum {
    LEVELS_MAX = 8,       // of a photograph's pyramid
    POINTS = 30000,       // that are examined,
    POINTS_OF_PHOTO = 100, // and more for each photograph
};
static const uint8_t CLIPPED = 254, BLACK = 0;
static const float SPOILT_MAX = 0.02f; // greatest fraction of clipped pixels in a patch
static const float CONTRAST_MAX = 0.5f; // (brightest - darkest) / mean within a patch, linear
static const double COSINE_MIN = 0.35;  // of the angle between normal and viewing direction

// --- a photograph at several scales ---

struct texel {
    float rgb[3];    // linear
    float spoilt[3]; // fraction of pixels that are clipped or black, by channel
};

struct pyramid {
    struct orl_image image;
    int width[LEVELS_MAX], height[LEVELS_MAX], levels;
    struct texel *level[LEVELS_MAX]; // owned; level 0 is the image itself
    float linear[256];
};

static struct texel fetch(const struct pyramid *p, int level, int x, int y)
{
    x = x < 0 ? 0 : x >= p->width[level] ? p->width[level] - 1 : x;
    y = y < 0 ? 0 : y >= p->height[level] ? p->height[level] - 1 : y;
    size_t at = (size_t)y * (size_t)p->width[level] + (size_t)x;
    if (level > 0)
        return p->level[level][at];
    const uint8_t *v = p->image.u8 + 3 * at;
    struct texel texel = {{p->linear[v[0]], p->linear[v[1]], p->linear[v[2]]}, {0}};
    for (int c = 0; c < 3; c++)
        texel.spoilt[c] = v[c] >= CLIPPED || v[c] <= BLACK;
    return texel;
}

static enum orl_result make_level(const struct orl_log *log, struct pyramid *p, int level)
{
    int width = (p->width[level - 1] + 1) / 2, height = (p->height[level - 1] + 1) / 2;
    struct texel *out = orl_array(log, (size_t)width * (size_t)height, sizeof *out);
    ORL_TRY_MEMORY(out);
    p->width[level] = width;
    p->height[level] = height;
    p->level[level] = out;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++, out++)
            for (int k = 0; k < 4; k++) {
                struct texel from = fetch(p, level - 1, 2 * x + (k & 1), 2 * y + (k >> 1));
                for (int c = 0; c < 3; c++) {
                    out->rgb[c] += 0.25f * from.rgb[c];
                    out->spoilt[c] += 0.25f * from.spoilt[c];
                }
            }
    return ORL_OK;
}

static enum orl_result make_pyramid(const struct orl_log *log, const char *dir,
                                    const struct orl_exposed *photo, struct pyramid *p)
{
    const struct orl_camera *c = &photo->view.camera;
    const char *path = ORL_PATH(dir, "%s", photo->name);
    ORL_TRY(orl_picture_read(log, path, 3, &p->image));
    if (p->image.width != c->width || p->image.height != c->height)
        return orl_fail(log, ORL_ERR_FORMAT, "%s: %dx%d pixels, but its camera has %dx%d",
                        path, p->image.width, p->image.height, c->width, c->height);
    for (int v = 0; v < 256; v++)
        p->linear[v] = orl_srgb_decode((float)v / 255);
    p->width[0] = p->image.width;
    p->height[0] = p->image.height;
    for (p->levels = 1; p->levels < LEVELS_MAX; p->levels++) {
        if (p->width[p->levels - 1] < 8 || p->height[p->levels - 1] < 8)
            break;
        ORL_TRY(make_level(log, p, p->levels));
    }
    return ORL_OK;
}

static void finish_pyramid(struct pyramid *p)
{
    orl_image_finish(&p->image);
    for (int i = 1; i < LEVELS_MAX; i++)
        free(p->level[i]);
}

// Interpolates between texels, so that the mean is continuous in the position.
static struct texel bilinear(const struct pyramid *p, int level, double x, double y)
{
    int left = (int)floor(x - 0.5), top = (int)floor(y - 0.5);
    float u = (float)(x - 0.5 - left), v = (float)(y - 0.5 - top);
    struct texel sum = {0};
    for (int k = 0; k < 4; k++) {
        struct texel from = fetch(p, level, left + (k & 1), top + (k >> 1));
        float w = (k & 1 ? u : 1 - u) * (k >> 1 ? v : 1 - v);
        for (int c = 0; c < 3; c++) {
            sum.rgb[c] += w * from.rgb[c];
            sum.spoilt[c] += w * from.spoilt[c];
        }
    }
    return sum;
}

// Mean of 3x3 texels, a third of the patch's width apart. Returns false when every channel of the
// patch is clipped, or when the patch is so uneven that another photograph would show another mean.
static bool take_patch(const struct pyramid *p, const double pixel[2], double radius,
                       struct orl_observation *item)
{
    double step = 2 * radius / 3;
    int level = 0;
    while (level + 1 < p->levels && step > 1.42 * (1 << level))
        level++;
    double scale = 1.0 / (1 << level), sum[3] = {0};
    float darkest = INFINITY, brightest = 0;
    item->clipped = 0;
    for (int k = 0; k < 9; k++) {
        struct texel t = bilinear(p, level, (pixel[0] + (k % 3 - 1) * step) * scale,
                                  (pixel[1] + (k / 3 - 1) * step) * scale);
        for (int c = 0; c < 3; c++)
            item->clipped |= (uint8_t)((t.spoilt[c] > SPOILT_MAX) << c);
        float luminance = orl_luminance(t.rgb);
        darkest = fminf(darkest, luminance);
        brightest = fmaxf(brightest, luminance);
        for (int c = 0; c < 3; c++)
            sum[c] += (double)t.rgb[c] / 9;
    }
    if (item->clipped == 7 || brightest - darkest > CONTRAST_MAX * 0.5f * (brightest + darkest))
        return false;
    for (int c = 0; c < 3; c++)
        item->value[c] = 255 * orl_srgb_encode((float)sum[c]);
    return true;
}

// --- samples of all photographs ---

struct taking {
    const struct orl_log *log;
    const char *dir; // of the photographs
    const struct orl_points *points;
    size_t stride;
    struct orl_observation *items;
    size_t count, capacity;
};

static bool faces(const struct orl_points *points, size_t i, const double eye[3])
{
    const float *n = points->normal[i], *at = points->position[i];
    double to[3], dot = 0, length = 0;
    if (n[0] == 0 && n[1] == 0 && n[2] == 0)
        return true;
    for (int k = 0; k < 3; k++) {
        to[k] = eye[k] - (double)at[k];
        dot += to[k] * (double)n[k];
        length += to[k] * to[k];
    }
    return dot >= COSINE_MIN * sqrt(length);
}

static enum orl_result take_point(struct taking *t, uint32_t photo, const struct orl_view *view,
                                  const double eye[3], const struct orl_depth_buffer *buffer,
                                  const struct pyramid *pyramid, size_t point)
{
    double pixel[2], depth;
    struct orl_observation item = {.point = (uint32_t)point, .photo = photo};
    if (!orl_point_project(view, t->points->position[point], pixel, &depth) ||
        !faces(t->points, point, eye) ||
        !orl_depth_buffer_shows(buffer, pixel, depth))
        return ORL_OK;
    // The patch covers at least the pixels by which calibration may be wrong.
    double radius = fmax((double)t->points->radius[point] * view->camera.fx / depth, 3.0);
    if (!take_patch(pyramid, pixel, radius, &item))
        return ORL_OK;
    ORL_TRY(ORL_GROW(t->log, t->items, t->capacity, t->count));
    item.r2 = (float)orl_squared_radius(&view->camera, pixel[0], pixel[1]);
    t->items[t->count++] = item;
    return ORL_OK;
}

static enum orl_result take_photo(struct taking *t, const struct orl_exposed *photo,
                                  uint32_t index)
{
    struct orl_depth_buffer buffer = {0};
    struct pyramid pyramid = {0};
    double eye[3];
    orl_pose_centre(&photo->view.cam_from_world, eye);
    enum orl_result result = make_pyramid(t->log, t->dir, photo, &pyramid);
    ORL_THEN(result, orl_depth_buffer_draw(t->log, &photo->view, t->points, &buffer));
    for (size_t i = 0; result == ORL_OK && i < t->points->count; i += t->stride)
        result = take_point(t, index, &photo->view, eye, &buffer, &pyramid, i);
    orl_depth_buffer_finish(&buffer);
    finish_pyramid(&pyramid);
    return result;
}

enum orl_result orl_samples_take(const struct orl_log *log, const struct orl_progress *progress,
                                 const char *dir, const struct orl_exposed *photos,
                                 size_t photo_count, const struct orl_points *points,
                                 struct orl_samples *samples)
{
    memset(samples, 0, sizeof *samples);
    ORL_REQUIRE(log, points->count < UINT32_MAX && photo_count < UINT32_MAX);
    struct taking t = {.log = log, .dir = dir, .points = points,
                       .stride = 1 + points->count / (POINTS + POINTS_OF_PHOTO * photo_count)};
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < photo_count; i++) {
        if (orl_progress_cancelled(progress))
            result = ORL_ERR_CANCELLED;
        else
            result = take_photo(&t, &photos[i], (uint32_t)i);
        orl_progress_report(progress, "expose", (double)(i + 1), (double)photo_count + 1, NULL);
    }
    ORL_THEN(result, orl_samples_collect(log, t.items, t.count, samples));
    free(t.items);
    return result;
}

// Is observation `index` of the `seen` ones of a point kept? The kept ones are evenly spaced, with
// a phase that differs between points.
static bool is_kept(size_t index, size_t seen, size_t point)
{
    if (seen <= ORL_SAMPLES_PER_POINT)
        return true;
    size_t turned = (index + point) % seen;
    return turned * ORL_SAMPLES_PER_POINT / seen != (turned + 1) * ORL_SAMPLES_PER_POINT / seen;
}

enum orl_result orl_samples_collect(const struct orl_log *log, struct orl_observation *observations, size_t count,
                                    struct orl_samples *samples)
{
    *samples = (struct orl_samples){.first = orl_array(log, count / 2 + 1, sizeof *samples->first),
                                    .items = orl_array(log, count, sizeof *samples->items)};
    if (!samples->first || !samples->items) {
        orl_samples_finish(samples);
        return ORL_ERR_MEMORY;
    }
    if (count)
        qsort(observations, count, sizeof *observations, orl_order_pairs);
    for (size_t begin = 0, end = 0; begin < count; begin = end) {
        uint32_t point = observations[begin].point;
        while (end < count && observations[end].point == point)
            end++;
        if (end - begin < 2)
            continue;
        samples->point_count++;
        for (size_t i = begin; i < end; i++)
            if (is_kept(i - begin, end - begin, point))
                samples->items[samples->count++] = observations[i];
        samples->first[samples->point_count] = samples->count;
    }
    return ORL_OK;
}

void orl_samples_finish(struct orl_samples *samples)
{
    free(samples->first);
    free(samples->items);
    memset(samples, 0, sizeof *samples);
}
