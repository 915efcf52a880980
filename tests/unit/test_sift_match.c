// Matching of features: known numbers of matches.
#include "preprocess/calibrate/sift_match.h"
#include "sift_like.h"
#include "test.h"

enum { ROOM = 300, FIRST = 256 };

struct set {
    uint8_t bytes[ROOM * SIFT_SIZE];
    struct orl_features features;
};

// Features first, first + 1, ...
static void fill(struct set *set, uint32_t first, size_t count, float alike, uint32_t seed)
{
    uint32_t noise = seed;
    for (size_t i = 0; i < count; i++)
        sift_write(set->bytes + i * SIFT_SIZE, first + (uint32_t)i, alike, &noise);
    set->features = (struct orl_features){.descriptors = set->bytes, .count = count};
}

static int shared_by(const struct set *a, const struct set *b)
{
    struct orl_sift_matches matches;
    assert_int_equal(orl_sift_match(&a->features, &b->features, FIRST, &matches), ORL_OK);
    for (size_t i = 0; i < matches.count; i++)
        assert_true(matches.items[i][0] < a->features.count && matches.items[i][1] < b->features.count);
    free(matches.items);
    return (int)matches.count;
}

static int matches(size_t first, size_t a_count, size_t b_count)
{
    static struct set a, b;
    fill(&a, 0, a_count, 0.95f, 1);
    fill(&b, (uint32_t)first, b_count, 0.95f, 2);
    int shared = shared_by(&a, &b);
    assert_int_equal(shared_by(&b, &a), shared);
    return shared;
}

static void counts_what_is_shared(void **state)
{
    (void)state;
    assert_int_equal(matches(0, 100, 100), 100);
    assert_int_equal(matches(60, 100, 100), 40);
    assert_int_equal(matches(0, 100, 37), 37);
    assert_int_equal(matches(1000, 200, 200), 0);
}

static void looks_at_the_first_alone(void **state)
{
    (void)state;
    assert_int_equal(matches(0, ROOM, ROOM), FIRST);
    assert_int_equal(matches(FIRST, ROOM, 100), 0);
}

static void nothing_matches_nothing(void **state)
{
    (void)state;
    assert_int_equal(matches(0, 0, 0), 0);
    assert_int_equal(matches(0, 100, 0), 0);
    // A lone feature has no second nearest that the nearest could be told apart from.
    assert_int_equal(matches(0, 1, 1), 0);
}

// Two features of b that are like one of a: neither is that feature for certain.
static void ambiguous_features_do_not_match(void **state)
{
    (void)state;
    static struct set a, b;
    fill(&a, 0, 50, 0.95f, 1);
    fill(&b, 0, 50, 0.95f, 2);
    assert_int_equal(shared_by(&a, &b), 50);
    memcpy(b.bytes + 49 * SIFT_SIZE, b.bytes, SIFT_SIZE); // feature 49 becomes feature 0 again
    assert_int_equal(shared_by(&a, &b), 48);
    assert_int_equal(shared_by(&b, &a), 48);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(counts_what_is_shared), cmocka_unit_test(looks_at_the_first_alone),
        cmocka_unit_test(nothing_matches_nothing),
        cmocka_unit_test(ambiguous_features_do_not_match),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
