// Reconstructs depth from points: compute splatting, then pull-push (Airieau 2012, 5.1).
#include "render/proxy/splats.h"

#include "core/memory.h"
#include "render/frame/frame.h"

static enum orl_result init(struct orl_gpu *gpu, const struct orl_scene *scene, size_t max_bytes, void *state)
{
    struct cloud *cloud = state;
    ORL_TRY(scene->lod ? orl_cloud_pages_init(gpu, scene->lod, max_bytes, cloud)
                       : orl_cloud_init(gpu, &scene->points, cloud));
    cloud->near = (float)scene->near_distance;
    return ORL_OK;
}

static void vertices(const void *state, const struct orl_scene *scene, const float (**out)[3],
                     size_t *count)
{
    (void)state;
    *out = (const float(*)[3])scene->points.position;
    *count = scene->points.count;
}

static void finish(struct orl_gpu *gpu, void *state)
{
    orl_cloud_finish(gpu, state);
}

// Number of pyramid levels, down to a size of one or two pixels. At least two, since level 0 is
// made together with level 1 and pushed from it.
static int pyramid_levels(int width, int height)
{
    int levels = 2;
    for (int side = width > height ? width : height; side > 2; side /= 2)
        levels++;
    return levels < PYRAMID_LEVELS_MAX ? levels : PYRAMID_LEVELS_MAX;
}

size_t orl_splats_target_bytes(const struct cloud *cloud, int width, int height)
{
    // Bytes per pixel: three words of splats, 8 bytes of level 0, two depths, a normal, and 24
    // bytes of the coarser levels; four more words if there are several chunks.
    size_t chunks = cloud->chunk_count < 2 ? 0 : 16;
    return (size_t)width * (size_t)height * (12 + 8 + 8 + 8 + 24 / 3 + chunks);
}

// Each level is half as large as the one before, rounded up. Loads outside read as empty.
static enum orl_result make_pyramid(struct orl_gpu *gpu, struct splat_target *t)
{
    int width = t->surface.width, height = t->surface.height, levels = pyramid_levels(width, height);
    for (int i = 1; i < levels; i++) {
        width = (width + 1) / 2;
        height = (height + 1) / 2;
        struct orl_tex_params params = {.width = width, .height = height, .format = GL_RGBA32F,
                                        .tag = "surfel pyramid"};
        ORL_TRY(orl_tex_create(gpu, &params, &t->surfel_a[i]));
        params.format = GL_RG32UI;
        ORL_TRY(orl_tex_create(gpu, &params, &t->surfel_b[i]));
    }
    return ORL_OK;
}

static enum orl_result make_target(struct orl_gpu *gpu, const void *state, void *memory)
{
    const struct cloud *cloud = state;
    struct splat_target *target = memory;
    const struct orl_tex_row rows[] = {
        {"splat depth", GL_R32UI, &target->splat_depth},
        {"splat index", GL_R32UI, &target->splat_index},
        {"splat layer", GL_R32UI, &target->splat_layer},
        {"splats", GL_RG32UI, &target->splats},
        {"pushed depth", GL_R32F, &target->pushed},
        {"splats of chunks", GL_RGBA32UI, &target->chunk_splats},
    };
    ORL_TRY(make_pyramid(gpu, target));
    return orl_tex_create_rows(gpu, target->surface.width, target->surface.height, rows,
                               ORL_COUNT(rows) - (cloud->chunk_count > 1 ? 0 : 1));
}

// params: NULL if nothing is drawn.
static struct splat_block splat_params(const struct cloud *cloud, const struct orl_view *view,
                                       const struct orl_render_params *params)
{
    struct splat_block block = {.view_size = {view->camera.width, view->camera.height},
                                .near = cloud->near};
    if (params) {
        block.splat_scale = params->splat_scale;
        block.front_layer = params->front_layer;
    }
    orl_set_pose(&view->cam_from_world, block.rotation, block.eye);
    orl_set_focal(&view->camera, block.focal);
    return block;
}

static void splat(struct orl_gpu *gpu, const struct cloud *cloud, struct splat_block *block,
                  struct splat_target *t)
{
    orl_tex_fill(t->splat_depth, UINT32_MAX);
    orl_tex_fill(t->splat_index, UINT32_MAX);
    orl_tex_fill(t->splat_layer, 0);
    orl_cloud_cull(gpu, cloud, block);
    struct orl_prog *const passes[] = {orl_prog_get(gpu, "proxy/splat_depth.comp", NULL, NULL),
                                       orl_prog_get(gpu, "proxy/splat_index.comp", NULL, NULL)};
    for (size_t pass = 0; pass < ORL_COUNT(passes); pass++)
        for (size_t i = 0; i < cloud->chunk_count; i++) {
            const struct point_chunk *chunk = &cloud->chunks[i];
            block->point_count = chunk->count;
            block->first_point = chunk->first;
            orl_gpu_dispatch(gpu, &(struct orl_dispatch){
                .prog = passes[pass], ORL_PARAMS(*block), .textures = {&chunk->blocks->texels},
                .images = {&chunk->points->texels, &chunk->list->texels, &chunk->args->texels, t->splat_depth,
                           t->splat_index, t->splat_layer},
                .indirect = chunk->args});
        }
}

// Makes levels 0 and 1. Level 0 goes into `depth` without normals, else into the target's splats.
static void resolve(struct orl_gpu *gpu, const struct cloud *cloud, struct splat_block *block,
                    const struct orl_tex *depth, bool normals, struct splat_target *t)
{
    bool chunks = cloud->chunk_count > 1;
    struct orl_prog *prog = orl_prog_get(gpu, "proxy/splat_resolve.comp", NULL,
                                         chunks ? normals ? "CHUNKS\nNORMALS" : "CHUNKS"
                                         : normals ? "NORMALS" : NULL);
    for (size_t i = 0; i < cloud->chunk_count; i++) {
        const struct point_chunk *chunk = &cloud->chunks[i];
        block->point_count = chunk->count;
        block->first_point = chunk->first;
        orl_gpu_dispatch(gpu, &(struct orl_dispatch){
            .prog = prog, ORL_PARAMS(*block), .textures = {&chunk->blocks->texels},
            .images = {&chunk->points->texels, t->splat_index, t->splat_layer,
                       normals ? t->splats : depth, t->surfel_a[1], t->surfel_b[1], t->chunk_splats},
            .size = {t->surfel_a[1]->params.width, t->surfel_a[1]->params.height}});
    }
}

static void set_level(struct pyramid_block *block, const struct orl_tex *written, int level)
{
    block->level_size[0] = written->params.width;
    block->level_size[1] = written->params.height;
    block->level_number = level;
}

static void pull(struct orl_gpu *gpu, struct pyramid_block *block,
                 struct splat_target *t, int level)
{
    const struct orl_tex *coarse = t->surfel_a[level];
    set_level(block, coarse, level);
    orl_gpu_dispatch(gpu, &(struct orl_dispatch){
        .prog = orl_prog_get(gpu, "proxy/pull.comp", NULL, NULL), ORL_PARAMS(*block),
        .images = {t->surfel_a[level - 1], t->surfel_b[level - 1], coarse, t->surfel_b[level]},
        .size = {coarse->params.width, coarse->params.height}});
}

// Pushes into `level` from the coarser one. Level 0 is written as `depth`, and as the normal if it is
// asked for.
static void push(struct orl_gpu *gpu, struct pyramid_block *block,
                 struct splat_target *t, int level, const struct orl_tex *depth, bool normals)
{
    const char *defines = level ? NULL : normals ? "LAST\nNORMALS" : "LAST";
    const struct orl_tex *written = level ? t->surfel_a[level] : t->splats;
    set_level(block, written, level);
    orl_gpu_dispatch(gpu, &(struct orl_dispatch){
        .prog = orl_prog_get(gpu, "proxy/push.comp", NULL, defines), ORL_PARAMS(*block),
        .images = {t->surfel_a[level + 1], t->surfel_b[level + 1], written,
                   level ? t->surfel_b[level] : depth, t->surface.normal},
        // One invocation handles one corner of the coarse level's pixels.
        .size = {block->level_size[0] / 2 + 1, block->level_size[1] / 2 + 1}});
}

static void drop_outliers(struct orl_gpu *gpu, struct pyramid_block *block, bool normals, struct splat_target *t)
{
    set_level(block, t->pushed, 0);
    orl_gpu_dispatch(gpu, &(struct orl_dispatch){
        .prog = orl_prog_get(gpu, "proxy/support.comp", NULL, normals ? "NORMALS" : NULL), ORL_PARAMS(*block),
        .images = {t->pushed, t->surface.depth, t->surface.normal},
        // One invocation handles 2x2 pixels.
        .size = {(t->surface.width + 1) / 2, (t->surface.height + 1) / 2}});
}

static void pull_push(struct orl_gpu *gpu, const struct orl_view *view, float front_layer,
                      const struct orl_tex *depth, bool normals, struct splat_target *t)
{
    struct pyramid_block block = {.front_layer = front_layer};
    const int levels = pyramid_levels(t->surface.width, t->surface.height);
    orl_set_focal(&view->camera, block.camera);
    for (int i = 2; i < levels; i++)
        pull(gpu, &block, t, i);
    for (int i = levels - 2; i >= 0; i--)
        push(gpu, &block, t, i, depth, normals);
    if (front_layer > 0)
        drop_outliers(gpu, &block, normals, t);
}

static enum orl_result bring(const void *state, const struct orl_view *view)
{
    const struct cloud *cloud = state;
    return cloud->pages ? orl_cloud_pages_choose(cloud, view) : ORL_OK;
}

static void draw(struct orl_gpu *gpu, const void *state, const struct orl_view *view,
                 const struct orl_render_params *params, bool normals, void *target)
{
    struct splat_target *t = target;
    struct splat_block block = splat_params(state, view, params);
    const struct orl_tex *depth = params->front_layer > 0 ? t->pushed : t->surface.depth;
    orl_pass_begin(gpu, "splat");
    splat(gpu, state, &block, t);
    orl_pass_end(gpu);
    orl_pass_begin(gpu, "pull-push");
    resolve(gpu, state, &block, depth, normals, t);
    pull_push(gpu, view, params->front_layer, depth, normals, t);
    orl_pass_end(gpu);
}

static enum orl_result bring_colors(struct orl_gpu *gpu, void *state)
{
    return orl_cloud_bring_colors(gpu, state);
}

static void color(struct orl_gpu *gpu, const void *state, const struct orl_view *view,
                  const void *target, const struct paint_into *into)
{
    const struct cloud *cloud = state;
    const struct splat_target *t = target;
    struct splat_block block = splat_params(cloud, view, NULL);
    const char *defines = !into->only_unpainted ? NULL : into->seeds ? "UNDER\nFINISHED" : "UNDER";
    for (size_t i = 0; i < cloud->chunk_count; i++) {
        const struct point_chunk *chunk = &cloud->chunks[i];
        block.point_count = chunk->count;
        block.first_point = chunk->first;
        orl_gpu_dispatch(gpu, &(struct orl_dispatch){
            .prog = orl_prog_get(gpu, "proxy/points_color.comp", NULL, defines), ORL_PARAMS(block),
            .images = {&chunk->colors->texels, t->splat_index, t->surface.normal, into->picture, into->seeds},
            // One invocation handles 2x2 pixels.
            .size = {(t->surface.width + 1) / 2, (t->surface.height + 1) / 2}});
    }
}

const struct orl_proxy_kind orl_proxy_splats = {
    .name = "splats", .state_size = sizeof(struct cloud), .init = init, .vertices = vertices, .finish = finish,
    .target_size = sizeof(struct splat_target), .make_target = make_target,
    .bring = bring, .draw = draw, .bring_colors = bring_colors, .color = color,
};
