// Points of one cell, one pixel each. Row 0 of every target but the canvas is the top row.
// LAYER: the points of the front layer alone, which layer.frag sums for their mean depth.
#include "proxy/octahedron.glsl"
#include "proxy/point.glsl"

layout(location = 0) in uvec2 code;
layout(location = 1) in vec2 octahedral; // normal
layout(location = 2) in vec3 srgb;
uniform mat3 rotation;      // camera from world
uniform vec3 cell_low;      // what positions count from, relative to the eye
uniform float cell_step;    // their unit
uniform float radius_scale;
uniform vec4 view_focal;    // fx fy cx cy, pixels
uniform vec2 size;          // pixels
uniform float typical;      // depth, where the depth test is most exact

#ifdef LAYER
uniform sampler2D nearest; // splats.frag
uniform float front_layer;
flat out float behind;
#else
flat out vec4 splat;
flat out uint normal;
flat out vec3 color;
#endif

void main()
{
    vec3 p = rotation * (cell_low + cell_step * point_steps(code));
    vec2 pixel = view_focal.xy * p.xy / p.z + view_focal.zw;
    vec2 at = floor(pixel);
    bool drawn = p.z > 0.0 && at.x >= 0.0 && at.y >= 0.0 && at.x < size.x && at.y < size.y;
#ifdef LAYER
    float front = drawn ? texelFetch(nearest, ivec2(at), 0).x : 0.0;
    behind = (p.z - front) / (front * max(front_layer, 1e-9));
    drawn = drawn && behind < 1.0;
#else
    vec3 n = rotation * octahedron_decode(octahedral);
    n = dot(n, p) > 0.0 ? -n : n;
    splat = vec4(p.z, radius_scale * point_radius(code, cell_step), pixel - (at + 0.5));
    normal = packSnorm2x16(octahedron_encode(n));
    color = srgb;
#endif
    vec2 place = (at + 0.5) / size * 2.0 - 1.0;
    float order = 2.0 * p.z / (p.z + typical) - 1.0;
    gl_Position = drawn ? vec4(place, order, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
    gl_PointSize = 1.0;
}
