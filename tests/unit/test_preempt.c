// Preemptive matching: known numbers of matches.
#include "preprocess/calibrate/preempt.h"
#include "sift_like.h"
#include "test.h"

enum { ROOM = 300 };

struct set {
    uint8_t bytes[ROOM * SIFT_SIZE];
    struct orl_descriptors descriptors;
};

// Features first, first + 1, ...
static void fill(struct set *set, uint32_t first, size_t count, float alike, uint32_t seed)
{
    uint32_t noise = seed;
    for (size_t i = 0; i < count; i++)
        sift_write(set->bytes + i * SIFT_SIZE, first + (uint32_t)i, alike, &noise);
    set->descriptors = (struct orl_descriptors){set->bytes, count};
}

static int shared_by(const struct orl_descriptors *a, const struct orl_descriptors *b)
{
    const struct orl_descriptors photos[] = {*a, *b};
    struct orl_preempt_pair pair = {0, 1, 0};
    assert_int_equal(orl_preempt_match_all(NULL, NULL, photos, &pair, 1), ORL_OK);
    return pair.matches;
}

static int matches(size_t first, size_t a_count, size_t b_count)
{
    static struct set a, b;
    fill(&a, 0, a_count, 0.95f, 1);
    fill(&b, (uint32_t)first, b_count, 0.95f, 2);
    int shared = shared_by(&a.descriptors, &b.descriptors);
    assert_int_equal(shared_by(&b.descriptors, &a.descriptors), shared);
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
    assert_int_equal(matches(0, ROOM, ROOM), ORL_PREEMPT_FEATURES);
    assert_int_equal(matches(ORL_PREEMPT_FEATURES, ROOM, 100), 0);
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
    assert_int_equal(shared_by(&a.descriptors, &b.descriptors), 50);
    memcpy(b.bytes + 49 * SIFT_SIZE, b.bytes, SIFT_SIZE); // feature 49 becomes feature 0 again
    assert_int_equal(shared_by(&a.descriptors, &b.descriptors), 48);
    assert_int_equal(shared_by(&b.descriptors, &a.descriptors), 48);
}

static bool never(void *priv)
{
    (void)priv;
    return false;
}

static bool always(void *priv)
{
    (void)priv;
    return true;
}

static void report(void *priv, const char *step, double done, double total, const char *detail)
{
    (void)detail;
    assert_string_equal(step, "pairs");
    assert_true(done < total);
    ++*(int *)priv;
}

static void many_pairs_are_as_one(void **state)
{
    (void)state;
    enum { COUNT = 50, PAIRS = COUNT * (COUNT - 1) / 2 };
    static struct set sets[COUNT];
    static struct orl_descriptors photos[COUNT];
    static struct orl_preempt_pair pairs[PAIRS];
    size_t count = 0;
    for (uint32_t a = 0; a < COUNT; a++) {
        fill(&sets[a], 7 * a, 40, 0.95f, a);
        photos[a] = sets[a].descriptors;
        for (uint32_t b = a + 1; b < COUNT; b++)
            pairs[count++] = (struct orl_preempt_pair){a, b, -1};
    }
    int reports = 0;
    struct orl_progress progress = {.report = report, .cancelled = never, .priv = &reports};
    assert_int_equal(orl_preempt_match_all(NULL, &progress, photos, pairs, PAIRS), ORL_OK);
    assert_true(reports > 0);
    for (size_t i = 0; i < PAIRS; i++) {
        int shared = 40 - 7 * (int)(pairs[i].b - pairs[i].a);
        assert_int_equal(pairs[i].matches, shared > 0 ? shared : 0);
    }
    progress.cancelled = always;
    assert_int_equal(orl_preempt_match_all(NULL, &progress, photos, pairs, PAIRS),
                     ORL_ERR_CANCELLED);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(counts_what_is_shared), cmocka_unit_test(looks_at_the_first_alone),
        cmocka_unit_test(nothing_matches_nothing),
        cmocka_unit_test(ambiguous_features_do_not_match), cmocka_unit_test(many_pairs_are_as_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
