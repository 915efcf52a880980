#include "preprocess/calibrate/pairs.h"

#include <math.h>
#include <stdlib.h>

#include "core/memory.h"
#include "core/order.h"
#include "preprocess/calibrate/vlad.h"
#include "preprocess/job/threads.h"

enum {
    CANDIDATE = 4,    // matches that make a pair a candidate (the limit of Wu 2013 for 100 features)
    ALIKE = 100,      // photographs by likeness that each is tried with
    NEAR = 10,        // and by time, and by place
    EXPANSIONS = 2,   // rounds of trying partners' partners
    EXPAND_BY = 10,   // partners that these rounds look at
    PARTNERS = 20,    // best candidates that a photograph is matched with
    PARTNERS_MIN = 10, // with fewer candidates, weaker pairs are tried up to this number
    LINKS = 5,        // pairs that link what hangs together to the rest
};
static const double SOON_S = 60; // photographs in succession within this time are matched

// A pair that was tried.
struct trial {
    uint32_t a, b;
    int matches;
};

// A pair as one of its photographs sees it.
struct link {
    uint32_t from, to;
    float score;
    size_t pair;
};

struct choice {
    const struct orl_log *log;
    const struct orl_progress *progress;
    const struct orl_pair_photo *photos;
    size_t count;
    float *vectors;      // owned; orl_vlad
    struct trial *pairs; // owned; in order of a, then b
    size_t pair_count, capacity;
    struct link *links;  // owned; each pair twice, in order of `from`, the best first
    size_t *first_link;  // owned; of each photograph, and the end
    bool *chosen;        // owned; of each pair
    uint64_t *partners;  // owned; a bit for each two photographs: are they chosen as a pair?
    size_t words;        // of partners, for one photograph
    uint32_t *component; // owned; of each photograph
};

// --- which pairs to try ---

static struct trial *find_pair(const struct choice *c, size_t count, uint32_t a,
                                          uint32_t b)
{
    struct trial key = {a < b ? a : b, a < b ? b : a, 0};
    return count ? bsearch(&key, c->pairs, count, sizeof key, orl_order_pairs) : NULL;
}

// `tried` pairs are in order already; the others may repeat.
static enum orl_result propose(struct choice *c, size_t tried, uint32_t a, uint32_t b)
{
    if (a == b || find_pair(c, tried, a, b))
        return ORL_OK;
    ORL_TRY(ORL_GROW(c->log, c->pairs, c->capacity, c->pair_count));
    c->pairs[c->pair_count++] = (struct trial){a < b ? a : b, a < b ? b : a, 0};
    return ORL_OK;
}

struct trying {
    const struct orl_pair_photo *photos;
    struct trial *proposed;
};

// Preemptive matching (Wu 2013, "Towards linear-time incremental structure from motion", 3): the few
// features of largest scale of two photographs tell whether all of them are worth matching.
static enum orl_result try_one(void *priv, size_t index)
{
    const struct trying *t = priv;
    struct trial *trial = &t->proposed[index];
    struct orl_sift_matches matches;
    enum orl_result result = orl_sift_match(&t->photos[trial->a].features, &t->photos[trial->b].features,
                                            ORL_PAIR_FEATURES, &matches);
    trial->matches = (int)matches.count;
    free(matches.items);
    return result;
}

// Matches what was proposed since `tried`.
static enum orl_result try_proposed(struct choice *c, size_t tried)
{
    struct trial *proposed = c->pairs + tried;
    size_t all = c->pair_count - tried, kept = 0;
    if (!all)
        return ORL_OK;
    qsort(proposed, all, sizeof *proposed, orl_order_pairs);
    for (size_t i = 0; i < all; i++)
        if (i == 0 || orl_order_pairs(&proposed[i], &proposed[kept - 1]) != 0)
            proposed[kept++] = proposed[i];
    c->pair_count = tried + kept;
    orl_logf(c->log, ORL_LOG_DEBUG, "pairs: preemptive matching of %zu pairs", kept);
    ORL_TRY(orl_threads_each(&(struct orl_each){
        .work = try_one, .priv = &(struct trying){c->photos, proposed}, .count = kept,
        .progress = c->progress, .step = "pairs", .share = 0.99, .total = 1}));
    qsort(c->pairs, c->pair_count, sizeof *c->pairs, orl_order_pairs);
    return ORL_OK;
}

// How far two photographs are from each other in one respect; NAN: unknown.
typedef double (*distance_fn)(const struct choice *c, size_t a, size_t b);

static double unlikeness(const struct choice *c, size_t a, size_t b)
{
    return -orl_vlad_similarity(c->vectors, a, b);
}

static double time_apart(const struct choice *c, size_t a, size_t b)
{
    return fabs(c->photos[a].taken_s - c->photos[b].taken_s);
}

// In degrees of latitude.
static double place_apart(const struct choice *c, size_t a, size_t b)
{
    const struct orl_pair_photo *x = &c->photos[a], *y = &c->photos[b];
    double east = remainder(x->longitude - y->longitude, 360) * cos(x->latitude * M_PI / 180);
    return hypot(east, x->latitude - y->latitude);
}

// Proposes each photograph with its `nearest` in this respect.
static enum orl_result propose_near(struct choice *c, distance_fn distance, size_t nearest)
{
    struct orl_ranked *others = orl_array(c->log, c->count, sizeof *others);
    enum orl_result result = others ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t a = 0; result == ORL_OK && a < c->count; a++) {
        size_t known = 0;
        if (orl_progress_cancelled(c->progress))
            result = ORL_ERR_CANCELLED;
        for (size_t b = 0; b < c->count; b++) {
            double d = a == b ? NAN : distance(c, a, b);
            if (!isnan(d))
                others[known++] = (struct orl_ranked){d, b};
        }
        qsort(others, known, sizeof *others, orl_order_ranked);
        for (size_t i = 0; result == ORL_OK && i < known && i < nearest; i++)
            result = propose(c, 0, (uint32_t)a, (uint32_t)others[i].index);
    }
    free(others);
    return result;
}

// --- what the pairs look like from their photographs ---

// Matches count; likeness decides between pairs with as many.
static float score(const struct choice *c, const struct trial *pair)
{
    return (float)pair->matches + 0.5f * orl_vlad_similarity(c->vectors, pair->a, pair->b);
}

static int by_photo_and_score(const void *a, const void *b)
{
    const struct link *x = a, *y = b;
    if (x->from != y->from)
        return x->from < y->from ? -1 : 1;
    if (x->score != y->score)
        return x->score < y->score ? 1 : -1;
    return x->to < y->to ? -1 : x->to > y->to;
}

static enum orl_result make_links(struct choice *c)
{
    free(c->links);
    free(c->first_link);
    c->links = orl_array(c->log, c->pair_count, 2 * sizeof *c->links);
    c->first_link = orl_array(c->log, c->count + 1, sizeof *c->first_link);
    ORL_TRY_MEMORY(c->links && c->first_link);
    for (size_t i = 0; i < c->pair_count; i++) {
        const struct trial *pair = &c->pairs[i];
        float value = score(c, pair);
        c->links[2 * i] = (struct link){pair->a, pair->b, value, i};
        c->links[2 * i + 1] = (struct link){pair->b, pair->a, value, i};
        c->first_link[pair->a + 1]++;
        c->first_link[pair->b + 1]++;
    }
    for (size_t p = 0; p < c->count; p++)
        c->first_link[p + 1] += c->first_link[p];
    qsort(c->links, 2 * c->pair_count, sizeof *c->links, by_photo_and_score);
    return ORL_OK;
}

// The best candidates among the partners of a photograph, EXPAND_BY at most.
static size_t best_links(const struct choice *c, size_t photo, const struct link **links)
{
    size_t n = 0, room = c->first_link[photo + 1] - c->first_link[photo];
    *links = c->links + c->first_link[photo];
    while (n < room && n < EXPAND_BY && c->pairs[(*links)[n].pair].matches >= CANDIDATE)
        n++;
    return n;
}

// Query expansion (Chum et al. 2007, in the view graph): what my partners overlap I may overlap.
static enum orl_result expand(struct choice *c)
{
    size_t tried = c->pair_count;
    enum orl_result result = make_links(c);
    for (size_t a = 0; result == ORL_OK && a < c->count; a++) {
        const struct link *mine, *theirs;
        size_t my_count = best_links(c, a, &mine);
        for (size_t i = 0; i < my_count; i++) {
            size_t their_count = best_links(c, mine[i].to, &theirs);
            for (size_t k = 0; result == ORL_OK && k < their_count; k++)
                result = propose(c, tried, (uint32_t)a, theirs[k].to);
        }
    }
    return result == ORL_OK ? try_proposed(c, tried) : result;
}

static enum orl_result try_pairs(struct choice *c)
{
    ORL_TRY(propose_near(c, unlikeness, ALIKE));
    ORL_TRY(propose_near(c, time_apart, NEAR));
    ORL_TRY(propose_near(c, place_apart, NEAR));
    ORL_TRY(try_proposed(c, 0));
    for (int round = 0; round < EXPANSIONS; round++)
        ORL_TRY(expand(c));
    return make_links(c);
}

// --- which of them to choose ---

static void choose(struct choice *c, size_t index)
{
    const struct trial *pair = &c->pairs[index];
    c->chosen[index] = true;
    c->partners[pair->a * c->words + pair->b / 64] |= UINT64_C(1) << pair->b % 64;
    c->partners[pair->b * c->words + pair->a / 64] |= UINT64_C(1) << pair->a % 64;
}

static void choose_best(struct choice *c)
{
    for (size_t p = 0; p < c->count; p++) {
        for (size_t i = c->first_link[p]; i < c->first_link[p + 1]; i++) {
            int matches = c->pairs[c->links[i].pair].matches;
            size_t limit = matches >= CANDIDATE ? PARTNERS : matches > 0 ? PARTNERS_MIN : 0;
            if (i - c->first_link[p] < limit)
                choose(c, c->links[i].pair);
        }
    }
}

// Photographs in succession usually overlap, even where few features say so.
static enum orl_result choose_successive(struct choice *c)
{
    struct orl_ranked *order = orl_array(c->log, c->count, sizeof *order);
    size_t known = 0;
    ORL_TRY_MEMORY(order);
    for (size_t p = 0; p < c->count; p++)
        if (!isnan(c->photos[p].taken_s))
            order[known++] = (struct orl_ranked){c->photos[p].taken_s, p};
    qsort(order, known, sizeof *order, orl_order_ranked);
    for (size_t i = 1; i < known; i++) {
        struct trial *pair =
            order[i].key - order[i - 1].key > SOON_S
                ? NULL
                : find_pair(c, c->pair_count, (uint32_t)order[i - 1].index,
                            (uint32_t)order[i].index);
        if (pair)
            choose(c, (size_t)(pair - c->pairs));
    }
    free(order);
    return ORL_OK;
}

static bool share_a_partner(const struct choice *c, uint32_t a, uint32_t b)
{
    for (size_t w = 0; w < c->words; w++)
        if (c->partners[a * c->words + w] & c->partners[b * c->words + w])
            return true;
    return false;
}

// A weaker candidate matters where nothing else joins its photographs, as where a loop closes.
static void choose_shortcuts(struct choice *c, const struct orl_ranked *ranked)
{
    for (size_t i = 0; i < c->pair_count; i++) {
        size_t index = ranked[i].index;
        const struct trial *pair = &c->pairs[index];
        if (!c->chosen[index] && pair->matches >= CANDIDATE &&
            !share_a_partner(c, pair->a, pair->b))
            choose(c, index);
    }
}

static uint32_t root(uint32_t *component, uint32_t photo)
{
    while (component[photo] != photo)
        photo = component[photo] = component[component[photo]];
    return photo;
}

// Joins the components of the chosen pairs; `linked` counts the pairs that each has got.
static bool join_components(struct choice *c, const struct orl_ranked *ranked, uint8_t *linked)
{
    bool joined = false;
    for (size_t p = 0; p < c->count; p++)
        c->component[p] = (uint32_t)p, linked[p] = 0;
    for (size_t i = 0; i < c->pair_count; i++)
        if (c->chosen[i])
            c->component[root(c->component, c->pairs[i].a)] = root(c->component, c->pairs[i].b);
    for (size_t i = 0; i < c->pair_count; i++) {
        uint32_t a = root(c->component, c->pairs[ranked[i].index].a);
        uint32_t b = root(c->component, c->pairs[ranked[i].index].b);
        if (a == b || (linked[a] >= LINKS && linked[b] >= LINKS))
            continue;
        linked[a] += linked[a] < LINKS;
        linked[b] += linked[b] < LINKS;
        choose(c, ranked[i].index);
        joined = true;
    }
    return joined;
}

static enum orl_result choose_pairs(struct choice *c)
{
    c->words = (c->count + 63) / 64;
    c->chosen = orl_array(c->log, c->pair_count, sizeof *c->chosen);
    c->partners = orl_array(c->log, c->count, c->words * sizeof *c->partners);
    c->component = orl_array(c->log, c->count, sizeof *c->component);
    struct orl_ranked *ranked = orl_array(c->log, c->pair_count, sizeof *ranked);
    uint8_t *linked = orl_array(c->log, c->count, 1);
    enum orl_result result = c->chosen && c->partners && c->component && ranked && linked
                                 ? ORL_OK : ORL_ERR_MEMORY;
    if (result == ORL_OK) {
        for (size_t i = 0; i < c->pair_count; i++)
            ranked[i] = (struct orl_ranked){-(double)score(c, &c->pairs[i]), i};
        qsort(ranked, c->pair_count, sizeof *ranked, orl_order_ranked);
        choose_best(c);
        result = choose_successive(c);
    }
    if (result == ORL_OK)
        choose_shortcuts(c, ranked);
    while (result == ORL_OK && join_components(c, ranked, linked))
        ;
    free(ranked);
    free(linked);
    return result;
}

static enum orl_result list_chosen(const struct choice *c, struct orl_pair_list *list)
{
    list->items = orl_array(c->log, c->pair_count, sizeof *list->items);
    ORL_TRY_MEMORY(list->items);
    for (size_t i = 0; i < c->pair_count; i++)
        if (c->chosen[i])
            list->items[list->count++] = (struct orl_pair){c->pairs[i].a, c->pairs[i].b};
    list->tried = c->pair_count;
    return ORL_OK;
}

static void finish(struct choice *c)
{
    free(c->vectors);
    free(c->pairs);
    free(c->links);
    free(c->first_link);
    free(c->chosen);
    free(c->partners);
    free(c->component);
}

enum orl_result orl_pairs_choose(const struct orl_log *log, const struct orl_progress *progress,
                                 const struct orl_pair_photo *photos, size_t count, uint32_t seed,
                                 struct orl_pair_list *list)
{
    *list = (struct orl_pair_list){0};
    struct choice c = {.log = log, .progress = progress, .photos = photos, .count = count};
    enum orl_result result = orl_vlad(log, photos, count, seed, &c.vectors);
    ORL_THEN(result, try_pairs(&c));
    ORL_THEN(result, choose_pairs(&c));
    ORL_THEN(result, list_chosen(&c, list));
    finish(&c);
    return result;
}

void orl_pairs_finish(struct orl_pair_list *list)
{
    free(list->items);
    *list = (struct orl_pair_list){0};
}
