// Chooses each photograph's sources and its range of depth.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "core/order.h"
#include "core/vec3.h"
#include "preprocess/densify/densify_internal.h"

enum {
    SHARED_MIN = 3, // fewer shared points may be chance matches
    OUTLIERS = 20,  // so many of the nearest points that the sources see may be wrong
};
static const double NEAR_SHARE = 0.6; // of the depth of the nearest points: where the range begins

enum orl_result orl_densify_photos_init(const struct orl_log *log,
                                        const struct orl_colmap_model *model,
                                        const struct orl_names *names,
                                        struct densify_photos *photos)
{
    *photos = (struct densify_photos){.model = model};
    photos->images = orl_array(log, model->image_count, sizeof *photos->images);
    photos->views = orl_array(log, model->image_count, sizeof *photos->views);
    ORL_TRY_MEMORY(photos->images && photos->views);
    for (size_t i = 0; i < model->image_count; i++) {
        const struct orl_colmap_image *image = &model->images[i];
        if (names && !orl_names_contain(names, image->name))
            continue;
        const struct orl_colmap_camera *camera = orl_colmap_camera_by_id(model, image->camera_id);
        if (camera->model > 1)
            orl_logf(log, ORL_LOG_WARNING, "%s: not undistorted (camera model %d); depth will be "
                     "off towards the corners", image->name, camera->model);
        photos->images[photos->count] = i;
        photos->views[photos->count++] =
            (struct orl_view){.camera = camera->pinhole, .cam_from_world = image->cam_from_world};
    }
    for (size_t k = 0; names && k < names->count; k++)
        if (!orl_colmap_image_by_name(model, names->items[k]))
            orl_logf(log, ORL_LOG_WARNING, "%s: not in the model; left out", names->items[k]);
    return photos->count ? ORL_OK
                         : orl_fail(log, ORL_ERR_DATA, "the sparse model has none of the photographs");
}

void orl_densify_photos_finish(struct densify_photos *photos)
{
    free(photos->images);
    free(photos->views);
    memset(photos, 0, sizeof *photos);
}

// --- points and the photographs that see them ---

struct point_views {
    size_t *first;   // owned; point_count + 1 offsets into photo
    uint32_t *photo; // owned
};

static enum orl_result point_views_init(const struct orl_log *log,
                                        const struct densify_photos *photos,
                                        struct point_views *views)
{
    const struct orl_colmap_model *model = photos->model;
    size_t total = 0;
    views->first = orl_array(log, model->point_count + 2, sizeof *views->first);
    ORL_TRY_MEMORY(views->first);
    for (size_t i = 0; i < photos->count; i++) {
        const struct orl_colmap_image *image = &model->images[photos->images[i]];
        for (size_t k = 0; k < image->point_count; k++)
            views->first[image->points[k] + 2]++;
        total += image->point_count;
    }
    views->photo = orl_array(log, total, sizeof *views->photo);
    ORL_TRY_MEMORY(views->photo);
    // Counting sort: after filling, first[p + 1] is where point p + 1 begins.
    for (size_t p = 2; p < model->point_count + 2; p++)
        views->first[p] += views->first[p - 1];
    for (size_t i = 0; i < photos->count; i++) {
        const struct orl_colmap_image *image = &model->images[photos->images[i]];
        for (size_t k = 0; k < image->point_count; k++)
            views->photo[views->first[image->points[k] + 1]++] = (uint32_t)i;
    }
    return ORL_OK;
}

// --- scores ---

static double smooth_step(double low, double high, double x)
{
    double t = fmin(fmax((x - low) / (high - low), 0.0), 1.0);
    return t * t * (3.0 - 2.0 * t);
}

// Depth is ill-conditioned below one degree; beyond 40 degrees patches look different.
static double angle_score(const double a[3], const double b[3], const double point[3])
{
    double to_a[3], to_b[3];
    for (int i = 0; i < 3; i++) {
        to_a[i] = a[i] - point[i];
        to_b[i] = b[i] - point[i];
    }
    double cosine = orl_dot3(to_a, to_b) / sqrt(fmax(orl_dot3(to_a, to_a) * orl_dot3(to_b, to_b), 1e-300));
    double degrees = acos(fmin(fmax(cosine, -1.0), 1.0)) * 57.29577951308232;
    return smooth_step(0.3, 4.0, degrees) * (1.0 - smooth_step(30.0, 65.0, degrees));
}

struct tally {
    double score, log_finer; // sums over shared points
    size_t shared;
};

// Range of inverse depth. Sparse points cluster on well textured surfaces, so the range extends
// well beyond them, mostly towards greater depth, where inverse depth changes little.
static void depth_range(double *depths, size_t count, struct densify_plan *plan)
{
    qsort(depths, count, sizeof *depths, orl_order_doubles);
    double near = depths[count / 100], far = depths[count - 1 - count / 100];
    plan->w_min = 1.0 / (50.0 * far);
    plan->w_max = 1.0 / (NEAR_SHARE * near);
    plan->w_typical = 0.5 * (plan->w_min + 1.0 / near);
}

static void choose_sources(const struct tally *tallies, size_t photo_count, int sources,
                           struct densify_plan *plan)
{
    while (plan->count < sources) {
        size_t best = photo_count;
        for (size_t j = 0; j < photo_count; j++) {
            bool taken = tallies[j].shared < SHARED_MIN || tallies[j].score <= 1e-3;
            for (int k = 0; k < plan->count && !taken; k++)
                taken = plan->sources[k].photo == j;
            if (!taken && (best == photo_count || tallies[j].score > tallies[best].score))
                best = j;
        }
        if (best == photo_count)
            break;
        double finer = tallies[best].log_finer / (double)tallies[best].shared;
        plan->sources[plan->count++] = (struct densify_source){
            .photo = best,
            .score = tallies[best].score,
            .finer = (int)fmin(fmax(floor(finer + 0.5), 0.0), 3.0),
        };
    }
    for (int k = 0; k < plan->count; k++)
        plan->sources[k].prior =
            fmax(sqrt(plan->sources[k].score / plan->sources[0].score), 0.3);
}

// Extends the range to what is nearer than nearly all of the photograph's sparse points, as a vehicle
// before a facade: few points are on it, and its sources have most of them. `depths` has room for the
// points of all sources.
static void widen_range(const struct densify_photos *photos, const struct orl_view *view,
                        double *depths, struct densify_plan *plan)
{
    const struct orl_colmap_model *model = photos->model;
    size_t count = 0;
    for (int k = 0; k < plan->count; k++) {
        const struct orl_colmap_image *source =
            &model->images[photos->images[plan->sources[k].photo]];
        for (size_t i = 0; i < source->point_count; i++) {
            double pixel[2];
            count += orl_view_project(view, model->points[source->points[i]].position, pixel,
                                      &depths[count]) &&
                     pixel[0] >= 0 && pixel[1] >= 0 && pixel[0] < view->camera.width &&
                     pixel[1] < view->camera.height;
        }
    }
    if (count <= OUTLIERS)
        return;
    qsort(depths, count, sizeof *depths, orl_order_doubles);
    plan->w_max = fmax(plan->w_max, 1.0 / (NEAR_SHARE * depths[OUTLIERS]));
}

struct plan_scratch {
    struct point_views seen_by;
    struct tally *tallies;
    double (*centres)[3];
    double *depths; // of the points of a photograph, or of its sources
};

static void make_plan(const struct densify_photos *photos, size_t ref, int sources,
                      struct plan_scratch *scratch, struct densify_plan *plan)
{
    const struct orl_colmap_model *model = photos->model;
    const struct orl_colmap_image *image = &model->images[photos->images[ref]];
    const struct orl_view *view = &photos->views[ref];
    size_t depth_count = 0;
    memset(scratch->tallies, 0, photos->count * sizeof *scratch->tallies);
    for (size_t k = 0; k < image->point_count; k++) {
        const double *position = model->points[image->points[k]].position;
        double cam[3];
        orl_pose_apply(&view->cam_from_world, position, cam);
        if (!(cam[2] > 0.0))
            continue;
        scratch->depths[depth_count++] = cam[2];
        size_t end = scratch->seen_by.first[image->points[k] + 1];
        for (size_t at = scratch->seen_by.first[image->points[k]]; at < end; at++) {
            size_t other = scratch->seen_by.photo[at];
            const struct orl_view *source = &photos->views[other];
            double cam2[3];
            if (other == ref)
                continue;
            orl_pose_apply(&source->cam_from_world, position, cam2);
            if (!(cam2[2] > 0.0))
                continue;
            double finer = log2(source->camera.fx * cam[2] / (view->camera.fx * cam2[2]));
            struct tally *tally = &scratch->tallies[other];
            // A factor of two in scale matches well. Beyond it, patches share less and less.
            tally->score += angle_score(scratch->centres[ref], scratch->centres[other], position) /
                            (1.0 + 0.25 * finer * finer);
            tally->log_finer += finer;
            tally->shared++;
        }
    }
    if (!depth_count)
        return;
    depth_range(scratch->depths, depth_count, plan);
    choose_sources(scratch->tallies, photos->count, sources, plan);
    widen_range(photos, view, scratch->depths, plan);
}

enum orl_result orl_densify_plans_make(const struct orl_log *log,
                                       const struct densify_photos *photos, int sources,
                                       struct densify_plan **plans)
{
    struct plan_scratch scratch = {0};
    *plans = orl_array(log, photos->count, sizeof **plans);
    scratch.tallies = orl_array(log, photos->count, sizeof *scratch.tallies);
    scratch.centres = orl_array(log, photos->count, sizeof *scratch.centres);
    size_t max_points = 0;
    for (size_t i = 0; i < photos->count; i++) {
        size_t points = photos->model->images[photos->images[i]].point_count;
        max_points = points > max_points ? points : max_points;
    }
    scratch.depths = orl_array(log, max_points, (size_t)sources * sizeof *scratch.depths);
    enum orl_result result = *plans && scratch.tallies && scratch.centres && scratch.depths
                                 ? point_views_init(log, photos, &scratch.seen_by) : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < photos->count; i++)
        orl_pose_centre(&photos->views[i].cam_from_world, scratch.centres[i]);
    for (size_t i = 0; result == ORL_OK && i < photos->count; i++)
        make_plan(photos, i, sources, &scratch, &(*plans)[i]);
    free(scratch.seen_by.first);
    free(scratch.seen_by.photo);
    free(scratch.tallies);
    free(scratch.centres);
    free(scratch.depths);
    return result;
}

// x_to ~ K_to (R K_from^-1 (x, y, 1) + t w), since a point is its ray divided by w.
void orl_densify_transfer(const struct orl_view *to, const struct orl_view *from, float rows[3][4])
{
    double r[3][3], t[3];
    const struct orl_pose *a = &to->cam_from_world, *b = &from->cam_from_world;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            r[i][j] = a->r[i][0] * b->r[j][0] + a->r[i][1] * b->r[j][1] + a->r[i][2] * b->r[j][2];
    for (int i = 0; i < 3; i++)
        t[i] = a->t[i] - (r[i][0] * b->t[0] + r[i][1] * b->t[1] + r[i][2] * b->t[2]);
    const struct orl_camera *ct = &to->camera, *cf = &from->camera;
    for (int i = 0; i < 3; i++) {
        double row[4];
        for (int j = 0; j < 3; j++)
            row[j] = i == 0   ? ct->fx * r[0][j] + ct->cx * r[2][j]
                     : i == 1 ? ct->fy * r[1][j] + ct->cy * r[2][j]
                              : r[2][j];
        row[3] = i == 0   ? ct->fx * t[0] + ct->cx * t[2]
                 : i == 1 ? ct->fy * t[1] + ct->cy * t[2]
                          : t[2];
        rows[i][0] = (float)(row[0] / cf->fx);
        rows[i][1] = (float)(row[1] / cf->fy);
        rows[i][2] = (float)(row[2] - row[0] * cf->cx / cf->fx - row[1] * cf->cy / cf->fy);
        rows[i][3] = (float)row[3];
    }
}

// --- parts ---

// The part of `count` photographs in `parts` parts that photograph `i` belongs to.
static size_t part_of(size_t i, size_t count, size_t parts)
{
    size_t part = i * parts / count;
    while (count * (part + 1) / parts <= i)
        part++;
    return part;
}

enum orl_result orl_densify_part_sources(const struct orl_log *log,
                                         const struct orl_colmap_model *model,
                                         const struct orl_names *names, int sources, int parts,
                                         bool *reads)
{
    struct densify_photos photos;
    struct densify_plan *plans = NULL;
    enum orl_result result = orl_densify_photos_init(log, model, names, &photos);
    ORL_THEN(result, orl_densify_plans_make(log, &photos, sources, &plans));
    for (size_t i = 0; result == ORL_OK && i < photos.count; i++)
        for (int k = 0; k < plans[i].count; k++)
            reads[part_of(i, photos.count, (size_t)parts) * (size_t)parts +
                  part_of(plans[i].sources[k].photo, photos.count, (size_t)parts)] = true;
    free(plans);
    orl_densify_photos_finish(&photos);
    return result;
}
