// Panoramas: six overlapping square views from one point, blended.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "core/vec3.h"
#include "hdr/internal.h"
#include "scene/upright.h"

enum { FACES = 6 };

// Overlap of the faces beyond the cube's edges, in half sides, where they are blended. Each face
// has its own depth reconstruction, which may differ on the two sides of an edge.
static const double MARGIN = 0.15;
// Face pixels per panorama pixel at a face's centre, which makes up for the blur of resampling.
static const double OVERSAMPLE = 1.25;

// Rows: a face's x, y and z axes in the panorama's frame (x right, y down, z forward).
static const double faces[FACES][3][3] = {
    {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},    // forward
    {{0, 0, -1}, {0, 1, 0}, {1, 0, 0}},   // right
    {{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}},  // back
    {{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}},   // left
    {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}},   // up
    {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}},   // down
};

// --- frames ---

// False if the vector is zero up to rounding, as the sum of opposite directions is.
static bool normalize(double v[3])
{
    double length = orl_normalize3(v);
    return length > 1e-9 && isfinite(length);
}

// Rows: right, down and forward in the world. False if `up` has no direction.
static bool panorama_axes(const struct orl_panorama *p, double axes[3][3])
{
    double up[3], forward[3];
    memcpy(up, p->up, sizeof up);
    memcpy(forward, p->forward, sizeof forward);
    if (!normalize(up))
        return false;
    if (!normalize(forward))
        forward[0] = 1;
    // Makes the forward direction level. If it points up or down, any level direction will do.
    for (int attempt = 0; attempt < 3; attempt++) {
        double level[3];
        for (int i = 0; i < 3; i++)
            level[i] = forward[i] - orl_dot3(forward, up) * up[i];
        if (orl_dot3(level, level) > 1e-6 && normalize(level)) {
            for (int i = 0; i < 3; i++) {
                axes[1][i] = -up[i];
                axes[2][i] = level[i];
            }
            orl_cross3(axes[1], axes[2], axes[0]);
            return true;
        }
        for (int i = 0; i < 3; i++)
            forward[i] = i == attempt;
    }
    return false;
}

enum orl_result orl_panorama_place(const struct orl_log *log, const struct orl_scene *scene,
                                   const char *at, struct orl_panorama *p)
{
    orl_scene_mean_up(scene, p->up);
    memset(p->forward, 0, sizeof p->forward);
    for (size_t k = 0; !at && k < scene->photo_count; k++)
        for (int i = 0; i < 3; i++)
            p->forward[i] += scene->photos[k].view.cam_from_world.r[2][i];
    if (!at)
        return ORL_OK;
    int index = orl_scene_find_photo(scene, at);
    if (index < 0)
        return orl_fail(log, ORL_ERR_NOT_FOUND, "%s has no photograph %s", scene->dir, at);
    const struct orl_pose *pose = &scene->photos[index].view.cam_from_world;
    orl_pose_centre(pose, p->position);
    memcpy(p->forward, pose->r[2], sizeof p->forward);
    return ORL_OK;
}

static void place(const struct orl_panorama *p, struct orl_pose *pose)
{
    for (int i = 0; i < 3; i++)
        pose->t[i] = -orl_dot3(pose->r[i], p->position);
}

bool orl_panorama_view(const struct orl_panorama *p, struct orl_view *view)
{
    double focal = p->width / (2 * M_PI);
    memset(view, 0, sizeof *view);
    view->camera = (struct orl_camera){p->width, p->height, focal, focal, 0.5 * p->width,
                                       0.5 * p->height};
    if (!panorama_axes(p, view->cam_from_world.r))
        return false;
    place(p, &view->cam_from_world);
    return true;
}

static struct orl_view face_view(const struct orl_panorama *p, const double axes[3][3], int face)
{
    double focal = ceil(OVERSAMPLE * p->width / (2 * M_PI));
    int side = (int)ceil(2 * (1 + MARGIN) * focal);
    struct orl_view view = {.camera = {side, side, focal, focal, 0.5 * side, 0.5 * side}};
    struct orl_pose *pose = &view.cam_from_world;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++)
                pose->r[i][j] += faces[face][i][k] * axes[k][j];
    place(p, pose);
    return view;
}

// --- joining ---

struct panorama_sums {
    float color[3], coverage, confidence, weight;
    float nearest; // weight of the face that gave depth and normal
};

// Direction of a panorama pixel in the panorama's frame.
static void direction_of(const struct orl_panorama *p, int x, int y, double d[3])
{
    double longitude = M_PI - 2 * M_PI * (x + 0.5) / p->width;
    double latitude = M_PI / 2 - M_PI * (y + 0.5) / p->height;
    d[0] = -sin(longitude) * cos(latitude);
    d[1] = -sin(latitude);
    d[2] = cos(longitude) * cos(latitude);
}

// Blending weight: 1 inside the face, 1/2 at the cube's edge, 0 at the face's border.
static double edge_weight(double at)
{
    double t = (fabs(at) - (1 - MARGIN)) / (2 * MARGIN);
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    return 1 - t * t * (3 - 2 * t);
}

static void add_taps(const struct orl_frame *face, double u, double v, float weight,
                     struct panorama_sums *sums)
{
    int width = face->color.width, height = face->color.height;
    int x0 = (int)floor(u - 0.5), y0 = (int)floor(v - 0.5);
    float fx = (float)(u - 0.5 - x0), fy = (float)(v - 0.5 - y0);
    for (int k = 0; k < 4; k++) {
        int x = x0 + (k & 1), y = y0 + (k >> 1);
        if (x < 0 || y < 0 || x >= width || y >= height)
            continue;
        size_t at = (size_t)y * (size_t)width + (size_t)x;
        // Pixels that only hole filling painted are filled better over the whole panorama.
        if (!(face->confidence.f32[at] > 0))
            continue;
        float w = weight * (k & 1 ? fx : 1 - fx) * (k >> 1 ? fy : 1 - fy);
        for (size_t c = 0; c < 3; c++)
            sums->color[c] += w * face->color.f32[3 * at + c];
        sums->coverage += w * face->coverage.f32[at];
        sums->confidence += w * face->confidence.f32[at];
        sums->weight += w;
    }
}

// Takes depth and normal from the face pixel that a direction meets. z: the pixel's depth per unit
// of distance.
static void take_surface(const struct orl_frame *face, const double axes[3][3], double u, double v,
                         double z, size_t at, struct orl_frame *frame)
{
    int x = (int)u, y = (int)v;
    size_t from = (size_t)y * (size_t)face->depth.width + (size_t)x;
    frame->depth.f32[at] = (float)((double)face->depth.f32[from] / z);
    for (size_t i = 0; i < 3; i++) {
        double sum = 0;
        for (size_t k = 0; k < 3; k++)
            sum += axes[k][i] * (double)face->normal.f32[3 * from + k];
        frame->normal.f32[3 * at + i] = (float)sum;
    }
}

static void add_face(const struct orl_panorama *p, int number, const struct orl_frame *face,
                     const struct orl_camera *camera, struct panorama_sums *sums,
                     struct orl_frame *frame)
{
    for (int y = 0; y < p->height; y++)
        for (int x = 0; x < p->width; x++) {
            double d[3];
            direction_of(p, x, y, d);
            double z = orl_dot3(faces[number][2], d);
            if (!(z > 0.1))
                continue;
            double a = orl_dot3(faces[number][0], d) / z, b = orl_dot3(faces[number][1], d) / z;
            double weight = edge_weight(a) * edge_weight(b);
            if (!(weight > 0))
                continue;
            size_t at = (size_t)y * (size_t)p->width + (size_t)x;
            double u = camera->fx * a + camera->cx, v = camera->fy * b + camera->cy;
            add_taps(face, u, v, (float)weight, &sums[at]);
            if ((float)weight > sums[at].nearest && u >= 0 && v >= 0 && u < camera->width &&
                v < camera->height) {
                sums[at].nearest = (float)weight;
                take_surface(face, faces[number], u, v, z, at, frame);
            }
        }
}

static void divide(const struct panorama_sums *sums, struct orl_frame *frame)
{
    size_t pixels = (size_t)frame->color.width * (size_t)frame->color.height;
    for (size_t i = 0; i < pixels; i++) {
        float weight = sums[i].weight;
        if (!(weight > 0))
            continue;
        for (size_t c = 0; c < 3; c++)
            frame->color.f32[3 * i + c] = sums[i].color[c] / weight;
        frame->coverage.f32[i] = sums[i].coverage / weight;
        frame->confidence.f32[i] = sums[i].confidence / weight;
    }
}

static enum orl_result panorama_images(const struct orl_log *log, const struct orl_panorama *p,
                                       struct orl_frame *frame)
{
    struct orl_image *const images[] = {&frame->color, &frame->depth, &frame->normal,
                                        &frame->coverage, &frame->confidence};
    static const int channels[] = {3, 1, 3, 1, 1};
    for (size_t i = 0; i < ORL_COUNT(images); i++)
        ORL_TRY(orl_image_init(log, images[i], p->width, p->height, channels[i], ORL_PIXEL_F32));
    return ORL_OK;
}

enum orl_result orl_hdr_draw_panorama(struct orl_hdr *hdr, const struct orl_panorama *p,
                                      const bool *skip, struct orl_frame *frame)
{
    const struct orl_log *log = orl_gpu_log(hdr->gpu);
    double axes[3][3];
    memset(frame, 0, sizeof *frame);
    if (p->width < 8 || p->height < 8 || p->width > 32768 || p->height > 32768)
        return orl_fail(log, ORL_ERR_ARGUMENT, "a panorama of %dx%d: sides must be from 8 to 32768",
                        p->width, p->height);
    if (!panorama_axes(p, axes))
        return orl_fail(log, ORL_ERR_ARGUMENT, "the panorama's upward direction has no length");
    size_t pixels = (size_t)p->width * (size_t)p->height;
    struct panorama_sums *sums = orl_array(log, pixels, sizeof *sums);
    enum orl_result result = sums ? panorama_images(log, p, frame) : ORL_ERR_MEMORY;
    for (int i = 0; result == ORL_OK && i < FACES; i++) {
        struct orl_view view = face_view(p, (const double (*)[3])axes, i);
        struct orl_frame face;
        result = orl_hdr_draw(hdr, &view, skip, &face);
        if (result == ORL_OK)
            add_face(p, i, &face, &view.camera, sums, frame);
        orl_frame_finish(&face);
    }
    if (result == ORL_OK) {
        divide(sums, frame);
        result = orl_fill_around(log, &frame->color, &frame->confidence);
    }
    if (result != ORL_OK)
        orl_frame_finish(frame);
    free(sums);
    return result;
}
