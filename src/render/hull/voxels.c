// Voxels from silhouettes, carved on the device, and from points.
#include "render/hull/voxels.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

#include "core/memory.h"
#include "render/photos/photos.h"
#include "render/proxy/proxy.h"
#include "shared/hull_blocks.h"

// Whether this photograph's silhouette takes part in the hull of this frame.
static bool has_silhouette(const struct frame *frame, size_t photo)
{
    return frame->scene->photos[photo].masked && orl_frame_may_use(frame, photo);
}

enum orl_result orl_voxels_silhouettes(const struct frame *frame, size_t **photos, size_t *count)
{
    *count = 0;
    *photos = orl_array(orl_gpu_log(frame->gpu), frame->scene->photo_count, sizeof **photos);
    ORL_TRY_MEMORY(*photos);
    for (size_t i = 0; i < frame->scene->photo_count; i++)
        if (has_silhouette(frame, i))
            (*photos)[(*count)++] = i;
    return ORL_OK;
}

int orl_voxels_side(const struct frame *frame)
{
    return (int)(frame->params->hull_side + 0.5f);
}

uint64_t orl_voxels_key(const struct frame *frame)
{
    const int side = orl_voxels_side(frame);
    uint64_t key = XXH3_64bits(&side, sizeof side);
    for (size_t i = 0; i < frame->scene->photo_count; i++) {
        const int64_t silhouette[2] = {(int64_t)i, frame->scene->frame};
        if (has_silhouette(frame, i))
            key = XXH3_64bits_withSeed(silhouette, sizeof silhouette, key);
    }
    return key;
}

void orl_voxels_finish(struct voxels *voxels)
{
    free(voxels->field);
    free(voxels->centre);
    memset(voxels, 0, sizeof *voxels);
}

// --- the surface ---

static bool stays(const struct voxels *v, size_t x, size_t y, size_t z)
{
    size_t side = (size_t)v->cube.side;
    if (x >= side || y >= side || z >= side) // size_t: below 0 too
        return false;
    return v->field[x + side * (y + side * z)] <= 0;
}

static bool at_surface(const struct voxels *v, size_t x, size_t y, size_t z)
{
    return stays(v, x, y, z) &&
           !(stays(v, x - 1, y, z) && stays(v, x + 1, y, z) && stays(v, x, y - 1, z) &&
             stays(v, x, y + 1, z) && stays(v, x, y, z - 1) && stays(v, x, y, z + 1));
}

enum orl_result orl_voxels_list(const struct orl_log *log, struct voxels *v)
{
    size_t side = (size_t)v->cube.side, capacity = 0;
    for (size_t z = 0; z < side; z++)
        for (size_t y = 0; y < side; y++)
            for (size_t x = 0; x < side; x++) {
                if (!at_surface(v, x, y, z))
                    continue;
                ORL_TRY(ORL_GROW(log, v->centre, capacity, v->count));
                const double at[3] = {(double)x + 0.5, (double)y + 0.5, (double)z + 0.5};
                for (int k = 0; k < 3; k++)
                    v->centre[v->count][k] = (float)(v->cube.origin[k] + v->cube.voxel * at[k]);
                v->count++;
            }
    return ORL_OK;
}

// --- from silhouettes ---

static struct carve_block carve_params(const struct cone *cone, const struct orl_hull *cube)
{
    const struct orl_view *view = &cone->view;
    double origin[3];
    struct carve_block block = {.size = {view->camera.width, view->camera.height}, .side = cube->side,
                                .open = cone->open, .most = (float)(ORL_CONES_MAX * cube->voxel)};
    orl_set_focal(&view->camera, block.focal);
    orl_pose_apply(&view->cam_from_world, cube->origin, origin);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            block.camera_from_voxels[i][j] = (float)(view->cam_from_world.r[i][j] * cube->voxel);
        block.camera_from_voxels[i][3] = (float)origin[i];
    }
    return block;
}

static enum orl_result carve_one(struct orl_gpu *gpu, const struct cone *cone,
                                 const struct carve_block *block, struct orl_buf *field)
{
    struct orl_tex *tex = NULL;
    const struct orl_tex_params params = {.width = cone->distance.width,
                                          .height = cone->distance.height, .format = GL_R32F,
                                          .linear = true, .tag = "silhouette"};
    ORL_TRY(orl_tex_create(gpu, &params, &tex));
    orl_tex_write(tex, GL_RED, GL_FLOAT, cone->distance.data);
    orl_gpu_dispatch(gpu, &(struct orl_dispatch){
        .prog = orl_prog_get(gpu, "hull/carve.comp", NULL, NULL), ORL_PARAMS(*block),
        .bufs = {field}, .textures = {tex}, .size = {block->side * block->side, block->side}});
    orl_tex_destroy(gpu, &tex);
    return ORL_OK;
}

enum orl_result orl_cones_carve(struct orl_gpu *gpu, const struct cones *cones,
                                struct orl_buf **field)
{
    const float unlimited = -INFINITY; // no silhouette has limited a voxel yet
    size_t voxels = orl_hull_voxels(&cones->cube);
    uint32_t word;
    *field = NULL;
    ORL_TRY(orl_buf_create(gpu, ORL_OWNER_FRAME, "voxels", voxels * sizeof(float), NULL, 0, field));
    memcpy(&word, &unlimited, sizeof word);
    orl_buf_fill(*field, word);
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < cones->count; i++) {
        struct carve_block block = carve_params(&cones->all[i], &cones->cube);
        result = carve_one(gpu, &cones->all[i], &block, *field);
    }
    if (result != ORL_OK)
        orl_buf_destroy(gpu, field);
    return result;
}

enum orl_result orl_voxels_read(const struct orl_log *log, const struct cones *cones,
                                const struct orl_buf *field, struct voxels *voxels)
{
    size_t count = orl_hull_voxels(&cones->cube);
    *voxels = (struct voxels){.cube = cones->cube, .field = orl_array(log, count, sizeof *voxels->field)};
    ORL_TRY_MEMORY(voxels->field);
    orl_buf_read(field, count * sizeof *voxels->field, voxels->field);
    return ORL_OK;
}

// --- from points ---

// A cube around all points but the outermost hundredth along each axis.
static enum orl_result bound_points(const struct orl_log *log, const struct orl_points *points,
                                    struct orl_hull *cube)
{
    double low[3] = {0}, high[3] = {0}, size = 0;
    ORL_TRY(orl_vertices_range(log, (const float (*)[3])points->position, points->count, 0.01, low, high));
    for (int k = 0; k < 3; k++)
        size = fmax(size, high[k] - low[k]);
    size = size > 0 ? 1.05 * size : 1;
    cube->voxel = size / cube->side;
    for (int k = 0; k < 3; k++)
        cube->origin[k] = 0.5 * (low[k] + high[k] - size);
    return ORL_OK;
}

enum orl_result orl_voxels_fill(const struct orl_log *log, const struct orl_points *points,
                                int side, struct voxels *voxels)
{
    *voxels = (struct voxels){.cube.side = side};
    enum orl_result result = bound_points(log, points, &voxels->cube);
    size_t count = orl_hull_voxels(&voxels->cube), index;
    float voxel = (float)voxels->cube.voxel;
    if (result == ORL_OK)
        voxels->field = orl_array(log, count, sizeof *voxels->field);
    if (result == ORL_OK && !voxels->field)
        result = ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < count; i++)
        voxels->field[i] = voxel;
    for (size_t i = 0; result == ORL_OK && i < points->count; i++)
        if (orl_hull_find(&voxels->cube, points->position[i], &index))
            voxels->field[index] = -voxel;
    ORL_THEN(result, orl_voxels_list(log, voxels));
    if (result != ORL_OK)
        orl_voxels_finish(voxels);
    return result;
}

// --- of a frame ---

enum orl_result orl_cones_read(const struct orl_log *log, const struct orl_scene *scene, const size_t *photos,
                               size_t count, int side, struct orl_image *masks, struct cones *cones)
{
    struct orl_silhouette *all = orl_array(log, count, sizeof *all);
    enum orl_result result = all ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < count; i++) {
        result = orl_photo_mask_read(log, scene, photos[i], &masks[photos[i]]);
        all[i] = (struct orl_silhouette){scene->photos[photos[i]].view, masks[photos[i]]};
    }
    ORL_THEN(result, orl_cones_make(log, all, count, side, cones));
    free(all);
    return result;
}

// From the silhouettes of these photographs.
static enum orl_result carve(const struct frame *frame, const size_t *photos, size_t count, struct voxels *voxels)
{
    const struct orl_log *log = orl_gpu_log(frame->gpu);
    struct orl_image *masks = orl_array(log, frame->scene->photo_count, sizeof *masks);
    struct cones cones = {0};
    struct orl_buf *field = NULL;
    ORL_TRY_MEMORY(masks);
    enum orl_result result = orl_cones_read(log, frame->scene, photos, count, orl_voxels_side(frame), masks, &cones);
    ORL_THEN(result, orl_cones_carve(frame->gpu, &cones, &field));
    ORL_THEN(result, orl_voxels_read(log, &cones, field, voxels));
    ORL_THEN(result, orl_voxels_list(log, voxels));
    for (size_t i = 0; i < count; i++)
        orl_image_finish(&masks[photos[i]]);
    free(masks);
    orl_buf_destroy(frame->gpu, &field);
    orl_cones_finish(&cones);
    if (result != ORL_OK)
        orl_voxels_finish(voxels);
    return result;
}

enum orl_result orl_voxels_make(const struct frame *frame, bool hull, struct voxels *voxels)
{
    const struct orl_log *log = orl_gpu_log(frame->gpu);
    const struct orl_scene *scene = frame->scene;
    size_t *photos, count;
    memset(voxels, 0, sizeof *voxels);
    enum orl_result result = orl_voxels_silhouettes(frame, &photos, &count);
    if (result == ORL_OK && count)
        result = carve(frame, photos, count, voxels);
    else if (result == ORL_OK && hull)
        result = orl_fail(log, ORL_ERR_NOT_FOUND, "%s: no silhouettes to make a hull of; see oriel import", scene->dir);
    else if (result == ORL_OK && scene->points.count)
        result = orl_voxels_fill(log, &scene->points, orl_voxels_side(frame), voxels);
    else if (result == ORL_OK)
        result = orl_fail(log, ORL_ERR_NOT_FOUND, "%s has neither silhouettes nor points to make "
                          "voxels of; see oriel import", scene->dir);
    free(photos);
    return result;
}
