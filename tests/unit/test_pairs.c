// Which pairs are chosen, in collections whose overlap is known.
#include "preprocess/calibrate/pairs.h"
#include "sift_like.h"
#include "test.h"

enum { PHOTOS_MAX = 400, FEATURES = 40 };
static const float SAME = 0.95f;

struct collection {
    struct orl_pair_photo photos[PHOTOS_MAX];
    size_t count;
    uint32_t noise;
};

static void begin(struct collection *c)
{
    *c = (struct collection){.noise = 1};
}

// A photograph without features, time or place yet.
static struct orl_pair_photo *add_photo(struct collection *c, size_t room)
{
    assert_true(c->count < PHOTOS_MAX);
    struct orl_pair_photo *photo = &c->photos[c->count++];
    photo->features.descriptors = calloc(room, SIFT_SIZE);
    assert_non_null(photo->features.descriptors);
    photo->taken_s = photo->latitude = photo->longitude = NAN;
    return photo;
}

static void add_features(struct collection *c, struct orl_pair_photo *photo, uint32_t first,
                         size_t count, float alike)
{
    struct orl_features *features = &photo->features;
    for (size_t i = 0; i < count; i++)
        sift_write(features->descriptors + features->count++ * SIFT_SIZE, first + (uint32_t)i, alike,
                   &c->noise);
}

static void end(struct collection *c, struct orl_pair_list *list)
{
    for (size_t i = 0; i < c->count; i++)
        free(c->photos[i].features.descriptors);
    orl_pairs_finish(list);
}

static struct orl_pair_list pairs_of(const struct collection *c)
{
    struct orl_pair_list list;
    assert_int_equal(orl_pairs_choose(NULL, NULL, c->photos, c->count, 0, &list), ORL_OK);
    for (size_t i = 0; i < list.count; i++) {
        assert_true(list.items[i].a < list.items[i].b && list.items[i].b < c->count);
        if (i > 0)
            assert_true(list.items[i].a > list.items[i - 1].a ||
                        (list.items[i].a == list.items[i - 1].a &&
                         list.items[i].b > list.items[i - 1].b));
    }
    return list;
}

static bool has(const struct orl_pair_list *list, uint32_t a, uint32_t b)
{
    for (size_t i = 0; i < list->count; i++)
        if ((list->items[i].a == a && list->items[i].b == b) ||
            (list->items[i].a == b && list->items[i].b == a))
            return true;
    return false;
}

// Does one piece hold all photographs?
static bool is_connected(const struct orl_pair_list *list, size_t count)
{
    bool reached[PHOTOS_MAX] = {true};
    size_t reached_count = 1;
    for (bool more = true; more;) {
        more = false;
        for (size_t i = 0; i < list->count; i++) {
            uint32_t a = list->items[i].a, b = list->items[i].b;
            if (reached[a] != reached[b])
                reached[a] = reached[b] = more = true, reached_count++;
        }
    }
    return reached_count == count;
}

// Photographs around a thing, in no order. Neighbours at distance d share 40 - 8 d features.
static void ring_is_closed(void **state)
{
    (void)state;
    enum { RING = 130, STEP = 7 }; // place on the ring is STEP times the number, modulo RING
    static struct collection c;
    begin(&c);
    for (uint32_t i = 0; i < RING; i++) {
        struct orl_pair_photo *photo = add_photo(&c, FEATURES);
        uint32_t place = i * STEP % RING;
        for (uint32_t k = 0; k < FEATURES; k++)
            add_features(&c, photo, (place * 8 + k) % (RING * 8), 1, SAME);
    }
    struct orl_pair_list list = pairs_of(&c);
    size_t strangers = 0; // chosen for a match by chance, as some have few partners
    for (uint32_t a = 0; a < RING; a++) {
        for (uint32_t b = a + 1; b < RING; b++) {
            int apart = abs((int)(a * STEP % RING) - (int)(b * STEP % RING));
            apart = apart < RING - apart ? apart : RING - apart;
            if (apart <= 4)
                assert_true(has(&list, a, b)); // the ends of the ring, too
            else
                strangers += has(&list, a, b);
        }
    }
    assert_int_equal(list.count, 4 * RING + strangers);
    assert_true(strangers < RING / 4);
    end(&c, &list);
}

static bool always(void *priv)
{
    (void)priv;
    return true;
}

static bool never(void *priv)
{
    (void)priv;
    return false;
}

static void report(void *priv, const char *step, double done, double total, const char *detail)
{
    (void)detail;
    assert_string_equal(step, "pairs");
    assert_true(done < total);
    ++*(int *)priv;
}

static void progress_is_told_and_cancelled(void **state)
{
    (void)state;
    static struct collection c;
    struct orl_pair_list list;
    int reports = 0;
    struct orl_progress progress = {.report = report, .cancelled = never, .priv = &reports};
    begin(&c);
    for (uint32_t i = 0; i < 30; i++)
        add_features(&c, add_photo(&c, FEATURES), 7 * i, FEATURES, SAME);
    assert_int_equal(orl_pairs_choose(NULL, &progress, c.photos, c.count, 0, &list), ORL_OK);
    assert_true(reports > 0);
    orl_pairs_finish(&list);
    progress.cancelled = always;
    assert_int_equal(orl_pairs_choose(NULL, &progress, c.photos, c.count, 0, &list), ORL_ERR_CANCELLED);
    end(&c, &list);
}

// All overlap all: each is matched with some, and still all hang together.
static void partners_are_bounded(void **state)
{
    (void)state;
    enum { COUNT = 120 };
    static struct collection c;
    begin(&c);
    for (uint32_t i = 0; i < COUNT; i++)
        add_features(&c, add_photo(&c, FEATURES), 0, FEATURES, SAME);
    struct orl_pair_list list = pairs_of(&c);
    assert_true(list.count >= 10 * COUNT && list.count <= 20 * COUNT);
    assert_true(is_connected(&list, COUNT));
    end(&c, &list);
}

// A pair with five common features is all that two crowds share, whose own pairs are far better.
static void weak_link_is_kept(void **state)
{
    (void)state;
    enum { CROWD = 40 };
    static struct collection c;
    begin(&c);
    for (uint32_t i = 0; i < 2 * CROWD; i++) {
        struct orl_pair_photo *photo = add_photo(&c, FEATURES + 5);
        add_features(&c, photo, i % 2 * 1000, FEATURES, SAME);
        if (i == 12 || i == 51)
            add_features(&c, photo, 5000, 5, SAME);
    }
    struct orl_pair_list list = pairs_of(&c);
    assert_true(has(&list, 12, 51));
    assert_true(is_connected(&list, c.count));
    end(&c, &list);
}

// Without features in common, or without any, a few pairs are tried all the same.
static void strangers_are_tried_a_few_times(void **state)
{
    (void)state;
    static struct collection c;
    begin(&c);
    for (uint32_t i = 0; i < 30; i++)
        add_features(&c, add_photo(&c, FEATURES), i * 1000, i % 3 ? FEATURES : 0, SAME);
    struct orl_pair_list list = pairs_of(&c);
    assert_true(is_connected(&list, c.count));
    assert_true(list.count < 30 * 29 / 2 / 2);
    end(&c, &list);
}

static void few_photographs_are_no_trouble(void **state)
{
    (void)state;
    for (size_t count = 0; count < 4; count++) {
        static struct collection c;
        begin(&c);
        for (size_t i = 0; i < count; i++)
            add_features(&c, add_photo(&c, FEATURES), 0, FEATURES, SAME);
        struct orl_pair_list list = pairs_of(&c);
        assert_int_equal(list.count, count * (count - (count > 0)) / 2);
        assert_int_equal(list.tried, list.count);
        end(&c, &list);
    }
}

// --- pairs that likeness alone does not find ---

// Photographs 0 and 1 share six features. More than a hundred others are more like each of them, and
// match none: they have half of its features, each twice, so that none is distinct. Photograph 2, if
// there is one between the two, overlaps both. Trying a pair takes time as the square of the number of
// features, so the many have few.
static void begin_misleading(struct collection *c, bool between)
{
    enum { OWN = 24, HALF = OWN / 2, OTHERS = 210 };
    begin(c);
    for (uint32_t i = 0; i < 2; i++) {
        struct orl_pair_photo *photo = add_photo(c, 6 + OWN);
        add_features(c, photo, 5000, 6, SAME);
        add_features(c, photo, 10000 * i, OWN, SAME);
    }
    for (uint32_t i = 0; i < 2 && between; i++) {
        struct orl_pair_photo *photo = i ? &c->photos[2] : add_photo(c, 2 * OWN);
        add_features(c, photo, 10000 * i, OWN, SAME);
    }
    for (uint32_t i = 0; i < OTHERS; i++) {
        struct orl_pair_photo *photo = add_photo(c, 2 * HALF);
        for (int k = 0; k < 2; k++)
            add_features(c, photo, i % 2 * 10000, HALF, SAME);
    }
}

static void likeness_can_mislead(void **state)
{
    (void)state;
    static struct collection c;
    begin_misleading(&c, false);
    struct orl_pair_list list = pairs_of(&c);
    assert_false(has(&list, 0, 1));
    end(&c, &list);
}

static void time_helps(void **state)
{
    (void)state;
    static struct collection c;
    begin_misleading(&c, false);
    for (size_t i = 0; i < c.count; i++)
        c.photos[i].taken_s = 1e9 + 100 * (double)i;
    struct orl_pair_list list = pairs_of(&c);
    assert_true(has(&list, 0, 1));
    assert_false(has(&list, 2, 3)); // a minute and more apart, and nothing in common
    end(&c, &list);
}

static void succession_is_matched(void **state)
{
    (void)state;
    static struct collection c;
    begin_misleading(&c, false);
    c.photos[2].taken_s = 1e9;
    c.photos[3].taken_s = 1e9 + 30;
    struct orl_pair_list list = pairs_of(&c);
    assert_true(has(&list, 2, 3)); // nothing in common, but the next moment
    end(&c, &list);
}

static void place_helps(void **state)
{
    (void)state;
    static struct collection c;
    begin_misleading(&c, false);
    for (size_t i = 0; i < c.count; i++) {
        c.photos[i].latitude = 48;
        c.photos[i].longitude = (double)i;
    }
    // Either side of the date line.
    c.photos[0].longitude = -179.99;
    c.photos[1].longitude = 179.99;
    struct orl_pair_list list = pairs_of(&c);
    assert_true(has(&list, 0, 1));
    end(&c, &list);
}

// A photograph that overlaps both tells that the two may overlap.
static void common_partner_helps(void **state)
{
    (void)state;
    static struct collection c;
    begin_misleading(&c, true);
    // Time leads to the pairs with photograph 2; it leads 0 and 1 to others.
    for (size_t i = 0; i < 2; i++)
        c.photos[i].taken_s = 20000 * (double)i + 1e9;
    c.photos[2].taken_s = 10000 + 1e9;
    for (int k = 1; k <= 12; k++) {
        c.photos[2 + k].taken_s = 1e9 - 100 * k;
        c.photos[20 + k].taken_s = 1e9 + 20000 + 100 * k;
    }
    struct orl_pair_list list = pairs_of(&c);
    assert_true(has(&list, 0, 1));
    end(&c, &list);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ring_is_closed), cmocka_unit_test(partners_are_bounded),
        cmocka_unit_test(weak_link_is_kept), cmocka_unit_test(strangers_are_tried_a_few_times),
        cmocka_unit_test(few_photographs_are_no_trouble), cmocka_unit_test(likeness_can_mislead),
        cmocka_unit_test(time_helps), cmocka_unit_test(succession_is_matched),
        cmocka_unit_test(place_helps), cmocka_unit_test(common_partner_helps),
        cmocka_unit_test(progress_is_told_and_cancelled),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
