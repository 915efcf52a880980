// Photographs removed in groups. To judge each removal by itself takes a dozen frames: many
// photographs have no time for it. The members of a group stand apart, so that the two nearest
// photographs of each stay. All training photographs judge the group at once; what they lose is
// divided among the members nearest to them, and members that cost too much come back.
#include <math.h>
#include <stdlib.h>

#include "core/memory.h"
#include "eval/trim_search.h"

enum {
    GROUP_MIN = 32,  // fewer photographs are tried one by one
    STAY_NEAREST = 2,  // of a member's neighbours
    PASSES_MAX = 6,   // of putting members back
    BACK_DIVIDE = 8,   // at least this part of the members comes back while too much is lost
};

struct group {
    struct trim_state state;     // without the members
    struct trim_move **moves;    // owned, per target: its removal; NULL: it cannot go
    bool *is_member, *stays;     // owned, per target
    double *cost_db;             // owned, per target: a member's part of what all targets lose
    struct trim_score *after;    // owned, per target: without the members
    bool *outdated;              // owned, per target: `after` is of a larger group
};

// --- choosing it ---

static bool is_open(const struct trim_move *move)
{
    return move && !move->dead && !move->blocked;
}

bool orl_trim_has_group(const struct trim_search *s)
{
    size_t open = 0;
    for (size_t i = 0; i < s->move_count; i++)
        open += s->moves[i].part == ORL_TRIM_PHOTOGRAPH && is_open(&s->moves[i]);
    return !orl_trim_has_budget(s) && open >= GROUP_MIN;
}

static double apart(const struct trim_search *s, size_t a, size_t b)
{
    double distance, angle;
    orl_validation_apart(s->source.scene, s->targets.views[a].photo, s->targets.views[b].photo,
                         &distance, &angle);
    return distance + angle;
}

// The photographs nearest to the target that are left, and how far the furthest of them is.
static double nearest_left(const struct trim_search *s, size_t target,
                           size_t nearest[STAY_NEAREST])
{
    double distance[STAY_NEAREST] = {INFINITY, INFINITY};
    for (int k = 0; k < STAY_NEAREST; k++)
        nearest[k] = target;
    for (size_t i = 0; i < s->targets.count; i++) {
        if (i == target || s->state.removed[s->targets.views[i].photo])
            continue;
        double d = apart(s, target, i);
        int at = STAY_NEAREST;
        for (; at > 0 && d < distance[at - 1]; at--)
            if (at < STAY_NEAREST) {
                distance[at] = distance[at - 1];
                nearest[at] = nearest[at - 1];
            }
        if (at < STAY_NEAREST) {
            distance[at] = d;
            nearest[at] = i;
        }
    }
    return distance[STAY_NEAREST - 1];
}

static void set_member(const struct trim_search *s, struct group *g, size_t target, bool member)
{
    g->is_member[target] = member;
    g->state.removed[s->targets.views[target].photo] = member;
    if (member)
        g->state.removed_count++;
    else
        g->state.removed_count--;
}

struct candidate {
    size_t target, nearest[STAY_NEAREST];
    double distance;
};

static int compare_candidates(const void *a, const void *b)
{
    const struct candidate *x = a, *y = b;
    return (x->distance > y->distance) - (x->distance < y->distance);
}

// Members are photographs whose neighbours are nearest.
static enum orl_result choose(const struct trim_search *s, struct group *g)
{
    size_t n = s->targets.count, count = 0;
    struct candidate *all = orl_array(s->source.log, n, sizeof *all);
    if (!all)
        return ORL_ERR_MEMORY;
    for (size_t i = 0; i < s->move_count; i++)
        if (s->moves[i].part == ORL_TRIM_PHOTOGRAPH)
            g->moves[s->moves[i].index] = &s->moves[i];
    for (size_t i = 0; i < n; i++)
        if (is_open(g->moves[i])) {
            struct candidate *c = &all[count++];
            c->target = i;
            c->distance = nearest_left(s, i, c->nearest);
        }
    qsort(all, count, sizeof *all, compare_candidates);
    for (size_t i = 0; i < count; i++) {
        const struct candidate *c = &all[i];
        bool free_to_go = !g->stays[c->target];
        for (int k = 0; k < STAY_NEAREST; k++)
            free_to_go = free_to_go && !g->is_member[c->nearest[k]];
        if (!free_to_go)
            continue;
        set_member(s, g, c->target, true);
        for (int k = 0; k < STAY_NEAREST; k++)
            g->stays[c->nearest[k]] = true;
    }
    free(all);
    return ORL_OK;
}

// --- judging it ---

// The member comes back. again: it may be tried again when there is more room.
static void put_back(const struct trim_search *s, struct group *g, size_t target, bool again)
{
    set_member(s, g, target, false);
    g->moves[target]->blocked = again;
    g->moves[target]->dead = !again;
    g->moves[target]->measured.loss_db = g->cost_db[target];
    g->moves[target]->measured.total_loss_db = s->total_loss_db;
    for (size_t v = 0; v < s->targets.count; v++)
        for (size_t k = 0; k < s->near_count; k++)
            g->outdated[v] |= s->nearest[v][k] == target || s->nearest[target][k] == v;
}

// Views between a member and its neighbours say what is lost where it stood itself.
static enum orl_result look_between(struct trim_search *s, struct group *g)
{
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < s->targets.count; i++) {
        bool stays = false;
        if (!g->is_member[i])
            continue;
        g->moves[i]->measured = (struct trim_measured){.slower = 1};
        result = orl_trim_measure_between(s, i, &g->state, &g->moves[i]->measured, &stays);
        if (result == ORL_OK && stays)
            put_back(s, g, i, false);
    }
    return result;
}

static enum orl_result measure(struct trim_search *s, struct group *g)
{
    enum orl_result result = ORL_OK;
    for (size_t v = 0; result == ORL_OK && v < s->targets.count; v++) {
        struct orl_metrics m;
        if (!g->outdated[v])
            continue;
        result = orl_trim_measure_view(s, s->model->renderer, &g->state, v, true, &m);
        g->after[v] = (struct trim_score){m.psnr_db, m.ssim};
        g->outdated[v] = false;
    }
    return result;
}

// The member nearest to a view; the number of targets: there is none.
static size_t nearest_member(const struct trim_search *s, const struct group *g, size_t view)
{
    size_t best = s->targets.count;
    double least = INFINITY;
    for (size_t i = 0; i < s->targets.count; i++)
        if (g->is_member[i] && i != view && apart(s, view, i) < least) {
            least = apart(s, view, i);
            best = i;
        }
    return best;
}

static void find_costs(const struct trim_search *s, struct group *g)
{
    size_t n = s->targets.count;
    for (size_t i = 0; i < n; i++)
        g->cost_db[i] = g->is_member[i] ? g->moves[i]->measured.beside_db : 0;
    for (size_t v = 0; v < n; v++) {
        size_t near = 0;
        double loss = s->first_db[v] - s->lost_db[v] - g->after[v].db;
        for (size_t k = 0; k < s->near_count; k++)
            near += g->is_member[s->nearest[v][k]];
        for (size_t k = 0; k < s->near_count; k++)
            if (g->is_member[s->nearest[v][k]])
                g->cost_db[s->nearest[v][k]] += loss / (double)(n * near);
    }
}

// The members that cost most, while the group loses more than it may. Their own parts say how many
// they are.
static void put_back_costly(const struct trim_search *s, struct group *g, double loss_db,
                            double loss_ssim)
{
    const struct orl_trim_params *p = s->params;
    bool lost = loss_db > p->tolerance_db || loss_ssim > p->tolerance_ssim;
    size_t members = g->state.removed_count - s->state.removed_count;
    for (size_t k = 0; lost && (k <= members / BACK_DIVIDE || loss_db > p->tolerance_db); k++) {
        size_t worst = s->targets.count;
        for (size_t i = 0; i < s->targets.count; i++)
            if (g->is_member[i] &&
                (worst == s->targets.count || g->cost_db[i] > g->cost_db[worst]))
                worst = i;
        if (worst == s->targets.count)
            return;
        loss_db -= fmax(g->cost_db[worst], 0);
        put_back(s, g, worst, true);
    }
}

// Whether members came back.
static bool shrink(const struct trim_search *s, struct group *g)
{
    size_t members = g->state.removed_count;
    double n = (double)s->targets.count, db = 0, ssim = 0;
    find_costs(s, g);
    for (size_t v = 0; v < s->targets.count; v++) {
        size_t member = nearest_member(s, g, v);
        double loss = s->first_db[v] - g->after[v].db;
        db += g->after[v].db / n;
        ssim += g->after[v].ssim / n;
        if (member < s->targets.count && loss > fmax(s->params->worst_db, s->lost_db[v]))
            put_back(s, g, member, false);
    }
    if (g->state.removed_count == members)
        put_back_costly(s, g, s->trim->before.psnr_db - db, s->trim->before.ssim - ssim);
    return g->state.removed_count < members;
}

// --- taking it ---

// The members that cost least come first: what has to be taken back later are the last steps.
static enum orl_result take(struct trim_search *s, struct group *g)
{
    enum orl_result result = ORL_OK;
    size_t n = s->targets.count;
    find_costs(s, g);
    while (result == ORL_OK && s->state.removed_count < g->state.removed_count) {
        size_t best = n;
        for (size_t i = 0; i < n; i++)
            if (g->is_member[i] && !s->state.removed[s->targets.views[i].photo] &&
                (best == n || g->cost_db[i] < g->cost_db[best]))
                best = i;
        g->moves[best]->measured.loss_db = g->cost_db[best];
        result = orl_trim_take_measured(s, g->moves[best]);
    }
    s->total_loss_db = s->trim->before.psnr_db;
    s->total_loss_ssim = s->trim->before.ssim;
    for (size_t v = 0; v < n; v++) {
        s->now[v] = g->after[v];
        s->lost_db[v] = s->first_db[v] - g->after[v].db;
        s->total_loss_db -= g->after[v].db / (double)n;
        s->total_loss_ssim -= g->after[v].ssim / (double)n;
    }
    return result;
}

static enum orl_result measure_and_take(struct trim_search *s, struct group *g)
{
    size_t n = s->targets.count;
    enum orl_result result = choose(s, g);
    if (result == ORL_OK)
        result = look_between(s, g);
    for (size_t v = 0; v < n; v++)
        g->outdated[v] = true;
    if (result == ORL_OK)
        result = measure(s, g);
    bool shrunk = true;
    for (int pass = 0; result == ORL_OK && shrunk && pass < PASSES_MAX; pass++) {
        shrunk = shrink(s, g);
        if (shrunk)
            result = measure(s, g);
    }
    orl_logf(s->source.log, ORL_LOG_DEBUG, "a group of photographs: %zu of %zu can go",
             g->state.removed_count, n);
    if (result == ORL_OK && g->state.removed_count > s->state.removed_count)
        result = take(s, g);
    return result;
}

enum orl_result orl_trim_try_group(struct trim_search *s)
{
    const struct orl_log *log = s->source.log;
    size_t n = s->targets.count;
    struct group g = {.moves = orl_array(log, n, sizeof *g.moves),
                      .is_member = orl_array(log, n, sizeof *g.is_member),
                      .stays = orl_array(log, n, sizeof *g.stays),
                      .cost_db = orl_array(log, n, sizeof *g.cost_db),
                      .after = orl_array(log, n, sizeof *g.after),
                      .outdated = orl_array(log, n, sizeof *g.outdated)};
    enum orl_result result = g.moves && g.is_member && g.stays && g.cost_db && g.after && g.outdated
                                 ? ORL_OK : ORL_ERR_MEMORY;
    if (result == ORL_OK)
        result = orl_trim_state_copy(log, &s->state, s->source.scene->photo_count, &g.state);
    if (result == ORL_OK)
        result = measure_and_take(s, &g);
    free(g.state.removed);
    free(g.moves);
    free(g.is_member);
    free(g.stays);
    free(g.cost_db);
    free(g.after);
    free(g.outdated);
    return result;
}
