#include "eval/refine.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

#include "core/color.h"
#include "core/file.h"
#include "core/memory.h"
#include "core/process.h"
#include "eval/validation.h"
#include "io/picture.h"
#include "scene/depth_buffer.h"
#include "scene/manifest.h"
#include "scene/meter.h"
#include "scene/tuned_settings.h"
#include "soft/descent.h"
#include "soft/soft_ply.h"

// Far splats: one of GRID x GRID pixels, as many in all views together as FAR_VIEWS views have open pixels. A
// pixel is open if more than OPEN of it passes all splats of points. They lie at NEAR_FROM to FAR_TO of the
// depth within which FAR_SHARE of the view's splats are.
enum { GRID = 4, FAR_VIEWS = 3 };
// One of CHECKED photographs, at least CHECKS_MIN of them, or one of two, and at most CHECKS_MAX, waits for the last
// third of the steps, so that the shares of the splats can be found on what they have not seen.
enum { CHECKED = 6, CHECKS_MIN = 3, CHECKS_MAX = 8 };
// Steps for each photograph, and the fewest and the most for all photographs together, unless a number is asked for.
enum { STEPS_OF_PHOTO = 20, STEPS_MIN = 200, STEPS_MAX = 1200 };
static const double FIRST_PART = 2.0 / 3, LAST_FIRST_SIZE = 0.3;
static const float SHARES[] = {0.1f, 0.3f, 0.5f, 0.75f, 1};
static const size_t MIX_SHARES = 3; // so many of them are tried for opt.soft_mix
static const double GAIN_DB = 0.05; // that splats must bring, or else none are taken
// Pixels of a photograph for each splat within it, hidden or not. Half as many splats lose 0.2 dB on photographs that
// they have not seen, and twice as many gain nothing in the mean.
static const double PIXELS_OF_SPLAT = 2;
enum { PLACES_TRIED = 1000 }; // so many tell in how many photographs a place is
static const double OPEN = 0.5, FAR_SHARE = 0.98, SIGMA = 0.9; // SIGMA: of the grid's spacing
static const float FAR_OPACITY = 0.27f, FADED = 0.02f;
// Entries in the lists of a view's tiles that device memory is planned for: so many for a splat and for a pixel.
// Where every photograph shows the whole subject, three quarters of them are needed (docs/how/oriel.md).
enum { SPLAT_ENTRIES = 5, PIXEL_ENTRIES = 12, SPLATS_MIN = 1000 };
static const double KEEP_EVERY = 20; // the state is kept so many times as long apart as keeping it takes

static const size_t STATE_MAX = (size_t)1 << 36, ROW = ORL_SOFT_VALUES * sizeof(float); // bytes; of a splat

// Where a run goes on after it was cut off, in a file for the same machine. Zero-initialised, it is the beginning.
// The file holds it as it is, then the model's splats and, once a step of this part has been made, its moments.
struct state {
    uint64_t key;    // hash of all that the result depends on: photographs, settings, method and options, the splats to begin with
    uint64_t splats; // of the model
    int32_t part;    // of the descent: 0; 1: the shares have been found
    struct orl_soft_descent_report at; // in this part
    struct orl_refine_report report;
};

struct refine {
    const struct orl_log *log;
    const struct orl_scene *scene;
    const struct orl_refine_params *params;
    struct orl_soft_photo *photos; // owned: those that are not checks first
    size_t count, checks;
    double steps;                  // for each photograph
    struct orl_soft_model model;   // owned
    struct state state;
    const char *state_path;
    double keep_s;                 // how long it took to keep the state
};

// Adds something to the key of the state.
static void add_key(struct refine *r, const void *data, size_t size)
{
    r->state.key = XXH3_64bits_withSeed(data, size, r->state.key);
}

// --- photographs ---

// What stands before the scene in a photograph, at the size of `use`.
static enum orl_result read_occluders(const struct refine *r, size_t photo, struct orl_soft_photo *to)
{
    if (!(r->scene->photos[photo].occluded > 0))
        return ORL_OK;
    struct orl_image mask = {0};
    const int width = to->color.width, height = to->color.height;
    enum orl_result result = orl_picture_read(r->log, orl_scene_file(r->scene, photo, ORL_FILE_OCCLUDERS).text,
                                               1, &mask);
    ORL_THEN(result, orl_image_init(r->log, &to->use, width, height, 1, ORL_PIXEL_U8));
    for (int y = 0; result == ORL_OK && y < height; y++)
        for (int x = 0; x < width; x++) {
            size_t from = (size_t)(y * mask.height / height) * (size_t)mask.width + (size_t)(x * mask.width / width);
            to->use.u8[(size_t)y * (size_t)width + (size_t)x] = mask.u8[from] < 128;
        }
    orl_image_finish(&mask);
    return result;
}

// The photograph at the scene's exposure and white balance, without its vignetting.
static enum orl_result read_photo(const struct refine *r, size_t photo, struct orl_soft_photo *to)
{
    const struct orl_photo *from = &r->scene->photos[photo];
    struct orl_heldout read = {0};
    enum orl_result result = orl_heldout_load(r->log, r->scene, photo, r->params->size_divide, &read);
    const int width = read.picture.width, height = read.picture.height;
    ORL_THEN(result, orl_image_init(r->log, &to->color, width, height, 3, ORL_PIXEL_F32));
    for (int y = 0; result == ORL_OK && y < height; y++)
        for (int x = 0; x < width; x++) {
            float light = orl_illumination(from->vignette, &read.view.camera, x + 0.5, y + 0.5);
            size_t at = 3 * ((size_t)y * (size_t)width + (size_t)x);
            for (size_t c = 0; c < 3; c++) {
                float value = orl_srgb_decode((float)read.picture.u8[at + c] / 255);
                to->color.f32[at + c] = orl_srgb_encode(orl_light_aligned(from->gain[c] / light, value));
            }
        }
    to->view = read.view;
    orl_heldout_finish(&read);
    ORL_THEN(result, read_occluders(r, photo, to));
    return result;
}

static enum orl_result read_photos(struct refine *r, bool checks)
{
    for (size_t i = 0; i < r->scene->photo_count; i++) {
        if (r->scene->photos[i].test || orl_heldout_chosen(r->scene, false, r->checks, i) != checks)
            continue;
        struct orl_soft_photo *to = &r->photos[r->count++];
        ORL_TRY(read_photo(r, i, to));
        add_key(r, &to->view, sizeof to->view);
        add_key(r, to->color.data, orl_image_bytes(&to->color));
        add_key(r, to->use.data, orl_image_bytes(&to->use));
        orl_progress_report(r->params->progress, "photographs", (double)r->count, (double)r->scene->photo_count,
                            r->scene->photos[i].name);
    }
    return ORL_OK;
}

// --- far splats ---

// Where pixels of a view are open, splats beyond and among the farthest.
static enum orl_result add_far(struct refine *r, const struct orl_soft_raster *raster, const float *blended,
                               const struct orl_soft_photo *photo, uint64_t *state)
{
    const struct orl_camera *c = &photo->view.camera;
    if (raster->lists.seen == 0)
        return ORL_OK;
    uint32_t bits = raster->lists.order[(size_t)(FAR_SHARE * (double)(raster->lists.seen - 1))].depth;
    float far;
    memcpy(&far, &bits, sizeof far);
    for (int y = GRID / 2; y < c->height; y += GRID)
        for (int x = GRID / 2; x < c->width; x += GRID) {
            size_t pixel = (size_t)y * (size_t)c->width + (size_t)x;
            const double views = (double)(r->count - r->checks);
            if ((double)blended[4 * pixel + 3] < OPEN || orl_soft_random(state) * views > FAR_VIEWS)
                continue;
            double beyond = orl_soft_random(state), part = orl_soft_random(state);
            double z = (double)far * (beyond < 0.5 ? 1 + 2 * part : 0.6 + 0.6 * part);
            double world[3];
            orl_view_unproject(&photo->view, x + 0.5, y + 0.5, z, world);
            ORL_TRY(orl_soft_add(r->log, &r->model, world, SIGMA * GRID * z / c->fx, FAR_OPACITY,
                                 photo->color.f32 + 3 * pixel));
        }
    return ORL_OK;
}

static enum orl_result add_all_far(struct refine *r, struct orl_gpu *gpu)
{
    uint64_t state = 0xd1342543de82ef95u ^ ((uint64_t)r->params->seed + 1) * 0x9e3779b97f4a7c15u;
    struct orl_soft_raster raster = {0};
    struct orl_image blended = {0};
    enum orl_result result = orl_soft_raster_init(gpu, &r->model, &raster);
    for (size_t i = 0; result == ORL_OK && i < r->count - r->checks; i++) {
        struct soft_block block;
        const struct orl_camera *c = &r->photos[i].view.camera;
        orl_image_finish(&blended);
        result = orl_soft_raster_draw(gpu, &raster, &r->photos[i].view, false, &block);
        ORL_THEN(result, orl_image_init(r->log, &blended, c->width, c->height, 4, ORL_PIXEL_F32));
        if (result == ORL_OK) {
            orl_tex_read(raster.blended, 0, GL_RGBA, GL_FLOAT, orl_image_bytes(&blended), blended.f32);
            result = orl_gpu_finish(gpu);
        }
        ORL_THEN(result, add_far(r, &raster, blended.f32, &r->photos[i], &state));
    }
    orl_image_finish(&blended);
    orl_soft_raster_finish(gpu, &raster);
    return result;
}

// --- how much of them ---

// Of the shares, the one for `option` of `render` with which the checks come out best, if that is better than 0.
// psnr_db: means with 0 and with the one that was found.
static enum orl_result find_share(const struct refine *r, struct orl_renderer *renderer,
                                  const struct orl_validation *checks, struct orl_render_params *render, float *option,
                                  size_t count, double psnr_db[2])
{
    struct orl_score scores[1 + ORL_COUNT(SHARES)] = {{0}}; // the first: with 0
    enum orl_result result = ORL_OK;
    size_t best = 0;
    for (size_t i = 0; result == ORL_OK && i <= count; i++) {
        *option = i ? SHARES[i - 1] : 0;
        result = orl_score_measure(r->log, renderer, checks, checks->count, render, NULL, r->params->progress,
                                   &scores[i]);
        if (result == ORL_OK && scores[i].psnr_db > scores[best].psnr_db &&
            orl_score_better(&scores[i], &scores[0], GAIN_DB))
            best = i;
    }
    *option = best ? SHARES[best - 1] : 0;
    psnr_db[0] = scores[0].psnr_db;
    psnr_db[1] = scores[best].psnr_db;
    for (size_t i = 0; i <= count; i++)
        orl_score_finish(&scores[i]);
    return result;
}

// How far splats correct pictures, and, if they do, how much of them is mixed in.
static enum orl_result find_shares(struct refine *r, struct orl_gpu *gpu, struct orl_refine_report *report)
{
    struct orl_validation checks = {0};
    struct orl_renderer *renderer = NULL;
    struct orl_render_params render = r->params->choice.params;
    double soft_db[2] = {0}, mix_db[2] = {0};
    enum orl_result result = orl_validation_load(r->log, r->scene, r->checks, r->params->size_divide, &checks);
    const struct orl_renderer_params limits = {.max_vram_bytes = r->params->max_vram_bytes};
    ORL_THEN(result, orl_renderer_create(gpu, r->scene, &limits, &renderer));
    render.soft = render.soft_mix = 0;
    ORL_THEN(result, find_share(r, renderer, &checks, &render, &render.soft, ORL_COUNT(SHARES), soft_db));
    bool mixes = result == ORL_OK && render.soft > 0;
    if (mixes)
        result = find_share(r, renderer, &checks, &render, &render.soft_mix, MIX_SHARES, mix_db);
    report->checks = checks.count;
    report->share = (double)render.soft;
    report->mix_share = (double)render.soft_mix;
    report->before_psnr_db = soft_db[0];
    report->psnr_db = mixes ? mix_db[1] : soft_db[1];
    orl_renderer_destroy(&renderer);
    orl_validation_finish(&checks);
    return result;
}

// Keeps the shares beside what is tuned.
static enum orl_result keep_shares(const struct refine *r, struct orl_refine_report *report)
{
    struct orl_choice choice = r->params->choice;
    report->kept = orl_path_is_file(ORL_PATH(r->scene->dir, "scene.json"));
    choice.params.soft = (float)report->share;
    choice.params.soft_mix = (float)report->mix_share;
    if (!report->kept)
        return ORL_OK;
    return orl_tuned_write(r->log, r->scene->dir, choice.method->name,
                           orl_choice_record(&choice, report->before_psnr_db, report->psnr_db, report->checks,
                                             r->params->size_divide, true));
}

// --- the state ---

static enum orl_result keep_state(struct refine *r)
{
    const double start_s = orl_time_s();
    struct orl_atomic_file file;
    r->state.splats = r->model.count;
    ORL_TRY(orl_atomic_open(r->log, r->state_path, &file));
    fwrite(&r->state, sizeof r->state, 1, file.stream);
    fwrite(r->model.splats, ROW, r->model.count, file.stream);
    if (r->state.at.steps)
        fwrite(r->model.moments, ROW, 2 * r->model.count, file.stream);
    ORL_TRY(orl_atomic_commit(r->log, &file));
    r->keep_s = orl_time_s() - start_s;
    return ORL_OK;
}

static enum orl_result take_state(struct refine *r, const struct state *state, const uint8_t *rows)
{
    const size_t count = state->splats;
    struct orl_soft_model read = {.splats = orl_array(r->log, count, ROW), .count = count, .capacity = count};
    if (state->at.steps)
        read.moments = orl_array(r->log, 2 * count, ROW);
    orl_soft_finish(&r->model);
    r->model = read;
    if (!read.splats || (state->at.steps && !read.moments))
        return ORL_ERR_MEMORY;
    memcpy(read.splats, rows, count * ROW);
    if (read.moments)
        memcpy(read.moments, rows + count * ROW, 2 * count * ROW);
    r->state = *state;
    return ORL_OK;
}

// Takes state and model of the file, if there is one with the key of this run. Another one is logged.
static enum orl_result read_state(struct refine *r)
{
    struct state head = {0};
    uint8_t *data = NULL;
    size_t size = 0;
    if (!orl_path_is_file(r->state_path))
        return ORL_OK;
    enum orl_result result = orl_file_read(r->log, r->state_path, STATE_MAX, &data, &size);
    if (result == ORL_OK && size >= sizeof head)
        memcpy(&head, data, sizeof head);
    const size_t rows = head.at.steps ? 3 : 1;
    bool fits = head.key == r->state.key && head.splats > 0 && head.splats < STATE_MAX / ROW &&
                size == sizeof head + rows * head.splats * ROW;
    if (result == ORL_OK && !fits)
        orl_logf(r->log, ORL_LOG_WARNING, "%s: of another scene or other settings, or damaged; refine begins anew",
                 r->state_path);
    else if (result == ORL_OK)
        result = take_state(r, &head, data + sizeof head);
    free(data);
    return result;
}

// --- the whole ---

// Device memory for so many splats of points and the far ones that there may be, in a view of this size.
static double memory_need(double splats, int width, int height)
{
    const double pixels = (double)width * height, all = splats + FAR_VIEWS * pixels / (GRID * GRID);
    return (double)orl_soft_descent_bytes((size_t)all, (size_t)(SPLAT_ENTRIES * all + PIXEL_ENTRIES * pixels), width,
                                          height);
}

// Makes *splats so many that they fit in device memory.
static enum orl_result fit_memory(const struct refine *r, int width, int height, double *splats)
{
    const double most = (double)r->params->max_vram_bytes, least = memory_need(SPLATS_MIN, width, height);
    const double asked = memory_need(*splats, width, height), mib = 1 << 20;
    if (most <= 0 || asked <= most)
        return ORL_OK;
    if (least > most)
        return orl_fail(r->log, ORL_ERR_GPU, "refine: %.0f MiB of device memory are not enough for photographs of "
                        "%dx%d: the least is %.1f MiB; give a larger --size-divide", most / mib, width, height,
                        least / mib);
    double fewer = SPLATS_MIN + (*splats - SPLATS_MIN) * (most - least) / (asked - least);
    orl_logf(r->log, ORL_LOG_WARNING, "refine: %.0f splats at %dx%d need %.0f MiB of device memory; using %.0f",
             *splats, width, height, asked / mib, floor(fewer));
    *splats = floor(fewer);
    return ORL_OK;
}

// In how many photographs a place is, whatever hides it: the mean of some of the places.
static double mean_views(const struct refine *r, const float (*places)[3], size_t count)
{
    double views = 0, tried = 0;
    for (size_t i = 0; i < count; i += count / PLACES_TRIED + 1, tried++)
        for (size_t k = 0; k < r->count; k++) {
            double pixel[2], depth;
            views += orl_point_project(&r->photos[k].view, places[i], pixel, &depth);
        }
    return fmax(views / fmax(tried, 1), 1);
}

// Splats on the scene's points or, without any, on its mesh.
static enum orl_result make_splats(struct refine *r, const struct orl_mesh *mesh)
{
    const struct orl_points *points = &r->scene->points;
    const bool on_points = points->count > 0;
    double pixels = 0, splats = r->params->splats;
    int width = 0, height = 0;
    for (size_t i = 0; i < r->count; i++) {
        const struct orl_image *color = &r->photos[i].color;
        pixels += (double)color->width * color->height;
        width = color->width > width ? color->width : width;
        height = color->height > height ? color->height : height;
    }
    pixels /= on_points ? mean_views(r, (const float(*)[3])points->position, points->count)
                        : mean_views(r, (const float(*)[3])mesh->position, mesh->vertex_count);
    splats = fmin(splats, pixels / PIXELS_OF_SPLAT);
    if (on_points)
        splats = fmin(splats, (double)points->count);
    ORL_TRY(fit_memory(r, width, height, &splats));
    return on_points ? orl_soft_from_points(r->log, points, (double)points->count / splats, r->params->seed, &r->model)
                     : orl_soft_from_mesh(r->log, mesh, splats, r->params->seed, &r->model);
}

static enum orl_result begin(struct refine *r)
{
    struct orl_mesh mesh = {0};
    const struct orl_file_path path = orl_scene_mesh_path(r->scene);
    if (r->scene->points.count == 0 && orl_path_is_file(path.text))
        ORL_TRY(orl_mesh_read(r->log, path.text, NULL, &mesh));
    enum orl_result result = make_splats(r, &mesh);
    orl_mesh_finish(&mesh);
    return result;
}

// Adds the method and its options to the key of the state, but for the shares of splats, which are found, not asked for: a
// run that was cut off at its very end may have kept them already.
static void add_choice(struct refine *r)
{
    struct orl_choice choice = r->params->choice;
    choice.params.soft = choice.params.soft_mix = 0;
    add_key(r, choice.method->name, strlen(choice.method->name));
    for (const struct orl_option *o = orl_render_options(); o->name; o++) {
        char value[ORL_OPTION_TEXT] = "";
        orl_option_print(o, &choice.params, value);
        add_key(r, value, sizeof value);
    }
}

// Begins, or goes on where an earlier run was cut off.
static enum orl_result start(struct refine *r, struct orl_gpu *gpu)
{
    const struct orl_refine_params *p = r->params;
    struct orl_refine_report *report = &r->state.report;
    ORL_TRY(begin(r));
    if (r->model.count == 0)
        return orl_fail(r->log, ORL_ERR_DATA, "the scene has neither points nor a mesh to make splats of");
    report->points = r->model.count;
    add_key(r, r->model.splats, r->model.count * sizeof *r->model.splats);
    const double settings[] = {r->steps, p->budget_s, p->seed, (double)p->max_vram_bytes};
    add_key(r, settings, sizeof settings);
    add_choice(r);
    ORL_TRY(read_state(r));
    if (r->state.splats > 0) {
        orl_logf(r->log, ORL_LOG_INFO, "refine: goes on after %d steps", report->steps + r->state.at.steps);
        return ORL_OK;
    }
    ORL_TRY(add_all_far(r, gpu));
    report->far = r->model.count - report->points;
    return ORL_OK;
}

// A part of the descent, on the first `photographs` of them, and its splats as SCENE/soft.ply.
static enum orl_result descend(struct refine *r, struct orl_gpu *gpu, size_t photographs, double part,
                               double first_size)
{
    struct orl_soft_descent_report *at = &r->state.at;
    struct orl_soft_descent_params params = {
        .steps = (int)ceil(part * r->steps * (double)photographs), .first_size = first_size,
        .seed = r->params->seed, .budget_s = part * r->params->budget_s, .max_bytes = r->params->max_vram_bytes,
        .progress = r->params->progress};
    while (!at->done) {
        params.part_s = KEEP_EVERY * r->keep_s;
        ORL_TRY(orl_soft_descend(gpu, r->photos, photographs, &params, &r->model, at));
        if (!at->done)
            ORL_TRY(keep_state(r));
    }
    orl_soft_drop(&r->model, FADED);
    r->state.report.splats = r->model.count;
    r->state.report.steps += at->steps;
    r->state.report.loss = at->loss;
    *at = (struct orl_soft_descent_report){0};
    return orl_soft_write(r->log, ORL_PATH(r->scene->dir, ORL_SOFT_NAME), &r->model);
}

static enum orl_result run(struct refine *r, struct orl_gpu *gpu)
{
    size_t train;
    ORL_TRY(orl_dir_sweep(r->log, r->scene->dir)); // a state that was being written
    ORL_TRY(orl_validation_check(r->log, r->scene, &train));
    r->checks = (size_t)fmin(fmin(fmax((double)(train / CHECKED), CHECKS_MIN), (double)(train / 2)), CHECKS_MAX);
    const double photographs = (double)train;
    r->steps = r->params->steps ? r->params->steps
                                : fmin(fmax(STEPS_OF_PHOTO, STEPS_MIN / photographs), STEPS_MAX / photographs);
    r->photos = orl_array(r->log, train, sizeof *r->photos);
    ORL_TRY_MEMORY(r->photos);
    ORL_TRY(read_photos(r, false));
    ORL_TRY(read_photos(r, true));
    ORL_TRY(start(r, gpu));
    if (r->state.part == 0) {
        ORL_TRY(descend(r, gpu, r->count - r->checks, FIRST_PART, 1));
        ORL_TRY(find_shares(r, gpu, &r->state.report));
        r->state.part = 1;
        ORL_TRY(keep_state(r));
    }
    ORL_TRY(descend(r, gpu, r->count, 1 - FIRST_PART, LAST_FIRST_SIZE));
    r->state.report.photographs = r->count;
    ORL_TRY(keep_shares(r, &r->state.report));
    return orl_dir_remove(r->log, r->state_path);
}

enum orl_result orl_refine(struct orl_gpu *gpu, const struct orl_scene *scene, const struct orl_refine_params *params,
                           struct orl_refine_report *report)
{
    struct refine r = {.log = orl_gpu_log(gpu), .scene = scene, .params = params,
                       .state_path = ORL_PATH(scene->dir, ORL_REFINE_STATE_NAME)};
    enum orl_result result = run(&r, gpu);
    *report = r.state.report;
    for (size_t i = 0; i < r.count; i++) {
        orl_image_finish(&r.photos[i].color);
        orl_image_finish(&r.photos[i].use);
    }
    free(r.photos);
    orl_soft_finish(&r.model);
    return result;
}
