// Which points a scene can do without.
#include "eval/trim_search.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "core/order.h"
#include "core/vec3.h"
#include "render/proxy/proxy.h"
#include "render/proxy/splats.h"
#include "scene/nearest_points.h"
#include "scene/point_blocks.h"
#include "scene/point_radii.h"

// Sides of the pictures' pixels, in pixels of full resolution.
static const int pixel_sides[] = {1, 2, 3, 4, 6, 8, 12, 16};
// Points that are no farther behind the nearest one, as a share of depth, are of one surface.
static const float surface_depth = 0.01f;
// Views are drawn at most so large.
enum { SIDE_MAX = 1024 };
// A thinned cloud's radii grow with its spacing, by no more than this factor times the mean growth.
static const double growth_max = 1.5;

// --- the views ---

// Which points are nearest in a view, row by row.
struct drawn {
    int width, height;
    uint32_t *point; // owned: index in the scene's points; UINT32_MAX: none
    float *depth;    // owned: z of that point; INFINITY: none
};

struct ranker {
    struct orl_gpu *gpu;
    struct proxy proxy;
    uint32_t *points;       // owned, per point on the device: its index in the scene
    size_t count;           // of these
    struct orl_view *views; // owned
    size_t view_count;
    struct drawn *drawn;    // owned, one for each view
    uint8_t *level;         // owned, per point: 1 + the last of pixel_sides; 0: never
    struct orl_point_ranking *ranking;
};

static struct orl_view drawn_size(const struct orl_view *view)
{
    struct orl_view small = *view;
    const struct orl_camera *c = &view->camera;
    int longer = c->width > c->height ? c->width : c->height;
    if (longer > SIDE_MAX)
        small.camera = orl_camera_resized(c, c->width * SIDE_MAX / longer,
                                          c->height * SIDE_MAX / longer);
    return small;
}

static enum orl_result choose_views(const struct orl_log *log, const struct orl_scene *scene,
                                    size_t most, struct ranker *r)
{
    r->views = orl_array(log, most + 1, sizeof *r->views);
    ORL_TRY_MEMORY(r->views);
    for (size_t i = 0; i < scene->photo_count; i++) {
        if (!orl_heldout_chosen(scene, false, (most + 1) / 2, i))
            continue;
        struct orl_view view = drawn_size(&scene->photos[i].view);
        size_t other = orl_validation_nearest(scene, i, NULL, false, i);
        r->views[r->view_count++] = view;
        if (other < scene->photo_count)
            r->views[r->view_count++] = orl_view_interpolate(&view, &scene->photos[other].view, 0.5);
    }
    return ORL_OK;
}

// --- the ranking ---

// Splats all points into the view, and counts the pixels that each wins. Of points at the same depth one wins.
static enum orl_result draw_view(struct ranker *r, const struct orl_view *view, struct drawn *drawn)
{
    const struct orl_log *log = orl_gpu_log(r->gpu);
    const size_t pixels = (size_t)view->camera.width * (size_t)view->camera.height;
    struct surface surface;
    *drawn = (struct drawn){view->camera.width, view->camera.height, orl_array(log, pixels, sizeof *drawn->point),
                            orl_array(log, pixels, sizeof *drawn->depth)};
    ORL_TRY_MEMORY(drawn->point && drawn->depth);
    ORL_TRY(orl_proxy_draw(r->gpu, &r->proxy, view, &orl_methods[0].params, false, &r->proxy.view_target,
                           &surface));
    const struct splat_target *target = r->proxy.view_target;
    orl_tex_read(target->splat_index, 0, GL_RED_INTEGER, GL_UNSIGNED_INT, 4 * pixels, drawn->point);
    orl_tex_read(target->splat_depth, 0, GL_RED_INTEGER, GL_UNSIGNED_INT, 4 * pixels, drawn->depth); // its bits
    ORL_TRY(orl_gpu_finish(r->gpu));
    for (size_t i = 0; i < pixels; i++) {
        const uint32_t point = drawn->point[i] < r->count ? r->points[drawn->point[i]] : UINT32_MAX;
        drawn->point[i] = point;
        if (point == UINT32_MAX)
            drawn->depth[i] = INFINITY;
        else
            r->ranking->pixels[point]++;
    }
    return ORL_OK;
}

static enum orl_result draw_views(struct ranker *r, const struct orl_scene *scene, const struct orl_progress *progress)
{
    const struct orl_log *log = orl_gpu_log(r->gpu);
    r->drawn = orl_array(log, r->view_count, sizeof *r->drawn);
    ORL_TRY_MEMORY(r->drawn);
    ORL_TRY(orl_proxy_create(r->gpu, scene, &orl_proxy_splats, 0, &r->proxy));
    ORL_TRY(orl_point_order(log, &scene->points, NULL, ORL_BLOCK_POINTS, &r->points, &r->count));
    for (size_t i = 0; i < r->view_count; i++) {
        orl_progress_report(progress, "points", (double)i, (double)r->view_count, NULL);
        if (orl_progress_cancelled(progress))
            return ORL_ERR_CANCELLED;
        ORL_TRY(draw_view(r, &r->views[i], &r->drawn[i]));
    }
    return ORL_OK;
}

// Chooses a point for the pixel of side `side` whose first small pixel is at (x, y).
static uint32_t choose(const struct ranker *r, const struct drawn *drawn, int x, int y,
                       int side)
{
    float nearest = INFINITY;
    uint32_t chosen = UINT32_MAX;
    int right = x + side < drawn->width ? x + side : drawn->width;
    int bottom = y + side < drawn->height ? y + side : drawn->height;
    for (int v = y; v < bottom; v++)
        for (int u = x; u < right; u++)
            nearest = fminf(nearest, drawn->depth[(size_t)v * (size_t)drawn->width + (size_t)u]);
    for (int v = y; v < bottom; v++)
        for (int u = x; u < right; u++) {
            size_t at = (size_t)v * (size_t)drawn->width + (size_t)u;
            uint32_t point = drawn->point[at];
            if (point == UINT32_MAX || drawn->depth[at] > nearest * (1 + surface_depth))
                continue;
            const uint32_t *pixels = r->ranking->pixels;
            if (chosen == UINT32_MAX || pixels[point] > pixels[chosen] ||
                (point < chosen && pixels[point] == pixels[chosen]))
                chosen = point;
        }
    return chosen;
}

static void set_levels(const struct ranker *r, const struct drawn *drawn)
{
    for (size_t k = 0; k < ORL_COUNT(pixel_sides); k++)
        for (int y = 0; y < drawn->height; y += pixel_sides[k])
            for (int x = 0; x < drawn->width; x += pixel_sides[k]) {
                uint32_t point = choose(r, drawn, x, y, pixel_sides[k]);
                if (point != UINT32_MAX && r->level[point] < k + 1)
                    r->level[point] = (uint8_t)(k + 1);
            }
}

// By level, then by pixels, the greatest first.
static enum orl_result sort(const struct orl_log *log, const struct ranker *r)
{
    struct orl_point_ranking *ranking = r->ranking;
    struct orl_ranked *ranks = orl_array(log, ranking->count, sizeof *ranks);
    ORL_TRY_MEMORY(ranks);
    for (size_t i = 0; i < ranking->count; i++)
        ranks[i] = (struct orl_ranked){-(ldexp(r->level[i], 32) + ranking->pixels[i]), i};
    qsort(ranks, ranking->count, sizeof *ranks, orl_order_ranked);
    for (size_t i = 0; i < ranking->count; i++)
        ranking->order[i] = (uint32_t)ranks[i].index;
    free(ranks);
    return ORL_OK;
}

enum orl_result orl_point_ranking_make(struct orl_gpu *gpu, const struct orl_scene *scene,
                                       size_t max_views, const struct orl_progress *progress,
                                       struct orl_point_ranking *ranking)
{
    const struct orl_log *log = orl_gpu_log(gpu);
    struct ranker r = {.gpu = gpu, .ranking = ranking};
    size_t count = scene->points.count;
    *ranking = (struct orl_point_ranking){.count = count};
    ranking->order = orl_array(log, count, sizeof *ranking->order);
    ranking->pixels = orl_array(log, count, sizeof *ranking->pixels);
    r.level = orl_array(log, count, sizeof *r.level);
    enum orl_result result =
        ranking->order && ranking->pixels && r.level ? ORL_OK : ORL_ERR_MEMORY;
    ORL_THEN(result, choose_views(log, scene, max_views, &r));
    ORL_THEN(result, draw_views(&r, scene, progress));
    for (size_t i = 0; result == ORL_OK && i < r.view_count; i++)
        set_levels(&r, &r.drawn[i]);
    ORL_THEN(result, sort(log, &r));
    for (size_t i = 0; r.drawn && i < r.view_count; i++) {
        free(r.drawn[i].point);
        free(r.drawn[i].depth);
    }
    orl_proxy_finish(gpu, &r.proxy);
    free(r.points);
    free(r.drawn);
    free(r.level);
    free(r.views);
    if (result != ORL_OK)
        orl_point_ranking_finish(ranking);
    return result;
}

void orl_point_ranking_finish(struct orl_point_ranking *ranking)
{
    free(ranking->order);
    free(ranking->pixels);
    memset(ranking, 0, sizeof *ranking);
}

// --- the smaller cloud ---

// What a point stands for: sums over the points nearest to it.
struct sums {
    double along, normal[3], color[3], count;
};

// Adds point i of `from` to the sums of point k of `to`, unless it is of another surface.
static void add_point(const struct orl_points *from, size_t i, const struct orl_points *to,
                      size_t k, struct sums *sums)
{
    double along = 0, cosine = 0;
    for (int c = 0; c < 3; c++) {
        double n = (double)to->normal[k][c];
        along += n * ((double)from->position[i][c] - (double)to->position[k][c]);
        cosine += n * (double)from->normal[i][c];
    }
    if (cosine < 0.5 || fabs(along) > (double)to->radius[k])
        return;
    sums->along += along;
    for (int c = 0; c < 3; c++) {
        sums->normal[c] += (double)from->normal[i][c];
        sums->color[c] += from->color[i][c];
    }
    sums->count++;
}

static void take_mean(struct sums *sums, struct orl_points *to, size_t k)
{
    if (sums->count == 0)
        return;
    double length = orl_normalize3(sums->normal);
    for (int c = 0; c < 3; c++) {
        to->position[k][c] += (float)(sums->along / sums->count) * to->normal[k][c];
        to->color[k][c] = (uint8_t)(sums->color[c] / sums->count + 0.5);
        if (length > 0)
            to->normal[k][c] = (float)sums->normal[c];
    }
}

static enum orl_result merge_points(const struct orl_log *log, const struct orl_points *from,
                                    struct orl_points *to)
{
    int *found = orl_array(log, from->count, sizeof *found);
    float *dist2 = orl_array(log, from->count, sizeof *dist2);
    struct sums *sums = orl_array(log, to->count, sizeof *sums);
    enum orl_result result = found && dist2 && sums ? ORL_OK : ORL_ERR_MEMORY;
    ORL_THEN(result, orl_points_nearest(log, to, from, found, dist2));
    for (size_t i = 0; result == ORL_OK && i < from->count; i++) {
        float room = to->radius[found[i]];
        if (dist2[i] <= room * room)
            add_point(from, i, to, (size_t)found[i], &sums[found[i]]);
    }
    for (size_t k = 0; result == ORL_OK && k < to->count; k++)
        take_mean(&sums[k], to, k);
    free(found);
    free(dist2);
    free(sums);
    return result;
}

enum orl_result orl_points_thin_out(const struct orl_log *log, const struct orl_points *from,
                                    const uint32_t *order, size_t count,
                                    struct orl_points *to)
{
    enum orl_result result = orl_points_init(log, to, count);
    if (result != ORL_OK || !count)
        return result;
    for (size_t k = 0; k < count; k++)
        orl_points_copy(from, order[k], to, k);
    if (count == from->count)
        return ORL_OK;
    // Radii that are unknown are those of a cloud of this density.
    float most = (float)(growth_max * sqrt((double)from->count / (double)count));
    result = orl_points_set_radii(log, NULL, &(struct orl_radii_params){ORL_RADII_DEFAULTS}, NULL,
                                  0, to);
    for (size_t k = 0; result == ORL_OK && k < count; k++)
        to->radius[k] = fminf(fmaxf(to->radius[k], from->radius[order[k]]),
                              most * from->radius[order[k]]);
    ORL_THEN(result, merge_points(log, from, to));
    if (result != ORL_OK)
        orl_points_finish(to);
    return result;
}
