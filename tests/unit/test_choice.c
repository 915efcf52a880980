// Which methods and values a command works with.
#include "test.h"

#include "eval/choice.h"

static struct orl_names names_of(const char *a, const char *b)
{
    struct orl_names names = {0};
    assert_int_equal(a ? orl_names_add(NULL, &names, a) : ORL_OK, ORL_OK);
    assert_int_equal(b ? orl_names_add(NULL, &names, b) : ORL_OK, ORL_OK);
    return names;
}

static size_t count_methods(void)
{
    size_t count = 0;
    while (orl_methods[count].name)
        count++;
    return count;
}

// The method's own value, then the scene's, then the settings'.
static void settings_win_over_tuned_over_own(void **state)
{
    (void)state;
    struct orl_tuned tuned[] = {{(char[]){"oriel"}, (char[]){"depth_tolerance"}, 0.25, NULL},
                                {(char[]){"oriel"}, (char[]){"splat_scale"}, 2, NULL}};
    const struct orl_scene scene = {.dir = (char[]){"somewhere"}, .points.count = 1, .tuned = tuned,
                                    .tuned_count = 2};
    struct orl_names none = {0}, settings = names_of("splat_scale=3", NULL);
    struct orl_choice choice;
    assert_int_equal(orl_choice_make(NULL, NULL, ORL_SAMPLE_SRGB, "oriel", &none, &choice), ORL_OK);
    assert_memory_equal(&choice.params, &choice.method->params, sizeof choice.params);
    assert_int_equal(orl_choice_make(NULL, &scene, ORL_SAMPLE_SRGB, "oriel", &settings, &choice), ORL_OK);
    assert_float_equal(choice.params.depth_tolerance, 0.25, 1e-6);
    assert_float_equal(choice.params.splat_scale, 3, 0);
    assert_int_equal(orl_choice_make(NULL, &scene, ORL_SAMPLE_SRGB, "points", &none, &choice), ORL_OK);
    assert_float_equal(choice.params.splat_scale, choice.method->params.splat_scale, 0);
    orl_names_finish(&settings);
}

static void scenes_default_method(void **state)
{
    (void)state;
    const struct orl_names none = {0};
    struct orl_scene scene = {.dir = (char[]){"somewhere"}, .points.count = 1,
                              .defaults.method = (char[]){"points"}};
    struct orl_choice choice;
    struct orl_choices choices;
    assert_int_equal(orl_choice_make(NULL, &scene, ORL_SAMPLE_SRGB, NULL, &none, &choice), ORL_OK);
    assert_string_equal(choice.method->name, "points");
    assert_int_equal(orl_choices_make(NULL, &scene, ORL_SAMPLE_SRGB, &none, &none, NULL, &choices),
                     ORL_OK);
    assert_string_equal(choices.items[0].method->name, "points");
    orl_choices_finish(&choices);
    assert_int_equal(orl_choice_make(NULL, NULL, ORL_SAMPLE_SRGB, NULL, &none, &choice), ORL_OK);
    assert_ptr_equal(choice.method, &orl_methods[0]);
    scene.defaults.method = (char[]){"of_tomorrow"};
    assert_int_not_equal(orl_choice_make(NULL, &scene, ORL_SAMPLE_SRGB, NULL, &none, &choice),
                         ORL_OK);
}

static void lists_of_methods(void **state)
{
    (void)state;
    struct orl_names none = {0}, all = names_of("points", "all"), two = names_of("points", "oriel");
    struct orl_choices choices;
    assert_int_equal(orl_choices_make(NULL, NULL, ORL_SAMPLE_SRGB, &none, &none, NULL, &choices), ORL_OK);
    assert_int_equal(choices.count, 1);
    assert_ptr_equal(choices.items[0].method, &orl_methods[0]);
    orl_choices_finish(&choices);
    assert_int_equal(orl_choices_make(NULL, NULL, ORL_SAMPLE_SRGB, &all, &none, NULL, &choices), ORL_OK);
    assert_int_equal(choices.count, count_methods());
    orl_choices_finish(&choices);
    assert_int_equal(orl_choices_make(NULL, NULL, ORL_SAMPLE_SRGB, &two, &none, NULL, &choices), ORL_OK);
    assert_string_equal(choices.items[0].method->name, "points");
    assert_string_equal(choices.items[1].method->name, "oriel");
    orl_choices_finish(&choices);
    orl_names_finish(&all);
    orl_names_finish(&two);
}

// Methods of papers once more on the proxy of oriel: what remains of them is weights.
static void papers_on_one_proxy(void **state)
{
    (void)state;
    struct orl_names none = {0}, paired = names_of("paired", NULL);
    struct orl_choices choices;
    const struct orl_render_params *oriel = &orl_methods[0].params;
    assert_int_equal(orl_choices_make(NULL, NULL, ORL_SAMPLE_SRGB, &paired, &none, NULL, &choices),
                     ORL_OK);
    assert_int_equal(choices.count, count_methods() + 7);
    for (size_t i = count_methods(); i < choices.count; i++) {
        const struct orl_choice *c = &choices.items[i];
        const struct orl_render_params *own = &c->method->params;
        bool needs_normal = strcmp(own->weight, "normal") == 0 || strcmp(own->weight, "princ") == 0;
        assert_ptr_equal(c->params.proxy, oriel->proxy);
        assert_float_equal(c->params.front_layer, oriel->front_layer, 0);
        assert_int_equal(c->params.fill, needs_normal ? own->fill : oriel->fill);
        assert_string_equal(c->params.weight, own->weight);
        assert_string_equal(c->params.visibility, own->visibility);
        assert_string_not_equal(c->method->name, "goldluecke");
    }
    assert_string_equal(choices.items[count_methods()].setting, "on the proxy of oriel");
    orl_choices_finish(&choices);
    orl_names_finish(&paired);
}

static void varied(void **state)
{
    (void)state;
    struct orl_names none = {0}, one = names_of("oriel", NULL);
    struct orl_choices choices;
    assert_int_equal(orl_choices_make(NULL, NULL, ORL_SAMPLE_SRGB, &one, &none, "splat_scale=1,2.5", &choices),
                     ORL_OK);
    assert_int_equal(choices.count, 2);
    assert_string_equal(choices.items[1].setting, "splat_scale=2.5");
    assert_float_equal(choices.items[1].params.splat_scale, 2.5, 0);
    orl_choices_finish(&choices);
    static const char *const wrong[] = {"splat_scale", "splat_scale=1,x", "nonsense=1",
                                        "splat_scale="};
    for (size_t i = 0; i < ORL_COUNT(wrong); i++) {
        assert_int_equal(orl_choices_make(NULL, NULL, ORL_SAMPLE_SRGB, &one, &none, wrong[i], &choices),
                         ORL_ERR_ARGUMENT);
        assert_int_equal(choices.count, 0);
    }
    orl_names_finish(&one);
}

static void unknown(void **state)
{
    (void)state;
    struct orl_names none = {0}, bad = names_of("nonsense", NULL);
    struct orl_names setting = names_of("nonsense=1", NULL);
    struct orl_choice choice;
    struct orl_choices choices;
    assert_int_equal(orl_choice_make(NULL, NULL, ORL_SAMPLE_SRGB, "nonsense", &none, &choice), ORL_ERR_ARGUMENT);
    assert_int_equal(orl_choice_make(NULL, NULL, ORL_SAMPLE_SRGB, "oriel", &setting, &choice), ORL_ERR_ARGUMENT);
    assert_int_equal(orl_choices_make(NULL, NULL, ORL_SAMPLE_SRGB, &bad, &none, NULL, &choices),
                     ORL_ERR_ARGUMENT);
    orl_names_finish(&bad);
    orl_names_finish(&setting);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(settings_win_over_tuned_over_own),
        cmocka_unit_test(scenes_default_method),
        cmocka_unit_test(lists_of_methods),
        cmocka_unit_test(papers_on_one_proxy),
        cmocka_unit_test(varied),
        cmocka_unit_test(unknown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
