#include "eval/stress.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/json.h"
#include "core/memory.h"
#include "eval/choice.h"
#include "eval/commit.h"
#include "eval/eval.h"
#include "eval/stress_internal.h"
#include "io/picture.h"

enum { JPEG_QUALITY = 82 };
static const char synth_name[] = "synth";

struct job {
    const struct orl_log *log;
    struct orl_gpu *gpu;
    const struct orl_stress_params *params;
    struct orl_stress *stress;
    struct orl_row_store store;
    char checksum[ORL_ROW_CHECKSUM_SIZE];
    struct stress_case base;
    struct orl_choices choices;
    json_t *provenance, *rows; // rows: of the report
    char work_folder[32];      // of the report's folder
    size_t severities;         // so far, which parts divide
    double done, total;        // number of rows, for the progress report
};

// One severity of an axis. It is made when the first method needs it.
struct severity {
    const struct stress_axis *axis;
    int level;
    const char *id; // in names of rows
    struct stress_case changed;
    bool made, impossible;
};

static char *work_path(const struct job *job, const char *name)
{
    return orl_format(job->log, "%s/%s/%s", job->params->out, job->work_folder, name);
}

// --- one severity ---

static enum orl_result make_severity(struct job *job, struct severity *s)
{
    char *dir = work_path(job, "changed");
    enum orl_result result =
        dir ? orl_stress_perturb(&job->base, job->params, s->axis, s->axis->levels[s->level], dir,
                                 &s->changed)
            : ORL_ERR_MEMORY;
    free(dir);
    s->made = true;
    s->impossible = result == ORL_ERR_NOT_FOUND;
    if (result == ORL_OK)
        result = orl_stress_open(&s->changed);
    return s->impossible ? ORL_OK : result;
}

static void finish_severity(struct severity *s)
{
    if (s->made)
        orl_stress_case_finish(&s->changed);
}

// --- one row ---

static enum orl_result write_picture(const struct job *job, const char *id, const char *what,
                                     const struct orl_image *picture, const char *key, json_t *row)
{
    char *name = orl_format(job->log, "pictures/%s/%s.%s.jpg", job->store.group, id, what);
    char *dir = orl_format(job->log, "%s/pictures/%s", job->params->out, job->store.group);
    char *path = name ? orl_path_join(job->log, job->params->out, name) : NULL;
    enum orl_result result = path && dir ? orl_dir_make(job->log, dir) : ORL_ERR_MEMORY;
    if (result == ORL_OK)
        result = orl_jpeg_write(job->log, path, picture, JPEG_QUALITY, NULL);
    if (result == ORL_OK)
        json_object_set_new(row, key, orl_json_string(name));
    free(path);
    free(dir);
    free(name);
    return result;
}

static json_t *invariants_json(const struct stress_invariants *i)
{
    return json_pack("{s:b, s:I, s:o, s:f, s:f, s:f}", "hold", orl_stress_invariants_hold(i),
                     "not_finite", (json_int_t)i->not_finite, "brightness",
                     orl_number_json(i->brightness), "overshoot", i->overshoot, "moved_mean",
                     i->moved_mean, "moved_share", i->moved_share);
}

static enum orl_result measure(struct job *job, struct severity *s,
                               const struct orl_choice *choice, json_t **out)
{
    struct stress_result result_of = {0};
    struct orl_render_params render = choice->params;
    char method[ORL_CHOICE_LABEL_MAX];
    orl_choice_label(choice, method);
    // The figure has silhouettes, so a method may stand on another proxy than before the monument.
    if (job->base.synth && s->axis->flags & STRESS_NEEDS_MASKS)
        orl_render_params_tuned(job->log, choice->method, &s->changed.scene, &render);
    orl_stress_axis_options(s->axis, &render);
    enum orl_result result = orl_stress_measure(&s->changed, &render, &result_of);
    json_t *mean = json_object();
    for (int k = 0; k < STRESS_FIGURES; k++)
        json_object_set_new(mean, orl_stress_figures[k], orl_number_json(result_of.figures[k]));
    *out = json_pack("{s:s, s:i, s:f, s:s, s:o, s:f, s:o, s:O}", "axis", s->axis->name, "severity",
                     s->level, "level", s->axis->levels[s->level], "method", method, "mean", mean,
                     "flicker", result_of.flicker, "invariants",
                     invariants_json(&result_of.invariants), "provenance", job->provenance);
    if (result == ORL_OK)
        result = *out ? write_picture(job, s->id, method, &result_of.picture, "picture", *out)
                      : ORL_ERR_MEMORY;
    if (result == ORL_OK)
        result = write_picture(job, s->id, "truth", &s->changed.views[0].picture, "truth", *out);
    orl_image_finish(&result_of.picture);
    if (result != ORL_OK) {
        json_decref(*out);
        *out = NULL;
    }
    return result;
}

static json_t *load_row(const struct job *job, const char *id)
{
    json_t *row = orl_row_load(&job->store, id, job->provenance);
    static const char *const keys[] = {"picture", "truth"};
    for (size_t k = 0; row && k < ORL_COUNT(keys); k++) {
        char *path = orl_path_join(job->log, job->params->out, orl_row_text(row, keys[k]));
        if (!path || !orl_path_is_file(path)) {
            json_decref(row);
            row = NULL;
        }
        free(path);
    }
    return row;
}

// A row that cannot be measured is left out, and the others are still measured.
static enum orl_result leave_out(struct job *job, const struct severity *s, const char *method,
                                 enum orl_result result)
{
    if (result == ORL_ERR_CANCELLED || result == ORL_ERR_MEMORY || result == ORL_ERR_IO)
        return result;
    orl_logf(job->log, ORL_LOG_WARNING, "%s %g: %s is left out", s->axis->name,
             s->axis->levels[s->level], method);
    job->stress->left_out++;
    return ORL_OK;
}

// Adds the row of a method; the row keeps the names of this axis even where severities are shared.
static enum orl_result add_row(struct job *job, struct severity *s,
                               const struct orl_choice *choice)
{
    char id[ORL_ROW_ID_MAX];
    enum orl_result result = ORL_OK;
    char method[ORL_CHOICE_LABEL_MAX];
    orl_choice_label(choice, method);
    orl_row_id(s->id, method, id);
    orl_progress_report(job->params->progress, "stress", job->done++, job->total, id);
    json_t *row = load_row(job, id);
    if (row) {
        job->stress->reused++;
    } else if (orl_progress_cancelled(job->params->progress)) {
        return ORL_ERR_CANCELLED;
    } else {
        if (!s->made)
            result = make_severity(job, s);
        if (result == ORL_OK && s->impossible)
            return ORL_OK;
        if (result == ORL_OK)
            result = measure(job, s, choice, &row);
        if (result == ORL_OK && row)
            result = orl_row_keep(&job->store, id, &row);
        job->stress->measured += row != NULL;
    }
    if (!row)
        return leave_out(job, s, method, result);
    json_t *own = json_copy(row);
    json_decref(row);
    json_object_set_new(own, "axis", json_string(s->axis->name));
    json_object_set_new(own, "level", json_real(s->axis->levels[s->level]));
    if (!json_is_true(json_object_get(json_object_get(own, "invariants"), "hold")))
        job->stress->broken++;
    json_array_append_new(job->rows, own);
    return result;
}

// Axes of silhouettes ask methods on their hull.
static bool takes_part(const struct stress_axis *axis, const struct orl_choice *choice)
{
    return !choice->setting[0] || !(axis->flags & STRESS_NEEDS_MASKS);
}

static enum orl_result add_severity(struct job *job, const struct stress_axis *axis, int level)
{
    char id[64];
    bool unchanged = level == 0 && !(axis->flags & STRESS_OWN_START) && !axis->settings[0];
    // All axes that start from the unchanged scene share its rows.
    snprintf(id, sizeof id, "%s-%d", unchanged ? "start" : axis->name, level);
    struct severity s = {.axis = axis, .level = level, .id = id};
    enum orl_result result = ORL_OK;
    bool own = orl_row_part_has(&job->params->part, unchanged ? 0 : ++job->severities);
    for (size_t i = 0; own && result == ORL_OK && i < job->choices.count; i++)
        if (takes_part(axis, &job->choices.items[i]))
            result = add_row(job, &s, &job->choices.items[i]);
    finish_severity(&s);
    return result;
}

// --- all of them ---

static bool is_wanted(const struct orl_names *names, const char *name)
{
    return !names->count || orl_names_contain(names, "all") || orl_names_contain(names, name);
}

static bool is_level_wanted(const struct job *job, int level)
{
    return !job->params->quick || level == 0 || level == ORL_STRESS_LEVELS / 2 ||
           level == ORL_STRESS_LEVELS - 1;
}

static bool is_served(const struct job *job, const struct stress_axis *axis)
{
    bool masks = false; // the synthetic scene has a figure with silhouettes beside the monument
    for (size_t i = 0; i < job->base.scene.photo_count; i++)
        masks = masks || (job->base.masks[i].data && !job->base.scene.photos[i].test);
    return is_wanted(&job->params->axes, axis->name) &&
           (job->base.synth || !(axis->flags & STRESS_NEEDS_TRUTH)) &&
           (masks || job->base.synth || !(axis->flags & STRESS_NEEDS_MASKS));
}

static enum orl_result add_axes(struct job *job, json_t *axes)
{
    enum orl_result result = ORL_OK;
    for (const struct stress_axis *axis = orl_stress_axes; axis->name; axis++)
        for (int level = 0; level < ORL_STRESS_LEVELS; level++)
            for (size_t i = 0; i < job->choices.count; i++)
                job->total += is_served(job, axis) && is_level_wanted(job, level) &&
                              takes_part(axis, &job->choices.items[i]);
    for (const struct stress_axis *axis = orl_stress_axes; axis->name; axis++) {
        json_t *levels = json_array();
        for (int level = 0; result == ORL_OK && level < ORL_STRESS_LEVELS; level++) {
            if (!is_served(job, axis) || !is_level_wanted(job, level))
                continue;
            json_array_append_new(levels, json_real(axis->levels[level]));
            result = add_severity(job, axis, level);
        }
        if (json_array_size(levels))
            json_array_append_new(
                axes, json_pack("{s:s, s:s, s:s, s:O, s:b}", "name", axis->name, "title",
                                axis->title, "unit", axis->unit, "levels", levels, "own_truth",
                                (axis->flags & STRESS_OWN_TRUTH) != 0));
        json_decref(levels);
        if (result != ORL_OK)
            return result;
    }
    return json_array_size(axes) ? ORL_OK
                                 : orl_fail(job->log, ORL_ERR_ARGUMENT, "stress: none of these "
                                            "axes suits the scene");
}

static enum orl_result check_axes(const struct orl_log *log, const struct orl_names *names)
{
    for (size_t i = 0; i < names->count; i++) {
        bool found = strcmp(names->items[i], "all") == 0;
        char known[512] = "";
        for (const struct stress_axis *axis = orl_stress_axes; axis->name; axis++) {
            found = found || strcmp(names->items[i], axis->name) == 0;
            snprintf(known + strlen(known), sizeof known - strlen(known), "%s%s",
                     known[0] ? ", " : "", axis->name);
        }
        if (!found)
            return orl_fail(log, ORL_ERR_ARGUMENT, "there is no axis %s; there are: %s",
                            names->items[i], known);
    }
    return ORL_OK;
}

// --- the scene ---

static enum orl_result open_scene(struct job *job)
{
    const struct orl_names none = {0}, all = {1, 1, (char *[]){(char[]){"paired"}}};
    const struct orl_stress_params *params = job->params;
    const struct orl_names *methods = params->methods.count ? &params->methods : &all;
    struct orl_scene *scene = NULL;
    enum orl_result result = ORL_OK;
    if (strcmp(params->scene, synth_name) == 0) {
        const struct orl_synth_params generator = orl_stress_generator(params);
        snprintf(job->checksum, sizeof job->checksum, "%s", synth_name);
        job->store.group = synth_name;
        result = orl_stress_make_synth(job->gpu, params, &generator, &job->base);
    } else {
        result = orl_scene_open(job->log, params->scene, &scene);
        if (result == ORL_OK)
            result = orl_eval_check(job->log, scene);
        if (result == ORL_OK)
            result = orl_row_checksum(job->log, scene, job->checksum);
        if (result == ORL_OK)
            result = orl_stress_make_scene(job->gpu, params, scene, &job->base);
    }
    if (result == ORL_OK)
        result = orl_choices_make(job->log, scene ? scene : &job->base.scene, ORL_SAMPLE_SRGB,
                                  methods, &none, NULL, &job->choices);
    orl_scene_destroy(&scene);
    char *dir = result == ORL_OK ? work_path(job, "base") : NULL;
    if (result == ORL_OK)
        result = dir ? orl_stress_write_files(&job->base, dir, false) : ORL_ERR_MEMORY;
    free(dir);
    return result;
}

static json_t *make_root(const struct job *job)
{
    const struct orl_gpu_caps *caps = orl_gpu_caps(job->gpu);
    const struct stress_case *base = &job->base;
    const struct orl_camera *camera = &base->views[0].view.camera;
    size_t training = 0;
    json_t *methods = json_array();
    for (size_t i = 0; i < base->scene.photo_count; i++)
        training += !base->scene.photos[i].test;
    for (size_t i = 0; i < job->choices.count; i++) {
        char label[ORL_CHOICE_LABEL_MAX];
        orl_choice_label(&job->choices.items[i], label);
        json_array_append_new(methods, json_string(label));
    }
    return json_pack("{s:i, s:s, s:s, s:s, s:b, s:b, s:{s:s, s:s, s:b, s:I, s:I, s:I, s:[ii], s:I}, "
                     "s:o, s:[], s:[]}",
                     "version", 1, "commit", orl_commit(), "device", caps->renderer, "driver",
                     caps->version, "software", caps->software, "quick", job->params->quick,
                     "scene", "name", job->store.group, "checksum", job->checksum, "truth",
                     base->synth != NULL, "photographs", (json_int_t)training, "held_out",
                     (json_int_t)base->view_count, "points", (json_int_t)base->scene.points.count,
                     "size", camera->width, camera->height, "seed",
                     (json_int_t)job->params->seed, "methods", methods, "axes", "rows");
}

static enum orl_result run(struct job *job)
{
    const struct orl_stress_params *params = job->params;
    enum orl_result result = open_scene(job);
    if (result != ORL_OK)
        return result;
    job->provenance = orl_row_provenance(job->gpu, job->checksum);
    json_object_set_new(job->provenance, "side", json_integer(params->side));
    json_object_set_new(job->provenance, "photographs", json_integer(params->photographs));
    json_object_set_new(job->provenance, "views", json_integer((json_int_t)job->base.view_count));
    json_object_set_new(job->provenance, "seed", json_integer((json_int_t)params->seed));
    json_t *root = make_root(job);
    if (!root)
        return orl_fail(job->log, ORL_ERR_MEMORY, "no memory for the report");
    job->stress->json = root;
    job->rows = json_object_get(root, "rows");
    result = add_axes(job, json_object_get(root, "axes"));
    if (result == ORL_OK && !params->part.count)
        result = orl_stress_analyse(job->log, root);
    if (result == ORL_OK && !params->part.count)
        result = orl_stress_write(job->log, params->out, root);
    return result;
}

static enum orl_result list_losses(const struct orl_log *log, struct orl_stress *stress)
{
    const json_t *list = json_object_get(stress->json, "losses"), *loss;
    size_t i;
    stress->losses = orl_array(log, json_array_size(list), sizeof *stress->losses);
    if (!stress->losses)
        return ORL_ERR_MEMORY;
    json_array_foreach((json_t *)(uintptr_t)list, i, loss) {
        struct orl_stress_loss *to = &stress->losses[stress->loss_count++];
        *to = (struct orl_stress_loss){
            .axis = orl_row_text(loss, "axis"), .unit = orl_row_text(loss, "unit"),
            .method = orl_row_text(loss, "method"), .start_db = orl_row_number(loss, "start_db"),
            .worst_db = orl_row_number(loss, "worst_db")};
        const json_t *at = json_object_get(loss, "at");
        for (size_t k = 0; k < ORL_STRESS_LOSSES; k++) {
            const json_t *value = json_array_get(at, k);
            to->at[k] = json_is_number(value) ? json_number_value(value) : (double)NAN;
        }
    }
    return ORL_OK;
}

enum orl_result orl_stress_run(struct orl_gpu *gpu, const struct orl_stress_params *params,
                               struct orl_stress *stress)
{
    struct job job = {.log = orl_gpu_log(gpu), .gpu = gpu, .params = params, .stress = stress};
    char *whole = realpath(params->scene, NULL); // "." and "scene/" do not end in the name
    memset(stress, 0, sizeof *stress);
    job.store = (struct orl_row_store){job.log, params->out,
                                       orl_path_name(whole ? whole : params->scene)};
    snprintf(job.work_folder, sizeof job.work_folder, ".work-%d", params->part.index);
    enum orl_result result = check_axes(job.log, &params->axes);
    if (result == ORL_OK)
        result = orl_dir_make(job.log, params->out);
    if (result == ORL_OK)
        result = run(&job);
    if (result == ORL_OK && !params->part.count)
        result = list_losses(job.log, stress);
    char *work = orl_path_join(job.log, params->out, job.work_folder);
    if (work && orl_dir_remove(NULL, work) != ORL_OK && result == ORL_OK)
        result = orl_fail(job.log, ORL_ERR_IO, "%s: cannot be removed", work);
    free(work);
    json_decref(job.provenance);
    orl_choices_finish(&job.choices);
    orl_stress_case_finish(&job.base);
    free(whole);
    if (result == ORL_OK)
        orl_progress_report(params->progress, "stress", 1, 1, NULL);
    else
        orl_stress_finish(stress);
    return result;
}

void orl_stress_finish(struct orl_stress *stress)
{
    json_decref(stress->json);
    free(stress->losses);
    memset(stress, 0, sizeof *stress);
}
