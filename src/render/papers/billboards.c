// The painter of Goldluecke 2003: each voxel is a billboard with the pictures of two photographs,
// laid over those behind it.
#include "render/papers/billboards.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "core/memory.h"
#include "core/vec3.h"
#include "gpu/raster.h"
#include "render/frame/method.h"
#include "render/hull/voxels.h"
#include "render/paint/paint.h"
#include "render/photos/photos.h"

// --- two photographs for each voxel ---

void orl_rank_by_axis(const struct orl_scene *scene, const struct orl_view *view,
                      const size_t *photos, size_t count, struct orl_ranked *ranked)
{
    for (size_t i = 0; i < count; i++) {
        double across[3];
        const double *axis = view->cam_from_world.r[2];
        const double *other = scene->photos[photos[i]].view.cam_from_world.r[2];
        orl_cross3(axis, other, across);
        ranked[i] = (struct orl_ranked){atan2(sqrt(orl_dot3(across, across)), orl_dot3(axis, other)), photos[i]};
    }
    qsort(ranked, count, sizeof *ranked, orl_order_ranked);
}

static bool has(const uint32_t *set, size_t photo)
{
    return set[photo / 32] >> photo % 32 & 1;
}

// The places of the first two of `ranked` that are in the set; returns how many there are.
static int first_two(const struct orl_ranked *ranked, size_t count, const uint32_t *set, size_t found[2])
{
    int n = 0;
    for (size_t i = 0; i < count && n < 2; i++)
        if (has(set, ranked[i].index))
            found[n++] = i;
    return n;
}

bool orl_billboard_choose(const struct orl_ranked *ranked, size_t count, const uint32_t *seen,
                          size_t words, struct billboard *out)
{
    size_t found[2] = {0};
    int n = first_two(ranked, count, seen, found);
    if (!n) // no photograph sees all of it
        n = first_two(ranked, count, seen + words, found);
    if (!n)
        return false;
    double sum = n == 2 ? ranked[found[0]].key + ranked[found[1]].key : 0;
    out->photos = (uint32_t)found[0] | (uint32_t)found[1] << 16;
    out->second = sum > 0 ? (float)(1 - ranked[found[1]].key / sum) : 0;
    return true;
}

// --- from back to front ---

static int by_depth(const void *a, const void *b)
{
    const struct billboard *x = a, *y = b;
    if (x->centre[2] != y->centre[2])
        return x->centre[2] > y->centre[2] ? -1 : 1;
    return (x->voxel > y->voxel) - (x->voxel < y->voxel);
}

// Fills `out` with the billboards before the view that photographs see; returns their number.
static size_t list(const struct frame *frame, const struct voxel_state *state,
                   const struct orl_ranked *ranked, size_t count, struct billboard *out)
{
    double least = 0.5 * orl_billboard_width(state);
    size_t n = 0;
    for (size_t i = 0; i < state->voxels.count; i++) {
        double world[3], p[3];
        for (int k = 0; k < 3; k++)
            world[k] = (double)state->voxels.centre[i][k];
        orl_pose_apply(&frame->view->cam_from_world, world, p);
        if (!(p[2] > least) || !orl_billboard_choose(ranked, count,
                                                     state->seen + 2 * state->words * i,
                                                     state->words, &out[n]))
            continue;
        for (int k = 0; k < 3; k++)
            out[n].centre[k] = (float)p[k];
        out[n++].voxel = (uint32_t)i;
    }
    qsort(out, n, sizeof *out, by_depth);
    return n;
}

// --- the painter ---

static struct orl_prog *program(const struct frame *frame)
{
    char defines[64];
    snprintf(defines, sizeof defines, "PAINTED 1\n%s%s", frame->radiance ? "RADIANCE 1\n" : "",
             frame->reads_chroma ? "CHROMA 1\n" : "");
    char *text = orl_format(orl_gpu_log(frame->gpu), "%s\n%s", frame->paint->gather.options, defines);
    struct orl_prog *prog =
        text ? orl_prog_get_raster(frame->gpu, "hull/billboard.vert", "hull/billboard.frag", text)
             : NULL;
    free(text);
    return prog;
}

static void draw(const struct frame *frame, const struct voxel_state *state,
                 const struct orl_buf *billboards, size_t count)
{
    struct gather_block block = orl_gather_prepare(frame, 0, frame->chosen_count);
    block.billboard_half = (float)(0.5 * orl_billboard_width(state));
    const size_t stride = sizeof(struct billboard);
    const struct orl_raster raster = {
        .prog = program(frame), ORL_PARAMS(block),
        .inputs = {{billboards, offsetof(struct billboard, centre), stride, 3, GL_FLOAT, true},
                   {billboards, offsetof(struct billboard, photos), stride, 1, GL_UNSIGNED_INT,
                    true},
                   {billboards, offsetof(struct billboard, second), stride, 1, GL_FLOAT, true}},
        .count = 6, .instances = count, .over = true,
        .textures = {frame->photos->color, NULL, frame->photos->mask,
                     [ORL_PHOTO_CHROMA] = frame->photos->chroma},
        .images = {[PHOTO_ROWS] = &frame->paint->gather.photos->texels},
        .targets = {frame->picture}};
    if (count)
        orl_gpu_raster(frame->gpu, &raster);
}

// Leaves the first `count` of `ranked` chosen, in that order.
static void choose(struct frame *frame, const struct orl_ranked *ranked, size_t count)
{
    frame->chosen_count = count;
    for (size_t i = 0; i < count; i++)
        frame->chosen[i] = ranked[i].index;
}

// For a progressive frame: leaves those chosen that are on the device with their masks. A frame
// reads one mask: the others come with later frames.
static enum orl_result bring(struct frame *frame, struct orl_ranked *ranked)
{
    size_t kept = 0;
    bool has_read = false;
    ORL_TRY(orl_progressive_admit(frame, false));
    orl_rank_by_axis(frame->scene, frame->view, frame->chosen, frame->chosen_count, ranked);
    for (size_t i = 0; i < frame->chosen_count; i++) {
        bool there = frame->photos->states[ranked[i].index].has_mask;
        if (there || !has_read) {
            ORL_TRY(orl_photos_require_mask(frame, ranked[i].index));
            has_read = has_read || !there;
            ranked[kept++] = ranked[i];
        } else {
            frame->progressive->missing++;
        }
    }
    choose(frame, ranked, kept);
    return ORL_OK;
}

// Brings the photographs nearest by angle to the device, as many as fit, and leaves only these
// chosen. ranked: as orl_rank_by_axis.
static enum orl_result require(struct frame *frame, struct orl_ranked *ranked)
{
    size_t most = (size_t)frame->photos->slot_count;
    choose(frame, ranked, frame->chosen_count < most ? frame->chosen_count : most);
    if (frame->progressive)
        return bring(frame, ranked);
    for (size_t i = 0; i < frame->chosen_count; i++) {
        ORL_TRY(orl_photos_require(frame, ranked[i].index, false));
        ORL_TRY(orl_photos_require_mask(frame, ranked[i].index));
    }
    return ORL_OK;
}

static enum orl_result paint(struct frame *frame)
{
    const struct orl_log *log = orl_gpu_log(frame->gpu);
    struct voxel_state *state = frame->proxy->state;
    struct orl_buf *buf = NULL;
    struct orl_ranked *ranked = orl_array(log, frame->scene->photo_count, sizeof *ranked);
    struct billboard *all = orl_array(log, state->voxels.count, sizeof *all);
    orl_gather_clear(frame);
    enum orl_result result = ranked && all ? orl_select_all.choose(frame) : ORL_ERR_MEMORY;
    if (result == ORL_OK) {
        orl_rank_by_axis(frame->scene, frame->view, frame->chosen, frame->chosen_count, ranked);
        result = require(frame, ranked);
    }
    ORL_THEN(result, orl_voxels_see(frame, state));
    if (result != ORL_OK)
        goto end;
    orl_pass_begin(frame->gpu, "billboards");
    size_t drawn = list(frame, state, ranked, frame->chosen_count, all);
    result = orl_buf_create(frame->gpu, ORL_OWNER_FRAME, "billboards",
                            (drawn ? drawn : 1) * sizeof *all, all, 0, &buf);
    if (result == ORL_OK)
        draw(frame, state, buf, drawn);
    orl_pass_end(frame->gpu);
    orl_buf_destroy(frame->gpu, &buf);
end:
    free(ranked);
    free(all);
    return result;
}

const struct orl_painter orl_paint_billboards = {
    .name = "billboards", .needs = "proxy=voxels", .layers = true, .paint = paint};
