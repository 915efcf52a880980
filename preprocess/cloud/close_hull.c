#include "preprocess/cloud/close_hull.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "core/vec3.h"
#include "io/picture.h"
#include "preprocess/cloud/fuse_photographs.h"
#include "preprocess/cloud/hull_points.h"
#include "preprocess/cloud/silhouettes.h"

// Share of the points that may lie outside, each counted as often as other photographs agree on it:
// outliers, which few agree on, and what stands beside the subject. Pictures taken at night exclude more. Masks that are
// given are more reliable than points: most points of a glossy subject may be outliers.
static const double OUTSIDE_DARK = 0.3, OUTSIDE_GIVEN = 0.7;

// --- colours of new points ---

// The photograph that faces a point most directly and whose silhouette holds it; -1: none.
static int facing(const struct orl_silhouettes *found, const struct orl_points *points,
                  size_t point, double pixel[2])
{
    double world[3], normal[3], best = 0, at[2];
    int chosen = -1;
    for (int k = 0; k < 3; k++) {
        world[k] = (double)points->position[point][k];
        normal[k] = (double)points->normal[point][k];
    }
    for (size_t i = 0; i < found->count; i++) {
        const struct orl_silhouette *s = &found->items[i];
        double towards[3];
        orl_pose_centre(&s->view.cam_from_world, towards);
        for (int k = 0; k < 3; k++)
            towards[k] -= world[k];
        double cosine = orl_dot3(towards, normal) / sqrt(orl_dot3(towards, towards));
        if (!(cosine > best) || orl_silhouette_ask(s, world, at) != ORL_SILHOUETTE_INSIDE)
            continue;
        best = cosine;
        chosen = (int)i;
        memcpy(pixel, at, sizeof at);
    }
    return chosen;
}

// Where a new point takes its colour.
struct origin {
    int photo; // -1: nowhere
    double pixel[2];
};

static enum orl_result color_from(struct orl_job *job, const struct orl_silhouettes *found,
                                  int photo, const struct origin *origins, size_t first,
                                  struct orl_points *points)
{
    struct orl_image picture = {0};
    const char *path = ORL_PATH(job->dir, "images/%s", found->image[photo]->name);
    enum orl_result result = orl_picture_read(job->log, path, 3, &picture);
    for (size_t p = first; result == ORL_OK && p < points->count; p++) {
        const double *pixel = origins[p - first].pixel;
        if (origins[p - first].photo == photo && pixel[0] < picture.width &&
            pixel[1] < picture.height)
            memcpy(points->color[p],
                   picture.u8 + 3 * ((size_t)pixel[1] * (size_t)picture.width + (size_t)pixel[0]),
                   sizeof points->color[p]);
    }
    orl_image_finish(&picture);
    return result;
}

// Colours the points from `first` on.
static enum orl_result set_colors(struct orl_job *job, const struct orl_silhouettes *found,
                                  size_t first, struct orl_points *points)
{
    struct origin *origins = orl_array(job->log, points->count - first, sizeof *origins);
    enum orl_result result = origins ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t p = first; result == ORL_OK && p < points->count; p++)
        origins[p - first].photo = facing(found, points, p, origins[p - first].pixel);
    for (size_t i = 0; result == ORL_OK && i < found->count; i++)
        result = color_from(job, found, (int)i, origins, first, points);
    free(origins);
    return result;
}

// --- carving ---

static enum orl_result see_maps(struct orl_job *job, const struct orl_colmap_model *model,
                                const struct orl_silhouettes *found, struct orl_hull_points *hull)
{
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < found->count; i++) {
        struct orl_depth_map map = {0};
        result = orl_fuse_read_map(job, model, found->image[i], &map);
        if (result == ORL_OK && map.depth.f32)
            orl_hull_points_see(hull, i, &map);
        orl_image_finish(&map.depth);
        if (result == ORL_OK && orl_progress_cancelled(job->progress))
            result = ORL_ERR_CANCELLED;
    }
    return result;
}

// Carves the rest of the hull, and takes its points.
static enum orl_result take_points(struct orl_job *job, const struct orl_colmap_model *model,
                                   const struct orl_silhouettes *found,
                                   struct orl_hull_points *hull, struct orl_points *points,
                                   json_t *record)
{
    const char *from = found->given ? "masks" : "dark backdrop";
    size_t before = points->count, first = before;
    ORL_TRY(see_maps(job, model, found, hull));
    ORL_TRY(orl_hull_points_end(job->log, hull, points, &first));
    ORL_TRY(set_colors(job, found, first, points));
    orl_logf(job->log, ORL_LOG_INFO, "fuse: the visual hull of %zu silhouettes (%s) closes "
             "surfaces by %zu points; %zu outside it are dropped", found->count, from,
             points->count - first, before - first);
    json_object_set_new(record, "hull", json_pack(
        "{s:I, s:I, s:I, s:s}", "silhouettes", (json_int_t)found->count, "added",
        (json_int_t)(points->count - first), "dropped", (json_int_t)(before - first), "from",
        from));
    return ORL_OK;
}

static enum orl_result close_with(struct orl_job *job, const struct orl_colmap_model *model,
                                  const struct orl_silhouettes *found, struct orl_points *points,
                                  json_t *record)
{
    struct orl_hull_points hull = {0};
    enum orl_result result = orl_hull_points_begin(job->log, found->items, found->count, points,
                                                   job->params->max_ram_bytes, &hull);
    if (result == ORL_OK)
        orl_logf(job->log, ORL_LOG_DEBUG, "fuse: %.1f %% of the points lie outside silhouettes",
                 100 * hull.outside_share);
    if (result == ORL_OK && hull.outside_share <= (found->given ? OUTSIDE_GIVEN : OUTSIDE_DARK))
        result = take_points(job, model, found, &hull, points, record);
    orl_hull_points_finish(&hull);
    return result;
}

enum orl_result orl_close_hull(struct orl_job *job, const struct orl_colmap_model *model,
                               const struct orl_names *train, struct orl_points *points,
                               json_t *record)
{
    struct orl_silhouettes found;
    enum orl_result result = orl_silhouettes_find(job, model, train, points, &found);
    if (result == ORL_OK && found.count)
        result = close_with(job, model, &found, points, record);
    orl_silhouettes_finish(&found);
    return result;
}
