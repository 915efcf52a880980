#include "scene/point_code.h"

#include <math.h>

enum {
    POSITION_BITS = 13,
    MOST_CODE = (1 << POSITION_BITS) - 1,
    // Of the second word; the first has x, y and the low bits of z.
    RADIUS_AT = 3 * POSITION_BITS - 32,
    THERE_AT = RADIUS_AT + 8,
    NORMAL_AT = THERE_AT + 1,
    RADIUS_CODES = 255,   // of radii above 0
    CODES_PER_OCTAVE = 16 // radii are rounded by 2.2 % at most
};
static const float min_steps = 16; // see orl_point_range_is_precise

const struct point_code orl_point_code_none = {{0}, {0}, 0};

// --- the frame of a block ---

struct point_range orl_point_range_none(void)
{
    return (struct point_range){{INFINITY, INFINITY, INFINITY},
                                {-INFINITY, -INFINITY, -INFINITY}, INFINITY, 0};
}

void orl_point_range_add(struct point_range *range, const float position[3], float radius)
{
    for (int k = 0; k < 3; k++) {
        range->low[k] = fminf(range->low[k], position[k]);
        range->high[k] = fmaxf(range->high[k], position[k]);
    }
    if (radius > 0) {
        range->min_radius = fminf(range->min_radius, radius);
        range->max_radius = fmaxf(range->max_radius, radius);
    }
}

void orl_point_range_box(const struct point_range *range, float middle[3], float extent[3])
{
    for (int k = 0; k < 3; k++) {
        middle[k] = 0.5f * range->low[k] + 0.5f * range->high[k];
        extent[k] = fmaxf(range->high[k] - middle[k], middle[k] - range->low[k]);
    }
}

static float radius_steps(int code)
{
    return exp2f((float)code / CODES_PER_OCTAVE);
}

// The least step that reaches from one side of the block to the other.
static float extent_step(const struct point_range *range)
{
    float extent = 0;
    for (int k = 0; k < 3; k++)
        extent = fmaxf(extent, range->high[k] - range->low[k]);
    return extent / MOST_CODE;
}

bool orl_point_range_is_precise(const struct point_range *range)
{
    float step = fmaxf(extent_step(range), range->max_radius / radius_steps(RADIUS_CODES));
    return min_steps * step <= range->min_radius;
}

struct point_frame orl_point_frame(const struct point_range *range)
{
    float least = extent_step(range);
    struct point_frame frame = {{range->low[0], range->low[1], range->low[2]}, least};
    if (!(range->max_radius > 0))
        return frame;
    // The largest radius gets a code of its own, so that equal radii are kept exactly. The step
    // grows by 4.4 % at most for it.
    float code = CODES_PER_OCTAVE * log2f(range->max_radius / least);
    code = fminf(fmaxf(floorf(code), 1), RADIUS_CODES); // a step of 0 makes it infinite
    frame.step = fmaxf(range->max_radius / radius_steps((int)code), least);
    return frame;
}

// --- points ---

static uint32_t steps_from(float origin, float value, float step)
{
    double code = step > 0 ? ((double)value - (double)origin) / (double)step : 0;
    return (uint32_t)lrint(fmin(fmax(code, 0), MOST_CODE));
}

static uint32_t radius_code(float radius, float step)
{
    if (!(radius > 0 && step > 0))
        return 0;
    float code = rintf(CODES_PER_OCTAVE * log2f(radius / step));
    return (uint32_t)fminf(fmaxf(code, 1), RADIUS_CODES);
}

static uint8_t signed_byte(double value)
{
    return (uint8_t)(int8_t)lrint(fmin(1, fmax(-1, value)) * 127);
}

// A direction as in shaders/proxy/octahedron.glsl, in two signed bytes: x in the low byte.
static uint16_t octahedron_bytes(const float normal[3])
{
    double x = normal[0], y = normal[1], sum = fabs(x) + fabs(y) + fabs((double)normal[2]);
    if (!(sum > 0))
        return 0;
    x /= sum, y /= sum;
    if (normal[2] < 0) {
        double wrapped = (1 - fabs(y)) * (x >= 0 ? 1 : -1);
        y = (1 - fabs(x)) * (y >= 0 ? 1 : -1);
        x = wrapped;
    }
    return (uint16_t)(signed_byte(x) | signed_byte(y) << 8);
}

struct point_code orl_point_encode(const struct point_frame *frame, const float position[3],
                                   const float normal[3], const uint8_t color[3], float radius)
{
    uint32_t q[3];
    for (int k = 0; k < 3; k++)
        q[k] = steps_from(frame->origin[k], position[k], frame->step);
    return (struct point_code){
        .geometry = {q[0] | q[1] << POSITION_BITS | q[2] << 2 * POSITION_BITS,
                     q[2] >> (32 - 2 * POSITION_BITS) |
                         radius_code(radius, frame->step) << RADIUS_AT | 1u << THERE_AT |
                         (uint32_t)octahedron_bytes(normal) << NORMAL_AT},
        .color = {color[0], color[1], color[2]}};
}

bool orl_point_decode_position(const struct point_frame *frame, const uint32_t geometry[2],
                               float position[3])
{
    const uint32_t q[3] = {
        geometry[0] & MOST_CODE, geometry[0] >> POSITION_BITS & MOST_CODE,
        (geometry[0] >> 2 * POSITION_BITS | geometry[1] << (32 - 2 * POSITION_BITS)) & MOST_CODE};
    for (int k = 0; k < 3; k++)
        position[k] = frame->origin[k] + frame->step * (float)q[k];
    return geometry[1] >> THERE_AT & 1;
}

void orl_point_decode_normal(const uint32_t geometry[2], float normal[3])
{
    float x = fmaxf((float)(int8_t)(geometry[1] >> NORMAL_AT) / 127, -1);
    float y = fmaxf((float)(int8_t)(geometry[1] >> (NORMAL_AT + 8)) / 127, -1);
    float z = 1 - fabsf(x) - fabsf(y), fold = fmaxf(-z, 0);
    x += x >= 0 ? -fold : fold;
    y += y >= 0 ? -fold : fold;
    float length = sqrtf(x * x + y * y + z * z);
    normal[0] = x / length, normal[1] = y / length, normal[2] = z / length;
}

float orl_point_decode_radius(const struct point_frame *frame, const uint32_t geometry[2])
{
    uint32_t code = geometry[1] >> RADIUS_AT & 0xff;
    return code ? frame->step * radius_steps((int)code) : 0;
}
