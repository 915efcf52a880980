// The option table: what is tried can be set, presets survive their text, what nothing reads is
// refused, and scenes' settings are used.
#include <stdio.h>
#include <string.h>

#include "oriel/render.h"
#include "render/frame/method.h"
#include "render/proxy/proxy.h"
#include "test.h"

static void tries_can_be_set(void **state)
{
    (void)state;
    int tried = 0;
    for (const struct orl_option *o = orl_render_options(); o->name; o++) {
        tried += o->try_count > 0;
        for (int i = 0; i < o->try_count; i++) {
            assert_true(o->tries[i] >= o->low && o->tries[i] <= o->high);
            assert_true(i == 0 || o->tries[i] > o->tries[i - 1]);
        }
    }
    assert_true(tried > 4);
}

// Every preset, written as text and set on another, is itself again, byte by byte.
static void presets_survive_their_text(void **state)
{
    (void)state;
    for (const struct orl_method *m = orl_methods; m->name; m++) {
        struct orl_render_params params = orl_methods[m == orl_methods].params;
        char text[64][96];
        const char *assignments[64];
        size_t count = 0;
        for (const struct orl_option *o = orl_render_options(); o->name; o++) {
            char value[ORL_OPTION_TEXT];
            orl_option_print(o, &m->params, value);
            if (!orl_render_option_read(o, &m->params)) { // a default, which text may not set
                memcpy((char *)&params + o->offset, (const char *)&m->params + o->offset, o->size);
                continue;
            }
            snprintf(text[count], sizeof text[count], "%s=%s", o->name, value);
            assignments[count] = text[count];
            count++;
        }
        assert_int_equal(orl_render_params_assign(NULL, &params, assignments, count), ORL_OK);
        assert_memory_equal(&params, &m->params, sizeof params);
    }
}

// Every option is read by some method, and where none does it is refused.
static void options_that_nothing_reads_are_refused(void **state)
{
    (void)state;
    for (const struct orl_option *o = orl_render_options(); o->name; o++) {
        size_t readers = 0;
        for (const struct orl_method *m = orl_methods; m->name; m++) {
            struct orl_render_params params = m->params;
            char value[ORL_OPTION_TEXT], assignment[128];
            orl_option_print(o, &params, value);
            snprintf(assignment, sizeof assignment, "%s=%s", o->name, value);
            bool read = orl_render_option_read(o, &params);
            readers += read;
            assert_int_equal(orl_render_params_set(NULL, &params, assignment),
                             read ? ORL_OK : ORL_ERR_ARGUMENT);
        }
        assert_true(readers > 0);
    }
    struct orl_render_params params = orl_method_find(NULL, "airieau")->params;
    assert_int_equal(orl_render_params_set(NULL, &params, "photos_per_pixel=3"), ORL_ERR_ARGUMENT);
    assert_int_equal(orl_render_params_set(NULL, &params, "antialias=on"), ORL_OK);
    params.sample = ORL_SAMPLE_RADIANCE;
    assert_int_equal(orl_render_params_set(NULL, &params, "antialias=on"), ORL_ERR_ARGUMENT);
}

// Several at once may choose what reads the others, in any order; a failure changes nothing.
static void several_are_set_at_once(void **state)
{
    (void)state;
    static const char *const both[] = {"sharpness=2", "weight=lumigraph"};
    struct orl_render_params params = orl_method_find(NULL, "airieau")->params;
    const struct orl_render_params before = params;
    assert_int_equal(orl_render_params_assign(NULL, &params, both, 1), ORL_ERR_ARGUMENT);
    assert_memory_equal(&params, &before, sizeof params);
    assert_int_equal(orl_render_params_assign(NULL, &params, both, 2), ORL_OK);
    assert_float_equal(params.sharpness, 2, 0);
    assert_string_equal(params.weight, "lumigraph");
}

static void keep(void *text, enum orl_log_level level, const char *message)
{
    (void)level;
    snprintf(text, 512, "%s", message);
}

// What is refused says what is allowed.
static void errors_tell_what_is_allowed(void **state)
{
    (void)state;
    static const struct {
        const char *assignment, *said;
    } wrong[] = {{"outliers=7", "outliers=7: must be a number from 0 to 1"},
                 {"weight=heavy", "weight=heavy: must be one of airieau, equal, lumigraph, normal, princ, "
                                  "selected, ulr"},
                 {"proxy=splat", "proxy=splat: must be one of splats, mesh, hull, voxels"},
                 {"fill=red", "fill=red: must be one of none, color, depth, ground, room"},
                 {"of_tomorrow=1", "option of_tomorrow is not known; there are: proxy paint "},
                 {"outliers", "outliers: must be KEY=VALUE"}};
    char text[512];
    const struct orl_log log = {.level = ORL_LOG_ERROR, .print = keep, .priv = text};
    for (size_t i = 0; i < ORL_COUNT(wrong); i++) {
        struct orl_render_params params = orl_methods[0].params;
        assert_int_equal(orl_render_params_set(&log, &params, wrong[i].assignment), ORL_ERR_ARGUMENT);
        assert_int_equal(strncmp(text, wrong[i].said, strlen(wrong[i].said)), 0);
    }
}

// A number prints with the digits that were given, and with as many as a float needs.
static void numbers_print_as_they_are(void **state)
{
    (void)state;
    static const char *const given[] = {"0.1", "0.3", "0.123456791"};
    const struct orl_option *option = orl_render_option_find("outliers");
    for (size_t i = 0; i < ORL_COUNT(given); i++) {
        struct orl_render_params params = orl_methods[0].params;
        char text[ORL_OPTION_TEXT], assignment[64];
        snprintf(assignment, sizeof assignment, "outliers=%s", given[i]);
        assert_int_equal(orl_render_params_set(NULL, &params, assignment), ORL_OK);
        assert_true(orl_option_print(option, &params, text));
        assert_string_equal(text, given[i]);
    }
}

static void choices_must_go_together(void **state)
{
    (void)state;
    struct orl_render_params params = orl_method_find(NULL, "oriel")->params;
    assert_int_equal(orl_render_params_set(NULL, &params, "weight=airieau"), ORL_ERR_ARGUMENT);
    assert_int_equal(orl_render_params_set(NULL, &params, "paint=gather"), ORL_ERR_ARGUMENT);
    static const char *const generic[] = {"paint=gather", "combine=mean", "weight=airieau"};
    assert_int_equal(orl_render_params_assign(NULL, &params, generic, 3), ORL_OK);
    // Guessed depth has no normal to weigh photographs by.
    static const char *const normals[] = {"orzan-surface", "orzan-shadow", "princ"};
    for (size_t i = 0; i < ORL_COUNT(normals); i++) {
        params = orl_method_find(NULL, normals[i])->params;
        assert_int_equal(orl_render_params_set(NULL, &params, "fill=ground"), ORL_ERR_ARGUMENT);
        assert_int_equal(orl_render_params_set(NULL, &params, "fill=none"), ORL_OK);
    }
}

// A scene of silhouettes has no points, but a mesh or what makes a hull.
static void scenes_without_points_use_mesh_or_hull(void **state)
{
    (void)state;
    struct orl_scene scene = {.dir = (char *)"a scene"};
    struct orl_render_params params;
    const struct orl_method *method = orl_method_find(NULL, "orzan-view");
    orl_render_params_tuned(NULL, method, &scene, &params);
    assert_string_equal(params.proxy->name, "mesh");
    struct orl_photo photo = {.masked = true};
    scene.photos = &photo;
    scene.photo_count = 1;
    orl_render_params_tuned(NULL, method, &scene, &params);
    assert_string_equal(params.proxy->name, "hull"); // there is no mesh
    scene.points.count = 1;
    orl_render_params_tuned(NULL, method, &scene, &params);
    assert_string_equal(params.proxy->name, "splats");
    scene.points.count = 0;
    method = orl_method_find(NULL, "points");
    orl_render_params_tuned(NULL, method, &scene, &params);
    assert_string_equal(params.proxy->name, "splats");
}

// A variant takes what was found for its base, but not in what makes it a variant, and not if
// something was found for itself.
static void variants_take_the_settings_of_their_base(void **state)
{
    (void)state;
    const struct orl_method *high = orl_method_find(NULL, "oriel-high");
    struct orl_tuned tuned[] = {{(char *)"oriel", (char *)"sharpness", 16, NULL},
                                {(char *)"oriel", (char *)"reconstructions", 4, NULL},
                                {(char *)"oriel-high", (char *)"depth_tolerance", 0.25, NULL}};
    struct orl_scene scene = {.dir = (char *)"a scene", .points = {.count = 1}, .tuned = tuned,
                              .tuned_count = 2};
    struct orl_render_params params;
    orl_render_params_tuned(NULL, high, &scene, &params);
    assert_float_equal(params.sharpness, 16, 0);
    assert_float_equal(params.reconstructions, high->params.reconstructions, 0);
    scene.tuned_count = 3;
    orl_render_params_tuned(NULL, high, &scene, &params);
    assert_float_equal(params.sharpness, high->params.sharpness, 0);
    assert_float_equal(params.depth_tolerance, 0.25, 0);
}

static void scenes_settings_are_used(void **state)
{
    (void)state;
    const struct orl_method *method = &orl_methods[0];
    struct orl_tuned tuned[] = {{(char *)"other", (char *)"outliers", 0.25, NULL},
                                {(char *)method->name, (char *)"outliers", 0.5, NULL},
                                {(char *)method->name, (char *)"front_layer", 0.05, NULL}};
    struct orl_scene scene = {.dir = (char *)"a scene", .points = {.count = 1}, .tuned = tuned,
                              .tuned_count = 3};
    struct orl_render_params params;
    orl_render_params_tuned(NULL, method, &scene, &params);
    assert_float_equal(params.outliers, 0.5, 0);
    assert_float_equal(params.front_layer, 0.05, 1e-6);
    assert_float_equal(params.splat_scale, method->params.splat_scale, 0);
    tuned[0] = (struct orl_tuned){(char *)method->name, (char *)"antialias", 0, (char *)"off"};
    orl_render_params_tuned(NULL, method, &scene, &params);
    assert_int_equal(params.antialias, ORL_ANTIALIAS_OFF);
    assert_int_equal(method->params.antialias, ORL_ANTIALIAS_ON);
}

static void count_warnings(void *count, enum orl_log_level level, const char *message)
{
    *(int *)count += level == ORL_LOG_WARNING && strstr(message, "of_tomorrow=1 outliers=1000000 weight=heavy");
}

// A scene that another version tuned opens: what this one does not take is named once, and the rest holds.
static void settings_that_do_not_fit_are_ignored(void **state)
{
    (void)state;
    const struct orl_method *method = &orl_methods[0];
    char *name = (char *)method->name;
    struct orl_tuned tuned[] = {{name, (char *)"of_tomorrow", 1, NULL},
                                {name, (char *)"outliers", 1e6, NULL},
                                {name, (char *)"weight", 0, (char *)"heavy"},
                                {name, (char *)"splat_scale", 2, NULL}};
    struct orl_scene scene = {.dir = (char *)"a scene", .points = {.count = 1}, .tuned = tuned,
                              .tuned_count = ORL_COUNT(tuned)};
    struct orl_render_params params;
    int warnings = 0;
    const struct orl_log log = {.level = ORL_LOG_WARNING, .print = count_warnings, .priv = &warnings};
    orl_render_params_tuned(&log, method, &scene, &params);
    assert_int_equal(warnings, 1);
    assert_float_equal(params.splat_scale, 2, 0);
    assert_float_equal(params.outliers, method->params.outliers, 0);
    assert_string_equal(params.weight, method->params.weight);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tries_can_be_set),
        cmocka_unit_test(presets_survive_their_text),
        cmocka_unit_test(options_that_nothing_reads_are_refused),
        cmocka_unit_test(several_are_set_at_once),
        cmocka_unit_test(errors_tell_what_is_allowed),
        cmocka_unit_test(numbers_print_as_they_are),
        cmocka_unit_test(choices_must_go_together),
        cmocka_unit_test(scenes_without_points_use_mesh_or_hull),
        cmocka_unit_test(scenes_settings_are_used),
        cmocka_unit_test(settings_that_do_not_fit_are_ignored),
        cmocka_unit_test(variants_take_the_settings_of_their_base),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
