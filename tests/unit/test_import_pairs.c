// Pairs of photographs with known cameras that are worth matching.
#include "preprocess/import_densify.h"
#include "test.h"

enum { MANY = 60 };

struct made {
    struct orl_colmap_image images[MANY];
    struct import_view views[MANY];
    struct import_job job;
};

// Photographs in a row along x. Those with an odd index look backward, all others forward.
static struct made *make(size_t count)
{
    struct made *m = calloc(1, sizeof *m);
    for (size_t i = 0; i < count; i++) {
        struct orl_pose *pose = &m->images[i].cam_from_world;
        double way = i % 2 ? -1 : 1;
        pose->r[0][0] = pose->r[2][2] = way;
        pose->r[1][1] = 1;
        pose->t[0] = -way * (double)i;
        m->views[i].image = &m->images[i];
    }
    m->job = (struct import_job){.views = m->views, .view_count = count};
    return m;
}

static bool has(const struct orl_pair_list *list, uint32_t a, uint32_t b)
{
    for (size_t i = 0; i < list->count; i++)
        if (list->items[i].a == a && list->items[i].b == b)
            return true;
    return false;
}

static void pairs_all_where_they_are_few(void **state)
{
    (void)state;
    struct made *m = make(5);
    struct orl_pair_list list;
    m->views[2].test = true;
    assert_int_equal(orl_import_pairs(&m->job, &list), ORL_OK);
    assert_int_equal(list.count, 6); // of four
    assert_true(has(&list, 0, 1) && has(&list, 3, 4));
    orl_pairs_finish(&list);
    free(m);
}

static void pairs_near_ones_that_look_the_same_way(void **state)
{
    (void)state;
    struct made *m = make(MANY);
    struct orl_pair_list list;
    m->views[4].test = true;
    assert_int_equal(orl_import_pairs(&m->job, &list), ORL_OK);
    for (size_t i = 0; i < list.count; i++) {
        const struct orl_pair *p = &list.items[i];
        assert_true(p->a < p->b && p->b < MANY);
        assert_true(p->a % 2 == p->b % 2);
        assert_true(p->a != 4 && p->b != 4);
        assert_true(i == 0 || p[-1].a < p->a || (p[-1].a == p->a && p[-1].b < p->b));
    }
    // The first has the 20 that follow it and look forward, without the one that is held out.
    assert_true(has(&list, 0, 2) && has(&list, 0, 42));
    assert_false(has(&list, 0, 44));
    orl_pairs_finish(&list);
    free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pairs_all_where_they_are_few),
        cmocka_unit_test(pairs_near_ones_that_look_the_same_way),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
