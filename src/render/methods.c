// All methods: one row each. What the names in a row stand for is below them.
#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "render/frame/method.h"

// A row says what differs from these.
#define DEFAULTS ORL_RENDER_OPTIONS(ORL_OPTION_PRESET)

// Photographs of the tiles that see a surface best, and what nothing covers from guessed depth.
#define TILED \
    .paint = &orl_paint_tiled, .select = &orl_select_preselect, .visibility = "soft", .weight = "lumigraph", \
    .combine = &combine_robust, .fill = ORL_FILL_GROUND, .alignment = ORL_ALIGNMENT_ON

// What makes depth and edges better, and frames slower.
#define REFINED \
    , .front_layer = 0.01f, .guess_depths = 16, .antialias = ORL_ANTIALIAS_ON

static const struct orl_combine combine_top = {"top", .sweeps = 2, .states = 2};
static const struct orl_combine combine_sigma = {"sigma", .sweeps = 2, .states = 2};
static const struct orl_combine combine_best = {"best", .sweeps = 1};
static const struct orl_combine combine_robust = {"robust", .sweeps = 0};

const struct orl_method orl_methods[] = {
    {"oriel", "the best photographs per pixel, soft visibility, continuous weights",
     "Buehler 2001's penalty, weights of our own",
     {DEFAULTS TILED REFINED}},
    {"oriel-high", "the mean of five pictures of oriel, for stills and video", "as oriel",
     {DEFAULTS TILED REFINED, .reconstructions = 5}, .variant_of = "oriel"},
    {"oriel-fast", "oriel from two photographs a pixel, of three, sampled bilinearly", "as oriel",
     {DEFAULTS TILED, .sampling = ORL_SAMPLING_BILINEAR, .front_layer = 0.01f, .photos_per_pixel = 2}},
    {"airieau", "all photographs, shadow test, cos(theta)/delta", "Airieau 2012, eq. of 5.3",
     {DEFAULTS}},
    {"ulr", "the best four photographs by angle and resolution",
     "Buehler 2001, 4.2, as SIBR's ulrv2", {DEFAULTS .weight = "ulr", .combine = &combine_top}},
    {"orzan-view", "the four photographs nearest by direction, outliers left out",
     "Orzan 2005, 4.3",
     {DEFAULTS .select = &orl_select_nearest, .visibility = "none", .weight = "selected",
      .combine = &combine_sigma}},
    {"orzan-surface", "all photographs that the surface faces, outliers left out",
     "Orzan 2005, 4.4",
     {DEFAULTS .visibility = "facing", .weight = "normal", .combine = &combine_sigma}},
    {"orzan-shadow", "the best five photographs by shadow maps, outliers left out, holes by medians",
     "Orzan 2005, 4.5",
     {DEFAULTS .select = &orl_select_nearest, .nearest = 5, .visibility = "shadow", .weight = "normal",
      .combine = &combine_sigma, .median = ORL_MEDIAN_HOLES}},
    {"princ", "one photograph a pixel, of the nearest six and some more, without shadow maps",
     "Princ 2014, 2.3",
     {DEFAULTS .select = &orl_select_princ, .nearest = 6, .visibility = "none", .weight = "princ",
      .combine = &combine_best}},
    {"li", "a hull of the silhouettes, all photographs that see it alike, before the room's walls",
     "Li 2003, sections 4 and 5",
     {DEFAULTS .proxy = &orl_proxy_hull, .visibility = "opaque", .weight = "equal", .fill = ORL_FILL_ROOM,
      .hull_side = 128}},
    {"goldluecke", "voxels of silhouettes as billboards, each from the two photographs nearest by axis",
     "Goldluecke 2003, section 3",
     {DEFAULTS .proxy = &orl_proxy_voxels, .paint = &orl_paint_billboards, .fill = ORL_FILL_NONE}},
    {"points", "the splats' own colour: the baseline", "-",
     {DEFAULTS .paint = &orl_paint_points, .front_layer = 0.01f}},
    {0},
};

// --- what the names of options stand for ---

static const void *const proxies[] = {&orl_proxy_splats, &orl_proxy_mesh, &orl_proxy_hull, &orl_proxy_voxels, NULL};
static const void *const painters[] = {&orl_paint_gather, &orl_paint_tiled, &orl_paint_points, &orl_paint_billboards,
                                       NULL};
static const void *const selections[] = {&orl_select_all, &orl_select_nearest, &orl_select_preselect,
                                         &orl_select_princ, NULL};
static const void *const combinations[] = {&orl_combine_mean, &combine_top, &combine_sigma, &combine_best,
                                           &combine_robust, NULL};

static const char *file_at(const char *folder, size_t index)
{
    const char *file = orl_shader_file(folder, index);
    return file ? file + strlen(folder) + 1 : NULL;
}

static const char *visibility_at(size_t index)
{
    return file_at("gather/visibility", index);
}

static const char *weight_at(size_t index)
{
    return file_at("gather/weight", index);
}

ORL_OPTION_ROWS(orl_render_options, orl_render_params, ORL_RENDER_OPTIONS)

// --- methods by name ---

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

const char *orl_method_default(const struct orl_scene *scene)
{
    return scene && scene->defaults.method ? scene->defaults.method : orl_methods[0].name;
}
