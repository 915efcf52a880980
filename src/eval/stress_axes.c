// The axes: what gets worse, and how far.
#include <string.h>

#include "eval/stress_internal.h"
#include "render/method.h"

// Distance of the bars from the photographs, metres, which turns their width into pixels.
static const double bars_distance_m = 9.8;

static void set_gloss(struct orl_synth_params *generator, double level)
{
    generator->gloss = level;
}

static void set_bars(struct orl_synth_params *generator, double level)
{
    int side = generator->width > generator->height ? generator->width : generator->height;
    generator->bars_m = level * bars_distance_m / (ORL_SYNTH_FOCAL_35MM / 35.0 * side);
}

static void set_plain(struct orl_synth_params *generator, double level)
{
    generator->plain = level / 100;
}

enum { POINTS = STRESS_CHANGES_POINTS, FILES = STRESS_CHANGES_FILES, COLORS = STRESS_RECOLORS,
       TRUTH = STRESS_NEEDS_TRUTH };

const struct stress_axis orl_stress_axes[] = {
    {"photographs", "photographs left out (three stay)", "%", {0, 25, 50, 65, 75, 100}, COLORS, NULL,
     orl_stress_fewer_photos, {NULL}},
    {"points", "points left out", "%", {0, 50, 80, 90, 97, 99}, POINTS, NULL,
     orl_stress_fewer_points, {NULL}},
    {"depth", "noise of depth", "% of the distance", {0, 0.25, 0.5, 1, 2, 5}, POINTS, NULL,
     orl_stress_noisy_points, {NULL}},
    {"outliers", "outlier points", "% of the points", {0, 1, 2, 5, 10, 20}, POINTS, NULL,
     orl_stress_outliers, {NULL}},
    {"pose", "wrong poses", "px of reprojection", {0, 0.5, 1, 2, 3.5, 5}, 0, NULL,
     orl_stress_pose, {NULL}},
    {"focal", "wrong focal lengths", "%", {0, 0.3, 0.6, 1, 2, 3}, 0, NULL, orl_stress_focal,
     {NULL}},
    {"exposure", "exposures apart, not aligned", "EV", {0, 0.5, 1, 1.5, 2, 3}, FILES | COLORS,
     NULL, orl_stress_exposure, {NULL}},
    {"exposure-aligned", "exposures apart, aligned", "EV", {0, 0.5, 1, 1.5, 2, 3}, FILES, NULL,
     orl_stress_aligned_exposure, {"alignment=on", NULL}},
    {"white-balance", "white balances apart, red against blue", "EV", {0, 0.2, 0.4, 0.7, 1, 1.5},
     FILES | COLORS, NULL, orl_stress_white_balance, {NULL}},
    {"blur", "motion blur", "px", {0, 1, 2, 3, 5, 8}, FILES | COLORS, NULL, orl_stress_blur,
     {NULL}},
    {"noise", "noise of the photographs", "of 255", {0, 2, 5, 10, 20, 40}, FILES | COLORS, NULL,
     orl_stress_noise, {NULL}},
    {"jpeg", "JPEG quality", "", {100, 75, 50, 30, 15, 5}, FILES | STRESS_OWN_START, NULL,
     orl_stress_jpeg, {NULL}},
    {"gloss", "gloss: share of a mirror's light", "", {0, 0.2, 0.4, 0.6, 0.8, 1},
     TRUTH | STRESS_OWN_TRUTH, set_gloss, NULL, {NULL}},
    {"bars", "width of bars before the subject", "px", {10, 5, 3, 2, 1, 0.5},
     TRUTH | STRESS_OWN_START | STRESS_OWN_TRUTH, set_bars, NULL, {NULL}},
    {"plain", "walls without texture, where stereo finds nothing", "% of the walls",
     {0, 10, 25, 50, 75, 100}, TRUTH | STRESS_OWN_TRUTH, set_plain, NULL, {NULL}},
    {"passers-by", "other people in each photograph", "% of the area", {0, 2, 5, 10, 15, 20},
     FILES | COLORS, NULL, orl_stress_passers_by, {NULL}},
    {"silhouettes", "wrong silhouettes, methods on their hull", "px", {0, 1, 2, 3, 5, 8},
     FILES | STRESS_NEEDS_MASKS | STRESS_OWN_START | STRESS_ON_HULL, NULL, orl_stress_silhouettes,
     {"fill=none", NULL}},
    {"hull-cameras", "cameras left out (three stay), methods on their hull", "%",
     {0, 25, 50, 65, 75, 100}, FILES | STRESS_NEEDS_MASKS | STRESS_OWN_START | STRESS_ON_HULL, NULL,
     orl_stress_hull_cameras, {"fill=none", NULL}},
    {"angle", "angle to the nearest photograph used", "degrees", {0, 7, 15, 25, 40, 60}, 0, NULL,
     orl_stress_angle, {NULL}},
    {"nearer", "the viewer comes nearer", "times the distance", {1, 0.8, 0.65, 0.5, 0.35, 0.25},
     TRUTH | STRESS_OWN_TRUTH, NULL, orl_stress_nearer, {NULL}},
    {"farther", "the viewer goes away, the framing kept", "times the distance", {1, 1.3, 1.7, 2.2, 3, 4},
     TRUTH | STRESS_OWN_TRUTH, NULL, orl_stress_farther, {NULL}},
    {0},
};

bool orl_stress_axis_name(size_t index, const char **name, const char **title)
{
    *name = orl_stress_axes[index].name;
    *title = orl_stress_axes[index].title;
    return *name != NULL;
}

// A method that does not read the key, or cannot take the value, stays as it is.
static void set(struct orl_render_params *render, const char *assignment)
{
    struct orl_render_params changed = *render;
    if (orl_render_params_set(NULL, &changed, assignment) == ORL_OK)
        *render = changed;
}

void orl_stress_axis_options(const struct stress_axis *axis, struct orl_render_params *render)
{
    // The hull has no colours for a method that shows the proxy's own.
    if (axis->flags & STRESS_ON_HULL && orl_render_params_equal(render, "proxy=splats") &&
        !orl_render_params_equal(render, "paint=points"))
        set(render, "proxy=mesh");
    for (size_t i = 0; axis->settings[i]; i++)
        set(render, axis->settings[i]);
}

static uint64_t seed_of(const struct stress_axis *axis, uint32_t seed)
{
    uint64_t hash = 1469598103934665603u ^ seed; // FNV-1a
    for (const char *c = axis->name; *c; c++)
        hash = (hash ^ (uint8_t)*c) * 1099511628211u;
    return hash;
}

enum orl_result orl_stress_perturb(const struct stress_case *base,
                                   const struct orl_stress_params *params,
                                   const struct stress_axis *axis, double level, const char *dir,
                                   struct stress_case *c)
{
    enum orl_result result;
    if (axis->generate) {
        struct orl_synth_params generator = orl_stress_generator(params);
        axis->generate(&generator, level);
        result = orl_stress_make_synth(base->gpu, params, &generator, c);
    } else if (axis->flags & STRESS_NEEDS_MASKS && base->synth) {
        result = orl_stress_make_figure(base->gpu, params, c);
    } else {
        result = orl_stress_copy(base, c);
    }
    if (result == ORL_OK && axis->perturb)
        result = axis->perturb(c, level, seed_of(axis, params->seed));
    if (result == ORL_OK && axis->flags & STRESS_RECOLORS)
        result = orl_stress_color_points(orl_gpu_log(c->gpu), c->photos, &c->scene);
    if (result == ORL_OK && axis->flags & STRESS_CHANGES_POINTS)
        result = orl_stress_set_radii(c);
    if (result == ORL_OK && (axis->flags & STRESS_CHANGES_FILES || axis->generate))
        result = orl_stress_write_files(c, dir, (axis->flags & STRESS_ON_HULL) != 0);
    return result;
}
