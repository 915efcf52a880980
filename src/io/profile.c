// Colour profiles through Little CMS.
#include <stdlib.h>

#include <lcms2.h>

#include "core/memory.h"
#include "io/internal.h"

struct orl_profile {
    cmsContext context;
    cmsHTRANSFORM transform;
};

// A profile with white point D65, Rec. 709 primaries and a linear curve.
static cmsHPROFILE linear_rec709(cmsContext context)
{
    const cmsCIExyY white = {0.3127, 0.3290, 1};
    const cmsCIExyYTRIPLE primaries = {{0.64, 0.33, 1}, {0.30, 0.60, 1}, {0.15, 0.06, 1}};
    cmsToneCurve *line = cmsBuildGamma(context, 1);
    cmsToneCurve *const curves[3] = {line, line, line};
    cmsHPROFILE profile =
        line ? cmsCreateRGBProfileTHR(context, &white, &primaries, curves) : NULL;
    if (line)
        cmsFreeToneCurve(line);
    return profile;
}

static bool make_transform(struct orl_profile *profile, const void *icc, size_t size)
{
    profile->context = cmsCreateContext(NULL, NULL); // without a handler messages are dropped
    if (!profile->context || size > UINT32_MAX)
        return false;
    cmsHPROFILE from = cmsOpenProfileFromMemTHR(profile->context, icc, (cmsUInt32Number)size);
    cmsHPROFILE to = linear_rec709(profile->context);
    if (from && to && cmsGetColorSpace(from) == cmsSigRgbData)
        profile->transform = cmsCreateTransformTHR(profile->context, from, TYPE_RGB_FLT, to,
                                                   TYPE_RGB_FLT, INTENT_RELATIVE_COLORIMETRIC,
                                                   cmsFLAGS_NOCACHE);
    if (from)
        cmsCloseProfile(from);
    if (to)
        cmsCloseProfile(to);
    return profile->transform != NULL;
}

struct orl_profile *orl_profile_create(const struct orl_log *log, const char *path,
                                       const void *icc, size_t size)
{
    struct orl_profile *profile = orl_array(log, 1, sizeof *profile);
    if (profile && !make_transform(profile, icc, size)) {
        orl_logf(log, ORL_LOG_WARNING, "%s: its colour profile cannot be used; taken as sRGB",
                 path);
        orl_profile_destroy(&profile);
    }
    return profile;
}

void orl_profile_destroy(struct orl_profile **handle)
{
    struct orl_profile *profile = *handle;
    if (!profile)
        return;
    if (profile->transform)
        cmsDeleteTransform(profile->transform);
    if (profile->context)
        cmsDeleteContext(profile->context);
    free(profile);
    *handle = NULL;
}

void orl_profile_apply(const struct orl_profile *profile, struct orl_image *image)
{
    size_t width = (size_t)image->width;
    for (size_t y = 0; y < (size_t)image->height; y++) {
        float *row = image->f32 + 3 * y * width;
        cmsDoTransform(profile->transform, row, row, (cmsUInt32Number)width);
        for (size_t i = 0; i < 3 * width; i++)
            row[i] = row[i] > 0 ? row[i] : 0;
    }
}
