// The ground under a facade that photographs walk along, and scenes without one.
#include <math.h>
#include <string.h>

#include "scene/ground_plane.h"
#include "test.h"

enum { PHOTOS = 9, GROUND = 150, FACADE = 3000 };

struct street {
    struct orl_scene scene;
    struct orl_photo photos[PHOTOS];
};

// Evenly spread over [0, 1).
static double spread(size_t i, double step)
{
    return fmod((double)i * step, 1);
}

// A facade 8 wide and 5 high at z = 10, a strip of ground at y = 1.6 before it, both off by up to
// 2 cm, and photographs of it, eyes at y = 0 give or take 5 cm, pitched by a fifth.
static void build(struct street *s, size_t ground_points)
{
    memset(s, 0, sizeof *s);
    s->scene.photos = s->photos;
    s->scene.photo_count = PHOTOS;
    s->scene.photo_distance = 10;
    assert_int_equal(orl_points_init(NULL, &s->scene.points, ground_points + FACADE), ORL_OK);
    for (size_t i = 0; i < s->scene.points.count; i++) {
        double a = spread(i, 0.6180339887), b = spread(i, 0.7548776662);
        double noise = 0.04 * spread(i, 0.5698402910) - 0.02;
        float *at = s->scene.points.position[i], *normal = s->scene.points.normal[i];
        bool on_ground = i < ground_points;
        at[0] = (float)(8 * a - 4);
        at[1] = (float)(on_ground ? 1.6 + noise : 1.6 - 5 * b);
        at[2] = (float)(on_ground ? 10 - 3 * b : 10 + noise);
        normal[on_ground ? 1 : 2] = -1;
        s->scene.points.radius[i] = 0.05f;
    }
    for (int i = 0; i < PHOTOS; i++) {
        const double eye[3] = {0.7 * i - 3, i % 3 == 0 ? -0.05 : 0.05, 0.3 * (i % 4)};
        const double target[3] = {0.2 * i, eye[1] - 2, 10}, up[3] = {0, -1, 0};
        s->photos[i].view.cam_from_world = orl_pose_look_at(eye, target, up);
    }
}

static struct orl_ground find(const struct street *s)
{
    struct orl_ground ground;
    assert_int_equal(orl_ground_find(NULL, &s->scene, &ground), ORL_OK);
    return ground;
}

static void assert_found(const struct orl_ground *ground)
{
    assert_float_equal(ground->height, 1.583, 0.02);
    assert_true(ground->plane[1] < -0.99999);
    const double feet[3] = {0, 1.6, 8}; // a point of it
    double off = ground->plane[3];
    for (int k = 0; k < 3; k++)
        off += ground->plane[k] * feet[k];
    assert_float_equal(off, 0, 0.01);
}

static void finds_the_street(void **state)
{
    (void)state;
    struct street s;
    build(&s, GROUND);
    struct orl_ground ground = find(&s), again = find(&s);
    assert_found(&ground);
    assert_float_equal(ground.height, again.height, 0);
    for (int k = 0; k < 4; k++)
        assert_float_equal(ground.plane[k], again.plane[k], 0);
    // Photographs on their side.
    for (int i = 0; i < PHOTOS; i++) {
        struct orl_pose *pose = &s.photos[i].view.cam_from_world, was = *pose;
        for (int k = 0; k < 3; k++) {
            pose->r[0][k] = -was.r[1][k];
            pose->r[1][k] = was.r[0][k];
        }
        pose->t[0] = -was.t[1];
        pose->t[1] = was.t[0];
    }
    ground = find(&s);
    assert_found(&ground);
    orl_points_finish(&s.scene.points);
}

// Gravel at a flat angle: the normal of each point is off by 20 degrees, to all sides.
static void spread_normals(struct street *s, size_t ground_points)
{
    for (size_t i = 0; i < ground_points; i++) {
        const double side = 6.2831853 * spread(i, 0.3247179572);
        const float normal[3] = {(float)(0.342 * cos(side)), -0.94f, (float)(0.342 * sin(side))};
        memcpy(s->scene.points.normal[i], normal, sizeof normal);
    }
}

static void normals_may_be_off(void **state)
{
    (void)state;
    struct street s;
    build(&s, GROUND);
    spread_normals(&s, GROUND);
    struct orl_ground ground = find(&s);
    assert_found(&ground);
    orl_points_finish(&s.scene.points);
}

// Uneven paving, of which the facade's large discs leave few points for the search.
static void all_points_of_the_ground_count(void **state)
{
    enum { PAVING = 600 };
    (void)state;
    struct street s;
    build(&s, PAVING);
    spread_normals(&s, PAVING);
    for (size_t i = 0; i < PAVING; i++) {
        s.scene.points.position[i][1] = (float)(1.52 + 0.16 * spread(i * i, 0.5698402910));
        s.scene.points.position[i][2] = (float)(10 - 7 * spread(i, 0.7548776662));
    }
    for (size_t i = PAVING; i < s.scene.points.count; i++)
        s.scene.points.radius[i] = 0.2f;
    struct orl_ground ground = find(&s);
    assert_found(&ground);
    orl_points_finish(&s.scene.points);
}

static void held_out_photographs_have_no_say(void **state)
{
    (void)state;
    struct street s;
    build(&s, GROUND);
    struct orl_ground without = find(&s);
    const double eye[3] = {0, 40, 5}, target[3] = {0, 0, 5}, up[3] = {0, 0, 1};
    s.photos[4].view.cam_from_world = orl_pose_look_at(eye, target, up); // from underground
    struct orl_ground none = find(&s);
    assert_float_equal(none.height, 0, 0);
    s.photos[4].test = true;
    struct orl_ground held_out = find(&s);
    assert_float_equal(held_out.height, without.height, 0.05);
    // Nor on which way is up, however many they are.
    for (int i = 3; i < PHOTOS; i++)
        s.photos[i].test = true;
    held_out = find(&s);
    assert_true(held_out.height > 1);
    for (int i = 3; i < PHOTOS; i++)
        s.photos[i].orientation = 3;
    assert_float_equal(find(&s).height, held_out.height, 0);
    orl_points_finish(&s.scene.points);
}

static void there_may_be_none(void **state)
{
    (void)state;
    struct street s;
    build(&s, GROUND);
    struct orl_ground ground;
    // From a kite: at heights of every kind.
    for (int i = 0; i < PHOTOS; i++) {
        const double eye[3] = {0.7 * i - 3, 1.2 - 0.25 * i, 0}, target[3] = {0, 0, 10}, up[3] = {0, -1, 0};
        s.photos[i].view.cam_from_world = orl_pose_look_at(eye, target, up);
    }
    ground = find(&s);
    assert_float_equal(ground.height, 0, 0);
    orl_points_finish(&s.scene.points);
    // A small thing on a turntable, all points near one another.
    build(&s, GROUND);
    for (size_t i = 0; i < s.scene.points.count; i++)
        for (int k = 0; k < 3; k++)
            s.scene.points.position[i][k] = 0.1f * s.scene.points.position[i][k] +
                                            (k == 2 ? 9.0f : k == 1 ? 1.4f : 0.0f);
    ground = find(&s);
    assert_float_equal(ground.height, 0, 0);
    // Few photographs and no points.
    s.scene.photo_count = 2;
    ground = find(&s);
    assert_float_equal(ground.height, 0, 0);
    s.scene.photo_count = PHOTOS;
    orl_points_finish(&s.scene.points);
    s.scene.points = (struct orl_points){0};
    ground = find(&s);
    assert_float_equal(ground.height, 0, 0);
}

// A facade whose points thin out towards its foot and its top: nothing is ground.
static void build_facade(struct street *s)
{
    build(s, 0);
    for (size_t i = 0; i < FACADE; i++) {
        float *y = &s->scene.points.position[i][1];
        float share = (1.6f - *y) / 5;
        *y = 1.6f - 5 * (share < 0.5f ? sqrtf(share / 2) : 1 - sqrtf((1 - share) / 2));
    }
}

static void few_points_are_no_ground(void **state)
{
    (void)state;
    struct street s;
    build_facade(&s);
    assert_float_equal(find(&s).height, 0, 0);
    orl_points_finish(&s.scene.points);
}

// A quarter of a facade's points lie along its foot, and three points beside it look up.
static void the_foot_of_a_facade_is_no_ground(void **state)
{
    enum { UPWARD = 3 };
    (void)state;
    struct street s;
    build(&s, UPWARD);
    for (size_t i = UPWARD; i < UPWARD + FACADE; i += 4)
        s.scene.points.position[i][1] = 1.6f;
    assert_float_equal(find(&s).height, 0, 0);
    orl_points_finish(&s.scene.points);
}

// As far before the photographs as ground is beneath them.
static void walls_are_no_ground(void **state)
{
    (void)state;
    struct street s;
    build_facade(&s);
    for (int i = 0; i < PHOTOS; i++) {
        const double eye[3] = {0.7 * i - 3, 0, 8 + 0.01 * i}, target[3] = {0.7 * i - 3, -0.2, 10};
        const double up[3] = {0, -1, 0};
        s.photos[i].view.cam_from_world = orl_pose_look_at(eye, target, up);
    }
    assert_float_equal(find(&s).height, 0, 0);
    orl_points_finish(&s.scene.points);
}

// A floor that much lies beneath, at every depth, is not what the photographer stood on.
static void floors_above_the_ground_are_none(void **state)
{
    (void)state;
    struct street s;
    build(&s, 900);
    for (size_t i = 0; i < 60; i++)
        s.scene.points.position[900 + 40 * i][1] = 2.6f + 0.08f * (float)i;
    assert_float_equal(find(&s).height, 0, 0);
    orl_points_finish(&s.scene.points);
}

// Photographs turned by half a turn about their own axes, so that the street is above all of them; the
// facade's points thin out towards its other end, which is the lower one then.
static void a_ceiling_is_none(void **state)
{
    (void)state;
    struct street s;
    build(&s, GROUND);
    for (size_t i = GROUND; i < s.scene.points.count; i++) {
        float *y = &s.scene.points.position[i][1];
        *y = 1.6f - 5 * (1 - sqrtf(1 - (1.6f - *y) / 5));
    }
    for (int i = 0; i < PHOTOS; i++) {
        struct orl_pose *pose = &s.photos[i].view.cam_from_world;
        for (int axis = 0; axis < 2; axis++) {
            for (int k = 0; k < 3; k++)
                pose->r[axis][k] = -pose->r[axis][k];
            pose->t[axis] = -pose->t[axis];
        }
    }
    assert_float_equal(find(&s).height, 0, 0);
    // Unless the files say that the pictures lie upside down.
    for (int i = 0; i < PHOTOS; i++)
        s.photos[i].orientation = 3;
    struct orl_ground ground = find(&s);
    assert_found(&ground);
    orl_points_finish(&s.scene.points);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(finds_the_street),
        cmocka_unit_test(normals_may_be_off),
        cmocka_unit_test(all_points_of_the_ground_count),
        cmocka_unit_test(held_out_photographs_have_no_say),
        cmocka_unit_test(there_may_be_none),
        cmocka_unit_test(few_points_are_no_ground),
        cmocka_unit_test(the_foot_of_a_facade_is_no_ground),
        cmocka_unit_test(walls_are_no_ground),
        cmocka_unit_test(floors_above_the_ground_are_none),
        cmocka_unit_test(a_ceiling_is_none),
    };
    return cmocka_run_group_tests_name("ground", tests, NULL, NULL);
}
