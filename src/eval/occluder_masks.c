#include "eval/occluder_masks.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bridge/bridge.h"
#include "core/color.h"
#include "core/memory.h"
#include "core/order.h"
#include "eval/validation.h"

// Pixels of pictures of ORL_OCCLUDERS_SIDE, and differences in square roots of light, as the length
// of the vector of channels.
static const double blur_px = 1.5;
enum { BLUR_TAPS = 11, OPEN_PX = 5, GROW_PX = 4 };
static const float surface_difference = 0.25f;
// Where depth is guessed, renderings are off by the error of the guess.
static const float guess_difference = 0.5f;
// Normalised cross-correlation: its window, the variance of noise in square roots of light, and what
// another light leaves of a surface's likeness.
enum { LIKENESS_TAPS = 25 };
static const double likeness_px = 4;
static const float noise = 1e-4f, likeness_max = 0.5f;
// Shares of the picture: the surfaces that a region must prove to hide, and all that is plausible. A
// photograph that differs nearly everywhere is in another light, or has a wrong pose.
static const double proven_min = 0.01, occluded_max = 0.67;
// Of a region's surfaces: less is proven along the edges of shadows.
static const double proven_share = 0.5;

// --- where a photograph differs ---

struct roots {
    float of[256]; // of light, by 8-bit value
};

static struct roots make_roots(void)
{
    struct roots roots;
    for (int i = 0; i < 256; i++)
        roots.of[i] = sqrtf(orl_srgb_decode((float)i / 255));
    return roots;
}

static float brightness(const struct roots *roots, const uint8_t rgb[3])
{
    return 0.25f * roots->of[rgb[0]] + 0.5f * roots->of[rgb[1]] + 0.25f * roots->of[rgb[2]];
}

// A rendering less the photograph, after a Gaussian filter that keeps surfaces and guesses apart,
// since these differ in how far they can be trusted. F32 x3.
static enum orl_result differ(const struct orl_log *log, const struct orl_image *rendering,
                              const struct orl_occluder_pictures *pictures,
                              struct orl_image *difference)
{
    const struct orl_image *photo = &pictures->photo;
    const struct roots roots = make_roots();
    size_t count = (size_t)photo->width * (size_t)photo->height;
    struct orl_image sides[2] = {{0}, {0}}, blurred[2] = {{0}, {0}}; // guesses, surfaces
    enum orl_result result = orl_image_init(log, difference, photo->width, photo->height, 3,
                                            ORL_PIXEL_F32);
    for (int k = 0; result == ORL_OK && k < 2; k++) {
        result = orl_image_init(log, &sides[k], photo->width, photo->height, 4, ORL_PIXEL_F32);
        for (size_t i = 0; result == ORL_OK && i < count; i++) {
            float *p = sides[k].f32 + 4 * i;
            p[3] = (pictures->covered.f32[i] > 0) == (k == 1);
            for (size_t c = 0; c < 3; c++)
                p[c] = p[3] * (roots.of[rendering->u8[3 * i + c]] - roots.of[photo->u8[3 * i + c]]);
        }
        ORL_THEN(result, orl_bridge_blur(log, &sides[k], BLUR_TAPS, blur_px, &blurred[k]));
    }
    for (size_t i = 0; result == ORL_OK && i < count; i++) {
        const float *p = blurred[pictures->covered.f32[i] > 0].f32 + 4 * i;
        for (size_t c = 0; c < 3; c++)
            difference->f32[3 * i + c] = p[c] / p[3];
    }
    for (int k = 0; k < 2; k++) {
        orl_image_finish(&sides[k]);
        orl_image_finish(&blurred[k]);
    }
    return result;
}

static float length_of(const float v[3])
{
    return sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

// How alike the structure of the photograph and a rendering is around each pixel: normalised
// cross-correlation of brightness, a mean of square roots of light. F32 x1.
static enum orl_result correlate(const struct orl_log *log, const struct orl_image *photo,
                                 const struct orl_image *rendering, struct orl_image *likeness)
{
    const struct roots roots = make_roots();
    size_t count = (size_t)photo->width * (size_t)photo->height;
    struct orl_image first, second = {0}, means[2] = {{0}, {0}}; // moments: a, b; a^2, b^2, a b
    enum orl_result result = orl_image_init(log, &first, photo->width, photo->height, 2,
                                            ORL_PIXEL_F32);
    ORL_THEN(result, orl_image_init(log, &second, photo->width, photo->height, 3, ORL_PIXEL_F32));
    ORL_THEN(result, orl_image_init(log, likeness, photo->width, photo->height, 1, ORL_PIXEL_F32));
    for (size_t i = 0; result == ORL_OK && i < count; i++) {
        float a = brightness(&roots, &photo->u8[3 * i]);
        float b = brightness(&roots, &rendering->u8[3 * i]);
        memcpy(first.f32 + 2 * i, (const float[]){a, b}, 2 * sizeof a);
        memcpy(second.f32 + 3 * i, (const float[]){a * a, b * b, a * b}, 3 * sizeof a);
    }
    ORL_THEN(result, orl_bridge_blur(log, &first, LIKENESS_TAPS, likeness_px, &means[0]));
    ORL_THEN(result, orl_bridge_blur(log, &second, LIKENESS_TAPS, likeness_px, &means[1]));
    for (size_t i = 0; result == ORL_OK && i < count; i++) {
        const float *m = means[0].f32 + 2 * i, *squares = means[1].f32 + 3 * i;
        float a = fmaxf(squares[0] - m[0] * m[0], 0), b = fmaxf(squares[1] - m[1] * m[1], 0);
        likeness->f32[i] = (squares[2] - m[0] * m[1]) / sqrtf((a + noise) * (b + noise));
    }
    orl_image_finish(&first);
    orl_image_finish(&second);
    orl_image_finish(&means[0]);
    orl_image_finish(&means[1]);
    return result;
}

// Where the photograph contradicts the consensus: *mask. Where it contradicts the nearest photographs
// and the points, too, on a surface, and neither rendering of photographs has its structure in another
// light: *proof. Both U8 x1, 255 there, without specks.
static enum orl_result contradict(const struct orl_log *log,
                                  const struct orl_occluder_pictures *pictures,
                                  struct orl_image *mask, struct orl_image *proof)
{
    static const struct orl_mask_cleaning no_specks = {.open_px = OPEN_PX};
    const struct orl_image *photo = &pictures->photo;
    size_t count = (size_t)photo->width * (size_t)photo->height;
    struct orl_image off[ORL_OCCLUDER_RENDERINGS] = {{0}}, like[ORL_OCCLUDER_POINTS] = {{0}}, rough[2] = {{0}, {0}};
    enum orl_result result = ORL_OK;
    for (int k = 0; result == ORL_OK && k < ORL_OCCLUDER_RENDERINGS; k++)
        result = differ(log, &pictures->rendered[k], pictures, &off[k]);
    for (int k = 0; result == ORL_OK && k < ORL_OCCLUDER_POINTS; k++)
        result = correlate(log, photo, &pictures->rendered[k], &like[k]);
    for (int k = 0; result == ORL_OK && k < 2; k++)
        result = orl_image_init(log, &rough[k], photo->width, photo->height, 1, ORL_PIXEL_U8);
    for (size_t i = 0; result == ORL_OK && i < count; i++) {
        bool surface = pictures->covered.f32[i] > 0;
        float least = surface ? surface_difference : guess_difference;
        rough[0].u8[i] = length_of(off[ORL_OCCLUDER_CONSENSUS].f32 + 3 * i) > least ? 255 : 0;
        bool proves = surface && length_of(off[ORL_OCCLUDER_NEAREST].f32 + 3 * i) > least &&
                      length_of(off[ORL_OCCLUDER_POINTS].f32 + 3 * i) > least &&
                      fmaxf(like[ORL_OCCLUDER_CONSENSUS].f32[i], like[ORL_OCCLUDER_NEAREST].f32[i]) < likeness_max;
        rough[1].u8[i] = proves ? rough[0].u8[i] : 0;
    }
    ORL_THEN(result, orl_bridge_clean_mask(log, &rough[0], &no_specks, mask));
    ORL_THEN(result, orl_bridge_clean_mask(log, &rough[1], &no_specks, proof));
    for (int k = 0; k < ORL_OCCLUDER_RENDERINGS; k++)
        orl_image_finish(&off[k]);
    for (int k = 0; k < 2; k++) {
        orl_image_finish(&like[k]);
        orl_image_finish(&rough[k]);
    }
    return result;
}

// --- which regions count ---

// Pixels of a region.
struct tally {
    size_t surface, proven;
};

// Keeps the regions of `mask` that have enough proof. covered: the surfaces, F32 x1.
static enum orl_result keep_proven(const struct orl_log *log, const struct orl_image *covered,
                                   const struct orl_image *proof, struct orl_image *mask)
{
    size_t count = (size_t)mask->width * (size_t)mask->height, regions;
    struct orl_image labels;
    enum orl_result result = orl_bridge_label(log, mask, &labels, &regions);
    struct tally *of = result == ORL_OK ? orl_array(log, regions + 1, sizeof *of) : NULL;
    if (result == ORL_OK && !of)
        result = ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < count; i++) {
        struct tally *region = &of[(size_t)labels.f32[i]];
        region->surface += covered->f32[i] > 0;
        region->proven += proof->u8[i] > 0;
    }
    for (size_t i = 0; result == ORL_OK && i < count; i++) {
        const struct tally *region = &of[(size_t)labels.f32[i]];
        if ((double)region->proven < fmax(proven_min * (double)count,
                                          proven_share * (double)region->surface))
            mask->u8[i] = 0;
    }
    free(of);
    orl_image_finish(&labels);
    return result;
}

// Grows the regions: what the filter has blurred at their borders is theirs.
static enum orl_result grow(const struct orl_log *log, struct orl_image *mask)
{
    struct orl_image distance;
    size_t count = (size_t)mask->width * (size_t)mask->height;
    enum orl_result result = orl_bridge_distance(log, mask, &distance);
    for (size_t i = 0; result == ORL_OK && i < count; i++)
        mask->u8[i] = distance.f32[i] <= GROW_PX ? 255 : 0;
    orl_image_finish(&distance);
    return result;
}

enum orl_result orl_occluder_mask(const struct orl_log *log,
                                  const struct orl_occluder_pictures *pictures,
                                  struct orl_image *mask, double *share)
{
    size_t count = (size_t)pictures->photo.width * (size_t)pictures->photo.height, marked = 0;
    struct orl_image proof = {0};
    *mask = (struct orl_image){0};
    *share = 0;
    enum orl_result result = contradict(log, pictures, mask, &proof);
    ORL_THEN(result, keep_proven(log, &pictures->covered, &proof, mask));
    ORL_THEN(result, grow(log, mask));
    for (size_t i = 0; result == ORL_OK && i < count; i++)
        marked += mask->u8[i] > 0;
    if (result == ORL_OK && (double)marked <= occluded_max * (double)count)
        *share = (double)marked / (double)count;
    if (!(*share > 0))
        orl_image_finish(mask);
    orl_image_finish(&proof);
    return result;
}

// --- the photographs of a scene ---

// Photographs that one is compared with, at most: the nearest, so that the work grows with the number
// of photographs and not with its square.
enum { OTHERS_MAX = 16 };

struct finder {
    const struct orl_log *log;
    const struct orl_scene *scene;
    const struct orl_progress *progress;
    struct orl_renderer *renderer;
    struct orl_render_params params[ORL_OCCLUDER_RENDERINGS];
    struct orl_image *masks; // by photograph
    double *shares;
    struct orl_ranked *others; // owned: room for all photographs
    bool *skip;           // owned
    bool *proven;         // owned: photographs whose occluders stand
};

// Skips what the rendering of a photograph's view does without: see orl_validation_leave_out, and
// all but the nearest.
static void set_skip(const struct finder *f, size_t photo, const bool *removed)
{
    size_t count = 0;
    orl_validation_leave_out(f->scene, photo, removed, f->skip);
    for (size_t i = 0; i < f->scene->photo_count; i++) {
        if (!f->skip[i] && !f->scene->photos[i].test)
            f->others[count++] = (struct orl_ranked){orl_validation_apart(f->scene, photo, i), i};
    }
    qsort(f->others, count, sizeof *f->others, orl_order_ranked);
    for (size_t k = OTHERS_MAX; k < count; k++)
        f->skip[f->others[k].index] = true;
}

// Finds the occluders of a photograph, compared with renderings without `removed` (NULL: none).
static enum orl_result find_of(const struct finder *f, size_t photo, const bool *removed)
{
    const struct orl_camera *c = &f->scene->photos[photo].view.camera;
    int longer = c->width > c->height ? c->width : c->height;
    int divide = (longer + ORL_OCCLUDERS_SIDE - 1) / ORL_OCCLUDERS_SIDE;
    struct orl_heldout shot;
    struct orl_occluder_pictures pictures = {0};
    if (orl_progress_cancelled(f->progress))
        return ORL_ERR_CANCELLED;
    orl_image_finish(&f->masks[photo]);
    set_skip(f, photo, removed);
    enum orl_result result = orl_heldout_load(f->log, f->scene, photo, divide, &shot);
    for (int k = 0; k < ORL_OCCLUDER_RENDERINGS; k++)
        ORL_THEN(result, orl_heldout_draw(f->log, f->renderer, f->scene, &shot, &f->params[k], f->skip,
                                          &pictures.rendered[k],
                                          k == ORL_OCCLUDER_CONSENSUS ? &pictures.covered : NULL));
    if (result == ORL_OK) {
        pictures.photo = shot.picture;
        result = orl_occluder_mask(f->log, &pictures, &f->masks[photo], &f->shares[photo]);
    }
    orl_image_finish(&pictures.covered);
    for (int k = 0; k < ORL_OCCLUDER_RENDERINGS; k++)
        orl_image_finish(&pictures.rendered[k]);
    orl_heldout_finish(&shot);
    return result;
}

// The photograph with the largest share among those not yet proven; photo_count if there is none.
static size_t next_accused(const struct finder *f)
{
    size_t next = f->scene->photo_count;
    for (size_t i = 0; i < f->scene->photo_count; i++)
        if (f->shares[i] > 0 && !f->proven[i] &&
            (next == f->scene->photo_count || f->shares[i] > f->shares[next]))
            next = i;
    return next;
}

// An occluder also makes those differ that see what it hides: where only two others see a place, one
// of them with the occluder, their mean is of both. So the photographs are compared again, the most
// occluded first, without those before.
static enum orl_result confirm(struct finder *f, size_t train)
{
    enum orl_result result = ORL_OK;
    size_t proven = 0, photo;
    while (result == ORL_OK && (photo = next_accused(f)) < f->scene->photo_count) {
        double first = f->shares[photo];
        f->shares[photo] = 0;
        if (train - proven < ORL_VALIDATION_TRAIN_MIN)
            orl_image_finish(&f->masks[photo]);
        else if (proven > 0)
            result = find_of(f, photo, f->proven);
        else
            f->shares[photo] = first;
        f->proven[photo] = f->shares[photo] > 0;
        proven += f->proven[photo];
    }
    return result;
}

// The mean of all photographs that see a place, without those that differ from it, and no weights
// by which one alone would decide.
static enum orl_result set_params(struct finder *f)
{
    static const char *const consensus[] = {"paint=gather", "combine=sigma", "weight=equal",
                                            "sampling=bilinear"};
    const struct orl_method *oriel = orl_method_find(f->log, "oriel");
    const struct orl_method *points = orl_method_find(f->log, "points");
    if (!oriel || !points)
        return ORL_ERR_NOT_FOUND;
    f->params[ORL_OCCLUDER_POINTS] = points->params;
    f->params[ORL_OCCLUDER_NEAREST] = f->params[ORL_OCCLUDER_CONSENSUS] = oriel->params;
    return orl_render_params_assign(f->log, &f->params[ORL_OCCLUDER_CONSENSUS], consensus, ORL_COUNT(consensus));
}

enum orl_result orl_occluders_find(struct orl_gpu *gpu, const struct orl_scene *scene,
                                   const struct orl_progress *progress, struct orl_image *masks,
                                   double *shares)
{
    struct finder f = {.log = orl_gpu_log(gpu), .scene = scene, .progress = progress,
                       .masks = masks, .shares = shares};
    size_t train;
    ORL_TRY(orl_validation_check(f.log, scene, &train));
    f.others = orl_array(f.log, scene->photo_count, sizeof *f.others);
    f.skip = orl_array(f.log, scene->photo_count, sizeof *f.skip);
    f.proven = orl_array(f.log, scene->photo_count, sizeof *f.proven);
    enum orl_result result = f.others && f.skip && f.proven ? set_params(&f) : ORL_ERR_MEMORY;
    ORL_THEN(result, orl_renderer_create(gpu, scene, NULL, &f.renderer));
    for (size_t i = 0; result == ORL_OK && i < scene->photo_count; i++) {
        orl_progress_report(progress, "occluders", (double)i, (double)scene->photo_count,
                            scene->photos[i].name);
        if (!scene->photos[i].test)
            result = find_of(&f, i, NULL);
    }
    ORL_THEN(result, confirm(&f, train));
    orl_renderer_destroy(&f.renderer);
    free(f.others);
    free(f.skip);
    free(f.proven);
    return result;
}
