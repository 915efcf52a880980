// Methods and their options: one table each.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "shared/render_blocks.h"
#include "render/render.h"

// points_per_pixel: as few as cost under 0.02 dB (docs/performance.md).
// distance_floor: best of a few values when each training photograph of fountain-P11 is rendered from
// the others; held-out photographs took no part.
#define COMMON_DEFAULTS                                                                    \
    .depth_tolerance = 0.01f, .splat_scale = 1.0f, .distance_floor = 0.03f,                 \
    .border_px = 8.0f, .ghosts = 1.0f, .points_per_pixel = 4.0f, .sharpness = 3.0f,        \
    .guess_sharpness = 1.5f, .guess_blur = 0.06f, .unknown_trust = 0.5f, .outliers = 0.3f

// Our depth from splats, chosen like distance_floor; the paper's is that of the nearest alone.
#define PROXY_DEFAULTS .front_layer = 0.01f, .min_support = 8.0f

// What each pixel of blend=best asks and blends.
#define BEST_DEFAULTS .candidates = 6.0f, .photos_per_pixel = 4.0f

const struct orl_method orl_methods[] = {
    {"oriel", "the best photographs per pixel, soft visibility, continuous weights",
     "Buehler 2001's penalty, weights of our own",
     {.color = ORL_COLOR_PHOTOS, .visibility = ORL_VISIBILITY_HARD, .fill = ORL_FILL_GROUND,
      .sampling = ORL_SAMPLING_BICUBIC, .blend = ORL_BLEND_BEST, COMMON_DEFAULTS, PROXY_DEFAULTS,
      BEST_DEFAULTS, .alignment = ORL_ALIGNMENT_ON, .silhouette = 2.0f,
      .antialias = ORL_ANTIALIAS_ON}},
    {"oriel-fast", "oriel from two photographs a pixel, of three, sampled bilinearly",
     "as oriel",
     {.color = ORL_COLOR_PHOTOS, .visibility = ORL_VISIBILITY_HARD, .fill = ORL_FILL_GROUND,
      .sampling = ORL_SAMPLING_BILINEAR, .blend = ORL_BLEND_BEST, COMMON_DEFAULTS,
      .min_support = 8.0f, .alignment = ORL_ALIGNMENT_ON, .candidates = 3.0f,
      .photos_per_pixel = 2.0f}},
    {"airieau", "all photographs, shadow test, cos(theta)/delta", "Airieau 2012, eq. of 5.3",
     {.color = ORL_COLOR_PHOTOS, .visibility = ORL_VISIBILITY_HARD, .fill = ORL_FILL_COLOR,
      .sampling = ORL_SAMPLING_BICUBIC, COMMON_DEFAULTS, BEST_DEFAULTS}},
    {"points", "the splats' own colour: the baseline", "-",
     {.color = ORL_COLOR_POINTS, .visibility = ORL_VISIBILITY_NONE, .fill = ORL_FILL_COLOR,
      .sampling = ORL_SAMPLING_BILINEAR, COMMON_DEFAULTS, PROXY_DEFAULTS, BEST_DEFAULTS}},
    {0},
};

static const char *const color_names[] = {"points", "photos", NULL};
static const char *const visibility_names[] = {"none", "hard", NULL};
static const char *const sampling_names[] = {"bilinear", "bicubic", NULL};
static const char *const alignment_names[] = {"off", "on", NULL};
static const char *const antialias_names[] = {"off", "on", NULL};
static const char *const blend_names[] = {"all", "best", NULL};
static const char *const fill_names[] = {"none", "color", "depth", "ground", NULL};

#define FIELD(name) offsetof(struct orl_render_params, name)

const struct orl_render_option orl_render_options[] = {
    {"color", FIELD(color), color_names, 0, 0, "",
     "points: the splats' own colour; photos: blended photographs"},
    {"visibility", FIELD(visibility), visibility_names, 0, 0, "",
     "which photographs see a surface point: all, or those whose depth map agrees"},
    {"fill", FIELD(fill), fill_names, 0, 0, "",
     "pixels without splats: black, neighbours' colour, photographs at a guessed depth, or "
     "that and no farther than the ground"},
    {"sampling", FIELD(sampling), sampling_names, 0, 0, "",
     "of photographs; bicubic is sharper and takes five fetches instead of one"},
    {"alignment", FIELD(alignment), alignment_names, 0, 0, "",
     "photographs are brought to one exposure and white balance, their vignetting undone"},
    {"antialias", FIELD(antialias), antialias_names, 0, 0, "",
     "depth edges are averaged with their neighbours, as in photographs; not of radiance"},
    {"blend", FIELD(blend), blend_names, 0, 0, "",
     "all photographs that see a pixel, or the best few, chosen per tile"},
    {"photos_per_pixel", FIELD(photos_per_pixel), NULL, 1, KEPT_MAX, "photographs",
     "blended into a pixel by blend=best"},
    {"candidates", FIELD(candidates), NULL, 1, CANDIDATES, "photographs",
     "of its tile that a pixel asks; fewer are faster, and miss more behind obstacles"},
    {"outliers", FIELD(outliers), NULL, 0, 1, "square root of light",
     "a sample that differs by this much from the consensus counts half; 0: all count"},
    {"sharpness", FIELD(sharpness), NULL, 0, 64, "",
     "how fast blend=best prefers the better photograph; 0: equal weights"},
    {"guess_sharpness", FIELD(guess_sharpness), NULL, 0, 64, "",
     "the same where only a guessed depth is known"},
    {"guess_blur", FIELD(guess_blur), NULL, 0, 1, "share of parallax",
     "that colour may lie from its place where depth is guessed and photographs differ; blurred "
     "as far; 0: not"},
    {"unknown_trust", FIELD(unknown_trust), NULL, 0, 1, "share",
     "of a photograph that has no depth where the surface would be"},
    {"depth_tolerance", FIELD(depth_tolerance), NULL, 1e-5, 0.5, "fraction of depth",
     "how far depths may differ on the same surface"},
    {"splat_scale", FIELD(splat_scale), NULL, 0.01, 16, "",
     "multiplies splat radii; larger closes more holes and fattens edges"},
    {"front_layer", FIELD(front_layer), NULL, 0, 0.1, "fraction of depth",
     "splats this close behind the nearest one are averaged with it; 0: the nearest alone"},
    {"min_support", FIELD(min_support), NULL, 0, 25, "pixels of 5x5",
     "with a surface at the same depth that a pixel needs, else it is a stray point; above 0, "
     "holes with 13 around them are closed"},
    {"silhouette", FIELD(silhouette), NULL, 0, 4, "pixels",
     "by which depth may reach past silhouettes; where photographs agree far better on what is "
     "behind, blend=best takes it back; 0: nowhere"},
    {"points_per_pixel", FIELD(points_per_pixel), NULL, 0, 64, "points",
     "above which splats are thinned and enlarged; 0: all are drawn"},
    {"distance_floor", FIELD(distance_floor), NULL, 1e-4, 1, "fraction of viewing distance",
     "keeps Airieau's distance difference from zero"},
    {"border_px", FIELD(border_px), NULL, 0, 1024, "pixels of the photograph",
     "photographs fade out over this width at their border"},
    {"ghosts", FIELD(ghosts), NULL, 0, 16, "stops",
     "of radiance: samples this far from the others count half, beyond noise and edges; 0: all "
     "count"},
    {0},
};

// Nothing that is there to trade quality for time, such as photos_per_pixel.
const struct orl_render_tries orl_render_tries[] = {
    {"sharpness", 6, {1, 2, 3, 4, 6, 10}},
    {"depth_tolerance", 5, {0.003, 0.005, 0.01, 0.02, 0.04}},
    {"min_support", 5, {0, 4, 8, 12, 16}},
    {"front_layer", 4, {0, 0.005, 0.01, 0.02}},
    {"splat_scale", 3, {0.7, 1, 1.4}},
    {"silhouette", 4, {0, 1, 2, 3}},
    {"guess_sharpness", 5, {0.5, 1, 2, 4, 8}},
    {"guess_blur", 5, {0, 0.03, 0.06, 0.12, 0.25}},
    {"unknown_trust", 5, {0, 0.02, 0.05, 0.15, 0.5}},
    {"distance_floor", 4, {0.01, 0.03, 0.1, 0.3}},
    {"border_px", 4, {4, 8, 16, 48}},
    {0},
};

const struct orl_method *orl_method_find(const struct orl_log *log, const char *name)
{
    char list[256] = "";
    for (const struct orl_method *m = orl_methods; m->name; m++) {
        if (strcmp(m->name, name) == 0)
            return m;
        size_t used = strlen(list);
        snprintf(list + used, sizeof list - used, " %s", m->name);
    }
    orl_logf(log, ORL_LOG_ERROR, "method %s is not known; there are:%s", name, list);
    return NULL;
}

static enum orl_result set_name(const struct orl_log *log, const struct orl_render_option *option,
                                const char *text, int *value)
{
    char list[256] = "";
    for (int i = 0; option->names[i]; i++) {
        if (strcmp(option->names[i], text) == 0) {
            *value = i;
            return ORL_OK;
        }
        size_t used = strlen(list);
        snprintf(list + used, sizeof list - used, " %s", option->names[i]);
    }
    return orl_fail(log, ORL_ERR_ARGUMENT, "%s=%s: must be one of%s", option->key, text, list);
}

static enum orl_result set_option(const struct orl_log *log,
                                  const struct orl_render_option *option, const char *text,
                                  struct orl_render_params *params)
{
    char *field = (char *)params + option->offset;
    if (option->names) {
        int value = 0;
        enum orl_result result = set_name(log, option, text, &value);
        if (result == ORL_OK)
            memcpy(field, &value, sizeof value); // enums of this struct are ints
        return result;
    }
    char *end;
    double value = strtod(text, &end);
    if (end == text || *end || !(value >= option->min && value <= option->max))
        return orl_fail(log, ORL_ERR_ARGUMENT, "%s=%s: must be a number from %g to %g",
                        option->key, text, option->min, option->max);
    *(float *)field = (float)value;
    return ORL_OK;
}

enum orl_result orl_render_params_set(const struct orl_log *log, struct orl_render_params *params,
                                      const char *assignment)
{
    size_t length = strcspn(assignment, "=");
    if (assignment[length] != '=')
        return orl_fail(log, ORL_ERR_ARGUMENT, "%s: must be KEY=VALUE", assignment);
    char list[512] = "";
    for (const struct orl_render_option *o = orl_render_options; o->key; o++) {
        if (strlen(o->key) == length && strncmp(o->key, assignment, length) == 0)
            return set_option(log, o, assignment + length + 1, params);
        size_t used = strlen(list);
        snprintf(list + used, sizeof list - used, " %s", o->key);
    }
    return orl_fail(log, ORL_ERR_ARGUMENT, "option %.*s is not known; there are:%s", (int)length,
                    assignment, list);
}
