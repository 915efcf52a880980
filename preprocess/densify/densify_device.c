// One photograph's depth and normals on the device.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "preprocess/densify/densify_internal.h"

enum {
    BAND_PIXELS = 1 << 17, // of one dispatch: short enough for the driver's watchdog
    VIEWS_COARSE = 8,      // sources judged at the coarsest level
    VIEWS_FINE = 3,        // sources judged at the other levels
    RANDOM_TRIES = 6,
};

// Greatest matching costs of depths that are kept: without, and with, other photographs' depths
// that confirm them.
static const float COST_MATCHED = 0.7f, COST_AGREED = 0.9f;

enum program {
    INIT_RANDOM,
    INIT_COARSE,
    INIT_FINE,
    SWEEP_FINE,
    INIT_MAPS,
    SWEEP,
    SWEEP_GEOMETRIC,
    FIT,
    FINISH_MATCHED,
    FINISH_AGREED,
    FINISH_LAST,
    PROGRAM_COUNT
};
static const struct {
    const char *file, *defines;
} program_table[PROGRAM_COUNT] = {
    [INIT_RANDOM] = {"densify/init.comp", "FROM_RANDOM"},
    [INIT_COARSE] = {"densify/init.comp", "FROM_COARSE"},
    [INIT_FINE] = {"densify/init.comp", "FROM_COARSE"},
    [SWEEP_FINE] = {"densify/sweep.comp", ""},
    [INIT_MAPS] = {"densify/init.comp", "FROM_MAPS\nGEOMETRIC"},
    [SWEEP] = {"densify/sweep.comp", ""},
    [SWEEP_GEOMETRIC] = {"densify/sweep.comp", "GEOMETRIC"},
    [FIT] = {"densify/fit.comp", ""},
    [FINISH_MATCHED] = {"densify/finish.comp", ""},
    [FINISH_AGREED] = {"densify/finish.comp", "GEOMETRIC"},
    [FINISH_LAST] = {"densify/finish.comp", "GEOMETRIC\nSMOOTH"},
};

// The state of one level.
struct level {
    struct orl_tex *reference, *sources, *source_depths, *planes, *costs, *view_costs;
    struct orl_tex *extra; // the first planes are made from this texture
    struct densify_block block;
    int number; // 0 = full size
};

static void level_finish(struct orl_gpu *gpu, struct level *level)
{
    orl_tex_destroy(gpu, &level->reference);
    orl_tex_destroy(gpu, &level->sources);
    orl_tex_destroy(gpu, &level->source_depths);
    orl_tex_destroy(gpu, &level->planes);
    orl_tex_destroy(gpu, &level->costs);
    orl_tex_destroy(gpu, &level->view_costs);
    orl_tex_destroy(gpu, &level->extra);
}

static int half(int value)
{
    return value > 1 ? value / 2 : 1;
}

static struct orl_prog *program_of(const struct densify_job *job, enum program which)
{
    char defines[256];
    const struct orl_densify_params *p = job->params;
    // Coarser levels have found the rough shape, and agreement with other photographs holds planes
    // in place. Patches may therefore be small, so that a patch lies on one surface up to a pixel
    // or two from its edge.
    bool fine = which == INIT_FINE || which == SWEEP_FINE;
    bool small = which == INIT_MAPS || which == SWEEP_GEOMETRIC || which == FINISH_AGREED ||
                 which == FINISH_LAST;
    int radius = fine ? (p->window_radius + 1) / 2 : p->window_radius;
    snprintf(defines, sizeof defines, "RADIUS %d\nSTEP %d\nSOURCES %d\nPADDING %d\n%s",
             small ? half(p->window_radius) : radius,
             small ? half(p->window_step) : p->window_step, p->sources, orl_densify_padding(p),
             program_table[which].defines);
    return orl_prog_get(job->gpu, program_table[which].file, NULL, defines);
}

// --- upload ---

bool orl_densify_mask_at(const struct orl_image *mask, int level, int x, int y)
{
    if (!mask->data)
        return true;
    int size = 1 << level;
    for (int j = y * size; j < (y + 1) * size; j++)
        for (int i = x * size; i < (x + 1) * size; i++)
            if (mask->u8[(size_t)j * (size_t)mask->width + (size_t)i])
                return true;
    return false;
}

static enum orl_result upload_reference(const struct densify_job *job, struct level *level)
{
    const struct orl_image *luma = &job->reference->levels[level->number];
    struct orl_tex_params params = {.width = luma->width, .height = luma->height,
                                    .format = GL_RG8, .tag = "densify reference"};
    ORL_TRY(orl_tex_create(job->gpu, &params, &level->reference));
    size_t count = (size_t)luma->width * (size_t)luma->height;
    uint8_t *pixels = orl_array(orl_gpu_log(job->gpu), count, 2);
    ORL_TRY_MEMORY(pixels);
    for (size_t i = 0; i < count; i++) {
        int x = (int)(i % (size_t)luma->width), y = (int)(i / (size_t)luma->width);
        pixels[2 * i] = luma->u8[i];
        pixels[2 * i + 1] = orl_densify_mask_at(&job->mask, level->number, x, y) ? 255 : 0;
    }
    orl_tex_write(level->reference, GL_RG, GL_UNSIGNED_BYTE, pixels);
    free(pixels);
    return ORL_OK;
}

static int source_level(const struct densify_job *job, int source, int level)
{
    int wanted = level + job->plan->sources[source].finer;
    int most = job->sources[source]->count - 1;
    return wanted < most ? wanted : most;
}

static int clamp_int(int value, int low, int high)
{
    return value < low ? low : value > high ? high : value;
}

// Each texel holds its 2x2 neighbourhood. Edge pixels are repeated into the padding.
static void pack_quads(const struct orl_image *luma, int padding, uint32_t *quads)
{
    int width = luma->width + 2 * padding, height = luma->height + 2 * padding;
    for (int y = 0; y < height; y++) {
        int y0 = clamp_int(y - padding, 0, luma->height - 1);
        int y1 = clamp_int(y + 1 - padding, 0, luma->height - 1);
        const uint8_t *row0 = luma->u8 + (size_t)y0 * (size_t)luma->width;
        const uint8_t *row1 = luma->u8 + (size_t)y1 * (size_t)luma->width;
        for (int x = 0; x < width; x++) {
            int x0 = clamp_int(x - padding, 0, luma->width - 1);
            int x1 = clamp_int(x + 1 - padding, 0, luma->width - 1);
            *quads++ = (uint32_t)row0[x0] | (uint32_t)row0[x1] << 8 | (uint32_t)row1[x0] << 16 |
                       (uint32_t)row1[x1] << 24;
        }
    }
}

static enum orl_result upload_sources(const struct densify_job *job, struct level *level)
{
    int count = job->plan->count, pad = orl_densify_padding(job->params);
    struct orl_tex_params params = {.layers = count, .format = GL_R32UI,
                                    .tag = "densify sources"};
    for (int k = 0; k < count; k++) {
        const struct orl_image *luma =
            &job->sources[k]->levels[source_level(job, k, level->number)];
        params.width = luma->width + 2 * pad > params.width ? luma->width + 2 * pad : params.width;
        params.height =
            luma->height + 2 * pad > params.height ? luma->height + 2 * pad : params.height;
    }
    ORL_TRY(orl_tex_create(job->gpu, &params, &level->sources));
    uint32_t *quads = orl_array(orl_gpu_log(job->gpu),
                                (size_t)params.width * (size_t)params.height, sizeof *quads);
    ORL_TRY_MEMORY(quads);
    for (int k = 0; k < count; k++) {
        const struct orl_image *luma =
            &job->sources[k]->levels[source_level(job, k, level->number)];
        pack_quads(luma, pad, quads);
        orl_tex_write_layer(level->sources, k, luma->width + 2 * pad, luma->height + 2 * pad,
                            GL_RED_INTEGER, GL_UNSIGNED_INT, quads);
    }
    free(quads);
    return ORL_OK;
}

static enum orl_result upload_source_depths(const struct densify_job *job, struct level *level)
{
    struct orl_tex_params params = {.layers = job->plan->count, .format = GL_R32F,
                                    .tag = "densify source depths"};
    for (int k = 0; k < job->plan->count; k++) {
        const struct orl_image *depth = &job->source_depths[k];
        params.width = depth->width > params.width ? depth->width : params.width;
        params.height = depth->height > params.height ? depth->height : params.height;
    }
    ORL_TRY(orl_tex_create(job->gpu, &params, &level->source_depths));
    float *inverse = orl_array(orl_gpu_log(job->gpu), (size_t)params.width * (size_t)params.height,
                               sizeof *inverse);
    ORL_TRY_MEMORY(inverse);
    for (int k = 0; k < job->plan->count; k++) {
        const struct orl_image *depth = &job->source_depths[k];
        size_t count = (size_t)depth->width * (size_t)depth->height;
        for (size_t i = 0; i < count; i++)
            inverse[i] = depth->f32[i] > 0.0f ? 1.0f / depth->f32[i] : 0.0f;
        orl_tex_write_layer(level->source_depths, k, depth->width, depth->height, GL_RED,
                            GL_FLOAT, inverse);
    }
    free(inverse);
    return ORL_OK;
}

static enum orl_result upload_start(const struct densify_job *job, struct level *level)
{
    const struct orl_image *depth = &job->start->depth, *normal = &job->start->normal;
    struct orl_tex_params params = {.width = depth->width, .height = depth->height,
                                    .format = GL_RGBA32F, .tag = "densify start"};
    ORL_TRY(orl_tex_create(job->gpu, &params, &level->extra));
    size_t count = (size_t)depth->width * (size_t)depth->height;
    float *pixels = orl_array(orl_gpu_log(job->gpu), count, 4 * sizeof *pixels);
    ORL_TRY_MEMORY(pixels);
    for (size_t i = 0; i < count; i++) {
        memcpy(&pixels[4 * i], &normal->f32[3 * i], 3 * sizeof *pixels);
        pixels[4 * i + 3] = depth->f32[i];
    }
    orl_tex_write(level->extra, GL_RGBA, GL_FLOAT, pixels);
    free(pixels);
    return ORL_OK;
}

static enum orl_result upload_seeds(const struct densify_job *job, struct level *level)
{
    struct orl_tex_params params = {.width = job->seeds.width, .height = job->seeds.height,
                                    .format = GL_R32F, .tag = "densify seeds"};
    ORL_TRY(orl_tex_create(job->gpu, &params, &level->extra));
    orl_tex_write(level->extra, GL_RED, GL_FLOAT, job->seeds.f32);
    return ORL_OK;
}

// --- parameters ---

// Pixels by which matches move per unit of inverse depth at the image centre, averaged over the
// sources.
static double parallax(const struct densify_job *job, const struct orl_camera *camera,
                       const struct densify_block *block)
{
    double sum = 0.0, total = 0.0;
    for (int k = 0; k < job->plan->count; k++) {
        double c[3], q[4] = {0.5 * camera->width, 0.5 * camera->height, 1.0, job->plan->w_typical};
        for (int i = 0; i < 3; i++) {
            const float *row = block->forward[3 * k + i];
            c[i] = row[0] * q[0] + row[1] * q[1] + row[2] * q[2] + row[3] * q[3];
        }
        if (!(c[2] > 0.0))
            continue;
        double motion = block->forward[3 * k + 2][3];
        double x = (block->forward[3 * k][3] - c[0] / c[2] * motion) / c[2];
        double y = (block->forward[3 * k + 1][3] - c[1] / c[2] * motion) / c[2];
        sum += job->plan->sources[k].prior * hypot(x, y);
        total += job->plan->sources[k].prior;
    }
    return sum > 0.0 ? sum / total : 1.0 / job->plan->w_max;
}

static void set_block(const struct densify_job *job, struct level *level)
{
    struct densify_block *block = &level->block;
    struct orl_view ref = job->view;
    ref.camera = orl_densify_level_camera(&job->reference->camera, level->number);
    for (int k = 0; k < job->plan->count; k++) {
        int shrunk = source_level(job, k, level->number);
        struct orl_view source = job->source_views[k];
        source.camera = orl_densify_level_camera(&job->sources[k]->camera, job->finest);
        orl_densify_transfer(&ref, &source, &block->backward[3 * k]);
        source.camera = orl_densify_level_camera(&job->sources[k]->camera, shrunk);
        block->extent[k][0] = (float)source.camera.width;
        block->extent[k][1] = (float)source.camera.height;
        block->extent[k][2] = (float)job->plan->sources[k].prior;
        block->extent[k][3] = (float)(1 << (shrunk - job->finest));
        // Texel centres are at whole numbers, offset by the padding.
        source.camera.cx += orl_densify_padding(job->params) - 0.5;
        source.camera.cy += orl_densify_padding(job->params) - 0.5;
        orl_densify_transfer(&source, &ref, &block->forward[3 * k]);
    }
    const struct orl_camera *c = &ref.camera;
    memcpy(block->camera, (float[]){(float)c->fx, (float)c->fy, (float)c->cx, (float)c->cy},
           sizeof block->camera);
    block->range[0] = (float)job->plan->w_min;
    block->range[1] = (float)job->plan->w_max;
    block->range[2] = (float)(1.0 / parallax(job, c, block));
    block->area[0] = c->width;
    block->area[1] = c->height;
    block->tune[2] = 0.2f; // Xu and Tao 2019, section 3.3
    block->tune[3] = 3.0f;
    block->limit[0] = COST_AGREED;
    block->limit[1] = 1.5f;
    block->limit[2] = 0.9f;
    block->limit[3] = 0.5f;
    block->run[0] = (int)job->seed;
}

// --- dispatch ---

static enum orl_result run(const struct densify_job *job, struct level *level, enum program which,
                           struct orl_tex *extra, double done)
{
    struct orl_prog *prog = program_of(job, which);
    enum orl_result result = ORL_OK;
    int width = level->block.area[0], height = level->block.area[1];
    bool half = which == SWEEP || which == SWEEP_FINE || which == SWEEP_GEOMETRIC;
    int band = (BAND_PIXELS / width / ORL_PIXEL_GROUP_Y + 1) * ORL_PIXEL_GROUP_Y;
    for (int row = 0; row < height && result == ORL_OK; row += band) {
        if (orl_progress_cancelled(job->progress))
            return ORL_ERR_CANCELLED;
        int end = row + band < height ? row + band : height;
        level->block.area[2] = row;
        level->block.area[3] = end;
        orl_gpu_dispatch(job->gpu, &(struct orl_dispatch){
            .prog = prog, ORL_PARAMS(level->block),
            .textures = {level->reference, level->sources, level->source_depths},
            .images = {level->planes, level->costs, level->view_costs, extra},
            .size = {half ? (width + 1) / 2 : width, end - row}});
        result = orl_gpu_finish(job->gpu);
    }
    orl_progress_report(job->progress, "densify", job->done + done, job->total, job->name);
    return result;
}

static enum orl_result read_maps(struct orl_gpu *gpu, struct orl_tex *tex, struct densify_maps *maps)
{
    const struct orl_log *log = orl_gpu_log(gpu);
    int width = tex->params.width, height = tex->params.height;
    size_t count = (size_t)width * (size_t)height;
    float *pixels = orl_array(log, count, 4 * sizeof *pixels);
    ORL_TRY_MEMORY(pixels);
    enum orl_result result = orl_densify_maps_init(log, width, height, maps);
    if (result == ORL_OK) {
        orl_tex_read(tex, 0, GL_RGBA, GL_FLOAT, count * 4 * sizeof *pixels, pixels);
        result = orl_gpu_finish(gpu);
    }
    for (size_t i = 0; result == ORL_OK && i < count; i++) {
        const float *n = &pixels[4 * i];
        float confidence = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        for (int k = 0; k < 3 && confidence > 0.0f; k++)
            maps->normal.f32[3 * i + (size_t)k] = n[k] / confidence;
        maps->confidence.f32[i] = confidence;
        maps->depth.f32[i] = n[3];
    }
    free(pixels);
    return result;
}

static enum orl_result finish(const struct densify_job *job, struct level *level, enum program which,
                              struct densify_maps *maps)
{
    struct orl_tex *out = NULL;
    struct orl_tex_params params = {.width = level->block.area[0], .height = level->block.area[1],
                                    .format = GL_RGBA32F, .tag = "densify maps"};
    enum orl_result result = orl_tex_create(job->gpu, &params, &out);
    ORL_THEN(result, run(job, level, FIT, NULL, 0.95));
    ORL_THEN(result, run(job, level, which, out, 1.0));
    ORL_THEN(result, read_maps(job->gpu, out, maps));
    orl_tex_destroy(job->gpu, &out);
    return result;
}

static enum orl_result level_open(const struct densify_job *job, struct level *level)
{
    const struct orl_tex_row rows[] = {{"densify planes", GL_RGBA32F, &level->planes},
                                       {"densify costs", GL_R32F, &level->costs},
                                       {"densify view costs", GL_RGBA32UI, &level->view_costs}};
    set_block(job, level);
    ORL_TRY(orl_tex_create_rows(job->gpu, level->block.area[0], level->block.area[1], rows, ORL_COUNT(rows)));
    ORL_TRY(upload_reference(job, level));
    return upload_sources(job, level);
}

// How one level is searched: first planes, then sweeps over them.
struct search {
    enum program init, sweep;
    struct orl_tex *from; // the first planes are made of this texture
    int tries;            // first planes of a pixel, of which the best is kept
    int sweeps;
    int candidates, variations, views; // a sweep's: neighbours' planes, changes of the own plane, sources judged
    float pixels, normal; // the first sweep's changes of depth and normal; they halve from sweep to sweep
    double begin, end;    // progress
};

static enum orl_result search_level(const struct densify_job *job, struct level *level,
                                    const struct search *search)
{
    struct densify_block *block = &level->block;
    block->run[3] = search->tries;
    block->tests[0] = search->candidates;
    block->tests[1] = search->variations;
    block->tests[2] = search->views < job->params->sources ? search->views : job->params->sources;
    enum orl_result result = run(job, level, search->init, search->from, search->begin);
    for (int i = 0; i < search->sweeps && result == ORL_OK; i++) {
        double done = search->begin + (search->end - search->begin) * (i + 1) / search->sweeps;
        block->tune[0] = fmaxf(search->pixels * exp2f((float)-i), 0.1f);
        block->tune[1] = fmaxf(search->normal * exp2f((float)-i), 0.05f);
        for (int color = 0; color < 2 && result == ORL_OK; color++) {
            block->run[1]++;
            block->run[2] = color;
            result = run(job, level, search->sweep, NULL, done);
        }
    }
    return result;
}

enum orl_result orl_densify_photometric(const struct densify_job *job, struct densify_maps *maps)
{
    struct level level = {0}, coarser = {0};
    enum orl_result result = ORL_OK;
    int count = job->levels;
    for (int number = count - 1; number >= job->finest && result == ORL_OK; number--) {
        // Each level has four times the pixels of the previous one.
        double end = exp2(2.0 * (job->finest - number));
        level = (struct level){.number = number};
        result = level_open(job, &level);
        if (result != ORL_OK)
            break;
        level.block.run[1] = 1000 * number;
        level.block.limit[0] = COST_MATCHED;
        if (number == count - 1) {
            result = upload_seeds(job, &level);
            ORL_THEN(result, search_level(job, &level, &(struct search){
                .init = INIT_RANDOM, .sweep = SWEEP, .from = level.extra, .tries = RANDOM_TRIES,
                .sweeps = job->params->iterations + 2, .candidates = 8, .variations = 6,
                .views = VIEWS_COARSE, .pixels = 4, .normal = 0.5f, .end = end}));
        } else {
            bool fine = number <= job->finest + 1;
            result = search_level(job, &level, &(struct search){
                .init = fine ? INIT_FINE : INIT_COARSE, .sweep = fine ? SWEEP_FINE : SWEEP,
                .from = coarser.planes, .tries = 1, .sweeps = (job->params->iterations + 1) / 2,
                .candidates = 4, .variations = 4, .views = VIEWS_FINE, .pixels = 1, .normal = 0.3f,
                .begin = 0.25 * end, .end = end});
        }
        level_finish(job->gpu, &coarser);
        if (result == ORL_OK && number == job->finest)
            result = finish(job, &level, FINISH_MATCHED, maps);
        coarser = level;
        level = (struct level){0};
    }
    level_finish(job->gpu, &level);
    level_finish(job->gpu, &coarser);
    return result;
}

enum orl_result orl_densify_geometric(const struct densify_job *job, struct densify_maps *maps)
{
    struct level level = {.number = job->finest};
    enum orl_result result = level_open(job, &level);
    ORL_THEN(result, upload_source_depths(job, &level));
    ORL_THEN(result, upload_start(job, &level));
    level.block.run[1] = 1000 * (DENSIFY_LEVELS_MAX + job->draw);
    ORL_THEN(result, search_level(job, &level, &(struct search){
        .init = INIT_MAPS, .sweep = SWEEP_GEOMETRIC, .from = level.extra, .tries = 1, .sweeps = 1,
        .candidates = 6, .variations = 1, .views = VIEWS_FINE, .pixels = 0.5f, .normal = 0.15f,
        .begin = 0.2, .end = 0.9}));
    ORL_THEN(result, finish(job, &level, job->last ? FINISH_LAST : FINISH_AGREED, maps));
    level_finish(job->gpu, &level);
    return result;
}
