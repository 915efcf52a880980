// How right and how complete a cloud of a synthetic monument is.
//     cloud_truth WORKSPACE CLOUD.ply TRUTH
// The workspace's cameras say how its frame lies in that of the truth (a similarity).
// Prints: points, share within 1 % of depth of a true surface, share off all of them by
// more than 5 %, share of the true surface's pixels that have a point within 1 %.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "scene/colmap.h"
#include "oriel/points.h"

struct similarity { // x_truth = scale * rotation * x + offset
    double scale, rotation[3][3], offset[3];
};

static const struct orl_colmap_image *find(const struct orl_colmap_model *model, const char *name)
{
    for (size_t i = 0; i < model->image_count; i++)
        if (strcmp(model->images[i].name, name) == 0)
            return &model->images[i];
    return NULL;
}

// Rotation as the mean of each camera's, scale and offset from the centres.
static bool align(const struct orl_colmap_model *from, const struct orl_colmap_model *to,
                  struct similarity *s)
{
    double q[4] = {0}, mean[2][3] = {{0}}, spread[2] = {0};
    size_t count = 0;
    for (int pass = 0; pass < 2; pass++)
        for (size_t i = 0; i < from->image_count; i++) {
            const struct orl_colmap_image *b = find(to, from->images[i].name);
            const struct orl_pose *poses[2] = {&from->images[i].cam_from_world,
                                               b ? &b->cam_from_world : NULL};
            if (!b)
                continue;
            for (int side = 0; side < 2; side++) {
                double centre[3];
                orl_pose_centre(poses[side], centre);
                for (int k = 0; k < 3; k++)
                    if (pass == 0)
                        mean[side][k] += centre[k];
                    else
                        spread[side] += pow(centre[k] - mean[side][k] / (double)count, 2);
            }
            if (pass == 1)
                continue;
            struct orl_pose turn = {.t = {0}};
            double part[4], sign = 0;
            for (int r = 0; r < 3; r++)
                for (int c = 0; c < 3; c++)
                    for (int k = 0; k < 3; k++)
                        turn.r[r][c] += poses[1]->r[k][r] * poses[0]->r[k][c];
            orl_pose_to_quat(&turn, part);
            for (int k = 0; k < 4; k++)
                sign += part[k] * q[k];
            for (int k = 0; k < 4; k++)
                q[k] += sign < 0 ? -part[k] : part[k];
            count++;
        }
    struct orl_pose mean_turn;
    static const double none[3] = {0};
    if (count < 3 || !(spread[0] > 0) || !orl_pose_from_quat(q, none, &mean_turn))
        return false;
    memcpy(s->rotation, mean_turn.r, sizeof s->rotation);
    s->scale = sqrt(spread[1] / spread[0]);
    for (int r = 0; r < 3; r++) {
        double turned = 0;
        for (int k = 0; k < 3; k++)
            turned += s->rotation[r][k] * mean[0][k] / (double)count;
        s->offset[r] = mean[1][r] / (double)count - s->scale * turned;
    }
    return true;
}

static void move_points(const struct similarity *s, struct orl_points *points)
{
    for (size_t i = 0; i < points->count; i++) {
        float p[3];
        memcpy(p, points->position[i], sizeof p);
        for (int r = 0; r < 3; r++) {
            double sum = 0;
            for (int k = 0; k < 3; k++)
                sum += s->rotation[r][k] * (double)p[k];
            points->position[i][r] = (float)(s->scale * sum + s->offset[r]);
        }
    }
}

// Lowers least[i] to each point's relative error in this view, and counts true pixels and
// those with a right point within a pixel.
static void compare_view(const struct orl_view *view, const struct orl_image *depth,
                         const struct orl_points *points, float *least, bool *found,
                         size_t *surface, size_t *covered)
{
    int width = depth->width, height = depth->height;
    memset(found, 0, (size_t)width * (size_t)height * sizeof *found);
    for (size_t i = 0; i < points->count; i++) {
        const double world[3] = {(double)points->position[i][0], (double)points->position[i][1],
                                 (double)points->position[i][2]};
        double pixel[2], z;
        if (!orl_view_project(view, world, pixel, &z) || !(pixel[0] >= 0 && pixel[0] < width) ||
            !(pixel[1] >= 0 && pixel[1] < height))
            continue;
        int x = (int)pixel[0], y = (int)pixel[1];
        double truth = (double)depth->f32[(size_t)y * (size_t)width + (size_t)x];
        if (truth > 0)
            least[i] = fminf(least[i], (float)(fabs(z - truth) / truth));
        for (int k = 0; truth > 0 && k < 9; k++) {
            int u = x + k % 3 - 1, v = y + k / 3 - 1;
            if (u < 0 || v < 0 || u >= width || v >= height)
                continue;
            size_t at = (size_t)v * (size_t)width + (size_t)u;
            double near = (double)depth->f32[at];
            found[at] = found[at] || (near > 0 && fabs(z - near) < 0.01 * near);
        }
    }
    for (size_t i = 0; i < (size_t)width * (size_t)height; i++) {
        *surface += depth->f32[i] > 0;
        *covered += found[i];
    }
}

static enum orl_result compare(const struct orl_log *log, const char *truth_dir,
                               const struct orl_colmap_model *truth,
                               const struct orl_points *points)
{
    size_t surface = 0, covered = 0, right = 0, stray = 0, seen = 0;
    float *least = orl_array(log, points->count, sizeof *least);
    enum orl_result result = least ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t i = 0; least && i < points->count; i++)
        least[i] = INFINITY;
    for (size_t i = 0; result == ORL_OK && i < truth->image_count; i++) {
        const struct orl_colmap_image *image = &truth->images[i];
        const struct orl_view view = {orl_colmap_camera_by_id(truth, image->camera_id)->pinhole,
                                      image->cam_from_world};
        struct orl_image depth = {0};
        char *path = orl_format(log, "%s/stereo/depth_maps/%s.geometric.bin", truth_dir,
                                image->name);
        result = path ? orl_colmap_map_read(log, path, &depth) : ORL_ERR_MEMORY;
        bool *found = result == ORL_OK
                          ? orl_array(log, (size_t)depth.width * (size_t)depth.height, sizeof *found)
                          : NULL;
        if (found)
            compare_view(&view, &depth, points, least, found, &surface, &covered);
        else if (result == ORL_OK)
            result = ORL_ERR_MEMORY;
        free(found);
        orl_image_finish(&depth);
        free(path);
    }
    for (size_t i = 0; result == ORL_OK && i < points->count; i++) {
        seen += isfinite(least[i]);
        right += least[i] < 0.01f;
        stray += isfinite(least[i]) && least[i] > 0.05f;
    }
    if (result == ORL_OK)
        printf("points %zu right %.4f stray %.4f complete %.4f\n", points->count,
               seen ? (double)right / (double)seen : 0, seen ? (double)stray / (double)seen : 0,
               surface ? (double)covered / (double)surface : 0);
    free(least);
    return result;
}

int main(int argc, char **argv)
{
    const struct orl_log log = orl_log_stderr(ORL_LOG_WARNING);
    struct orl_colmap_model model = {0}, truth = {0};
    struct orl_points points = {0};
    struct similarity similarity = {0};
    if (argc != 4) {
        fprintf(stderr, "usage: cloud_truth WORKSPACE CLOUD.ply TRUTH\n");
        return 2;
    }
    char *sparse = orl_path_join(&log, argv[1], "sparse");
    char *true_sparse = orl_path_join(&log, argv[3], "sparse");
    enum orl_result result = sparse && true_sparse ? ORL_OK : ORL_ERR_MEMORY;
    if (result == ORL_OK)
        result = orl_colmap_read(&log, sparse, &model);
    if (result == ORL_OK)
        result = orl_colmap_read(&log, true_sparse, &truth);
    if (result == ORL_OK)
        result = orl_points_read(&log, argv[2], NULL, &points);
    if (result == ORL_OK && !align(&model, &truth, &similarity))
        result = orl_fail(&log, ORL_ERR_DATA, "%s and %s share fewer than three cameras", argv[1],
                          argv[3]);
    if (result == ORL_OK) {
        move_points(&similarity, &points);
        result = compare(&log, argv[3], &truth, &points);
    }
    orl_points_finish(&points);
    orl_colmap_finish(&model);
    orl_colmap_finish(&truth);
    free(sparse);
    free(true_sparse);
    return result == ORL_OK ? 0 : 1;
}
