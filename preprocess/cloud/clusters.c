#include "preprocess/cloud/clusters.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "core/order.h"
#include "scene/nearest_points.h"

// --- members: photographs divided by where they stand ---

// Where each image of the model was taken.
typedef double place[3];

static int widest_axis(const struct orl_ranked *images, size_t count, const place *places)
{
    double widest = -1;
    int axis = 0;
    for (int k = 0; k < 3; k++) {
        double low = places[images[0].index][k], high = low;
        for (size_t i = 1; i < count; i++) {
            low = fmin(low, places[images[i].index][k]);
            high = fmax(high, places[images[i].index][k]);
        }
        if (high - low > widest)
            widest = high - low, axis = k;
    }
    return axis;
}

// Divides images into `parts` clusters from number `first` on, as equal as can be, by halves across the longest axis.
static void divide(struct orl_ranked *images, size_t count, const place *places, int first, int parts, int *member)
{
    if (parts == 1) {
        for (size_t i = 0; i < count; i++)
            member[images[i].index] = first;
        return;
    }
    int axis = widest_axis(images, count, places), half = parts / 2;
    for (size_t i = 0; i < count; i++)
        images[i].key = places[images[i].index][axis];
    qsort(images, count, sizeof *images, orl_order_ranked);
    size_t left = count * (size_t)half / (size_t)parts;
    divide(images, left, places, first, half, member);
    divide(images + left, count - left, places, first + half, parts - half, member);
}

static enum orl_result set_members(const struct orl_log *log, const struct orl_names *train,
                                   struct orl_clusters *clusters)
{
    const struct orl_colmap_model *model = clusters->model;
    struct orl_ranked *images = orl_array(log, model->image_count, sizeof *images);
    place *places = orl_array(log, model->image_count, sizeof *places);
    enum orl_result result = images && places ? ORL_OK : ORL_ERR_MEMORY;
    size_t count = 0;
    for (size_t i = 0; result == ORL_OK && i < model->image_count; i++) {
        clusters->member[i] = -1;
        orl_pose_centre(&model->images[i].cam_from_world, places[i]);
        if (orl_names_contain(train, model->images[i].name))
            images[count++].index = i;
    }
    clusters->count = count ? (count + clusters->size - 1) / clusters->size : 1;
    if (result == ORL_OK)
        divide(images, count, (const place *)places, 0, (int)clusters->count, clusters->member);
    free(images);
    free(places);
    return result;
}

// --- owners of sparse points ---

// How well a photograph shows a point: its focal length in pixels over the point's depth.
static double shown(const struct orl_colmap_model *model, const struct orl_colmap_image *image,
                    uint32_t point)
{
    double at[3];
    orl_pose_apply(&image->cam_from_world, model->points[point].position, at);
    return at[2] > 0 ? orl_colmap_camera_by_id(model, image->camera_id)->pinhole.fx / at[2] : 0;
}

static enum orl_result set_owners(const struct orl_log *log, struct orl_clusters *clusters)
{
    const struct orl_colmap_model *model = clusters->model;
    double *best = orl_array(log, model->point_count + 1, sizeof *best);
    double *sum = orl_array(log, model->point_count + 1, sizeof *sum);
    enum orl_result result = best && sum ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t p = 0; result == ORL_OK && p < model->point_count; p++)
        clusters->owner[p] = -1;
    for (int c = 0; result == ORL_OK && c < (int)clusters->count; c++) {
        memset(sum, 0, model->point_count * sizeof *sum);
        for (size_t i = 0; i < model->image_count; i++)
            for (size_t k = 0; clusters->member[i] == c && k < model->images[i].point_count; k++)
                sum[model->images[i].points[k]] +=
                    shown(model, &model->images[i], model->images[i].points[k]);
        for (size_t p = 0; p < model->point_count; p++)
            if (sum[p] > best[p])
                best[p] = sum[p], clusters->owner[p] = c;
    }
    free(best);
    free(sum);
    return result;
}

enum orl_result orl_clusters_make(const struct orl_log *log, const struct orl_colmap_model *model,
                                  const struct orl_names *train, size_t size,
                                  struct orl_clusters *clusters)
{
    ORL_REQUIRE(log, size > 0);
    *clusters = (struct orl_clusters){
        .model = model, .size = size,
        .member = orl_array(log, model->image_count + 1, sizeof *clusters->member),
        .owner = orl_array(log, model->point_count + 1, sizeof *clusters->owner)};
    enum orl_result result = clusters->member && clusters->owner ? ORL_OK : ORL_ERR_MEMORY;
    ORL_THEN(result, set_members(log, train, clusters));
    ORL_THEN(result, set_owners(log, clusters));
    if (result != ORL_OK)
        orl_clusters_finish(clusters);
    return result;
}

void orl_clusters_finish(struct orl_clusters *clusters)
{
    free(clusters->member);
    free(clusters->owner);
    *clusters = (struct orl_clusters){0};
}

// --- photographs of a cluster ---

size_t orl_clusters_helpers(size_t size)
{
    return (size + 1) / 2;
}

enum orl_result orl_clusters_photographs(const struct orl_log *log,
                                         const struct orl_clusters *clusters, int cluster,
                                         struct orl_names *names)
{
    const struct orl_colmap_model *model = clusters->model;
    struct orl_ranked *helpers = orl_array(log, model->image_count + 1, sizeof *helpers);
    bool *take = orl_array(log, model->image_count + 1, sizeof *take);
    enum orl_result result = helpers && take ? ORL_OK : ORL_ERR_MEMORY;
    size_t count = 0;
    for (size_t i = 0; result == ORL_OK && i < model->image_count; i++) {
        const struct orl_colmap_image *image = &model->images[i];
        double score = 0;
        take[i] = clusters->member[i] == cluster;
        for (size_t k = 0; !take[i] && clusters->member[i] >= 0 && k < image->point_count; k++)
            if (clusters->owner[image->points[k]] == cluster)
                score += shown(model, image, image->points[k]);
        if (score > 0)
            helpers[count++] = (struct orl_ranked){-score, i};
    }
    if (result == ORL_OK)
        qsort(helpers, count, sizeof *helpers, orl_order_ranked);
    for (size_t i = 0; result == ORL_OK && i < count && i < orl_clusters_helpers(clusters->size); i++)
        take[helpers[i].index] = true;
    for (size_t i = 0; result == ORL_OK && i < model->image_count; i++)
        if (take[i])
            result = orl_names_add(log, names, model->images[i].name);
    free(helpers);
    free(take);
    return result;
}

// --- points of a cluster ---

// The sparse points that have an owner, and their owners.
static enum orl_result owned_points(const struct orl_log *log, const struct orl_clusters *clusters,
                                    struct orl_points *sparse, int *owner)
{
    const struct orl_colmap_model *model = clusters->model;
    size_t count = 0;
    ORL_TRY(orl_points_init(log, sparse, model->point_count));
    for (size_t p = 0; p < model->point_count; p++) {
        if (clusters->owner[p] < 0)
            continue;
        for (int k = 0; k < 3; k++)
            sparse->position[count][k] = (float)model->points[p].position[k];
        owner[count++] = clusters->owner[p];
    }
    sparse->count = count;
    return ORL_OK;
}

enum orl_result orl_clusters_keep_own(const struct orl_log *log,
                                      const struct orl_clusters *clusters, int cluster,
                                      struct orl_points *points)
{
    struct orl_points sparse = {0};
    orl_points_drop_unusable(log, points);
    int *owner = orl_array(log, clusters->model->point_count + 1, sizeof *owner);
    int *nearest = orl_array(log, points->count + 1, sizeof *nearest);
    float *dist2 = orl_array(log, points->count + 1, sizeof *dist2);
    enum orl_result result = owner && nearest && dist2 ? owned_points(log, clusters, &sparse, owner)
                                                       : ORL_ERR_MEMORY;
    if (result == ORL_OK && sparse.count && points->count)
        result = orl_points_nearest(log, &sparse, points, nearest, dist2);
    size_t kept = 0;
    for (size_t i = 0; result == ORL_OK && i < points->count; i++)
        if (sparse.count ? owner[nearest[i]] == cluster : cluster == 0)
            orl_points_copy(points, i, points, kept++);
    if (result == ORL_OK)
        points->count = kept;
    orl_points_finish(&sparse);
    free(owner);
    free(nearest);
    free(dist2);
    return result;
}
