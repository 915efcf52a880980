#include "eval/validation.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"

// Photographs are from the same place when they are less than this apart.
static const double same_distance = 0.01, same_angle = 0.05;

// True when there are held-out photographs, and the stage `expose` gave them the scene's reference
// exposure because no other guess was better.
static bool exposure_is_unknown(const struct orl_scene *scene)
{
    bool held = false, guessed = false;
    for (size_t i = 0; i < scene->photo_count; i++) {
        const struct orl_photo *p = &scene->photos[i];
        held = held || p->test;
        for (int c = 0; c < 3; c++)
            guessed = guessed || (p->test && p->gain[c] != 1);
        guessed = guessed || (p->test && p->metering != 0);
    }
    return held && !guessed;
}

static enum orl_result copy_photos(const struct orl_log *log, const struct orl_scene *scene,
                                   struct orl_validation *validation)
{
    bool unknown = exposure_is_unknown(scene);
    struct orl_photo *photos = orl_array(log, scene->photo_count, sizeof *photos);
    ORL_TRY_MEMORY(photos);
    memcpy(photos, scene->photos, scene->photo_count * sizeof *photos);
    for (size_t i = 0; unknown && i < scene->photo_count; i++)
        for (int c = 0; c < 3; c++)
            photos[i].gain[c] = 1;
    validation->scene = *scene;
    validation->scene.photos = photos;
    return ORL_OK;
}

enum orl_result orl_validation_check(const struct orl_log *log, const struct orl_scene *scene,
                                     size_t *train)
{
    *train = scene->photo_count - orl_heldout_count(scene);
    return *train >= ORL_VALIDATION_TRAIN_MIN
               ? ORL_OK
               : orl_fail(log, ORL_ERR_DATA, "%s: %zu photographs that are not held out; three are "
                          "needed, to render one from two others", scene->dir, *train);
}

enum orl_result orl_validation_load(const struct orl_log *log, const struct orl_scene *scene,
                                    size_t most, int divide, struct orl_validation *validation)
{
    size_t train;
    memset(validation, 0, sizeof *validation);
    ORL_TRY(orl_validation_check(log, scene, &train));
    validation->views = orl_array(log, most && most < train ? most : train, sizeof *validation->views);
    validation->skip = orl_array(log, scene->photo_count, sizeof *validation->skip);
    enum orl_result result =
        validation->views && validation->skip ? copy_photos(log, scene, validation)
                                              : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < scene->photo_count; i++)
        if (orl_heldout_chosen(scene, false, most, i))
            result = orl_heldout_load(log, scene, i, divide,
                                      &validation->views[validation->count++]);
    if (result != ORL_OK)
        orl_validation_finish(validation);
    return result;
}

void orl_validation_finish(struct orl_validation *validation)
{
    for (size_t i = 0; i < validation->count; i++)
        orl_heldout_finish(&validation->views[i]);
    free(validation->views);
    free(validation->skip);
    free(validation->scene.photos);
    memset(validation, 0, sizeof *validation);
}

// The distance of two photographs' centres as a share of the distance to what they see, and the angle
// between their directions.
static void measure_apart(const struct orl_scene *scene, size_t a, size_t b, double *distance,
                          double *angle)
{
    const struct orl_pose *pose[] = {&scene->photos[a].view.cam_from_world,
                                     &scene->photos[b].view.cam_from_world};
    double centre[2][3], d2 = 0, cosine = 0;
    for (int i = 0; i < 2; i++)
        orl_pose_centre(pose[i], centre[i]);
    for (int k = 0; k < 3; k++) {
        d2 += (centre[0][k] - centre[1][k]) * (centre[0][k] - centre[1][k]);
        cosine += pose[0]->r[2][k] * pose[1]->r[2][k];
    }
    *distance = sqrt(d2) / scene->photo_distance;
    *angle = acos(fmin(fmax(cosine, -1), 1));
}

double orl_validation_apart(const struct orl_scene *scene, size_t a, size_t b)
{
    double distance, angle;
    measure_apart(scene, a, b, &distance, &angle);
    return distance + angle;
}

size_t orl_validation_nearest(const struct orl_scene *scene, size_t photo, const bool *removed, bool is_removed,
                              size_t but)
{
    double least = INFINITY;
    size_t found = scene->photo_count;
    for (size_t i = 0; i < scene->photo_count; i++) {
        if (i == photo || i == but || scene->photos[i].test || (removed && removed[i]) != is_removed)
            continue;
        const double apart = orl_validation_apart(scene, photo, i);
        if (apart < least) {
            least = apart;
            found = i;
        }
    }
    return found;
}

bool orl_validation_same_place(const struct orl_scene *scene, size_t a, size_t b)
{
    double distance, angle;
    measure_apart(scene, a, b, &distance, &angle);
    return distance < same_distance && angle < same_angle;
}

void orl_validation_leave_out(const struct orl_scene *scene, size_t photo, const bool *removed,
                              bool *skip)
{
    size_t left = 0;
    for (size_t i = 0; i < scene->photo_count; i++) {
        skip[i] = (removed && removed[i]) || orl_validation_same_place(scene, i, photo);
        left += !skip[i] && !scene->photos[i].test;
    }
    for (size_t i = 0; left == 0 && i < scene->photo_count; i++)
        skip[i] = removed && removed[i];
    skip[photo] = true;
}

// --- scores ---

static void set_means(struct orl_score *score)
{
    double n = (double)score->count;
    score->psnr_db = score->ssim = 0;
    for (size_t i = 0; i < score->count; i++) {
        score->psnr_db += score->views[i][0] / n;
        score->ssim += score->views[i][1] / n;
    }
}

// PSNR and SSIM of one view. The other figures of struct orl_metrics take longer than a fast frame.
static enum orl_result measure(const struct orl_log *log, struct orl_renderer *renderer,
                               const struct orl_validation *v, const struct orl_heldout *view,
                               const struct orl_render_params *render, const bool *removed, double figures[2])
{
    struct orl_image picture;
    orl_validation_leave_out(&v->scene, view->photo, removed, v->skip);
    enum orl_result result = orl_heldout_draw(log, renderer, &v->scene, view, render, v->skip, &picture, NULL);
    if (result == ORL_OK) {
        figures[0] = orl_metrics_psnr_db(&picture, &view->picture);
        result = orl_metrics_ssim(log, &picture, &view->picture, &figures[1]);
    }
    orl_image_finish(&picture);
    return result;
}

enum orl_result orl_score_measure(const struct orl_log *log, struct orl_renderer *renderer,
                                  const struct orl_validation *v, size_t count,
                                  const struct orl_render_params *render, const bool *removed,
                                  const struct orl_progress *progress,
                                  struct orl_score *score)
{
    if (!score->views)
        score->views = orl_array(log, v->count, sizeof *score->views);
    enum orl_result result = score->views ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t i = score->count; result == ORL_OK && i < count; i++) {
        result = orl_progress_cancelled(progress)
                     ? ORL_ERR_CANCELLED
                     : measure(log, renderer, v, &v->views[i], render, removed, score->views[i]);
        score->count = i + 1;
    }
    set_means(score);
    if (result != ORL_OK)
        orl_score_finish(score);
    return result;
}

void orl_score_finish(struct orl_score *score)
{
    free(score->views);
    memset(score, 0, sizeof *score);
}

static size_t common(const struct orl_score *a, const struct orl_score *b)
{
    return a->count < b->count ? a->count : b->count;
}

struct orl_score_loss orl_score_loss(const struct orl_score *before, const struct orl_score *now)
{
    const size_t n = common(before, now);
    struct orl_score_loss loss = {.worst_db = -INFINITY};
    for (size_t i = 0; i < n; i++) {
        const double lost_db = before->views[i][0] - now->views[i][0];
        loss.psnr_db += lost_db / (double)n;
        loss.ssim += (before->views[i][1] - now->views[i][1]) / (double)n;
        loss.worst_db = fmax(loss.worst_db, lost_db);
    }
    return loss;
}

// Both figures of a photograph as one, in dB.
static double decibels(const double view[2])
{
    static const double least = 1e-6; // 60 dB, for pictures that are the same
    return (view[0] - 10 * log10(fmax(1 - view[1], least))) / 2;
}

static double gain_of(const struct orl_score *now, const struct orl_score *before, size_t view)
{
    return decibels(now->views[view]) - decibels(before->views[view]);
}

bool orl_score_better(const struct orl_score *now, const struct orl_score *before,
                      double gain_db)
{
    const struct orl_score_loss loss = orl_score_loss(before, now);
    const size_t count = common(before, now);
    double n = (double)count, mean = 0, square = 0;
    if (loss.psnr_db > 0 || loss.ssim > 0)
        return false;
    for (size_t i = 0; i < count; i++)
        mean += gain_of(now, before, i) / n;
    for (size_t i = 0; i < count; i++)
        square += pow(gain_of(now, before, i) - mean, 2) / n;
    double error = n > 1 ? sqrt(square / (n - 1)) : 0;
    return mean >= gain_db && mean > error;
}
