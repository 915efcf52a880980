// Random removal, which every other choice must beat.
#include <math.h>
#include <stdlib.h>

#include "core/memory.h"
#include "eval/trim_search.h"

static uint32_t next_random(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(*state >> 33);
}

// The numbers below `count` in random order; owned by the caller (free).
static uint32_t *shuffled(const struct orl_log *log, size_t count, uint64_t *random)
{
    uint32_t *order = orl_array(log, count, sizeof *order);
    for (size_t i = 0; order && i < count; i++) {
        size_t k = next_random(random) % (i + 1);
        order[i] = order[k];
        order[k] = (uint32_t)i;
    }
    return order;
}

// Removes points and photographs until a share of each is left.
static enum orl_result measure(struct trim_search *s, double share, const uint32_t *points,
                               const uint32_t *photos, struct orl_trim_random *row)
{
    const struct orl_scene *scene = s->source.scene;
    struct trim_state state = {0};
    struct trim_model *model = NULL;
    struct orl_metrics metrics;
    size_t kept = (size_t)ceil(share * (double)s->targets.count);
    double sum = 0;
    enum orl_result result =
        orl_trim_state_copy(s->source.log, &s->first_state, scene->photo_count, &state);
    for (size_t i = kept > 2 ? kept : 2; result == ORL_OK && i < s->targets.count; i++) {
        state.removed[s->targets.views[photos[i]].photo] = true;
        state.removed_count++;
    }
    if (result == ORL_OK)
        result = orl_trim_model_open_with(&s->source, &state, points,
                                          (size_t)(share * (double)scene->points.count + 0.5),
                                          &model);
    for (size_t i = 0; result == ORL_OK && i < s->validation_count; i++) {
        size_t view = orl_trim_validation_view(s, i, s->validation_count);
        result = orl_trim_measure_view(s, model->renderer, &state, view, true, &metrics);
        sum += s->first[view].db - metrics.psnr_db;
    }
    if (result == ORL_OK)
        *row = (struct orl_trim_random){orl_trim_model_bytes(s, model, &state),
                                        sum / (double)s->validation_count};
    orl_trim_model_close(&model);
    free(state.removed);
    return result;
}

enum orl_result orl_trim_compare_random(struct trim_search *s)
{
    double own = s->bytes / s->first_bytes; // of the trimmed model
    const double shares[ORL_TRIM_RANDOM_ROWS] = { // the largest first
        fmax(0.5, own), own > 0.5 ? 0.5 : fmax(0.25, own), fmin(0.25, own)};
    uint64_t random = 1;
    uint32_t *points = shuffled(s->source.log, s->source.scene->points.count, &random);
    uint32_t *photos = shuffled(s->source.log, s->targets.count, &random);
    enum orl_result result = points && photos ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < ORL_TRIM_RANDOM_ROWS; i++) {
        result = measure(s, shares[i], points, photos, &s->trim->random[i]);
        s->trim->random_count += result == ORL_OK;
    }
    free(points);
    free(photos);
    return result;
}
