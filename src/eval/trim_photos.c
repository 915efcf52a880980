// Which photographs go first, and which must stay.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "eval/trim_search.h"

enum {
    NEAREST = 2,
    MENDS_MAX = 4, // of photographs that go together
};
// Views beside a photograph that goes may change by as much as renderings there are wrong anyway.
static const double between_max_db = 3;

// The training photographs nearest to a photograph that are left, the nearest first.
struct neighbours {
    size_t photo[NEAREST]; // the scene's photo_count: there are fewer
    double sum;            // of their distances
};

static struct neighbours nearest_left(const struct orl_scene *scene, const bool *removed, size_t photo)
{
    struct neighbours n = {.photo = {photo, photo}};
    for (int k = 0; k < NEAREST; k++) {
        n.photo[k] = orl_validation_nearest(scene, photo, removed, false, n.photo[0]);
        n.sum += n.photo[k] < scene->photo_count ? orl_validation_apart(scene, photo, n.photo[k]) : INFINITY;
    }
    return n;
}

enum orl_result orl_trim_order_photos(struct trim_search *s)
{
    const struct orl_scene *scene = s->scene;
    const size_t n = scene->photo_count;
    bool *removed = orl_array(s->log, n, sizeof *removed);
    struct neighbours *near = orl_array(s->log, n, sizeof *near);
    s->order = orl_array(s->log, s->targets.count, sizeof *s->order);
    enum orl_result result = removed && near && s->order ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < n; i++)
        near[i] = nearest_left(scene, removed, i);
    for (size_t k = 0; result == ORL_OK && k < s->targets.count; k++) {
        size_t next = n;
        for (size_t i = 0; i < n; i++)
            if (!removed[i] && !scene->photos[i].test && (next == n || near[i].sum < near[next].sum))
                next = i;
        removed[next] = true;
        s->order[k] = next;
        for (size_t i = 0; i < n; i++)
            if (near[i].photo[0] == next || near[i].photo[1] == next)
                near[i] = nearest_left(scene, removed, i);
    }
    free(removed);
    free(near);
    return result;
}

// --- views beside photographs that go ---

// How far a view half way to a neighbour changes when photographs go, in dB of PSNR: their squared
// difference adds to the squared error that a rendering there has anyway, which is taken to be that
// of the photograph's own view.
static enum orl_result between_loss(struct trim_search *s, const bool *removed, size_t target,
                                    size_t photo, double *loss_db)
{
    struct orl_renderer *renderer = orl_trim_model_of(s->now)->renderer;
    const struct orl_render_params *render = &s->now->render;
    struct orl_heldout between = s->targets.views[target];
    struct orl_image with = {0}, without = {0};
    between.view = orl_view_interpolate(&between.view, &s->scene->photos[photo].view, 0.5);
    if (orl_progress_cancelled(s->params->progress))
        return ORL_ERR_CANCELLED;
    enum orl_result result = orl_heldout_draw(s->log, renderer, &s->targets.scene, &between, render, NULL, &with, NULL);
    ORL_THEN(result, orl_heldout_draw(s->log, renderer, &s->targets.scene, &between, render, removed, &without, NULL));
    if (result == ORL_OK)
        *loss_db = 10 * log10(1 + pow(10, 0.1 * (s->first->score.views[target][0] -
                                                 orl_metrics_psnr_db(&with, &without))));
    orl_image_finish(&with);
    orl_image_finish(&without);
    return result;
}

static void put_back(struct trim_state *state, size_t photo)
{
    state->removed[photo] = false;
    state->removed_count--;
}

static enum orl_result put_back_beside(struct trim_search *s, struct trim_state *state)
{
    for (size_t i = 0; i < s->targets.count; i++) {
        size_t photo = s->targets.views[i].photo;
        double loss = 0;
        if (!state->removed[photo])
            continue;
        struct neighbours near = nearest_left(s->scene, state->removed, photo);
        for (int k = 0; k < NEAREST && loss <= between_max_db; k++)
            if (near.photo[k] < s->scene->photo_count)
                ORL_TRY(between_loss(s, state->removed, i, near.photo[k], &loss));
        if (loss > between_max_db)
            put_back(state, photo);
    }
    return ORL_OK;
}

// Puts back what measured views need that lose too much; the state then has to be measured again.
// False: there are none.
static bool mend(const struct trim_search *s, struct trim_state *t)
{
    bool mended = false;
    for (size_t v = 0; v < t->score.count; v++) {
        size_t photo = s->targets.views[v].photo, near = orl_validation_nearest(s->scene, photo, t->removed, true, photo);
        if (near == s->scene->photo_count || t->score.views[v][0] >= s->first->score.views[v][0] - s->most.worst_db)
            continue;
        put_back(t, near);
        mended = true;
    }
    if (mended)
        orl_score_finish(&t->score);
    return mended;
}

enum orl_result orl_trim_remove_photos(struct trim_search *s, size_t count, struct trim_state *t)
{
    memset(t->removed, 0, s->scene->photo_count * sizeof *t->removed);
    t->removed_count = count;
    for (size_t k = 0; k < count; k++)
        t->removed[s->order[k]] = true;
    ORL_TRY(put_back_beside(s, t));
    ORL_TRY(orl_trim_measure(s, t));
    for (int i = 0; i < MENDS_MAX && mend(s, t); i++)
        ORL_TRY(orl_trim_measure(s, t));
    snprintf(t->step.what, sizeof t->step.what, "photographs %zu of %zu", s->targets.count - t->removed_count,
             s->targets.count);
    return ORL_OK;
}
