#include "scene/alike_points.h"

#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

#include "core/memory.h"

// A hash table of positions by open addressing: 1 + the first point there; 0: free.
static size_t slot_of(const struct orl_points *points, const uint32_t *table, size_t slots, size_t i)
{
    float p[3];
    for (int k = 0; k < 3; k++)
        p[k] = points->position[i][k] + 0.0f; // -0 is 0
    size_t slot = XXH3_64bits(p, sizeof p) & (slots - 1);
    while (table[slot]) {
        const float *other = points->position[table[slot] - 1];
        if (other[0] == p[0] && other[1] == p[1] && other[2] == p[2])
            break;
        slot = (slot + 1) & (slots - 1);
    }
    return slot;
}

static enum orl_result take(const struct orl_log *log, const struct orl_points *points,
                            const bool *left_out, struct few_alike *few)
{
    few->index = orl_array(log, few->count, sizeof *few->index);
    few->own = orl_array(log, few->count, sizeof *few->own);
    ORL_TRY_MEMORY(few->index && few->own);
    size_t to = 0;
    for (size_t i = 0; i < points->count; i++) {
        if (left_out[i])
            continue;
        few->index[to] = (int)i;
        memcpy(few->own[to++], points->position[i], sizeof few->own[0]);
    }
    few->position = (const float(*)[3])few->own;
    return ORL_OK;
}

enum orl_result orl_points_few_alike(const struct orl_log *log, const struct orl_points *points,
                                     unsigned most, struct few_alike *few)
{
    size_t slots = 16;
    while (slots < 2 * points->count)
        slots *= 2;
    *few = (struct few_alike){.position = (const float(*)[3])points->position,
                              .count = points->count};
    uint32_t *table = orl_array(log, slots, sizeof *table);
    uint8_t *copies = orl_array(log, points->count, sizeof *copies); // at the first point there
    bool *left_out = orl_array(log, points->count, sizeof *left_out);
    enum orl_result result = table && copies && left_out ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < points->count; i++) {
        size_t slot = slot_of(points, table, slots, i);
        if (!table[slot])
            table[slot] = (uint32_t)i + 1;
        uint8_t *here = &copies[table[slot] - 1];
        left_out[i] = *here >= most;
        few->count -= left_out[i];
        *here = (uint8_t)(*here + !left_out[i]);
    }
    free(table);
    free(copies);
    if (result == ORL_OK && few->count < points->count)
        result = take(log, points, left_out, few);
    free(left_out);
    if (result != ORL_OK)
        orl_few_alike_finish(few);
    return result;
}

void orl_few_alike_finish(struct few_alike *few)
{
    free(few->index);
    free(few->own);
    *few = (struct few_alike){0};
}
