// edge_error IMAGES TRUTH METHOD NAME...: squared error near steps of the true depth and away from
// them. IMAGES is what `oriel eval --images` wrote of a scene whose photographs were not resampled,
// TRUTH what `oriel synth` wrote. Near is within NEAR_PX pixels of a pixel at which the second
// difference of inverse depth exceeds STEP of itself, so that slopes do not count.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "core/file.h"
#include "core/memory.h"
#include "io/exr.h"
#include "io/picture.h"

enum { NEAR_PX = 4 };
static const double STEP = 0.03;

struct error {
    double squares[2]; // away from steps, near them
    size_t pixels[2];
};

// Inverse depth; 0 in the sky and outside.
static double inverse(const struct orl_image *depth, int x, int y)
{
    float z = depth->f32[(size_t)y * (size_t)depth->width + (size_t)x];
    return z > 0 ? 1 / (double)z : 0;
}

static bool is_step(const struct orl_image *depth, int x, int y)
{
    if (x < 1 || y < 1 || x + 1 >= depth->width || y + 1 >= depth->height)
        return false;
    double here = inverse(depth, x, y);
    double across = inverse(depth, x - 1, y) - 2 * here + inverse(depth, x + 1, y);
    double down = inverse(depth, x, y - 1) - 2 * here + inverse(depth, x, y + 1);
    return fmax(fabs(across), fabs(down)) > STEP * here;
}

static void mark_near(const struct orl_image *depth, uint8_t *near)
{
    for (int y = 0; y < depth->height; y++)
        for (int x = 0; x < depth->width; x++) {
            if (!is_step(depth, x, y))
                continue;
            for (int j = y - NEAR_PX; j <= y + NEAR_PX; j++)
                for (int i = x - NEAR_PX; i <= x + NEAR_PX; i++)
                    if (i >= 0 && j >= 0 && i < depth->width && j < depth->height &&
                        (i - x) * (i - x) + (j - y) * (j - y) <= NEAR_PX * NEAR_PX)
                        near[(size_t)j * (size_t)depth->width + (size_t)i] = 1;
        }
}

static enum orl_result read_pictures(const struct orl_log *log, const char *const *words,
                                     const char *name, struct orl_image *drawn,
                                     struct orl_image *photo, struct orl_image *depth)
{
    static const char *const z[] = {"depth.Z"};
    char *paths[] = {orl_format(log, "%s/%s.%s.png", words[0], name, words[2]),
                     orl_format(log, "%s/%s.photo.png", words[0], name),
                     orl_format(log, "%s/depth/%s.exr", words[1], name)};
    enum orl_result result = paths[0] && paths[1] && paths[2] ? ORL_OK : ORL_ERR_MEMORY;
    if (result == ORL_OK)
        result = orl_picture_read(log, paths[0], 3, drawn);
    if (result == ORL_OK)
        result = orl_picture_read(log, paths[1], 3, photo);
    if (result == ORL_OK)
        result = orl_exr_read(log, paths[2], z, 1, depth);
    if (result == ORL_OK && (drawn->width != depth->width || drawn->height != depth->height ||
                             photo->width != depth->width || photo->height != depth->height))
        result = orl_fail(log, ORL_ERR_DATA, "%s: its pictures and depth differ in size", name);
    for (size_t i = 0; i < ORL_COUNT(paths); i++)
        free(paths[i]);
    return result;
}

static enum orl_result add(const struct orl_log *log, const char *const *words, const char *name,
                           struct error *error)
{
    struct orl_image drawn = {0}, photo = {0}, depth = {0};
    uint8_t *near = NULL;
    enum orl_result result = read_pictures(log, words, name, &drawn, &photo, &depth);
    size_t pixels = result == ORL_OK ? (size_t)depth.width * (size_t)depth.height : 0;
    if (result == ORL_OK && !(near = orl_array(log, pixels, 1)))
        result = ORL_ERR_MEMORY;
    if (result == ORL_OK)
        mark_near(&depth, near);
    for (size_t i = 0; result == ORL_OK && i < 3 * pixels; i++) {
        double difference = (double)drawn.u8[i] - photo.u8[i];
        error->squares[near[i / 3]] += difference * difference / 3;
        error->pixels[near[i / 3]] += i % 3 == 0;
    }
    free(near);
    orl_image_finish(&depth);
    orl_image_finish(&photo);
    orl_image_finish(&drawn);
    return result;
}

int main(int argc, char **argv)
{
    struct orl_log log = orl_log_stderr(ORL_LOG_WARNING);
    struct error error = {0};
    enum orl_result result = ORL_OK;
    if (argc < 5) {
        fprintf(stderr, "usage: edge_error IMAGES TRUTH METHOD NAME...\n");
        return 2;
    }
    for (int i = 4; result == ORL_OK && i < argc; i++)
        result = add(&log, (const char *const *)argv + 1, argv[i], &error);
    if (result == ORL_OK)
        printf("near %.1f of %.1f %% of the pixels, away %.1f\n",
               error.squares[1] / fmax((double)error.pixels[1], 1),
               100.0 * (double)error.pixels[1] / (double)(error.pixels[0] + error.pixels[1]),
               error.squares[0] / fmax((double)error.pixels[0], 1));
    return result == ORL_OK ? 0 : 1;
}
