// Colour profiles through Little CMS, which says nothing about one that is damaged.
#include <math.h>
#include <stdlib.h>

#include <lcms2.h>

#include "core/color.h"
#include "core/memory.h"
#include "io/internal.h"

const struct orl_primaries orl_primaries_rec709 = {
    .white = {0.3127, 0.3290}, .red = {0.64, 0.33}, .green = {0.30, 0.60}, .blue = {0.15, 0.06}};

struct orl_profile {
    cmsHPROFILE from;
    cmsHTRANSFORM to_linear;
    bool grey; // one channel
};

// Little CMS takes samples beyond 1e22 for negative light: infinities, as the sun has in half floats, would become black.
static const float SAMPLE_MAX = 1e20f;

// Pictures of grey have three equal channels, the first of which counts.
#define GREY_OF_3(type) ((type) | EXTRA_SH(2))

static cmsHPROFILE make_rgb(const struct orl_primaries *p, double gamma)
{
    const double srgb[5] = {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045};
    const cmsCIExyY white = {p->white[0], p->white[1], 1};
    const cmsCIExyYTRIPLE primaries = {
        {p->red[0], p->red[1], 1}, {p->green[0], p->green[1], 1}, {p->blue[0], p->blue[1], 1}};
    cmsToneCurve *line = gamma > 0 ? cmsBuildGamma(NULL, gamma) : cmsBuildParametricToneCurve(NULL, 4, srgb);
    cmsToneCurve *const curves[3] = {line, line, line};
    cmsHPROFILE profile = line ? cmsCreateRGBProfile(&white, &primaries, curves) : NULL;
    if (line)
        cmsFreeToneCurve(line);
    return profile;
}

// From samples of the profile to RGB of Rec. 709 primaries, light raised to 1 / gamma, or with 0 by sRGB's curve.
static cmsHTRANSFORM make_transform(const struct orl_profile *profile, cmsUInt32Number samples, double gamma,
                                    cmsUInt32Number rgb)
{
    cmsHPROFILE to = make_rgb(&orl_primaries_rec709, gamma);
    cmsHTRANSFORM transform = to ? cmsCreateTransform(profile->from, samples, to, rgb,
                                                      INTENT_RELATIVE_COLORIMETRIC, cmsFLAGS_NOCACHE)
                                 : NULL;
    if (to)
        cmsCloseProfile(to);
    return transform;
}

// Compares colours over the whole cube, whatever the profile is called.
static bool is_srgb(const struct orl_profile *profile)
{
    enum { STEPS = 6 };
    const float tolerance = 2.0f / 255;
    for (int i = 0; i < STEPS * STEPS * STEPS; i++) {
        const float stored[3] = {(float)(i % STEPS) / (STEPS - 1),
                                 (float)(i / STEPS % STEPS) / (STEPS - 1),
                                 (float)(i / STEPS / STEPS) / (STEPS - 1)};
        float linear[3];
        if (profile->grey && !(stored[0] == stored[1] && stored[1] == stored[2]))
            continue;
        cmsDoTransform(profile->to_linear, stored, linear, 1);
        for (int c = 0; c < 3; c++)
            if (fabsf(orl_srgb_encode(linear[c]) - stored[c]) > tolerance)
                return false;
    }
    return true;
}

// Takes `from`; NULL: it could not be made. unusable: said of one that cannot be used. exact: a profile near sRGB counts, too
static struct orl_profile *create(const struct orl_log *log, const char *path, cmsHPROFILE from,
                                  const char *unusable, bool exact)
{
    cmsColorSpaceSignature space = from ? cmsGetColorSpace(from) : cmsSigLabData;
    struct orl_profile *profile = orl_array(log, 1, sizeof *profile);
    if (!profile) {
        if (from)
            cmsCloseProfile(from);
        return NULL;
    }
    profile->from = from;
    profile->grey = space == cmsSigGrayData;
    if (profile->grey || space == cmsSigRgbData)
        profile->to_linear = make_transform(profile, profile->grey ? GREY_OF_3(TYPE_GRAY_FLT) : TYPE_RGB_FLT, 1,
                                            TYPE_RGB_FLT);
    if (!profile->to_linear)
        orl_logf(log, ORL_LOG_WARNING, "%s: its %s", path, unusable);
    if (!profile->to_linear || (!exact && is_srgb(profile)))
        orl_profile_destroy(&profile);
    return profile;
}

struct orl_profile *orl_profile_create(const struct orl_log *log, const char *path,
                                       const void *icc, size_t size)
{
    cmsHPROFILE from = size <= UINT32_MAX ? cmsOpenProfileFromMem(icc, (cmsUInt32Number)size) : NULL;
    return create(log, path, from, "colour profile cannot be used; taken as sRGB", false);
}

struct orl_profile *orl_profile_create_rgb(const struct orl_log *log, const char *path,
                                           const struct orl_primaries *primaries, double gamma)
{
    return create(log, path, make_rgb(primaries, gamma),
                  "primaries cannot be used; taken as those of sRGB", gamma > 0);
}

void orl_profile_destroy(struct orl_profile **handle)
{
    struct orl_profile *profile = *handle;
    if (!profile)
        return;
    if (profile->to_linear)
        cmsDeleteTransform(profile->to_linear);
    if (profile->from)
        cmsCloseProfile(profile->from);
    free(profile);
    *handle = NULL;
}

void orl_profile_to_linear(const struct orl_profile *profile, struct orl_image *image)
{
    size_t width = (size_t)image->width;
    for (size_t y = 0; y < (size_t)image->height; y++) {
        float *row = image->f32 + 3 * y * width;
        for (size_t i = 0; i < 3 * width; i++)
            row[i] = row[i] > SAMPLE_MAX ? SAMPLE_MAX : row[i]; // NaN stays
        cmsDoTransform(profile->to_linear, row, row, (cmsUInt32Number)width);
        for (size_t i = 0; i < 3 * width; i++)
            row[i] = row[i] > 0 ? row[i] : 0;
    }
}

enum orl_result orl_profile_to_srgb(const struct orl_log *log, const struct orl_profile *profile,
                                    struct orl_image *image)
{
    size_t width = (size_t)image->width;
    cmsHTRANSFORM transform = make_transform(profile, profile->grey ? GREY_OF_3(TYPE_GRAY_8) : TYPE_RGB_8, 0, TYPE_RGB_8);
    if (!transform)
        return orl_fail(log, ORL_ERR_MEMORY, "no memory to convert colours");
    for (size_t y = 0; y < (size_t)image->height; y++) {
        uint8_t *row = image->u8 + 3 * y * width;
        cmsDoTransform(transform, row, row, (cmsUInt32Number)width);
    }
    cmsDeleteTransform(transform);
    return ORL_OK;
}
