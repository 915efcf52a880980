// Level 0 of the pyramid, from the winning point of each pixel; runs once per chunk
// of points and writes the pixels that this chunk won.
#include "include/splat.glsl"
#include "include/octahedron.glsl"
#include "include/surfel.glsl"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(std430, binding = 2) readonly buffer pixel_point {
    uint point_index[];
};
layout(std430, binding = 3) readonly buffer point_attributes {
    uvec2 attributes[]; // octahedral normal (2x16 snorm), colour (8-bit sRGB)
};
layout(std430, binding = 4) readonly buffer pixel_layer {
    uvec2 layer[];
};
layout(rgba32f, binding = 0) writeonly uniform image2D surfel_a;
layout(rgba32f, binding = 1) writeonly uniform image2D surfel_b;
layout(rgba8, binding = 2) writeonly uniform image2D splat_color;

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= size.x || at.y >= size.y)
        return;
    uint winner = point_index[at.y * size.x + at.x];
    uint first = uint(size.w);
    if (winner < first || winner >= first + uint(size.z))
        return;
    uint point = winner - first;
    vec3 p = splat_camera_position(positions[point].xyz);
    vec2 pixel;
    splat_pixel(p, pixel);

    uvec2 mean = layer[at.y * size.x + at.x];
    if (mean.x > 0u) {
        float steps = (float(mean.y) / float(mean.x) + 0.5) / SPLAT_LAYER_STEPS;
        p *= 1.0 + (mean.x > 1u ? steps * options.y : 0.0);
    }

    surfel s;
    s.radius = positions[point].w * options.x;
    s.near = p.z;
    s.far = p.z + s.radius;
    s.depth = p.z;
    vec3 n = octahedron_decode(unpackSnorm2x16(attributes[point].x));
    n = vec3(dot(rotation[0].xyz, n), dot(rotation[1].xyz, n), dot(rotation[2].xyz, n));
    s.normal = dot(n, p) > 0.0 ? -n : n;
    s.displacement = pixel - (vec2(at) + 0.5);
    imageStore(surfel_a, at, surfel_pack_a(s));
    imageStore(surfel_b, at, surfel_pack_b(s));
    imageStore(splat_color, at, unpackUnorm4x8(attributes[point].y));
}
