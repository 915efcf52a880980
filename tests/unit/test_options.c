// The tables of options: what oriel tune tries can be set, and scenes' settings are used.
#include <string.h>

#include "render/render.h"
#include "test.h"

static const struct orl_render_option *find(const char *key)
{
    for (const struct orl_render_option *o = orl_render_options; o->key; o++)
        if (strcmp(o->key, key) == 0)
            return o;
    return NULL;
}

static void tries_can_be_set(void **state)
{
    (void)state;
    for (const struct orl_render_tries *t = orl_render_tries; t->key; t++) {
        const struct orl_render_option *option = find(t->key);
        assert_non_null(option);
        assert_null(option->names);
        assert_in_range(t->count, 2, ORL_COUNT(t->values));
        for (int i = 0; i < t->count; i++) {
            struct orl_render_params params = orl_methods[0].params;
            char assignment[64];
            snprintf(assignment, sizeof assignment, "%s=%.9g", t->key, t->values[i]);
            assert_int_equal(orl_render_params_set(NULL, &params, assignment), ORL_OK);
            assert_true(i == 0 || t->values[i] > t->values[i - 1]);
        }
    }
}

static void scenes_settings_are_used(void **state)
{
    (void)state;
    const struct orl_method *method = &orl_methods[0];
    struct orl_tuned tuned[] = {{(char *)"other", (char *)"min_support", 3},
                                {(char *)method->name, (char *)"min_support", 5},
                                {(char *)method->name, (char *)"front_layer", 0.05}};
    struct orl_scene scene = {.dir = (char *)"a scene", .tuned = tuned, .tuned_count = 3};
    struct orl_render_params params;
    assert_int_equal(orl_render_params_tuned(NULL, method, &scene, &params), ORL_OK);
    assert_float_equal(params.min_support, 5, 0);
    assert_float_equal(params.front_layer, 0.05, 1e-6);
    assert_float_equal(params.splat_scale, method->params.splat_scale, 0);
    tuned[1].value = 1e6; // out of range
    assert_int_equal(orl_render_params_tuned(NULL, method, &scene, &params), ORL_ERR_FORMAT);
    tuned[1].value = 5;
    tuned[1].key = (char *)"of_tomorrow";
    assert_int_equal(orl_render_params_tuned(NULL, method, &scene, &params), ORL_ERR_FORMAT);
    tuned[1].method = (char *)"other";
    assert_int_equal(orl_render_params_tuned(NULL, method, &scene, &params), ORL_OK);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tries_can_be_set),
        cmocka_unit_test(scenes_settings_are_used),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
