#include "preprocess/import_pairs.h"

#include <stdlib.h>

#include "core/memory.h"
#include "core/order.h"
#include "core/vec3.h"
#include "preprocess/calibrate/match.h"

enum { PARTNERS = 20 }; // that a photograph is matched with, where they are many
static const double SAME_WAY = 0.5; // cosine of the angle between directions of view, at least

// The partners of view `a`, the nearest first; how many.
static size_t find_partners(const struct import_job *import, size_t a, bool all,
                            struct orl_ranked *partners)
{
    const struct orl_pose *pose = &import->views[a].image->cam_from_world;
    double eye[3], off[3];
    size_t count = 0;
    orl_pose_centre(pose, eye);
    for (size_t b = 0; b < import->view_count; b++) {
        const struct orl_pose *other = &import->views[b].image->cam_from_world;
        if (b == a || import->views[b].test ||
            (!all && orl_dot3(pose->r[2], other->r[2]) < SAME_WAY))
            continue;
        orl_pose_centre(other, off);
        for (int k = 0; k < 3; k++)
            off[k] -= eye[k];
        partners[count++] = (struct orl_ranked){orl_dot3(off, off), b};
    }
    qsort(partners, count, sizeof *partners, orl_order_ranked);
    return all || count < PARTNERS ? count : PARTNERS;
}

enum orl_result orl_import_pairs(const struct import_job *import, struct orl_pair_list *list)
{
    size_t train = 0, kept = 0;
    for (size_t i = 0; i < import->view_count; i++)
        train += !import->views[i].test;
    bool all = orl_match_way(ORL_MATCHING_AUTO, train) == ORL_MATCHING_EXHAUSTIVE;
    struct orl_ranked *partners = orl_array(import->log, import->view_count, sizeof *partners);
    *list = (struct orl_pair_list){
        .items = orl_array(import->log, train * (all ? train : PARTNERS), sizeof *list->items)};
    enum orl_result result = partners && list->items ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t a = 0; result == ORL_OK && a < import->view_count; a++) {
        size_t count = import->views[a].test ? 0 : find_partners(import, a, all, partners);
        for (size_t i = 0; i < count; i++) {
            uint32_t b = (uint32_t)partners[i].index;
            list->items[list->count++] = (struct orl_pair){a < b ? (uint32_t)a : b,
                                                           a < b ? b : (uint32_t)a};
        }
    }
    if (result == ORL_OK)
        qsort(list->items, list->count, sizeof *list->items, orl_order_pairs);
    for (size_t i = 0; i < list->count; i++) // most are in the list from both sides
        if (!kept || orl_order_pairs(&list->items[i], &list->items[kept - 1]) != 0)
            list->items[kept++] = list->items[i];
    list->count = kept;
    free(partners);
    if (result != ORL_OK)
        orl_pairs_finish(list);
    return result;
}
