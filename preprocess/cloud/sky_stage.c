#include "preprocess/cloud/sky_stage.h"

#include <math.h>
#include <stdlib.h>

#include "core/color.h"
#include "core/memory.h"
#include "core/vec3.h"
#include "preprocess/cloud/reduced.h"
#include "scene/sky.h"

enum { SIDE = 256 }; // longer side of the reduced photographs, pixels
// Sky, as fractions of white: the range of luma over 3x3 pixels is at most SMOOTH, and luma is at least
// BRIGHT, or blue exceeds red by BLUE.
static const float SMOOTH = 0.08f, BRIGHT = 0.45f, BLUE = 0.05f;
static const double SHARE_LEAST = 0.02; // of the picture, or else it is no sky

static float luma(const uint8_t *rgb)
{
    return (0.299f * rgb[0] + 0.587f * rgb[1] + 0.114f * rgb[2]) / 255;
}

// Whether a pixel may be sky: all but its place.
static bool looks_so(const struct orl_reduced *shot, int x, int y)
{
    const struct orl_image *picture = &shot->picture;
    int width = picture->width, height = picture->height;
    const uint8_t *own = &picture->u8[3 * (y * width + x)];
    float least = 1, most = 0;
    if (!shot->open[y * width + x] || (luma(own) < BRIGHT && (own[2] - own[0]) / 255.0f < BLUE))
        return false;
    for (int v = y > 0 ? y - 1 : 0; v <= y + 1 && v < height; v++)
        for (int u = x > 0 ? x - 1 : 0; u <= x + 1 && u < width; u++) {
            float around = luma(&picture->u8[3 * (v * width + u)]);
            least = fminf(least, around);
            most = fmaxf(most, around);
        }
    return most - least <= SMOOTH;
}

// The pixels of the picture's upper border, as first, step and count. Photographs are as stored, so
// upwards may be any side.
static void upper_border(const struct orl_reduced *shot, const double up[3], int *first, int *step,
                         int *count)
{
    int width = shot->picture.width, height = shot->picture.height;
    const struct orl_pose *pose = &shot->view.cam_from_world;
    double right = orl_dot3(pose->r[0], up), down = orl_dot3(pose->r[1], up);
    bool sideways = fabs(right) > fabs(down);
    *count = sideways ? height : width;
    *step = sideways ? width : 1;
    *first = sideways ? (right > 0 ? width - 1 : 0) : (down > 0 ? (height - 1) * width : 0);
}

struct flood {
    const struct orl_reduced *shot;
    bool *sky;
    int *pixels; // those of the sky so far
    int count;
};

static void add(struct flood *flood, int x, int y)
{
    const struct orl_image *picture = &flood->shot->picture;
    int at = y * picture->width + x;
    if (x < 0 || y < 0 || x >= picture->width || y >= picture->height || flood->sky[at] ||
        !looks_so(flood->shot, x, y))
        return;
    flood->sky[at] = true;
    flood->pixels[flood->count++] = at;
}

static void spread_sky(struct flood *flood, const double up[3])
{
    int first, step, count, width = flood->shot->picture.width;
    upper_border(flood->shot, up, &first, &step, &count);
    for (int i = 0, at = first; i < count; i++, at += step)
        add(flood, at % width, at / width);
    for (int i = 0; i < flood->count; i++) {
        int x = flood->pixels[i] % width, y = flood->pixels[i] / width;
        add(flood, x - 1, y);
        add(flood, x + 1, y);
        add(flood, x, y - 1);
        add(flood, x, y + 1);
    }
}

// Mean and standard deviation in square roots of light, in which differences are about as large as
// they look.
static void measure(const struct flood *flood, struct orl_photo *photo)
{
    double sum[3] = {0}, squares = 0, mean2 = 0;
    for (int i = 0; i < flood->count; i++)
        for (int c = 0; c < 3; c++) {
            uint8_t value = flood->shot->picture.u8[3 * flood->pixels[i] + c];
            double light = (double)orl_srgb_decode(value / 255.0f);
            sum[c] += sqrt(light);
            squares += light;
        }
    for (int c = 0; c < 3; c++) {
        double mean = sum[c] / flood->count;
        photo->sky[c] = (float)(mean * mean);
        mean2 += mean * mean;
    }
    photo->sky_spread = (float)sqrt(fmax(squares / flood->count - mean2, 0));
}

static enum orl_result find_sky(const struct orl_log *log, struct orl_scene *scene,
                                const double up[3], size_t i)
{
    struct orl_reduced shot;
    enum orl_result result = orl_reduced_read(log, scene, i, SIDE, &shot);
    size_t count = (size_t)shot.picture.width * (size_t)shot.picture.height;
    struct flood flood = {.shot = &shot};
    if (result == ORL_OK) {
        flood.sky = orl_array(log, count, sizeof *flood.sky);
        flood.pixels = orl_array(log, count, sizeof *flood.pixels);
        result = flood.sky && flood.pixels ? ORL_OK : ORL_ERR_MEMORY;
    }
    if (result == ORL_OK) {
        spread_sky(&flood, up);
        scene->photos[i].has_sky = flood.count >= SHARE_LEAST * (double)count;
        if (scene->photos[i].has_sky)
            measure(&flood, &scene->photos[i]);
    }
    free(flood.sky);
    free(flood.pixels);
    orl_reduced_finish(&shot);
    return result;
}

enum orl_result orl_skies_find(const struct orl_log *log, struct orl_scene *scene)
{
    size_t with = 0;
    double up[3];
    orl_scene_upwards(scene, up);
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < scene->photo_count; i++) {
        scene->photos[i].has_sky = false;
        if (!scene->photos[i].test)
            result = find_sky(log, scene, up, i);
        with += scene->photos[i].has_sky;
    }
    if (result == ORL_OK)
        orl_logf(log, ORL_LOG_INFO, "sky: %zu photographs show it", with);
    return result;
}

enum orl_result orl_stage_sky(struct orl_job *job, json_t *record)
{
    struct orl_scene *scene = NULL;
    json_t *skies = json_object();
    enum orl_result result = skies ? orl_job_open_scene(job, &scene) : ORL_ERR_MEMORY;
    if (result == ORL_OK)
        result = orl_skies_find(job->log, scene);
    for (size_t i = 0; result == ORL_OK && i < scene->photo_count; i++) {
        const struct orl_photo *p = &scene->photos[i];
        if (p->has_sky)
            json_object_set_new(skies, p->name,
                                json_pack("[f,f,f,f]", (double)p->sky[0], (double)p->sky[1],
                                          (double)p->sky[2], (double)p->sky_spread));
    }
    if (result == ORL_OK && json_object_set(record, "skies", skies) != 0)
        result = orl_fail(job->log, ORL_ERR_MEMORY, "no memory for the skies");
    json_decref(skies);
    orl_scene_destroy(&scene);
    return result;
}
