// What suits the scene: settings of its method, and whether its backdrop rests.
#include <math.h>

#include "eval/search.h"
#include "preprocess/drawing.h"
#include "preprocess/scene_json.h"
#include "scene/manifest.h"

enum {
    VIEWS = 8,     // photographs that are compared, at most
    VIEWS_MIN = 5, // fewer may agree by chance
    SIDE = 256,    // their longer side, pixels, at most
};
static const double GAIN_DB = 0.1; // a change must bring so much
// What is best differs most from scene to scene for this one; oriel tune moves others as well.
static char *const KEYS[] = {"sharpness"};

static int size_divide(const struct orl_scene *scene)
{
    int largest = 1;
    for (size_t i = 0; i < scene->photo_count; i++) {
        const struct orl_camera *c = &scene->photos[i].view.camera;
        largest = (int)fmax(largest, fmax(c->width, c->height));
    }
    return (int)fmin((largest + SIDE - 1) / SIDE, ORL_SEARCH_DIVIDE_MAX);
}

static enum orl_result tune(struct orl_job *job, struct orl_gpu *gpu, struct orl_scene *scene, json_t *tuned)
{
    const struct orl_search_params params = {.size_divide = size_divide(scene), .views = VIEWS, .gain_db = GAIN_DB,
                                             .progress = job->progress};
    const struct orl_names keys = {.items = (char **)KEYS, .count = ORL_COUNT(KEYS)};
    struct orl_renderer *renderer = NULL;
    struct orl_search search = {0};
    struct orl_choice start;
    enum orl_result result = orl_choice_make(job->log, scene, ORL_SAMPLE_SRGB, NULL, &(struct orl_names){0}, &start);
    ORL_THEN(result, orl_renderer_create(gpu, scene, NULL, &renderer));
    ORL_THEN(result, orl_search_backdrop(job->log, renderer, scene, &params, &start));
    ORL_THEN(result, orl_search_run(gpu, renderer, scene, &params, &start, &keys, &search));
    if (result == ORL_OK)
        orl_logf(job->log, ORL_LOG_INFO, "tune: %zu photographs, each rendered without itself: %.3f dB, was %.3f; the "
                 "backdrop %s", search.validation.count, search.score.psnr_db, search.trials[0].psnr_db,
                 scene->backdrop_rests ? "rests in the pictures" : "moves with the view");
    if (result == ORL_OK && json_object_set_new(tuned, start.method->name, orl_search_record(&search)) != 0)
        result = orl_fail(job->log, ORL_ERR_MEMORY, "no memory for the settings");
    orl_search_finish(&search);
    orl_renderer_destroy(&renderer);
    return result;
}

enum orl_result orl_stage_tune(struct orl_job *job, json_t *record)
{
    struct orl_scene *scene = NULL;
    struct orl_gpu *gpu = NULL;
    json_t *tuned = json_object();
    enum orl_result result = json_object_set_new(record, "tuned", tuned) == 0
                                 ? orl_scene_json_open(job, &scene)
                                 : orl_fail(job->log, ORL_ERR_MEMORY, "no memory for the settings");
    if (result == ORL_OK && job->params->adapt == ORL_ADAPT_AUTO &&
        scene->photo_count - orl_heldout_count(scene) >= VIEWS_MIN)
        gpu = orl_drawing_device(job, scene, "tune: settings stay those of the method");
    if (gpu)
        result = tune(job, gpu, scene, tuned);
    if (result == ORL_OK &&
        json_object_set_new(record, "backdrop", orl_manifest_backdrop(scene->backdrop_rests)) != 0)
        result = orl_fail(job->log, ORL_ERR_MEMORY, "no memory for the settings");
    orl_scene_destroy(&scene);
    return result;
}
