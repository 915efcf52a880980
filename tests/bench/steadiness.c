// How steadily a view at rest shows a moving subject: what changes from one picture to the next less what
// changes in the truth, over pixels where the subject is before or after. Prints one line of JSON.
// usage: bench_steadiness RENDERED TRUTH MASKS, folders of NNNNN.png with the same numbers
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "io/picture.h"

struct step {
    struct orl_image rendered, truth, mask;
};

static enum orl_result read_one(const char *folder, size_t number, int channels, struct orl_image *image)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%05zu.png", folder, number);
    return orl_picture_read(NULL, path, channels, image);
}

static void finish(struct step *step)
{
    orl_image_finish(&step->rendered);
    orl_image_finish(&step->truth);
    orl_image_finish(&step->mask);
}

struct sums {
    double off, moved, wrong, values; // differences of changes, changes of the truth, squared errors
};

static void compare(const struct step *a, const struct step *b, struct sums *sums)
{
    size_t pixels = (size_t)b->mask.width * (size_t)b->mask.height;
    for (size_t i = 0; i < 3 * pixels; i++) {
        if (!a->mask.u8[i / 3] && !b->mask.u8[i / 3])
            continue;
        double shown = (double)b->rendered.u8[i] - a->rendered.u8[i];
        double true_one = (double)b->truth.u8[i] - a->truth.u8[i];
        double wrong = (double)b->rendered.u8[i] - b->truth.u8[i];
        sums->off += fabs(shown - true_one);
        sums->moved += fabs(true_one);
        sums->wrong += wrong * wrong;
        sums->values++;
    }
}

int main(int argc, char **argv)
{
    struct step steps[2];
    struct sums sums = {0};
    memset(steps, 0, sizeof steps);
    size_t t = 0;
    if (argc != 4) {
        fprintf(stderr, "usage: bench_steadiness RENDERED TRUTH MASKS\n");
        return 2;
    }
    for (;; t++) {
        struct step *now = &steps[t % 2];
        finish(now);
        if (read_one(argv[1], t, 3, &now->rendered) != ORL_OK || read_one(argv[2], t, 3, &now->truth) != ORL_OK ||
            read_one(argv[3], t, 1, &now->mask) != ORL_OK)
            break;
        if (now->rendered.width != now->truth.width || now->mask.width != now->truth.width ||
            now->rendered.height != now->truth.height || now->mask.height != now->truth.height) {
            fprintf(stderr, "%s: pictures are not of the truth's size\n", argv[1]);
            return 1;
        }
        if (t)
            compare(&steps[(t + 1) % 2], now, &sums);
    }
    finish(&steps[0]);
    finish(&steps[1]);
    if (!(sums.values > 0)) {
        fprintf(stderr, "%s: no two pictures with a subject\n", argv[1]);
        return 1;
    }
    printf("{\"time_steps\": %zu, \"unsteady\": %.3f, \"moved\": %.3f, \"psnr_db\": %.2f}\n", t, sums.off / sums.values,
           sums.moved / sums.values, 10 * log10(255 * 255 * sums.values / sums.wrong));
    return 0;
}
