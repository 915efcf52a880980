// Expose: the exposure of each photograph and its series, the response of its camera, and the gains
// and vignetting that bring photographs to one exposure and white balance.
#include "preprocess/expose/expose.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/json.h"
#include "core/memory.h"
#include "core/order.h"
#include "preprocess/expose/align.h"
#include "preprocess/expose/gain_guess.h"
#include "preprocess/expose/metered.h"
#include "preprocess/expose/response.h"
#include "preprocess/job/job.h"
#include "oriel/scene.h"
#include "scene/point_lod.h"

// The series of the nearest known exposure. `sorted` ascends.
static int nearest_series(const double *sorted, size_t count, double step_ev, double ev)
{
    int series = 0, best = 0;
    double distance = INFINITY;
    for (size_t i = 0; i < count; i++) {
        if (i && sorted[i] - sorted[i - 1] >= step_ev)
            series++;
        if (fabs(sorted[i] - ev) < distance) {
            distance = fabs(sorted[i] - ev);
            best = series;
        }
    }
    return best;
}

enum orl_result orl_exposures_group(const struct orl_log *log, struct orl_exposed *photos,
                                    size_t count, double step_ev, bool stays, int *series_count)
{
    size_t known = 0;
    double *sorted = orl_array(log, count, sizeof *sorted);
    ORL_TRY_MEMORY(sorted);
    for (size_t i = 0; i < count; i++)
        if (photos[i].known && !photos[i].test)
            sorted[known++] = photos[i].ev;
    qsort(sorted, known, sizeof *sorted, orl_order_doubles);
    double median = known ? sorted[(known - 1) / 2] : 0; // the lower one: a photograph has it
    const double most = stays ? INFINITY : ORL_EXPOSURE_FAR_EV;
    size_t first = 0;
    while (first < known && median - sorted[first] > most)
        first++;
    while (known > first && sorted[known - 1] - median > most)
        known--;
    *series_count = 1;
    for (size_t i = first + 1; i < known; i++)
        *series_count += sorted[i] - sorted[i - 1] >= step_ev;
    for (size_t i = 0; i < count; i++) {
        struct orl_exposed *e = &photos[i];
        // Without a median, no exposure can be relative to it, so all count as unknown.
        e->known = e->known && known;
        if (e->known && fabs(e->ev - median) > most) {
            orl_logf(log, ORL_LOG_WARNING, "%s: its exposure is %.0f stops from the others': taken as unknown",
                     e->name, fabs(e->ev - median));
            e->known = false;
            e->from = ORL_EXPOSURE_UNKNOWN;
        }
        e->series = nearest_series(sorted + first, known - first, step_ev, e->known ? e->ev : median);
        if (!stays)
            e->ev = e->known ? e->ev - median : 0;
    }
    free(sorted);
    return ORL_OK;
}

// --- the state of the stage ---

struct photo {
    const struct orl_source *source;
    const struct orl_colmap_image *image;
    int response; // index into the responses, -1: sRGB
    double metering[2]; // orl_photo.metering and metered_ev
};

// Training photographs come first; each part is sorted by name.
struct exposing {
    struct orl_job *job;
    json_t *record;
    const struct orl_colmap_model *model; // the job's
    struct photo *photos;
    struct orl_exposed *exposed; // of each
    size_t count, train;
    int camera_count; // of those that photographs may share a response of
    struct orl_samples samples; // of training photographs
    struct orl_response *responses;
    size_t response_count;
    json_t *response_list;
    int series_count;
    bool last; // the last fit
    bool contradicted; // exposures that are known, by the pictures
};

static bool same_camera(const struct orl_source *a, const struct orl_source *b)
{
    return strcmp(a->exif.make, b->exif.make) == 0 && strcmp(a->exif.model, b->exif.model) == 0;
}

// The response of photographs with more than 8 bits is known: their 8-bit copies are sRGB.
static void set_cameras(struct exposing *e)
{
    for (size_t i = 0; i < e->count; i++) {
        const struct orl_source *source = e->photos[i].source;
        int *camera = &e->exposed[i].camera;
        *camera = -1;
        if (source->deep)
            continue;
        for (size_t k = 0; k < i && *camera < 0; k++)
            if (e->exposed[k].camera >= 0 && same_camera(source, e->photos[k].source))
                *camera = e->exposed[k].camera;
        if (*camera < 0)
            *camera = e->camera_count++;
    }
}

static enum orl_result find_photos(struct exposing *e)
{
    struct orl_job *job = e->job;
    ORL_TRY(orl_job_sparse(job, &e->model));
    e->photos = orl_array(job->log, e->model->image_count, sizeof *e->photos);
    e->exposed = orl_array(job->log, e->model->image_count, sizeof *e->exposed);
    ORL_TRY_MEMORY(e->photos && e->exposed);
    for (int test = 0; test < 2; test++) {
        for (size_t i = 0; i < e->model->image_count; i++) {
            const struct orl_colmap_image *image = &e->model->images[i];
            const struct orl_source *source = orl_job_find(job, image->name);
            if (source->test != (test == 1))
                continue;
            // Photographs of one camera of the model share their lens.
            const struct orl_colmap_camera *lens = orl_colmap_camera_by_id(e->model, image->camera_id);
            e->exposed[e->count] = (struct orl_exposed){
                .name = source->name, .view = orl_colmap_image_view(e->model, image), .test = source->test,
                .lens = (int)(lens - e->model->cameras), .gain = {1, 1, 1}};
            e->photos[e->count++] = (struct photo){.source = source, .image = image};
            e->train += test == 0;
        }
    }
    set_cameras(e);
    return ORL_OK;
}

// --- exposures ---

static enum orl_result set_exposures(struct exposing *e)
{
    for (size_t i = 0; i < e->count; i++) {
        struct orl_exposed *photo = &e->exposed[i];
        photo->from = orl_source_exposure(e->job, e->photos[i].source, &photo->ev);
        photo->known = photo->from != ORL_EXPOSURE_UNKNOWN;
    }
    return orl_exposures_group(e->job->log, e->exposed, e->count, ORL_EXPOSURE_STEP_EV, false,
                               &e->series_count);
}

// Without EXIF or a list, exposures come from the gains. They are relative and as accurate as the
// samples. Where all exposures are unknown, the estimated ones form series of their own.
static enum orl_result estimate_exposures(struct exposing *e)
{
    size_t known = 0, estimated = 0;
    for (size_t i = 0; i < e->count; i++)
        known += e->exposed[i].known;
    for (size_t i = 0; i < e->train; i++) {
        struct orl_exposed *exposure = &e->exposed[i];
        const float *gain = exposure->gain;
        if (exposure->known)
            continue;
        exposure->known = true;
        exposure->ev = -log2((double)gain[0] * (double)gain[1] * (double)gain[2]) / 3;
        exposure->from = ORL_EXPOSURE_SCENE;
        estimated++;
    }
    if (!estimated)
        return ORL_OK;
    orl_logf(e->job->log, ORL_LOG_INFO,
             "expose: exposures of %zu photographs are not told; estimated from the scene, "
             "relative to each other", estimated);
    // The estimated exposures keep the scale of the gains.
    return orl_exposures_group(e->job->log, e->exposed, e->count,
                               known ? ORL_EXPOSURE_STEP_EV : ORL_ESTIMATED_STEP_EV, true,
                               &e->series_count);
}

// --- samples, responses, gains ---

static enum orl_result take_samples(struct exposing *e)
{
    struct orl_job *job = e->job;
    struct orl_points points = {0};
    enum orl_result result = orl_lod_read_cloud(job->log, job->dir, ORL_LOD_SAMPLE, &points);
    ORL_THEN(result, orl_samples_take(job->log, job->progress, ORL_PATH(job->dir, "images"), e->exposed, e->train,
                                      &points, &e->samples));
    orl_points_finish(&points);
    return result;
}

static json_t *curves_record(const struct orl_response *response)
{
    json_t *curves = json_array();
    for (int c = 0; c < 3; c++) {
        json_t *curve = json_array();
        for (int v = 0; v < 256; v++)
            json_array_append_new(curve, json_real((double)response->linear[c][v]));
        json_array_append_new(curves, curve);
    }
    return curves;
}

static const char *camera_name(const struct orl_source *source)
{
    return source->exif.model[0] ? source->exif.model : "camera";
}

static void say_response(const struct exposing *e, const struct orl_source *source,
                         const struct orl_response_fit *fit)
{
    static const char *const why[] = {
        [ORL_RESPONSE_FOUND] = "", [ORL_RESPONSE_ONE_EXPOSURE] = "no two known exposures differ",
        [ORL_RESPONSE_FEW_SAMPLES] = "too few points seen at several exposures",
        [ORL_RESPONSE_SRGB] = "it fits"};
    const struct orl_log *log = e->job->log;
    if (fit->outcome == ORL_RESPONSE_FOUND)
        orl_logf(log, ORL_LOG_INFO,
                 "expose: response curve of %s from %zu points (radiance agrees within %.2f EV, "
                 "as sRGB within %.2f)", camera_name(source), fit->points, fit->spread_ev,
                 fit->spread_srgb_ev);
    else
        orl_logf(log, ORL_LOG_INFO, "expose: sRGB is taken for the response of %s: %s",
                 camera_name(source), why[fit->outcome]);
}

static enum orl_result fit_camera(struct exposing *e, int camera)
{
    size_t first = 0;
    struct orl_response_fit fit;
    struct orl_response *response = &e->responses[e->response_count];
    while (first < e->train && e->exposed[first].camera != camera)
        first++;
    if (first == e->train)
        return ORL_OK; // all photographs of this camera are held out
    const struct orl_source *source = e->photos[first].source;
    ORL_TRY(orl_response_fit(e->job->log, e->job->params->response, &e->samples, e->exposed, e->train, camera,
                             response, &fit));
    if (e->last)
        say_response(e, source, &fit);
    if (fit.outcome != ORL_RESPONSE_FOUND)
        return ORL_OK;
    for (size_t i = 0; i < e->count; i++)
        if (e->exposed[i].camera == camera) {
            e->photos[i].response = (int)e->response_count;
            e->exposed[i].linear = (const float (*)[256])response->linear;
        }
    e->response_count++;
    json_array_append_new(e->response_list,
                          json_pack("{s:o, s:i, s:f, s:f, s:o}", "camera",
                                    orl_json_string(camera_name(source)), "points",
                                    (int)fit.points, "spread_ev", fit.spread_ev, "spread_srgb_ev",
                                    fit.spread_srgb_ev, "linear", curves_record(response)));
    return ORL_OK;
}

static enum orl_result fit_responses(struct exposing *e)
{
    e->response_count = 0;
    json_array_clear(e->response_list);
    if (!e->responses)
        e->responses = orl_array(e->job->log, (size_t)e->camera_count, sizeof *e->responses);
    ORL_TRY_MEMORY(e->responses);
    for (int camera = 0; camera < e->camera_count; camera++)
        ORL_TRY(fit_camera(e, camera));
    return ORL_OK;
}

static void say_alignment(const struct exposing *e, const struct orl_alignment *alignment)
{
    const struct orl_log *log = e->job->log;
    orl_logf(log, ORL_LOG_INFO,
             "expose: %zu points seen by several photographs; their colours agreed within "
             "%.2f EV, and do within %.2f", e->samples.point_count, alignment->spread_before_ev,
             alignment->spread_after_ev);
    for (size_t i = 0; i < e->train; i++)
        if (e->exposed[i].refused)
            orl_logf(log, ORL_LOG_WARNING,
                     "%s: too unlike the others to be aligned; its exposure is taken as it is",
                     e->exposed[i].name);
}

static enum orl_result align(struct exposing *e)
{
    struct orl_alignment alignment;
    ORL_TRY(orl_align(e->job->log, &e->samples, e->exposed, e->train, e->count, &alignment));
    e->contradicted = orl_align_contradicts(e->exposed, e->train);
    if (e->last) {
        say_alignment(e, &alignment);
        json_object_set_new(e->record, "co_visible_points",
                            json_integer((json_int_t)e->samples.point_count));
        json_object_set_new(e->record, "spread_before_ev",
                            json_real(alignment.spread_before_ev));
        json_object_set_new(e->record, "spread_after_ev", json_real(alignment.spread_after_ev));
    }
    return ORL_OK;
}

// EXIF of copies and of edited photographs may be anything, the same time everywhere for example.
// A list that the user wrote is kept.
static enum orl_result heed_pictures(struct exposing *e, bool *again)
{
    size_t told = 0, listed = 0;
    for (size_t i = 0; i < e->count; i++) {
        told += e->exposed[i].from == ORL_EXPOSURE_EXIF;
        listed += e->exposed[i].from == ORL_EXPOSURE_LIST;
    }
    *again = told > listed;
    orl_logf(e->job->log, ORL_LOG_WARNING, "expose: the exposures that %s do not fit the pictures, "
             "which differ from them by more than a stop%s",
             *again ? "EXIF tells" : "the list of --exposures tells",
             *again ? "; they are estimated from the pictures. --exposures FILE takes a list" : "");
    for (size_t i = 0; *again && i < e->count; i++) {
        if (e->exposed[i].from != ORL_EXPOSURE_EXIF)
            continue;
        e->exposed[i].known = false;
        e->exposed[i].from = ORL_EXPOSURE_UNKNOWN;
    }
    return orl_exposures_group(e->job->log, e->exposed, e->count, ORL_EXPOSURE_STEP_EV, false,
                               &e->series_count);
}

// Responses and vignetting depend on each other. Two rounds are enough, as vignetting is slight.
static enum orl_result fit_all(struct exposing *e)
{
    for (int round = 0; round < 2; round++) {
        e->last = round == 1;
        for (size_t i = 0; i < e->count; i++) {
            e->photos[i].response = -1;
            e->exposed[i].linear = NULL;
        }
        ORL_TRY(fit_responses(e));
        ORL_TRY(align(e));
        bool again = false;
        if (round == 0 && e->contradicted)
            ORL_TRY(heed_pictures(e, &again));
        round -= again;
    }
    return ORL_OK;
}

// --- held-out photographs ---

// Counts sparse points in common. Held-out photographs have them because they were calibrated too.
static enum orl_result count_shared(const struct exposing *e, uint32_t *shared, uint32_t *own)
{
    const struct orl_colmap_model *model = e->model;
    size_t *counts = orl_array(e->job->log, model->image_count, sizeof *counts);
    enum orl_result result = counts ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < e->count; i++) {
        result = orl_colmap_count_shared(e->job->log, model, e->photos[i].image, counts);
        own[i] = (uint32_t)e->photos[i].image->point_count;
        for (size_t k = 0; k < e->train; k++)
            shared[i * e->train + k] = (uint32_t)counts[e->photos[k].image - model->images];
    }
    free(counts);
    return result;
}

// Photographs whose exposures the camera chose by itself are one series. Merged as a bracket is, they give no
// wider range of light, and a worse picture.
static enum orl_result join_metered(struct exposing *e)
{
    static const float as_it_is[3] = {1, 1, 1};
    const struct orl_log *log = e->job->log;
    if (e->series_count < 2)
        return ORL_OK;
    for (size_t i = 0; i < e->train; i++)
        ORL_TRY(orl_photo_metered(log, ORL_PATH(e->job->dir, "images"), &e->exposed[i], as_it_is));
    if (!orl_exposures_are_metered(e->exposed, e->train))
        return ORL_OK;
    orl_logf(log, ORL_LOG_INFO, "expose: the camera chose the exposures by itself: they are no bracket");
    e->series_count = 1;
    for (size_t i = 0; i < e->count; i++)
        e->exposed[i].series = 0;
    return ORL_OK;
}

static enum orl_result guess_held_out(struct exposing *e)
{
    static const char *const guesses[] = {ORL_GAIN_GUESSES(ORL_ENUM_NAME)};
    const struct orl_log *log = e->job->log;
    double metering[2];
    if (e->count == e->train)
        return ORL_OK;
    uint32_t *shared = orl_array(log, e->count, e->train * sizeof *shared);
    uint32_t *own = orl_array(log, e->count, sizeof *own);
    enum orl_result result = shared && own ? count_shared(e, shared, own) : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < e->train; i++)
        result = orl_photo_metered(log, ORL_PATH(e->job->dir, "images"), &e->exposed[i], e->exposed[i].gain);
    if (result == ORL_OK) {
        enum orl_gain_guess guess = orl_gains_guess(e->exposed, e->train, e->count, shared, own, metering);
        for (size_t i = e->train; i < e->count; i++)
            memcpy(e->photos[i].metering, metering, sizeof metering);
        json_object_set_new(e->record, "held_out_gain", json_string(guesses[guess]));
    }
    free(shared);
    free(own);
    return result;
}

// --- the record ---

static json_t *photo_record(const struct photo *p, const struct orl_exposed *e)
{
    static const char *const from[] = {[ORL_EXPOSURE_EXIF] = "exif", [ORL_EXPOSURE_LIST] = "list",
                                       [ORL_EXPOSURE_SCENE] = "scene"};
    json_t *entry = json_pack(
        "{s:s, s:s, s:o, s:i, s:[f,f,f]}", "name", e->name, "split",
        e->test ? "test" : "train", "exposure_ev", e->known ? json_real(e->ev) : json_null(),
        "series", e->series, "gain", (double)e->gain[0], (double)e->gain[1], (double)e->gain[2]);
    if (e->known && from[e->from])
        json_object_set_new(entry, "exposure_from", json_string(from[e->from]));
    if (e->vignette[0] != 0 || e->vignette[1] != 0 || e->vignette[2] != 0)
        json_object_set_new(entry, "vignette",
                            json_pack("[f,f,f]", (double)e->vignette[0], (double)e->vignette[1],
                                      (double)e->vignette[2]));
    if (p->metering[0] > 0)
        json_object_set_new(entry, "metering",
                            json_pack("[f,f]", p->metering[0], p->metering[1]));
    if (p->response >= 0)
        json_object_set_new(entry, "response", json_integer(p->response));
    return entry;
}

static void write_record(const struct exposing *e)
{
    json_t *photos = json_array();
    size_t told = 0;
    for (size_t i = 0; i < e->count; i++) {
        json_array_append_new(photos, photo_record(&e->photos[i], &e->exposed[i]));
        told += e->exposed[i].from == ORL_EXPOSURE_EXIF || e->exposed[i].from == ORL_EXPOSURE_LIST;
    }
    json_object_set_new(e->record, "photographs", photos);
    json_object_set(e->record, "responses", e->response_list);
    json_object_set_new(e->record, "tool", json_string("libexif, co-visible points"));
    json_object_set_new(e->record, "series", json_integer(e->series_count));
    json_object_set_new(e->record, "with_exposure", json_integer((json_int_t)told));
}

enum orl_result orl_stage_expose(struct orl_job *job, json_t *record)
{
    struct exposing e = {.job = job, .record = record, .response_list = json_array()};
    enum orl_result result = e.response_list ? find_photos(&e) : ORL_ERR_MEMORY;
    ORL_THEN(result, set_exposures(&e));
    ORL_THEN(result, take_samples(&e));
    ORL_THEN(result, fit_all(&e));
    ORL_THEN(result, estimate_exposures(&e));
    ORL_THEN(result, join_metered(&e));
    ORL_THEN(result, guess_held_out(&e));
    if (result == ORL_OK) {
        write_record(&e);
        orl_progress_report(job->progress, "expose", 1, 1, NULL);
    }
    orl_samples_finish(&e.samples);
    json_decref(e.response_list);
    free(e.responses);
    free(e.exposed);
    free(e.photos);
    return result;
}
