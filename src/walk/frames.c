// A client's request for a frame, and the picture that answers it.
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "core/json.h"
#include "core/memory.h"
#include "io/picture.h"
#include "walk/internal.h"

enum { SIDE_LEAST = 16, SIDE_MOST = 4096, PIXELS_MOST = 4000000 };

// --- requests ---

static const char *const layer_names[WALK_LAYERS] = {"color", "depth", "normal", "coverage",
                                                     "points"};

// Is the matrix orthonormal, up to rounding?
static bool is_rotation(double r[3][3])
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            double product = r[i][0] * r[j][0] + r[i][1] * r[j][1] + r[i][2] * r[j][2];
            if (!(fabs(product - (i == j)) < 1e-3))
                return false;
        }
    return true;
}

static bool read_view(const json_t *root, struct orl_view *view)
{
    struct orl_camera *c = &view->camera;
    struct orl_pose *pose = &view->cam_from_world;
    double size[2], focal[4], eye[3];
    if (!orl_json_read_numbers(json_object_get(root, "size"), 2, size) ||
        !orl_json_read_numbers(json_object_get(root, "focal"), 4, focal) ||
        !orl_json_read_numbers(json_object_get(root, "r"), 9, &pose->r[0][0]) ||
        !orl_json_read_numbers(json_object_get(root, "eye"), 3, eye) || !is_rotation(pose->r))
        return false;
    if (!(size[0] >= SIDE_LEAST && size[1] >= SIDE_LEAST && size[0] <= SIDE_MOST &&
          size[1] <= SIDE_MOST && size[0] * size[1] <= PIXELS_MOST))
        return false;
    *c = (struct orl_camera){(int)size[0], (int)size[1], focal[0], focal[1], focal[2], focal[3]};
    for (int i = 0; i < 3; i++)
        pose->t[i] = -(pose->r[i][0] * eye[0] + pose->r[i][1] * eye[1] + pose->r[i][2] * eye[2]);
    return orl_camera_valid(c);
}

bool orl_walk_request_read(const char *text, size_t size, struct walk_request *request)
{
    json_t *root = json_loadb(text, size, JSON_REJECT_DUPLICATES, NULL);
    const json_t *number = json_object_get(root, "number"), *quality = json_object_get(root, "quality");
    const char *layer = json_string_value(json_object_get(root, "layer"));
    int index = 0;
    while (layer && index < WALK_LAYERS && strcmp(layer_names[index], layer) != 0)
        index++;
    *request = (struct walk_request){.number = (uint32_t)json_integer_value(number),
                                     .layer = (enum walk_layer)index,
                                     .quality = (int)json_integer_value(quality)};
    bool valid = layer && index < WALK_LAYERS && json_is_integer(number) &&
                 json_integer_value(number) >= 0 && json_integer_value(number) <= UINT32_MAX &&
                 json_is_integer(quality) && json_integer_value(quality) >= 1 &&
                 json_integer_value(quality) <= 100 && read_view(root, &request->view);
    json_decref(root);
    return valid;
}

// --- answers ---

static double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

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

static enum orl_result draw(const struct walk_renderer *walk, const struct walk_request *request,
                            struct orl_image *picture)
{
    static const unsigned needed[WALK_LAYERS] = {[WALK_DEPTH] = ORL_LAYER_DEPTH,
                                                 [WALK_NORMAL] = ORL_LAYER_NORMAL,
                                                 [WALK_COVERAGE] = ORL_LAYER_COVERAGE};
    struct orl_render_params params = *walk->render;
    if (request->layer == WALK_POINTS)
        params = orl_method_find(walk->log, "points")->params;
    params.leave_out = (ORL_LAYER_DEPTH | ORL_LAYER_NORMAL | ORL_LAYER_COVERAGE |
                        ORL_LAYER_CONFIDENCE) & ~needed[request->layer];
    struct orl_frame frame;
    enum orl_result result = orl_renderer_draw(walk->renderer, &request->view, &params, NULL,
                                               &frame);
    if (result != ORL_OK)
        return result;
    result = orl_tone_srgb(walk->log, &frame.color, picture);
    size_t count = (size_t)frame.color.width * (size_t)frame.color.height;
    for (size_t i = 0; result == ORL_OK && needed[request->layer] && i < count; i++)
        show_pixel(&frame, request->layer, walk->typical, i, picture->u8 + 3 * i);
    orl_frame_finish(&frame);
    return result;
}

enum orl_result orl_walk_frame(const struct walk_renderer *walk, const struct walk_request *request,
                               size_t before, uint8_t **data, size_t *size)
{
    struct orl_image picture = {0};
    uint8_t *jpeg = NULL;
    size_t jpeg_size = 0;
    double start = seconds();
    enum orl_result result = draw(walk, request, &picture);
    if (result == ORL_OK)
        result = orl_jpeg_encode(walk->log, &picture, request->quality, &jpeg, &jpeg_size);
    const uint32_t header[4] = {request->number, (uint32_t)(1e6 * (seconds() - start)),
                                (uint32_t)picture.width, (uint32_t)picture.height};
    _Static_assert(sizeof header == WALK_FRAME_HEADER, "the header of a frame");
    if (result == ORL_OK) {
        *data = orl_array(walk->log, before + sizeof header + jpeg_size, 1);
        result = *data ? ORL_OK : ORL_ERR_MEMORY;
    }
    if (result == ORL_OK) {
        memcpy(*data + before, header, sizeof header);
        memcpy(*data + before + sizeof header, jpeg, jpeg_size);
        *size = sizeof header + jpeg_size;
    }
    free(jpeg);
    orl_image_finish(&picture);
    return result;
}
