#include "render/photos/photos.h"

#include <math.h>
#include <stdlib.h>

#include "core/memory.h"
#include "core/order.h"
#include "render/frame/frame.h"
#include "scene/depth_buffer.h"
#include "shared/constants.h"
#include "shared/penalty.h"

bool orl_frame_may_use(const struct frame *frame, size_t photo)
{
    return frame->photos->states[photo].usable && !(frame->skip && frame->skip[photo]);
}

static enum orl_result choose_all(struct frame *frame)
{
    frame->chosen_count = 0;
    for (size_t i = 0; i < frame->scene->photo_count; i++) {
        if (!orl_frame_may_use(frame, i))
            continue;
        frame->selected[frame->chosen_count][0] = 1;
        frame->chosen[frame->chosen_count++] = i;
    }
    return ORL_OK;
}

const struct orl_selection orl_select_all = {"all", choose_all};

// --- nearest: the photographs of least angle at the scene's centre (Orzan 2005, 4.3.2) ---

// Angle between the view and the photograph, seen from the centre, radians.
static double deviation(const struct frame *frame, size_t photo)
{
    double eye[3], other[3], uu = 0, vv = 0, uv = 0;
    orl_pose_centre(&frame->view->cam_from_world, eye);
    orl_pose_centre(&frame->scene->photos[photo].view.cam_from_world, other);
    for (int k = 0; k < 3; k++) {
        double centre = 0.5 * (frame->proxy->extent.low[k] + frame->proxy->extent.high[k]);
        double u = eye[k] - centre, v = other[k] - centre;
        uu += u * u;
        vv += v * v;
        uv += u * v;
    }
    double cosine = uv / sqrt(uu * vv);
    return cosine >= 1 ? 0 : cosine > -1 ? acos(cosine) : 3.141592653589793; // includes NaN
}

// Each photograph has weight 1 - p / p', where p' is the penalty of the first one left out, so that
// it has faded out when another replaces it. All have weight 1 if none is left out.
static enum orl_result choose_nearest(struct frame *frame)
{
    size_t count = 0, kept = (size_t)(frame->params->nearest + 0.5f);
    struct orl_ranked *all = orl_array(orl_gpu_log(frame->gpu), frame->scene->photo_count,
                                       sizeof *all);
    ORL_TRY_MEMORY(all);
    for (size_t i = 0; i < frame->scene->photo_count; i++)
        if (orl_frame_may_use(frame, i))
            all[count++] = (struct orl_ranked){deviation(frame, i), i};
    qsort(all, count, sizeof *all, orl_order_ranked);
    double threshold = count > kept ? all[kept].key : INFINITY;
    kept = count < kept ? count : kept;
    for (size_t i = 0; i < kept; i++)
        frame->chosen[i] = all[i].index;
    qsort(frame->chosen, kept, sizeof *frame->chosen, orl_order_sizes);
    for (size_t i = 0; i < kept; i++) {
        // As in oriel, a trace of weight lets photographs that tie with the first left out paint.
        double weight = threshold > 0 ? 1.00001 - deviation(frame, frame->chosen[i]) / threshold : 1;
        frame->selected[i][0] = (float)weight;
    }
    frame->chosen_count = kept;
    free(all);
    return ORL_OK;
}

const struct orl_selection orl_select_nearest = {"nearest", choose_nearest};

// --- preselect: the photographs that can paint the view best, so that its cost is bounded ---

enum {
    ACROSS = 5,      // sample directions along x and along y
    DEPTHS = 3,
    PER_SAMPLE = 8,  // photographs that each sample point marks
};

struct candidate {
    size_t photo;
    double score; // sum over all sample points
    bool named;   // is among the best for some sample point
};

// A sample point of the view's frustum, in the world. typical: a typical depth of the scene.
static void sample_point(const struct orl_view *view, int index, double typical, double out[3])
{
    static const double depths[DEPTHS] = {0.4, 1, 4};
    const struct orl_camera *c = &view->camera;
    int x = index % ACROSS, y = index / ACROSS % ACROSS;
    double z = depths[index / (ACROSS * ACROSS)] * typical;
    orl_view_unproject(view, (x + 0.5) * c->width / ACROSS, (y + 0.5) * c->height / ACROSS, z, out);
}

double orl_photo_penalty(const struct orl_view *photo, const double eye[3], double view_focal,
                         const double point[3])
{
    double pixel[2], depth, centre[3], u[3], v[3];
    if (!orl_view_shows(photo, point, pixel, &depth))
        return -1;
    orl_pose_centre(&photo->cam_from_world, centre);
    double uu = 0, vv = 0, uv = 0;
    for (int k = 0; k < 3; k++) {
        u[k] = eye[k] - point[k];
        v[k] = centre[k] - point[k];
        uu += u[k] * u[k];
        vv += v[k] * v[k];
        uv += u[k] * v[k];
    }
    double cosine = uv / sqrt(uu * vv);
    double angle = acos(cosine < -1 ? -1 : cosine > 1 ? 1 : cosine);
    return ORL_PENALTY(angle, sqrt(vv / uu) * (view_focal / photo->camera.fx) - 1);
}

// Adds the scores of one sample point and marks its best PER_SAMPLE photographs.
static void name_best(struct candidate *candidates, const double *scores, size_t count)
{
    double best[PER_SAMPLE] = {0};
    size_t index[PER_SAMPLE] = {0};
    for (size_t i = 0; i < count; i++) {
        double value = scores[i];
        size_t at = i;
        candidates[i].score += value;
        for (int k = 0; k < PER_SAMPLE; k++) {
            if (value > best[k]) {
                double b = best[k];
                size_t n = index[k];
                best[k] = value;
                index[k] = at;
                value = b;
                at = n;
            }
        }
    }
    for (int k = 0; k < PER_SAMPLE; k++)
        if (best[k] > 0)
            candidates[index[k]].named = true;
}

static int better(const void *a, const void *b)
{
    const struct candidate *x = a, *y = b;
    if (x->named != y->named)
        return x->named ? -1 : 1;
    if (x->score != y->score)
        return x->score > y->score ? -1 : 1;
    return (x->photo > y->photo) - (x->photo < y->photo);
}

// Sorts the candidates: first those that a sample point has marked, then by total score.
static void rank(const struct frame *frame, struct candidate *candidates, double *scores,
                 size_t count)
{
    const struct orl_scene *scene = frame->scene;
    double eye[3], typical = scene->photo_distance > 0 ? scene->photo_distance : 1;
    orl_pose_centre(&frame->view->cam_from_world, eye);
    for (int s = 0; s < ACROSS * ACROSS * DEPTHS; s++) {
        double point[3];
        sample_point(frame->view, s, typical, point);
        for (size_t i = 0; i < count; i++) {
            double penalty = orl_photo_penalty(&scene->photos[candidates[i].photo].view, eye,
                                               frame->view->camera.fx, point);
            scores[i] = penalty > 0 ? 1 / penalty : 0;
        }
        name_best(candidates, scores, count);
    }
    qsort(candidates, count, sizeof *candidates, better);
}

// At most as many as the device holds at once.
static enum orl_result choose_best(struct frame *frame)
{
    // The best photographs by angle may all be clipped; radiance needs every exposure.
    if (frame->radiance)
        return choose_all(frame);
    const struct orl_log *log = orl_gpu_log(frame->gpu);
    size_t photo_count = frame->scene->photo_count, usable = 0, most = (size_t)frame->photos->slot_count;
    most = most < ORL_PHOTOS_PER_FRAME ? most : ORL_PHOTOS_PER_FRAME;
    struct candidate *candidates = orl_array(log, photo_count, sizeof *candidates);
    double *scores = orl_array(log, photo_count, sizeof *scores);
    enum orl_result result = candidates && scores ? ORL_OK : ORL_ERR_MEMORY;
    if (result != ORL_OK)
        goto end;
    for (size_t i = 0; i < photo_count; i++)
        if (orl_frame_may_use(frame, i))
            candidates[usable++] = (struct candidate){.photo = i};
    if (usable > most) {
        rank(frame, candidates, scores, usable);
        usable = most;
    }
    for (size_t i = 0; i < usable; i++) {
        frame->chosen[i] = candidates[i].photo;
        frame->selected[i][0] = 1;
    }
    qsort(frame->chosen, usable, sizeof *frame->chosen, orl_order_sizes);
    frame->chosen_count = usable;
end:
    free(candidates);
    free(scores);
    return result;
}

const struct orl_selection orl_select_preselect = {"preselect", choose_best};
