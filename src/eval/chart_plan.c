// Plans what is measured of a scene.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "eval/chart_internal.h"
#include "eval/choice.h"

// Settings that trade accuracy for speed in methods that choose a few photographs for each pixel.
static const char *const option_settings[] = {
    "photos_per_pixel=1", "photos_per_pixel=2", "photos_per_pixel=3", "candidates=2",
    "candidates=3", "candidates=4", "candidates=8", "sampling=bilinear", NULL};
static const int photo_divides[] = {2, 4};
static const int size_divides[] = {2};

static enum orl_result add(const struct orl_log *log, struct chart_plan *plan,
                           const struct chart_config *config)
{
    enum orl_result result = orl_grow(log, (void **)&plan->items, &plan->capacity,
                                      plan->count + 1, sizeof *plan->items);
    if (result == ORL_OK)
        plan->items[plan->count++] = *config;
    return result;
}

// True when each pixel of this method uses a few chosen photographs: only then do the settings
// above matter. What draws several pictures with the settings of another method trades them as that
// one does, in a multiple of the time.
static bool chooses_photographs(const struct orl_render_params *render)
{
    const struct orl_render_option *option = orl_render_option_find("candidates");
    return option && orl_render_option_read(option, render) && !(render->reconstructions > 1);
}

// True when the plan has the configuration already. The user's own values are planned first.
static bool is_planned(const struct chart_plan *plan, const struct chart_config *config)
{
    for (size_t i = 0; i < plan->count; i++)
        if (plan->items[i].method == config->method &&
            strcmp(plan->items[i].setting, config->setting) == 0)
            return true;
    return false;
}

static enum orl_result add_options(const struct orl_log *log, const struct chart_config *base,
                                   struct chart_plan *plan)
{
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && option_settings[i]; i++) {
        struct chart_config config = *base;
        snprintf(config.setting, sizeof config.setting, "%s", option_settings[i]);
        // A setting that the method does not read, or has already, makes no new configuration.
        if (orl_render_params_set(NULL, &config.render, config.setting) == ORL_OK &&
            memcmp(&config.render, &base->render, sizeof base->render) != 0 &&
            !is_planned(plan, &config))
            result = add(log, plan, &config);
    }
    return result;
}

// Adds the method once with each of the user's values.
static enum orl_result add_varied(const struct orl_log *log, const struct orl_scene *scene,
                                  const char *varied, const struct chart_config *base,
                                  struct chart_plan *plan)
{
    const struct orl_names none = {0};
    struct orl_names method = {0};
    struct orl_choices choices = {0};
    char key[64];
    snprintf(key, sizeof key, "%.*s", (int)strcspn(varied, "="), varied);
    const struct orl_render_option *option = orl_render_option_find(key);
    if (option && !orl_render_option_read(option, &base->render))
        return ORL_OK;
    enum orl_result result = orl_names_add(log, &method, base->method->name);
    if (result == ORL_OK)
        result = orl_choices_make(log, scene, ORL_SAMPLE_SRGB, &method, &none, varied, &choices);
    for (size_t i = 0; result == ORL_OK && i < choices.count; i++) {
        struct chart_config config = *base;
        config.render = choices.items[i].params;
        memcpy(config.setting, choices.items[i].setting, sizeof config.setting);
        result = add(log, plan, &config);
    }
    orl_choices_finish(&choices);
    orl_names_finish(&method);
    return result;
}

static enum orl_result add_renderers(struct orl_gpu *gpu, const struct chart_config *base,
                                     struct chart_plan *plan)
{
    static const enum orl_textures kinds[] = {ORL_TEXTURES_BC7, ORL_TEXTURES_YCC,
                                              ORL_TEXTURES_BC1};
    const struct orl_log *log = orl_gpu_log(gpu);
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < ORL_COUNT(photo_divides); i++) {
        struct chart_config config = *base;
        config.photo_divide = photo_divides[i];
        snprintf(config.setting, sizeof config.setting, "photographs at 1/%d", photo_divides[i]);
        result = add(log, plan, &config);
    }
    for (size_t i = 0; result == ORL_OK && i < ORL_COUNT(kinds); i++) {
        struct chart_config config = *base;
        config.textures = kinds[i];
        snprintf(config.setting, sizeof config.setting, "textures %s",
                 orl_textures_names[kinds[i]]);
        if (orl_textures_available(gpu, kinds[i]))
            result = add(log, plan, &config);
    }
    for (size_t i = 0; result == ORL_OK && i < ORL_COUNT(size_divides); i++) {
        struct chart_config config = *base;
        config.size_divide = size_divides[i];
        snprintf(config.setting, sizeof config.setting, "pictures at 1/%d", size_divides[i]);
        result = add(log, plan, &config);
    }
    return result;
}

enum orl_result orl_chart_make_plan(struct orl_gpu *gpu, const struct orl_scene *scene,
                                    const struct orl_chart_params *params,
                                    struct chart_plan *plan)
{
    const struct orl_log *log = orl_gpu_log(gpu);
    const struct orl_names none = {0};
    struct orl_names methods = {0};
    struct orl_choices choices = {0};
    memset(plan, 0, sizeof *plan);
    enum orl_result result = ORL_OK;
    if (!params->methods.count)
        result = orl_names_add(log, &methods, "paired");
    if (result == ORL_OK)
        result = orl_choices_make(log, scene, ORL_SAMPLE_SRGB,
                                  methods.count ? &methods : &params->methods, &none, NULL,
                                  &choices);
    for (size_t i = 0; result == ORL_OK && i < choices.count; i++) {
        struct chart_config base = {.method = choices.items[i].method,
                                          .render = choices.items[i].params,
                                          .textures = ORL_TEXTURES_AUTO, .photo_divide = 1,
                                          .size_divide = 1};
        memcpy(base.setting, choices.items[i].setting, sizeof base.setting);
        result = add(log, plan, &base);
        if (base.setting[0])
            continue;
        if (result == ORL_OK && params->varied)
            result = add_varied(log, scene, params->varied, &base, plan);
        if (params->quick || !chooses_photographs(&base.render))
            continue;
        if (result == ORL_OK)
            result = add_options(log, &base, plan);
        if (result == ORL_OK)
            result = add_renderers(gpu, &base, plan);
    }
    orl_choices_finish(&choices);
    orl_names_finish(&methods);
    if (result != ORL_OK) {
        free(plan->items);
        memset(plan, 0, sizeof *plan);
    }
    return result;
}
