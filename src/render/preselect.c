// Which photographs a frame may use at all, so that its cost does not grow with the scene.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "render/internal.h"

enum {
    ACROSS = 5,      // sample directions, each way
    DEPTHS = 3,
    PER_SAMPLE = 8,  // photographs that each sample point may name
};

struct candidate {
    size_t photo;
    double score; // over all sample points
    bool named;   // among the best of some sample point
};

// A point of the view's frustum, in the world.
static void sample_point(const struct orl_view *view, int index, double typical, double out[3])
{
    static const double depths[DEPTHS] = {0.4, 1, 4};
    const struct orl_camera *c = &view->camera;
    int x = index % ACROSS, y = index / ACROSS % ACROSS;
    double z = depths[index / (ACROSS * ACROSS)] * typical;
    orl_view_unproject(view, (x + 0.5) * c->width / ACROSS, (y + 0.5) * c->height / ACROSS, z, out);
}

// Inverse of the penalty of photo_choice.glsl; 0 where the photograph does not see the point.
static double score(const struct orl_photo *photo, const double eye[3], const double point[3])
{
    double q[3], centre[3], u[3], v[3];
    orl_pose_apply(&photo->view.cam_from_world, point, q);
    const struct orl_camera *c = &photo->view.camera;
    if (!(q[2] > 0))
        return 0;
    double x = c->fx * q[0] / q[2] + c->cx, y = c->fy * q[1] / q[2] + c->cy;
    if (!(x > 0 && y > 0 && x < c->width && y < c->height))
        return 0;
    orl_pose_centre(&photo->view.cam_from_world, centre);
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
    double coarser = sqrt(vv / uu) - 1;
    return 1 / (angle + 0.1 * (coarser > 0 ? coarser : 0) + 0.005);
}

// Marks the best PER_SAMPLE of one sample point.
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

static int by_photo(const void *a, const void *b)
{
    const struct candidate *x = a, *y = b;
    return (x->photo > y->photo) - (x->photo < y->photo);
}

enum orl_result orl_preselect(const struct orl_log *log, const struct photos *photos,
                              const struct orl_view *view, const bool *skip, size_t most,
                              size_t *chosen, size_t *count)
{
    const struct orl_scene *scene = photos->scene;
    struct candidate *candidates = orl_array(log, scene->photo_count, sizeof *candidates);
    double *scores = orl_array(log, scene->photo_count, sizeof *scores);
    enum orl_result result = candidates && scores ? ORL_OK : ORL_ERR_MEMORY;
    if (result != ORL_OK)
        goto end;
    size_t usable = 0;
    for (size_t i = 0; i < scene->photo_count; i++)
        if (photos->states[i].usable && !(skip && skip[i]))
            candidates[usable++] = (struct candidate){.photo = i};
    if (usable > most) {
        double eye[3], typical = scene->photo_distance > 0 ? scene->photo_distance : 1;
        orl_pose_centre(&view->cam_from_world, eye);
        for (int s = 0; s < ACROSS * ACROSS * DEPTHS; s++) {
            double point[3];
            sample_point(view, s, typical, point);
            for (size_t i = 0; i < usable; i++)
                scores[i] = score(&scene->photos[candidates[i].photo], eye, point);
            name_best(candidates, scores, usable);
        }
        qsort(candidates, usable, sizeof *candidates, better);
        usable = most;
        qsort(candidates, usable, sizeof *candidates, by_photo);
    }
    for (size_t i = 0; i < usable; i++)
        chosen[i] = candidates[i].photo;
    *count = usable;
end:
    free(candidates);
    free(scores);
    return result;
}
