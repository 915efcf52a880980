// Scenes that older programs have made keep what they are: their stages' keys have the same settings,
// and their recorded arguments are understood.
#include "test.h"

#include <string.h>

#include "core/file.h"
#include "core/json.h"
#include "preprocess/calibrate/parts.h"
#include "preprocess/plan.h"
#include "preprocess/stages.h"

static void assert_settings(const struct orl_prepare_params *params, enum orl_stage_id id,
                            const char *expected)
{
    struct orl_source sources[] = {{.name = "0.jpg", .hash = 77, .width = 640, .height = 480},
                                   {.name = "1.jpg", .hash = 78, .test = true},
                                   {.name = "2.jpg", .hash = 79}};
    const struct orl_job job = {.params = params, .sources = sources, .source_count = 3};
    json_t *settings = orl_stage_settings(&job, id);
    char *text = json_dumps(settings, JSON_COMPACT | JSON_SORT_KEYS);
    assert_string_equal(text, expected);
    free(text);
    json_decref(settings);
}

static void usual_settings(void **state)
{
    (void)state;
    const struct orl_prepare_params params = {ORL_PREPARE_DEFAULTS};
    assert_settings(&params, ORL_STAGE_CALIBRATE,
                    "{\"masks\":{},\"matching\":\"auto\",\"quality\":\"standard\",\"seed\":1,"
                    "\"sharing\":\"auto\"}");
    assert_settings(&params, ORL_STAGE_UNDISTORT, "{\"max_size\":1600}");
    assert_settings(&params, ORL_STAGE_DENSIFY,
                    "{\"densifier\":\"auto\",\"quality\":\"standard\",\"seed\":1,\"test\":[\"1.jpg\"]}");
    assert_settings(&params, ORL_STAGE_FUSE, "{}");
    assert_settings(&params, ORL_STAGE_RADII, "{}");
    assert_settings(&params, ORL_STAGE_MESH,
                    "{\"mesh\":\"none\",\"quality\":\"standard\",\"test\":[\"1.jpg\"]}");
    assert_settings(&params, ORL_STAGE_EXPOSE, "{\"exposures\":\"\",\"test\":[\"1.jpg\"]}");
    assert_settings(&params, ORL_STAGE_TUNE, "{}");
    assert_settings(&params, ORL_STAGE_OCCLUDERS, "{\"find\":true}");
}

static void other_settings(void **state)
{
    (void)state;
    struct orl_prepare_params params = {ORL_PREPARE_DEFAULTS};
    params.quality = ORL_QUALITY_DRAFT;
    params.sharing = ORL_SHARING_EACH;
    params.matching = ORL_MATCHING_SEQUENTIAL;
    params.mapper = ORL_MAPPER_GLOBAL;
    params.densifier = ORL_DENSIFIER_GL;
    params.mesh = ORL_MESH_POISSON;
    params.hull = ORL_HULL_NONE;
    params.seed = 7;
    params.max_size = 1000;
    params.max_vram_bytes = (size_t)512 << 20;
    params.radius_neighbours = 9;
    params.fuse_cluster = 1;
    params.adapt = ORL_ADAPT_NONE;
    assert_settings(&params, ORL_STAGE_CALIBRATE,
                    "{\"mapper\":\"global\",\"masks\":{},\"matching\":\"sequential\",\"quality\":"
                    "\"draft\",\"seed\":7,\"sharing\":\"each\"}");
    assert_settings(&params, ORL_STAGE_UNDISTORT, "{\"max_size\":1000}");
    assert_settings(&params, ORL_STAGE_DENSIFY,
                    "{\"densifier\":\"gl\",\"max_vram\":536870912,\"quality\":\"draft\",\"seed\":7,"
                    "\"test\":[\"1.jpg\"]}");
    assert_settings(&params, ORL_STAGE_FUSE, "{\"cluster\":1,\"hull\":\"none\"}");
    assert_settings(&params, ORL_STAGE_RADII, "{\"neighbours\":9}");
    assert_settings(&params, ORL_STAGE_TUNE, "{\"adapt\":\"none\"}");
    assert_settings(&params, ORL_STAGE_MESH,
                    "{\"mesh\":\"poisson\",\"quality\":\"draft\",\"test\":[\"1.jpg\"]}");
}

// .oriel/stages.json as the first programs wrote it, and what calibration has begun with.
static const char stored[] =
    "{\"version\": 1, \"plan\": [\"collect\"], \"done\": {\"collect\": {\"key\": \"83b1332dc580e029\"}},"
    "\"arguments\": [\"/photos\", \"--quality\", \"draft\", \"--camera-sharing\", \"each\","
    "\"--matching\", \"%s\", \"--mapper\", \"auto\", \"--densifier\", \"auto\", \"--keep\", \"minimal\","
    "\"--mesh\", \"none\", \"--hull\", \"close\", \"--occluders\", \"find\", \"--adapt\", \"short\","
    "\"--leave-out\", \"none\", \"--seed\", \"7\", \"--test-block\", \"1:3\", \"--adapt-budget\", \"120\","
    "\"--max-vram\", \"512\", \"--max-ram\", \"2048\", \"--test-list\", \"a,b\"]}";

static void write_text(const char *dir, const char *name, const char *format, const char *word)
{
    FILE *file = test_create(dir, name);
    fprintf(file, format, word);
    assert_int_equal(fclose(file), 0);
}

static enum orl_result plan(const char *dir, const char *matching, json_t **out)
{
    struct orl_log log = orl_log_stderr(ORL_LOG_ERROR);
    write_text(dir, ".oriel/stages.json", stored, matching);
    return orl_plan(&log, dir, 16, out);
}

static void stored_arguments(void **state)
{
    (void)state;
    char *dir = test_dir_make(), path[4096];
    snprintf(path, sizeof path, "%s/%s", dir, ORL_CALIBRATE_WORK);
    assert_int_equal(orl_dir_make(NULL, path), ORL_OK);
    write_text(dir, ORL_PARTS_STATE, "{\"photographs\": [1, 2, 3, 4, 5]%s}", "");
    json_t *jobs;
    assert_int_equal(plan(dir, "auto", &jobs), ORL_OK);
    assert_int_equal(json_array_size(json_object_get(jobs, "jobs")), 1);
    const json_t *command =
        json_object_get(json_array_get(json_object_get(jobs, "jobs"), 0), "command");
    assert_string_equal(json_string_value(json_array_get(command, 2)), "/photos");
    json_decref(jobs);
    assert_int_equal(plan(dir, "retrieval", &jobs), ORL_OK);
    assert_int_equal(json_array_size(json_object_get(jobs, "jobs")), 4);
    json_decref(jobs);
    assert_int_equal(plan(dir, "nonsense", &jobs), ORL_ERR_ARGUMENT);
    test_dir_remove(dir);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(usual_settings),
        cmocka_unit_test(other_settings),
        cmocka_unit_test(stored_arguments),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
