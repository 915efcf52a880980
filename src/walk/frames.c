// A client's request for a frame, and the picture that answers it.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/json.h"
#include "core/memory.h"
#include "core/process.h"
#include "io/picture.h"
#include "walk/choices.h"
#include "walk/internal.h"

enum { SIDE_MIN = 16, SIDE_MAX = 4096, PIXELS_MAX = 4000000 };

// --- requests ---

static const char *const layer_names[WALK_LAYERS] = {"color", "depth", "normal", "coverage",
                                                     "points"};

static bool read_view(const json_t *root, struct orl_view *view)
{
    struct orl_camera *c = &view->camera;
    struct orl_pose *pose = &view->cam_from_world;
    double size[2], focal[4], eye[3];
    if (!orl_json_read_numbers(json_object_get(root, "size"), 2, size) ||
        !orl_json_read_numbers(json_object_get(root, "focal"), 4, focal) ||
        !orl_json_read_numbers(json_object_get(root, "r"), 9, &pose->r[0][0]) ||
        !orl_json_read_numbers(json_object_get(root, "eye"), 3, eye))
        return false;
    if (!(size[0] >= SIDE_MIN && size[1] >= SIDE_MIN && size[0] <= SIDE_MAX &&
          size[1] <= SIDE_MAX && size[0] * size[1] <= PIXELS_MAX))
        return false;
    *c = (struct orl_camera){(int)size[0], (int)size[1], focal[0], focal[1], focal[2], focal[3]};
    orl_pose_set_centre(pose, eye);
    return !orl_view_problem(view);
}

// "ev": stops, within what a scene of several exposures spans. "tone": the name of a tone curve.
bool orl_walk_tone_read(const json_t *message, struct orl_tone_params *tone)
{
    const json_t *ev = json_object_get(message, "ev"), *curve = json_object_get(message, "tone");
    *tone = (struct orl_tone_params){ORL_TONE_DEFAULTS};
    tone->exposure_ev = json_number_value(ev);
    int index = 0;
    while (curve && index < ORL_TONE_COUNT &&
           (!json_is_string(curve) || strcmp(orl_tones[index].name, json_string_value(curve)) != 0))
        index++;
    if (index == ORL_TONE_COUNT)
        return false;
    tone->curve = (enum orl_tone_curve)index;
    return !ev || (json_is_number(ev) && fabs(tone->exposure_ev) <= 16);
}

// "picks": pixels of the frame.
static bool read_picks(const json_t *root, struct walk_request *request)
{
    const json_t *picks = json_object_get(root, "picks"), *pick;
    const struct orl_camera *c = &request->view.camera;
    size_t i;
    double at[2];
    if (picks && (!json_is_array(picks) || json_array_size(picks) > WALK_PICKS_MAX))
        return false;
    json_array_foreach(picks, i, pick) {
        if (!orl_json_read_numbers(pick, 2, at) || !(at[0] >= 0 && at[0] < c->width) ||
            !(at[1] >= 0 && at[1] < c->height))
            return false;
        request->picks[i][0] = (int)at[0];
        request->picks[i][1] = (int)at[1];
    }
    request->pick_count = json_array_size(picks);
    return true;
}

bool orl_walk_request_read(json_t *root, struct walk_request *request)
{
    json_int_t number = -1, quality = 0;
    const char *layer = "";
    int index = 0;
    bool valid = json_unpack(root, "{s:I, s:I, s:s}", "number", &number, "quality", &quality, "layer", &layer) == 0 &&
                 number >= 0 && number <= UINT32_MAX && quality >= 1 && quality <= 100;
    while (index < WALK_LAYERS && strcmp(layer_names[index], layer) != 0)
        index++;
    *request = (struct walk_request){.number = (uint32_t)number, .layer = (enum walk_layer)index,
                                     .quality = (int)quality, .at_rest = json_is_true(json_object_get(root, "rest")),
                                     .measures = json_is_true(json_object_get(root, "measure"))};
    const json_t *time_steps = json_object_get(root, "time_steps");
    double pair[2] = {0, 0};
    bool timed = !time_steps || (orl_json_read_numbers(time_steps, 2, pair) && pair[0] >= 0 &&
                                 pair[1] >= 0 && pair[0] <= INT32_MAX && pair[1] <= INT32_MAX);
    request->time_step = timed ? (int)pair[0] : 0;
    request->expected = timed ? (int)pair[1] : 0;
    return valid && timed && index < WALK_LAYERS && read_view(root, &request->view) &&
           read_picks(root, request) && orl_walk_tone_read(root, &request->tone);
}

// --- answers ---

// Shows a layer in the colours that the page's shaders use (web/shaders/show.frag).
static void show_pixel(const struct orl_frame *frame, enum walk_layer layer, float typical, size_t i,
                       uint8_t rgb[3])
{
    float z = layer == WALK_DEPTH ? frame->depth.f32[i] : 0;
    for (size_t c = 0; c < 3; c++) {
        float value = layer == WALK_DEPTH    ? z > 0 ? 1 / (1 + z / typical) : 0
                      : layer == WALK_NORMAL ? 0.5f + 0.5f * frame->normal.f32[3 * i + c]
                                             : (float)rgb[c] / 255;
        if (layer == WALK_COVERAGE && !(frame->coverage.f32[i] > 0.5f))
            value = 0.4f * value + 0.6f * (c == 0 ? 0.9f : c == 1 ? 0.2f : 0.1f);
        rgb[c] = (uint8_t)lrintf(255 * fminf(1, fmaxf(0, value)));
    }
}

// Seconds that a frame may spend on photographs. While the view moves, a frame with loading must
// not take much longer than one without; at rest, the answer to the next movement must not.
static double loading_seconds(const struct walk_renderer *walk, bool at_rest)
{
    static const double share = 0.25, rest_s = 0.15;
    return at_rest ? rest_s : share * walk->draw_s;
}

// What a frame says beside its picture.
struct outcome {
    size_t missing; // photographs that are not complete yet
    float picked[WALK_PICKS_MAX]; // depth under each picked pixel; 0: none
};

// A time step that there is not is that of the last one.
static int time_step_of(const struct orl_scene *scene, int asked)
{
    return asked < (int)scene->frame_count ? asked : (int)scene->frame_count - 1;
}

// A time step is drawn whole, with all of its photographs: by the time that they had come one by one, it
// would be over. The next one's files are read and its hull is made meanwhile.
static enum orl_result draw_time_step(struct walk_renderer *walk,
                                      const struct walk_request *request,
                                      const struct orl_render_params *params,
                                      struct orl_frame *frame)
{
    ORL_TRY(orl_scene_set_frame(walk->log, walk->scene, time_step_of(walk->scene, request->time_step)));
    int next = time_step_of(walk->scene, request->expected);
    if (next != walk->scene->frame)
        orl_renderer_expect(walk->renderer, next);
    return orl_renderer_draw(walk->renderer, &request->view, params, NULL, frame);
}

static enum orl_result draw_timed(struct walk_renderer *walk, const struct walk_request *request,
                                  const struct orl_render_params *params, size_t *missing,
                                  struct orl_frame *frame)
{
    struct orl_progressive progress = {.seconds = loading_seconds(walk, request->at_rest),
                                       .at_rest = request->at_rest};
    double start = orl_time_s();
    enum orl_result result = orl_renderer_draw_progressive(walk->renderer, &request->view, params,
                                                           &progress, frame);
    double took = orl_time_s() - start - progress.spent;
    if (!request->at_rest)
        walk->draw_s += (walk->draw_s > 0 ? 0.2 : 1) * (took - walk->draw_s);
    *missing = progress.missing;
    return result;
}

static enum orl_result draw(struct walk_renderer *walk, const struct walk_request *request,
                            const struct orl_render_params *at_rest, struct orl_image *picture,
                            struct outcome *outcome)
{
    static const unsigned needed[WALK_LAYERS] = {[WALK_DEPTH] = ORL_LAYER_DEPTH,
                                                 [WALK_NORMAL] = ORL_LAYER_NORMAL,
                                                 [WALK_COVERAGE] = ORL_LAYER_COVERAGE};
    unsigned layers = needed[request->layer] | (request->pick_count ? ORL_LAYER_DEPTH : 0);
    struct orl_render_params params = request->at_rest ? *at_rest : orl_walk_moving_params(at_rest);
    if (request->layer == WALK_POINTS)
        params = orl_method_find(walk->log, "points")->params;
    params.leave_out = (ORL_LAYER_DEPTH | ORL_LAYER_NORMAL | ORL_LAYER_COVERAGE |
                        ORL_LAYER_CONFIDENCE) & ~layers;
    struct orl_frame frame;
    ORL_TRY(walk->scene->frame_count ? draw_time_step(walk, request, &params, &frame)
                                     : draw_timed(walk, request, &params, &outcome->missing, &frame));
    enum orl_result result = orl_tone_apply(walk->log, &frame.color, &request->tone, picture);
    size_t width = (size_t)frame.color.width, count = width * (size_t)frame.color.height;
    for (size_t i = 0; result == ORL_OK && needed[request->layer] && i < count; i++)
        show_pixel(&frame, request->layer, walk->typical, i, picture->u8 + 3 * i);
    for (size_t i = 0; i < request->pick_count; i++)
        outcome->picked[i] = fabsf(
            frame.depth.f32[(size_t)request->picks[i][1] * width + (size_t)request->picks[i][0]]);
    orl_frame_finish(&frame);
    return result;
}

// --- what a frame took ---

enum { PASSES_MAX = 32 };

static void start_measuring(const struct walk_renderer *walk)
{
    (void)orl_gpu_take_times(walk->gpu, NULL, 0); // forgets what was measured before
    orl_gpu_time_passes(walk->gpu, true);
}

static json_t *finish_measuring(const struct walk_renderer *walk, double draw_s, double encode_s)
{
    struct orl_pass_time times[PASSES_MAX];
    size_t count = orl_gpu_take_times(walk->gpu, times, PASSES_MAX);
    json_t *passes = json_array(), *memory = json_object();
    orl_gpu_time_passes(walk->gpu, false);
    for (size_t i = 0; i < count && i < PASSES_MAX; i++)
        json_array_append_new(passes, json_pack("[s,f]", times[i].name, times[i].ms));
    for (int i = 0; i < ORL_OWNER_COUNT; i++)
        json_object_set_new(memory, orl_owner_names[i],
                            json_integer((json_int_t)orl_gpu_owner_bytes(walk->gpu, (enum orl_owner)i)));
    return json_pack("{s:f, s:f, s:o, s:o}", "draw_ms", 1e3 * draw_s, "encode_ms", 1e3 * encode_s,
                     "passes", passes, "memory", memory);
}

// --- frames ---

// Puts room, header, depths and JPEG together.
static enum orl_result assemble(const struct orl_log *log, const uint32_t header[WALK_FRAME_WORDS],
                                const float *depths, size_t before, const uint8_t *jpeg, size_t size,
                                struct walk_frame *frame)
{
    size_t head = WALK_FRAME_WORDS * sizeof *header;
    size_t more = header[WALK_FRAME_WORDS - 1] * sizeof *depths;
    frame->data = orl_array(log, before + head + more + size, 1);
    ORL_TRY_MEMORY(frame->data);
    memcpy(frame->data + before, header, head);
    memcpy(frame->data + before + head, depths, more);
    memcpy(frame->data + before + head + more, jpeg, size);
    frame->size = head + more + size;
    return ORL_OK;
}

enum orl_result orl_walk_frame(struct walk_renderer *walk, const struct walk_request *request,
                               const struct orl_render_params *params, size_t before,
                               struct walk_frame *frame)
{
    struct orl_image picture = {0};
    struct outcome outcome = {0};
    uint8_t *jpeg = NULL;
    size_t size = 0;
    *frame = (struct walk_frame){0};
    if (request->measures)
        start_measuring(walk);
    double start = orl_time_s();
    enum orl_result result = draw(walk, request, params, &picture, &outcome);
    double drawn = orl_time_s();
    ORL_THEN(result, orl_jpeg_encode(walk->log, &picture, request->quality, &jpeg, &size));
    double end = orl_time_s();
    if (request->measures)
        frame->figures = finish_measuring(walk, drawn - start, end - drawn);
    const uint32_t header[WALK_FRAME_WORDS] = {
        request->number, (uint32_t)(1e6 * (end - start)), (uint32_t)picture.width,
        (uint32_t)picture.height, (uint32_t)outcome.missing, (uint32_t)request->pick_count};
    ORL_THEN(result, assemble(walk->log, header, outcome.picked, before, jpeg, size, frame));
    if (result != ORL_OK) {
        json_decref(frame->figures);
        *frame = (struct walk_frame){0};
    }
    free(jpeg);
    orl_image_finish(&picture);
    return result;
}

enum orl_result orl_walk_warm_up(struct walk_renderer *walk,
                                 const struct orl_render_params *params)
{
    enum { WIDTH = 640 };
    static const double max_s = 4; // of processor time: a busy machine gets as far as an idle one
    struct walk_request request = {.quality = 75, .tone = {ORL_TONE_DEFAULTS}};
    size_t start_photo;
    ORL_TRY(orl_walk_start(walk->log, walk->scene, &start_photo));
    request.view = walk->scene->photos[start_photo].view;
    struct orl_camera *c = &request.view.camera;
    *c = orl_camera_resized(c, WIDTH, WIDTH * c->height / c->width + 1);
    // The first frame compiles the programs, which is no measure of those that follow.
    struct outcome outcome = {0};
    double start = 0;
    enum orl_result result = ORL_OK;
    for (int i = 0; result == ORL_OK && (i < 2 || outcome.missing > 0); i++) {
        struct orl_image picture = {0};
        outcome.missing = 0; // of a time step, which is drawn whole
        request.at_rest = i % 2 == 0; // both kinds of frames compile their programs
        result = draw(walk, &request, params, &picture, &outcome);
        orl_image_finish(&picture);
        if (i < 4) { // the later ones compile those that photographs need
            start = orl_cpu_time_s();
            walk->draw_s = 0;
        } else if (orl_cpu_time_s() - start > max_s) {
            break;
        }
    }
    return result;
}
