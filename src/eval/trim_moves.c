// The steps that can make a model smaller.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "eval/trim_search.h"

// A view is rendered from two photographs at least when it is left out itself.
enum { TRAIN_MIN = 3 };

// Options whose cheaper values save time.
static const char *const cheaper[] = {
    "sampling=bilinear", "antialias=off", "median=off", "guess_blur=0",
    "outliers=0", "min_support=0", "photos_per_pixel=3", "photos_per_pixel=2", "candidates=4",
    "candidates=3", "points_per_pixel=1"};

static double number_of(const struct orl_render_option *option,
                        const struct orl_render_params *render)
{
    float value;
    memcpy(&value, (const char *)render + option->offset, sizeof value);
    return (double)value;
}

// Sets `next` to the options with this assignment. False when it changes nothing or the method does
// not read it.
static bool assign(const struct orl_render_params *render, const char *assignment,
                   struct orl_render_params *next)
{
    char key[64];
    snprintf(key, sizeof key, "%.*s", (int)strcspn(assignment, "="), assignment);
    const struct orl_render_option *option = orl_render_option_find(key);
    *next = *render;
    if (!option || orl_render_params_set(NULL, next, assignment) != ORL_OK)
        return false;
    if (option->kind == ORL_OPTION_NUMBER)
        return number_of(option, next) < number_of(option, render);
    return memcmp(next, render, sizeof *next) != 0;
}

// Kinds of textures come in the order of their bytes. Software renderers decode BC7 several times
// as slowly.
static bool is_smaller(const struct trim_search *s, enum orl_textures from, enum orl_textures to)
{
    bool software = orl_gpu_caps(s->source.gpu)->software;
    return to > from && !(software && to == ORL_TEXTURES_BC7) &&
           orl_textures_available(s->source.gpu, to);
}

bool orl_trim_is_possible(const struct trim_search *s, const struct trim_move *move)
{
    struct orl_render_params next;
    const struct trim_state *state = &s->state;
    switch (move->part) {
    case ORL_TRIM_POINTS:
        return state->points + move->index < TRIM_POINT_LEVELS &&
               s->source.scene->points.count > 0;
    case ORL_TRIM_PHOTOGRAPH:
        return s->targets.count - state->removed_count > TRAIN_MIN;
    case ORL_TRIM_TEXTURES:
        return is_smaller(s, state->textures, (enum orl_textures)move->index);
    case ORL_TRIM_DEPTH:
        return state->depth + 1 < TRIM_DEPTH_LEVELS;
    case ORL_TRIM_RESOLUTION:
        return state->scale + 1 < TRIM_SCALE_LEVELS;
    case ORL_TRIM_QUALITY:
        return state->quality + 1 < TRIM_QUALITY_LEVELS;
    default:
        return assign(&state->render, cheaper[move->index], &next);
    }
}

bool orl_trim_redraws_depth(const struct trim_move *move)
{
    char key[64];
    if (move->part != ORL_TRIM_OPTION)
        return false;
    snprintf(key, sizeof key, "%.*s", (int)strcspn(cheaper[move->index], "="),
             cheaper[move->index]);
    const struct orl_render_option *option = orl_render_option_find(key);
    return option && strstr(option->readers, "proxy=");
}

void orl_trim_apply(const struct trim_search *s, const struct trim_move *move,
                    struct trim_state *state, char what[96])
{
    size_t photo;
    struct orl_scene_defaults defaults;
    struct orl_render_params next;
    enum { SIZE = 96 };
    switch (move->part) {
    case ORL_TRIM_POINTS:
        state->points += move->index;
        snprintf(what, SIZE, "points %.3g %%", 100 * orl_trim_point_shares[state->points]);
        break;
    case ORL_TRIM_PHOTOGRAPH:
        photo = s->targets.views[move->index].photo;
        state->removed[photo] = true;
        state->removed_count++;
        snprintf(what, SIZE, "without %.80s", s->source.scene->photos[photo].name);
        break;
    case ORL_TRIM_TEXTURES:
        state->textures = (enum orl_textures)move->index;
        snprintf(what, SIZE, "textures %s", orl_textures_names[state->textures]);
        break;
    case ORL_TRIM_DEPTH:
        state->depth++;
        defaults = orl_trim_defaults(&s->source, state);
        snprintf(what, SIZE, "depth 1/%d, %d bits", defaults.depth_divide,
                 defaults.depth_half ? 16 : 32);
        break;
    case ORL_TRIM_RESOLUTION:
        snprintf(what, SIZE, "photographs at %.3g", orl_trim_scales[++state->scale]);
        break;
    case ORL_TRIM_QUALITY:
        snprintf(what, SIZE, "JPEG quality %d", orl_trim_qualities[++state->quality]);
        break;
    default:
        if (assign(&state->render, cheaper[move->index], &next))
            state->render = next;
        snprintf(what, SIZE, "%s", cheaper[move->index]);
    }
}

// --- the plan ---

size_t orl_trim_validation_view(const struct trim_search *s, size_t i, size_t count)
{
    return (2 * i + 1) * s->targets.count / (2 * count);
}

// Finds the targets that a photograph's removal is judged by.
static void find_nearest(struct trim_search *s, size_t target)
{
    double distance[TRIM_NEAR];
    size_t count = 0;
    for (size_t i = 0; i < s->targets.count; i++) {
        double d, angle;
        orl_validation_apart(s->source.scene, s->targets.views[target].photo,
                             s->targets.views[i].photo, &d, &angle);
        d += angle;
        size_t at = count < s->near_count ? count : s->near_count;
        if (i == target || (at == s->near_count && d >= distance[at - 1]))
            continue;
        at = count < s->near_count ? count++ : s->near_count - 1;
        for (; at > 0 && d < distance[at - 1]; at--) {
            distance[at] = distance[at - 1];
            s->nearest[target][at] = s->nearest[target][at - 1];
        }
        distance[at] = d;
        s->nearest[target][at] = i;
    }
}

// What a photograph or an option is taken to cost before it is tried, as a share of the tolerance,
// and what an option or a small step is taken to save. To try all of them takes longest, and less in
// a model that other steps have made smaller: steps that promise more come first.
static const double untried_cost = 0.25, option_gain = 0.05;
// Levels of points that are taken at once, and where they lose too much.
enum { POINT_STEP = 2, SMALL_POINT_STEP = 1 };

static void add_move(struct trim_search *s, enum orl_trim_part part, size_t index)
{
    struct trim_move move = {.part = part, .index = index, .ratio = INFINITY};
    double gain = part == ORL_TRIM_PHOTOGRAPH ? 1 / (double)s->targets.count : option_gain;
    bool late = part == ORL_TRIM_PHOTOGRAPH || part == ORL_TRIM_OPTION ||
                (part == ORL_TRIM_POINTS && index == SMALL_POINT_STEP);
    if (late && s->params->tolerance_db > 0)
        move.ratio = gain / (untried_cost * s->params->tolerance_db);
    if (orl_trim_is_possible(s, &move))
        s->moves[s->move_count++] = move;
}

// Photographs can be written anew unless other files have their pixels.
static bool is_rewritable(const struct orl_log *log, const struct orl_scene *scene)
{
    char *mesh = orl_scene_mesh_path(log, scene);
    bool rewritable = mesh && !orl_path_is_file(mesh) && scene->frame_count == 0;
    for (size_t i = 0; i < scene->photo_count; i++)
        rewritable = rewritable && !scene->photos[i].linear && !scene->photos[i].masked;
    free(mesh);
    return rewritable;
}

enum orl_result orl_trim_plan(struct trim_search *s)
{
    size_t n = s->targets.count, views = s->params->views;
    views = views && views < n ? views : n;
    s->validation_count = views < TRIM_VIEWS_MAX ? views : TRIM_VIEWS_MAX;
    s->near_count = n - 1 < TRIM_NEAR ? n - 1 : TRIM_NEAR;
    s->nearest = orl_array(s->source.log, n, sizeof *s->nearest);
    s->moves = orl_array(s->source.log,
                         n + ORL_TRIM_PART_COUNT + ORL_TEXTURES_COUNT + ORL_COUNT(cheaper),
                         sizeof *s->moves);
    if (!s->nearest || !s->moves)
        return ORL_ERR_MEMORY;
    for (size_t i = 0; i < n; i++)
        find_nearest(s, i);
    bool all = !s->params->settings_only;
    s->source.rewritable = all && is_rewritable(s->source.log, s->source.scene);
    // They are tried in this order: first what saves most, since the time may end.
    add_move(s, ORL_TRIM_DEPTH, 0);
    for (size_t i = ORL_TEXTURES_BC7; i < ORL_TEXTURES_COUNT; i++)
        add_move(s, ORL_TRIM_TEXTURES, i);
    if (all) {
        add_move(s, ORL_TRIM_POINTS, POINT_STEP);
        add_move(s, ORL_TRIM_POINTS, SMALL_POINT_STEP);
    }
    if (s->source.rewritable) {
        add_move(s, ORL_TRIM_RESOLUTION, 0);
        add_move(s, ORL_TRIM_QUALITY, 0);
    }
    for (size_t i = 0; i < ORL_COUNT(cheaper); i++)
        add_move(s, ORL_TRIM_OPTION, i);
    for (size_t i = 0; all && i < n; i++)
        add_move(s, ORL_TRIM_PHOTOGRAPH, i);
    return ORL_OK;
}
