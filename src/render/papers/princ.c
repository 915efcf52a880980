// The photographs that Princ 2014, 2.3.2, takes: those whose direction agrees best with the view's,
// and some more for surfaces that these see too obliquely.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "core/order.h"
#include "core/vec3.h"
#include "render/frame/frame.h"
#include "render/proxy/proxy.h"
#include "render/photos/photos.h"
#include "scene/depth_buffer.h"

enum {
    VERTICES_MAX = 20000, // of the model that are projected into a photograph
    STRIDE = 4,           // pixels between the normals that are clustered, each way
    ROUNDS = 10,          // of k-means
};

static const double LIMIT_COS = 0.34202014; // of 70 degrees: shaders/gather/weight/princ.glsl
// What paints only where nothing else does weighs so much less.
static const float EXTRA_WEIGHT = 1e-6f;

// --- what a photograph shows of the model ---

static int compare_points(const void *a, const void *b)
{
    const double *p = a, *q = b;
    if (p[0] != q[0])
        return p[0] < q[0] ? -1 : 1;
    return (p[1] > q[1]) - (p[1] < q[1]);
}

static double turn(const double a[2], const double b[2], const double c[2])
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

// Convex hull of points that are sorted (Andrew 1979), in place; returns how many it has.
static size_t convex_hull(double (*points)[2], size_t count, double (*hull)[2])
{
    size_t k = 0;
    for (size_t i = 0; i < count; i++) { // lower
        while (k >= 2 && turn(hull[k - 2], hull[k - 1], points[i]) <= 0)
            k--;
        memcpy(hull[k++], points[i], sizeof points[i]);
    }
    for (size_t i = count - 1, lower = k + 1; i-- > 0;) { // upper
        while (k >= lower && turn(hull[k - 2], hull[k - 1], points[i]) <= 0)
            k--;
        memcpy(hull[k++], points[i], sizeof points[i]);
    }
    return k > 1 ? k - 1 : k; // the last is the first again
}

static size_t project(const struct proxy *proxy, const struct orl_view *view, double (*out)[2])
{
    size_t step = proxy->vertex_count / VERTICES_MAX + 1, count = 0;
    for (size_t i = 0; i < proxy->vertex_count; i += step) {
        double depth;
        count += orl_point_project(view, proxy->vertices[i], out[count], &depth);
    }
    return count;
}

// The photograph's direction, through the centroid of the corners of the convex hull, and the
// hull's area. Without vertices: its own axis, and nothing.
static void describe(const struct orl_view *view, double (*hull)[2], size_t count,
                     struct photo_aspect *aspect)
{
    const struct orl_camera *c = &view->camera;
    double x = c->cx, y = c->cy, area = 0, eye[3], through[3];
    for (size_t i = 0; i < count; i++) {
        const double *a = hull[i], *b = hull[(i + 1) % count];
        x = i ? x + a[0] : a[0];
        y = i ? y + a[1] : a[1];
        area += 0.5 * (a[0] * b[1] - b[0] * a[1]);
    }
    x = count ? x / (double)count : x;
    y = count ? y / (double)count : y;
    orl_pose_centre(&view->cam_from_world, eye);
    orl_view_unproject(view, x, y, 1, through);
    for (int k = 0; k < 3; k++)
        aspect->direction[k] = through[k] - eye[k];
    orl_normalize3(aspect->direction);
    aspect->area_px = fabs(area);
}

static enum orl_result find_aspects(const struct frame *frame)
{
    const struct orl_log *log = orl_gpu_log(frame->gpu);
    const struct orl_scene *scene = frame->scene;
    double(*points)[2] = orl_array(log, VERTICES_MAX + 1, sizeof *points);
    double(*hull)[2] = orl_array(log, 2 * VERTICES_MAX + 2, sizeof *hull);
    frame->proxy->aspects = orl_array(log, scene->photo_count, sizeof *frame->proxy->aspects);
    enum orl_result result = points && hull && frame->proxy->aspects ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < scene->photo_count; i++) {
        const struct orl_view *view = &scene->photos[i].view;
        size_t count = project(frame->proxy, view, points);
        qsort(points, count, sizeof *points, compare_points);
        count = count ? convex_hull(points, count, hull) : 0;
        describe(view, hull, count, &frame->proxy->aspects[i]);
    }
    free(points);
    free(hull);
    return result;
}

// --- the choice ---

// Outside the model's box towards its middle, inside along the view's own axis.
static void view_direction(const struct frame *frame, double out[3])
{
    double eye[3];
    bool inside = true;
    orl_pose_centre(&frame->view->cam_from_world, eye);
    for (int k = 0; k < 3; k++)
        inside = inside && eye[k] > frame->proxy->extent.low[k] && eye[k] < frame->proxy->extent.high[k];
    for (int k = 0; k < 3; k++)
        out[k] = inside ? frame->view->cam_from_world.r[2][k] : frame->proxy->extent.centroid[k] - eye[k];
    orl_normalize3(out);
}

// Adds the photograph that agrees best with a direction and is not chosen yet; false: none is left.
static bool add_best(struct frame *frame, bool *taken, const double direction[3])
{
    double best = -2;
    size_t index = SIZE_MAX;
    for (size_t i = 0; i < frame->scene->photo_count; i++) {
        double agrees = orl_dot3(direction, frame->proxy->aspects[i].direction);
        if (!taken[i] && agrees > best) {
            best = agrees;
            index = i;
        }
    }
    if (index == SIZE_MAX)
        return false;
    taken[index] = true;
    frame->chosen[frame->chosen_count++] = index;
    return true;
}

// Is this point of the view, with this normal, one that some chosen photograph looks at within the
// limit? Both in the view's camera frame.
static bool is_covered(const struct frame *frame, const double p[3], const double normal[3])
{
    for (size_t i = 0; i < frame->chosen_count; i++) {
        const struct orl_view *photo = &frame->scene->photos[frame->chosen[i]].view;
        const double *d = frame->proxy->aspects[frame->chosen[i]].direction;
        double in_view[3], world[3], pixel[2], depth;
        for (int k = 0; k < 3; k++)
            in_view[k] = orl_dot3(frame->view->cam_from_world.r[k], d);
        if (-orl_dot3(normal, in_view) < LIMIT_COS)
            continue;
        orl_view_unproject(frame->view, frame->view->camera.fx * p[0] / p[2] +
                           frame->view->camera.cx, frame->view->camera.fy * p[1] / p[2] +
                           frame->view->camera.cy, p[2], world);
        if (orl_view_shows(photo, world, pixel, &depth))
            return true;
    }
    return false;
}

// Normals, in the world, of surfaces that no chosen photograph covers.
static enum orl_result find_uncovered(const struct frame *frame, double (**normals)[3],
                                      size_t *count)
{
    const struct orl_log *log = orl_gpu_log(frame->gpu);
    const struct orl_camera *c = &frame->view->camera;
    size_t pixels = (size_t)c->width * (size_t)c->height;
    float *depth = orl_array(log, pixels, sizeof *depth);
    float(*normal)[4] = orl_array(log, pixels, sizeof *normal);
    *count = 0;
    *normals = orl_array(log, pixels / (STRIDE * STRIDE) + (size_t)(c->width + c->height),
                         sizeof **normals);
    enum orl_result result = depth && normal && *normals ? ORL_OK : ORL_ERR_MEMORY;
    if (result == ORL_OK) {
        orl_tex_read(frame->surface.depth, 0, GL_RED, GL_FLOAT, pixels * sizeof *depth, depth);
        orl_tex_read(frame->surface.normal, 0, GL_RGBA, GL_FLOAT, pixels * sizeof *normal, normal);
    }
    for (int y = STRIDE / 2; result == ORL_OK && y < c->height; y += STRIDE)
        for (int x = STRIDE / 2; x < c->width; x += STRIDE) {
            size_t at = (size_t)y * (size_t)c->width + (size_t)x;
            double z = (double)depth[at];
            const double p[3] = {(x + 0.5 - c->cx) / c->fx * z, (y + 0.5 - c->cy) / c->fy * z, z};
            const double n[3] = {(double)normal[at][0], (double)normal[at][1],
                                 (double)normal[at][2]};
            if (!(z > 0) || orl_dot3(n, n) < 0.5 || is_covered(frame, p, n))
                continue;
            double *out = (*normals)[(*count)++];
            for (int k = 0; k < 3; k++)
                out[k] = n[0] * frame->view->cam_from_world.r[0][k] +
                         n[1] * frame->view->cam_from_world.r[1][k] +
                         n[2] * frame->view->cam_from_world.r[2][k];
        }
    free(depth);
    free(normal);
    return result;
}

// k-means on the sphere: `means` begin as normals far from one another and end as unit vectors.
static size_t cluster(double (*normals)[3], size_t count, size_t clusters, double (*means)[3])
{
    size_t found = 0;
    while (found < clusters && found < count) { // the farthest from those there are
        size_t farthest = 0;
        double least = 2;
        for (size_t i = 0; i < count; i++) {
            double nearest = -1;
            for (size_t k = 0; k < found; k++)
                nearest = fmax(nearest, orl_dot3(normals[i], means[k]));
            if (nearest < least) {
                least = nearest;
                farthest = i;
            }
        }
        memcpy(means[found++], normals[farthest], sizeof *means);
    }
    for (int round = 0; round < ROUNDS; round++) {
        double sums[ORL_PRINC_EXTRAS][3] = {{0}};
        for (size_t i = 0; i < count; i++) {
            size_t best = 0;
            for (size_t k = 1; k < found; k++)
                if (orl_dot3(normals[i], means[k]) > orl_dot3(normals[i], means[best]))
                    best = k;
            for (int k = 0; k < 3; k++)
                sums[best][k] += normals[i][k];
        }
        for (size_t k = 0; k < found; k++)
            if (orl_dot3(sums[k], sums[k]) > 0) {
                memcpy(means[k], sums[k], sizeof *means);
                orl_normalize3(means[k]);
            }
    }
    return found;
}

// One photograph for each cluster of the normals of what is not covered.
static enum orl_result add_extras(struct frame *frame, bool *taken)
{
    size_t count;
    double(*normals)[3] = NULL, means[ORL_PRINC_EXTRAS][3];
    enum orl_result result = find_uncovered(frame, &normals, &count);
    if (result == ORL_OK && count > 0) {
        size_t clusters = cluster(normals, count, ORL_PRINC_EXTRAS, means);
        for (size_t k = 0; k < clusters; k++) {
            const double towards[3] = {-means[k][0], -means[k][1], -means[k][2]};
            add_best(frame, taken, towards);
        }
    }
    free(normals);
    return result;
}

// Into what shaders are told, photographs ascending. The first `nearest` were chosen by direction.
static void weigh(struct frame *frame, const double direction[3], size_t nearest, bool *extra)
{
    memset(extra, 0, frame->scene->photo_count * sizeof *extra);
    for (size_t i = nearest; i < frame->chosen_count; i++)
        extra[frame->chosen[i]] = true;
    qsort(frame->chosen, frame->chosen_count, sizeof *frame->chosen, orl_order_sizes);
    for (size_t i = 0; i < frame->chosen_count; i++) {
        const struct photo_aspect *aspect = &frame->proxy->aspects[frame->chosen[i]];
        double agrees = fmax(orl_dot3(direction, aspect->direction), 1e-3);
        float *selected = frame->selected[i];
        selected[0] = (float)(agrees * aspect->area_px) * (extra[frame->chosen[i]] ? EXTRA_WEIGHT : 1);
        for (int k = 0; k < 3; k++)
            selected[1 + k] =
                (float)orl_dot3(frame->view->cam_from_world.r[k], aspect->direction);
    }
}

static enum orl_result choose(struct frame *frame)
{
    enum orl_result result = frame->proxy->aspects ? ORL_OK : find_aspects(frame);
    bool *taken = orl_array(orl_gpu_log(frame->gpu), frame->scene->photo_count, sizeof *taken);
    double direction[3];
    if (result == ORL_OK && !taken)
        result = ORL_ERR_MEMORY;
    if (result != ORL_OK)
        goto end;
    for (size_t i = 0; i < frame->scene->photo_count; i++)
        taken[i] = !orl_frame_may_use(frame, i);
    view_direction(frame, direction);
    frame->chosen_count = 0;
    for (size_t n = (size_t)(frame->params->nearest + 0.5f); n > 0; n--)
        if (!add_best(frame, taken, direction))
            break;
    size_t nearest = frame->chosen_count;
    result = add_extras(frame, taken);
    if (result == ORL_OK)
        weigh(frame, direction, nearest, taken);
end:
    free(taken);
    return result;
}

const struct orl_selection orl_select_princ = {"princ", choose};
