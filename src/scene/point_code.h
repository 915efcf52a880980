// Private: how points are stored on the device: their geometry in 8 bytes, their colours apart, since
// only the method `points` reads them and a walk while photographs are loaded. Positions are whole
// numbers of steps from the corner of their block. shaders/proxy/point.glsl and, of a published site,
// web/js/points.js decode them.
#ifndef ORL_SCENE_POINT_CODE_H
#define ORL_SCENE_POINT_CODE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// A block's unit of length and the position that its codes count from, in scene units.
struct point_frame {
    float origin[3], step;
};

// Bounds of positions and radii, to choose a frame for.
struct point_range {
    float low[3], high[3];           // of positions
    float min_radius, max_radius; // of radii above 0; least INFINITY, most 0: there are none
};
struct point_range orl_point_range_none(void);
void orl_point_range_add(struct point_range *range, const float position[3], float radius);
// The middle and half the size, measured from the rounded middle, so that no position lies outside.
void orl_point_range_box(const struct point_range *range, float middle[3], float extent[3]);
// True if a frame for these points resolves positions to a sixteenth of the least radius, so that
// storage makes no difference to a picture. False: they are better stored as several blocks.
bool orl_point_range_is_precise(const struct point_range *range);
struct point_frame orl_point_frame(const struct point_range *range);

struct point_code {
    // 0: no point. From the lowest bit on: x, y and z, 13 bits each; the radius, 8; a bit that is
    // set; the normal, two signed bytes in octahedral form.
    uint32_t geometry[2];
    uint8_t color[3]; // sRGB
    uint8_t unused;   // 0
};
// Decodes as a point that is never drawn.
extern const struct point_code orl_point_code_none;

// Normals of any length are taken as directions.
struct point_code orl_point_encode(const struct point_frame *frame, const float position[3],
                                   const float normal[3], const uint8_t color[3], float radius);
// False: no point.
bool orl_point_decode_position(const struct point_frame *frame, const uint32_t geometry[2],
                               float position[3]);
// Unit length; of a point without a normal, +z.
void orl_point_decode_normal(const uint32_t geometry[2], float normal[3]);
float orl_point_decode_radius(const struct point_frame *frame, const uint32_t geometry[2]);

#endif
