// A quad over each soft splat, as shaders/soft/project.comp projects them. What src/walk/site_soft.c packs:
layout(location = 0) in vec3 place;        // world
layout(location = 1) in vec3 sigma;        // logarithms of the standard deviations, as ORL_SOFT_SIGMA_LOG has them
layout(location = 2) in vec2 opacity;      // y: logarithm of the pixel that it was adjusted in, within pixel_range
layout(location = 3) in vec4 turn;
layout(location = 4) in vec3 harmonic;     // parts of ORL_SOFT_COLOR_MOST
uniform mat3 rotation;                     // camera from world
uniform vec3 eye;
uniform vec4 focal;                        // fx fy cx cy, pixels
uniform vec2 size;                         // pixels
uniform vec2 pixel_range;                  // the smallest, and octaves up to the largest; scene units
flat out vec2 centre;
flat out vec4 shape;                       // inverse covariance; opacity
flat out vec3 color;                       // sRGB

mat3 view_rotation()
{
    return rotation;
}

#include "shared/constants.h"
#include "soft/seen.glsl"

void main()
{
    vec3 p = rotation * (place - eye);
    float pixel = pixel_range.x * exp2(pixel_range.y * opacity.y) * focal.x / p.z;
    splat s = splat(place, exp(ORL_SOFT_SIGMA_LOG * (2.0 * sigma - 1.0)), opacity.x, normalize(turn), 1.0);
    seen_splat seen;
    vec2 reach;
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    if (splat_seen(s, p, size, pixel, seen, reach)) {
        vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
        gl_Position = vec4((seen.centre + reach * corner) / size * 2.0 - 1.0, 0.0, 1.0);
    }
    centre = seen.centre;
    shape = vec4(seen.inverse, seen.opacity);
    color = max(splat_color(ORL_SOFT_COLOR_MOST * harmonic), 0.0);
}
