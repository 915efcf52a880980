// Voxel hulls of shapes whose silhouettes are known by formula.
#include <math.h>
#include <string.h>

#include "mesh_help.h"
#include "scene/cones.h"
#include "test.h"

enum { CAMERAS = 24, SIDE = 240 };
static const double RADIUS = 0.5, CENTRE[3] = {0.3, -0.2, 0.1};
static const double pi = 3.14159265358979323846;

// A sphere's silhouettes from all around, every pixel that it touches.
struct scene {
    struct orl_silhouette all[CAMERAS];
};

static bool touches(const struct orl_view *view, const double eye[3], int x, int y)
{
    // The ray through any of 3 x 3 places of the pixel meets the sphere.
    for (int s = 0; s < 9; s++) {
        double at[3], d[3], to[3], dd = 0, dt = 0, tt = 0;
        orl_view_unproject(view, x + 0.5 * (s % 3), y + 0.5 * (s / 3), 1, at);
        for (int k = 0; k < 3; k++) {
            d[k] = at[k] - eye[k];
            to[k] = CENTRE[k] - eye[k];
            dd += d[k] * d[k];
            dt += d[k] * to[k];
            tt += to[k] * to[k];
        }
        if (tt - dt * dt / dd <= RADIUS * RADIUS)
            return true;
    }
    return false;
}

static void draw(struct orl_silhouette *silhouette)
{
    double eye[3];
    orl_pose_centre(&silhouette->view.cam_from_world, eye);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
            silhouette->mask.u8[y * SIDE + x] = touches(&silhouette->view, eye, x, y) ? 255 : 0;
}

static void scene_init(struct scene *scene)
{
    for (int i = 0; i < CAMERAS; i++) {
        // Evenly on a sphere (a golden spiral).
        double z = 1 - (2 * i + 1.0) / CAMERAS, angle = 2.39996322972865 * i;
        double r = sqrt(1 - z * z);
        const double eye[3] = {CENTRE[0] + 4 * r * cos(angle), CENTRE[1] + 4 * r * sin(angle),
                               CENTRE[2] + 4 * z};
        const double up[3] = {0.1, 0.2, 1};
        struct orl_silhouette *s = &scene->all[i];
        s->view = (struct orl_view){
            {SIDE, SIDE, 700, 710, 121.5, 118},
            orl_pose_look_at(eye, CENTRE, up)};
        assert_int_equal(orl_image_init(NULL, &s->mask, SIDE, SIDE, 1, ORL_PIXEL_U8), ORL_OK);
        draw(s);
    }
}

static int set_up(void **state)
{
    struct scene *scene = calloc(1, sizeof *scene);
    *state = scene;
    if (scene)
        scene_init(scene);
    return scene ? 0 : -1;
}

static int tear_down(void **state)
{
    struct scene *scene = *state;
    for (int i = 0; i < CAMERAS; i++)
        orl_image_finish(&scene->all[i].mask);
    free(scene);
    return 0;
}

// The bounds hold all places of the sphere's surface.
static void holds_the_sphere(void **state)
{
    struct scene *scene = *state;
    struct cones cones;
    assert_int_equal(orl_cones_make(NULL, scene->all, CAMERAS, SIDE, &cones), ORL_OK);
    for (int k = 0; k < 3; k++) {
        assert_true(cones.cube.origin[k] < CENTRE[k] - RADIUS);
        assert_true(cones.cube.origin[k] + SIDE * cones.cube.voxel > CENTRE[k] + RADIUS);
    }
    assert_true(SIDE * cones.cube.voxel < 3 * RADIUS && !cones.cube.endless);
    orl_cones_finish(&cones);
}

// How far a place projects outside a mask: to the nearest corner of a pixel of the subject.
static double outside_px(const struct orl_silhouette *silhouette, const float position[3])
{
    const double at[3] = {(double)position[0], (double)position[1], (double)position[2]};
    double pixel[2], depth, nearest = INFINITY;
    assert_true(orl_view_project(&silhouette->view, at, pixel, &depth));
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
            if (silhouette->mask.u8[y * SIDE + x])
                nearest = fmin(nearest, hypot(fmax(fmax(x - pixel[0], pixel[0] - x - 1), 0),
                                              fmax(fmax(y - pixel[1], pixel[1] - y - 1), 0)));
    return nearest;
}

// A vertex outside a silhouette would be painted with what lies behind the subject. With the voxels
// here, up to 12 pixels wide, carving by voxels leaves the mesh that far outside.
static void lies_on_the_cones(void **state)
{
    struct scene *scene = *state;
    const size_t limits[] = {0, 500};
    for (int side = 16; side <= 32; side *= 2)
        for (size_t l = 0; l < 2; l++) {
            struct orl_mesh mesh;
            double worst = 0;
            assert_int_equal(orl_cones_mesh(NULL, scene->all, CAMERAS, side, limits[l], NULL, &mesh),
                             ORL_OK);
            for (size_t i = 0; i < mesh.vertex_count; i += 7)
                for (int c = 0; c < CAMERAS; c += 3)
                    worst = fmax(worst, outside_px(&scene->all[c], mesh.position[i]));
            assert_true(mesh.vertex_count > 200 && worst < 1);
            orl_mesh_finish(&mesh);
        }
}

// Even where its mirrored cone holds it: a camera sees nothing behind it.
static void leaves_out_what_is_behind_a_camera(void **state)
{
    enum { VOXELS = 8 };
    struct scene *scene = *state;
    struct cone cone;
    struct cones cones = {.all = &cone, .count = 1, .cube = {.side = VOXELS, .voxel = 2.0 / VOXELS}};
    float *field;
    double eye[3];
    int behind = 0;
    assert_int_equal(orl_cone_make(NULL, scene->all, &cone), ORL_OK);
    orl_pose_centre(&scene->all[0].view.cam_from_world, eye);
    for (int k = 0; k < 3; k++)
        cones.cube.origin[k] = eye[k] - 1;
    assert_int_equal(orl_cones_field(NULL, &cones, &field), ORL_OK);
    for (int i = 0; i < VOXELS * VOXELS * VOXELS; i++) {
        const int at[3] = {i % VOXELS, i / VOXELS % VOXELS, i / VOXELS / VOXELS};
        double place[3], local[3];
        for (int k = 0; k < 3; k++)
            place[k] = cones.cube.origin[k] + (at[k] + 0.5) * cones.cube.voxel;
        orl_pose_apply(&scene->all[0].view.cam_from_world, place, local);
        behind += local[2] < 0;
        assert_true(local[2] >= 0 || field[i] > 0);
    }
    assert_true(behind > 100);
    free(field);
    orl_image_finish(&cone.distance);
}

static void makes_a_mesh(void **state)
{
    struct scene *scene = *state;
    struct orl_mesh mesh, fewer;
    assert_int_equal(orl_cones_mesh(NULL, scene->all, CAMERAS, 48, 0, NULL, &mesh), ORL_OK);
    assert_int_equal(orl_cones_mesh(NULL, scene->all, CAMERAS, 48, 500, NULL, &fewer), ORL_OK);
    // 24 silhouettes of 240 pixels leave some room around the sphere.
    const double volume = 4.0 / 3 * pi * RADIUS * RADIUS * RADIUS;
    assert_true(mesh_volume(&mesh) > volume && mesh_volume(&mesh) < 1.1 * volume);
    assert_float_equal(mesh_volume(&fewer), mesh_volume(&mesh), 0.02 * volume);
    assert_true(fewer.triangle_count <= 500 && fewer.triangle_count > 400);
    for (size_t i = 0; i < mesh.vertex_count; i++) {
        double out = 0;
        for (int k = 0; k < 3; k++)
            out += (double)mesh.normal[i][k] * ((double)mesh.position[i][k] - CENTRE[k]);
        assert_true(out > 0); // normals point outward
    }
    orl_mesh_finish(&mesh);
    orl_mesh_finish(&fewer);
}

// What the picture's border cuts off is not carved away, else it is.
static bool keeps_any(const struct orl_silhouette *silhouette)
{
    struct cone cone;
    const struct cones cones = {&cone, 1, {2, {-3.4, -0.2, 4}, 0.2, false}}; // left of the border
    float *field;
    bool any = false;
    assert_int_equal(orl_cone_make(NULL, silhouette, &cone), ORL_OK);
    assert_int_equal(orl_cones_field(NULL, &cones, &field), ORL_OK);
    for (int i = 0; i < 8; i++)
        any = any || field[i] <= 0;
    orl_image_finish(&cone.distance);
    free(field);
    return any;
}

static void keeps_what_borders_cut(void **state)
{
    (void)state;
    struct orl_silhouette s = {.view = {{20, 20, 20, 20, 10, 10},
                                        {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 0, 0}}}};
    assert_int_equal(orl_image_init(NULL, &s.mask, 20, 20, 1, ORL_PIXEL_U8), ORL_OK);
    s.mask.u8[10 * 20 + 5] = 255;
    assert_false(keeps_any(&s));
    s.mask.u8[10 * 20] = 255;
    assert_true(keeps_any(&s));
    // Beside a subject that is larger, the pixel at the border is something else.
    for (int x = 5; x < 8; x++)
        s.mask.u8[10 * 20 + x] = 255;
    assert_false(keeps_any(&s));
    orl_image_finish(&s.mask);
}

// A subject that leaves every picture on the same side has no end there, which is said once.
static void says_once_that_it_does_not_end(void **state)
{
    (void)state;
    struct said said;
    struct orl_log log = log_to(&said);
    struct orl_silhouette pair[2];
    struct orl_mesh mesh;
    bool told = false;
    for (int i = 0; i < 2; i++) {
        pair[i].view = (struct orl_view){{20, 20, 20, 20, 10, 10},
                                         {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0.5 * i, 0, 0}}};
        assert_int_equal(orl_image_init(NULL, &pair[i].mask, 20, 20, 1, ORL_PIXEL_U8), ORL_OK);
        for (int y = 0; y < 12; y++)
            memset(pair[i].mask.u8 + 20 * y + 8 + i, 255, 4);
    }
    for (int i = 0; i < 2; i++) {
        assert_int_equal(orl_cones_mesh(&log, pair, 2, 16, 0, &told, &mesh), ORL_OK);
        assert_true(told);
        assert_int_equal(strstr(said.text, "without end") != NULL, i == 0);
        said.text[0] = 0;
        orl_mesh_finish(&mesh);
    }
    for (int i = 0; i < 2; i++)
        orl_image_finish(&pair[i].mask);
}

static void refuses_what_has_no_hull(void **state)
{
    struct scene *scene = *state;
    struct said said;
    struct orl_log log = log_to(&said);
    struct orl_mesh mesh;
    assert_int_equal(orl_cones_mesh(&log, scene->all, 1, 16, 0, NULL, &mesh), ORL_ERR_DATA);
    assert_non_null(strstr(said.text, "from two places"));
    // Two cameras that see the sphere in places that do not meet.
    struct orl_silhouette apart[3] = {scene->all[0], scene->all[10], scene->all[20]};
    for (int i = 0; i < 3; i++) {
        assert_int_equal(orl_image_init(NULL, &apart[i].mask, SIDE, SIDE, 1, ORL_PIXEL_U8),
                         ORL_OK);
        apart[i].mask.u8[(20 + 70 * i) * SIDE + 20 + 90 * (i == 1)] = 255;
    }
    assert_int_equal(orl_cones_mesh(&log, apart, 3, 16, 0, NULL, &mesh), ORL_ERR_DATA);
    assert_non_null(strstr(said.text, "no place in common"));
    memset(apart[1].mask.u8, 0, SIDE * SIDE);
    assert_int_equal(orl_cones_mesh(&log, apart, 3, 16, 0, NULL, &mesh), ORL_ERR_DATA);
    assert_non_null(strstr(said.text, "silhouette 2 of 3 is empty"));
    assert_null(mesh.position);
    for (int i = 0; i < 3; i++)
        orl_image_finish(&apart[i].mask);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(holds_the_sphere), cmocka_unit_test(lies_on_the_cones),
        cmocka_unit_test(leaves_out_what_is_behind_a_camera),
        cmocka_unit_test(makes_a_mesh),
        cmocka_unit_test(keeps_what_borders_cut),
        cmocka_unit_test(says_once_that_it_does_not_end), cmocka_unit_test(refuses_what_has_no_hull),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
