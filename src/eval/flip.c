// Sections and equations refer to Andersson et al. 2020.
#include <math.h>
#include <stdlib.h>

#include "core/color.h"
#include "core/memory.h"
#include "eval/metrics.h"

// A screen 0.7 m and 3840 pixels wide at a distance of 0.7 m.
static const double pixels_per_degree = 0.7 * 3840 / 0.7 * 3.14159265358979323846 / 180;
static const double pi = 3.14159265358979323846;

// A one-dimensional filter with its middle at taps[radius].
enum { RADIUS_MAX = 10, TAPS_MAX = 2 * RADIUS_MAX + 1 };
struct kernel {
    int radius;
    float taps[TAPS_MAX];
};

// One picture in the spaces that FLIP needs; width * height values each.
struct planes {
    int width, height;
    size_t count; // of pixels
    float *y, *cx, *cz; // YCxCz, then filtered by contrast sensitivity, then Lab with Hunt's effect
    float *edge, *point; // strength of features
    float *work[2]; // of convolve()
    float *spare[2];
    float *all; // owned: all of the above
};

// --- colour ---

// Linear Rec. 709 and XYZ relative to its white point, which makes white (1, 1, 1).
static const float xyz_from_rgb[3][3] = {{0.433895389f, 0.376242373f, 0.189862239f},
                                         {0.212636822f, 0.715182982f, 0.072180196f},
                                         {0.017752423f, 0.109465629f, 0.872781948f}};
static const float rgb_from_xyz[3][3] = {{3.080341988f, -1.537398969f, -0.542943019f},
                                         {-0.921178396f, 1.875929984f, 0.045248412f},
                                         {0.052881293f, -0.204011206f, 1.151129913f}};

static void apply(const float m[3][3], const float in[3], float out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = m[i][0] * in[0] + m[i][1] * in[1] + m[i][2] * in[2];
}

static float lab_curve(float t)
{
    const float delta = 6.0f / 29;
    return t > delta * delta * delta ? cbrtf(t) : t / (3 * delta * delta) + 4.0f / 29;
}

// Linear colour to L*a*b* with Hunt's effect: chroma grows with lightness (section 4.1.3).
static void hunt_lab(const float rgb[3], float lab[3])
{
    float xyz[3];
    apply(xyz_from_rgb, rgb, xyz);
    for (int i = 0; i < 3; i++)
        xyz[i] = lab_curve(xyz[i]);
    lab[0] = 116 * xyz[1] - 16;
    lab[1] = 0.01f * lab[0] * 500 * (xyz[0] - xyz[1]);
    lab[2] = 0.01f * lab[0] * 200 * (xyz[1] - xyz[2]);
}

// Distance for large colour differences (Abasi et al. 2020).
static float hyab(const float a[3], const float b[3])
{
    return fabsf(a[0] - b[0]) + hypotf(a[1] - b[1], a[2] - b[2]);
}

// --- filters ---

static void convolve_row(const float *in, int width, const struct kernel *kernel, float *padded,
                         float *out)
{
    int radius = kernel->radius;
    for (int x = -radius; x < width + radius; x++)
        padded[x + radius] = in[x < 0 ? 0 : x >= width ? width - 1 : x];
    for (int x = 0; x < width; x++)
        out[x] = kernel->taps[0] * padded[x];
    for (int k = 1; k <= 2 * radius; k++)
        for (int x = 0; x < width; x++)
            out[x] += kernel->taps[k] * padded[x + k];
}

// Filters in both directions, with border pixels repeated outward. `out` may be `in`. work: one
// plane and a padded row.
static void convolve(const float *in, int width, int height, const struct kernel *across,
                     const struct kernel *down, float *const work[2], float *out)
{
    for (int y = 0; y < height; y++)
        convolve_row(in + (size_t)y * (size_t)width, width, across, work[1],
                     work[0] + (size_t)y * (size_t)width);
    int radius = down->radius;
    for (int y = 0; y < height; y++) {
        float *row = out + (size_t)y * (size_t)width;
        for (int x = 0; x < width; x++)
            row[x] = 0;
        for (int k = -radius; k <= radius; k++) {
            int from = y + k < 0 ? 0 : y + k >= height ? height - 1 : y + k;
            const float *other = work[0] + (size_t)from * (size_t)width;
            for (int x = 0; x < width; x++)
                row[x] += down->taps[k + radius] * other[x];
        }
    }
}

static void blend(const float *a, const float *b, float share, size_t count, float *out)
{
    for (size_t i = 0; i < count; i++)
        out[i] = (1 - share) * a[i] + share * b[i];
}

// exp(-scale d^2) at distance d pixels, not normalised. Returns the sum of the taps.
static double fill_gaussian(double scale, int radius, struct kernel *kernel)
{
    double sum = 0;
    kernel->radius = radius;
    for (int i = -radius; i <= radius; i++) {
        kernel->taps[i + radius] = (float)exp(-scale * i * i);
        sum += (double)kernel->taps[i + radius];
    }
    return sum;
}

static void divide(struct kernel *kernel, double by)
{
    for (int i = 0; i <= 2 * kernel->radius; i++)
        kernel->taps[i] /= (float)by;
}

// The eye's contrast sensitivity as a normalised Gaussian of the paper's table 1. Returns `a` times
// the sum over two dimensions before normalisation: the Gaussian's weight in a sum of several.
static double fill_sensitivity(double a, double b, struct kernel *kernel)
{
    const double widest = 0.04; // greatest b in the table
    int radius = (int)ceil(3 * sqrt(widest / (2 * pi * pi)) * pixels_per_degree);
    double scale = pi * pi / b / (pixels_per_degree * pixels_per_degree);
    double sum = fill_gaussian(scale, radius, kernel);
    divide(kernel, sum);
    return a * sqrt(pi / b) * sum * sum;
}

// A Gaussian as wide as features are (0.082 degrees) and its first and second derivatives, whose
// positive taps sum to 1 and negative taps to -1 (section 4.2).
static void fill_features(struct kernel *blur, struct kernel *first, struct kernel *second)
{
    double sigma = 0.5 * 0.082 * pixels_per_degree;
    int radius = (int)ceil(3 * sigma);
    double sum = fill_gaussian(0.5 / (sigma * sigma), radius, blur);
    struct kernel *const derivatives[2] = {first, second};
    for (int k = 0; k < 2; k++) {
        double positive = 0, negative = 0;
        derivatives[k]->radius = radius;
        for (int i = -radius; i <= radius; i++) {
            double factor = k ? i * i / (sigma * sigma) - 1 : i;
            double tap = factor * (double)blur->taps[i + radius];
            derivatives[k]->taps[i + radius] = (float)tap;
            positive += fmax(tap, 0);
            negative += fmax(-tap, 0);
        }
        for (int i = 0; i <= 2 * radius; i++) {
            float *tap = &derivatives[k]->taps[i];
            *tap /= (float)(*tap > 0 ? positive : negative);
        }
    }
    divide(blur, sum);
}

// --- one picture ---

static void to_opponent(const struct orl_image *image, struct planes *p)
{
    for (size_t i = 0; i < p->count; i++) {
        float rgb[3], xyz[3];
        for (int c = 0; c < 3; c++)
            rgb[c] = orl_srgb_decode((float)image->u8[3 * i + (size_t)c] / 255);
        apply(xyz_from_rgb, rgb, xyz);
        p->y[i] = 116 * xyz[1] - 16;
        p->cx[i] = 500 * (xyz[0] - xyz[1]);
        p->cz[i] = 200 * (xyz[1] - xyz[2]);
    }
}

// Strength of edges (first derivative) or points (second derivative), from work[2].
static void find_features(struct planes *p, const struct kernel *blur,
                          const struct kernel *derivative, float *out)
{
    float *down = p->spare[1];
    convolve(p->spare[0], p->width, p->height, derivative, blur, p->work, out);
    convolve(p->spare[0], p->width, p->height, blur, derivative, p->work, down);
    for (size_t i = 0; i < p->count; i++)
        out[i] = hypotf(out[i], down[i]);
}

static void measure_features(struct planes *p)
{
    struct kernel blur, first, second;
    fill_features(&blur, &first, &second);
    for (size_t i = 0; i < p->count; i++)
        p->spare[0][i] = (p->y[i] + 16) / 116;
    find_features(p, &blur, &first, p->edge);
    find_features(p, &blur, &second, p->point);
}

static void see(struct planes *p)
{
    struct kernel lightness, red_green, blue_yellow, wide;
    fill_sensitivity(1, 0.0047, &lightness);
    fill_sensitivity(1, 0.0053, &red_green);
    double narrow_weight = fill_sensitivity(34.1, 0.04, &blue_yellow);
    double wide_weight = fill_sensitivity(13.5, 0.025, &wide);
    convolve(p->y, p->width, p->height, &lightness, &lightness, p->work, p->y);
    convolve(p->cx, p->width, p->height, &red_green, &red_green, p->work, p->cx);
    convolve(p->cz, p->width, p->height, &wide, &wide, p->work, p->spare[0]);
    convolve(p->cz, p->width, p->height, &blue_yellow, &blue_yellow, p->work, p->cz);
    blend(p->cz, p->spare[0], (float)(wide_weight / (narrow_weight + wide_weight)), p->count, p->cz);
    for (size_t i = 0; i < p->count; i++) {
        float xyz[3], rgb[3], lab[3];
        xyz[1] = (p->y[i] + 16) / 116;
        xyz[0] = xyz[1] + p->cx[i] / 500;
        xyz[2] = xyz[1] - p->cz[i] / 200;
        apply(rgb_from_xyz, xyz, rgb);
        for (int c = 0; c < 3; c++)
            rgb[c] = fminf(fmaxf(rgb[c], 0), 1); // the range of a screen
        hunt_lab(rgb, lab);
        p->y[i] = lab[0];
        p->cx[i] = lab[1];
        p->cz[i] = lab[2];
    }
}

static enum orl_result prepare(const struct orl_log *log, const struct orl_image *image,
                               struct planes *p)
{
    size_t count = (size_t)image->width * (size_t)image->height;
    *p = (struct planes){.width = image->width, .height = image->height, .count = count};
    // The last array also holds a padded row, which may be longer than a small picture.
    p->all = orl_array(log, 8 * count + (size_t)image->width + TAPS_MAX, sizeof *p->all);
    ORL_TRY_MEMORY(p->all);
    float **const planes[] = {&p->y, &p->cx, &p->cz, &p->edge, &p->point,
                              &p->spare[0], &p->spare[1], &p->work[0], &p->work[1]};
    for (size_t i = 0; i < ORL_COUNT(planes); i++)
        *planes[i] = p->all + i * count;
    to_opponent(image, p);
    measure_features(p);
    see(p);
    return ORL_OK;
}

// --- two pictures ---

// Maps colour differences to [0, 1]; those up to 0.4 of the largest take 0.95 of the range (section
// 4.1.4).
static float redistribute(float difference, float largest)
{
    const float knee_at = 0.4f * largest, knee = 0.95f;
    return difference < knee_at
               ? knee / knee_at * difference
               : knee + (difference - knee_at) / (largest - knee_at) * (1 - knee);
}

static float flip_at(const struct planes *a, const struct planes *b, size_t i, float largest)
{
    const float one[3] = {a->y[i], a->cx[i], a->cz[i]}, two[3] = {b->y[i], b->cx[i], b->cz[i]};
    float color = redistribute(powf(hyab(one, two), 0.7f), largest);
    float feature = fmaxf(fabsf(a->edge[i] - b->edge[i]), fabsf(a->point[i] - b->point[i]));
    return powf(color, 1 - sqrtf(feature / sqrtf(2))); // equation 5
}

enum orl_result orl_flip_compare(const struct orl_log *log, const struct orl_image *a,
                                 const struct orl_image *b, double *mean)
{
    struct planes one = {0}, two = {0};
    *mean = 0;
    enum orl_result result = prepare(log, a, &one);
    ORL_THEN(result, prepare(log, b, &two));
    if (result == ORL_OK) {
        float green[3], blue[3];
        hunt_lab((const float[]){0, 1, 0}, green);
        hunt_lab((const float[]){0, 0, 1}, blue);
        float largest = powf(hyab(green, blue), 0.7f);
        for (size_t i = 0; i < one.count; i++)
            *mean += (double)flip_at(&one, &two, i, largest) / (double)one.count;
    }
    free(one.all);
    free(two.all);
    return result;
}
