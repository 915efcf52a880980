// Blends photographs into the frame: projects every pixel's surface point into each,
// asks its depth map whether it saw that point, and adds its weighted colour.
#include "gather/airieau.glsl"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(r32f, binding = 0) readonly uniform image2D view_depth; // < 0: guessed background
layout(rgba32f, binding = 1) uniform image2D accumulated;      // colour * weight, weight

// One photograph's colour * weight, weight.
vec4 look(photo shot, vec3 p, bool guessed)
{
    vec2 pixel;
    float z;
    if (!photo_project(shot, p, pixel, z))
        return vec4(0.0);
    if (flags.x == 1 && !photo_sees(photo_depths(shot, pixel), z, guessed))
        return vec4(0.0);
    float weight = airieau_weight(p, shot.eye.xyz);
    // Where depth is only guessed, photographs disagree: let the best one dominate.
    if (guessed)
        weight = pow(weight * options.y, 8.0);
    weight *= photo_border(shot, pixel, false); // among all, no border shows
    return weight > 0.0
               ? vec4(photo_sample(shot, pixel, photo_mip(shot, z, p.z)).rgb, 1.0) * weight
               : vec4(0.0);
}

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= area.x || at.y >= area.y)
        return;
    float stored = imageLoad(view_depth, at).r;
    bool guessed = stored < 0.0;
    float depth = abs(stored);
    if (!(depth > 0.0))
        return;
    vec3 p = vec3((vec2(at) + 0.5 - view_focal.zw) / view_focal.xy, 1.0) * depth;
    vec4 sum = vec4(0.0);
    int i = 0;
    do { // the condition last: see gather_best.comp
        sum += look(photo_at(i), p, guessed);
        i++;
    } while (i < area.z);
    if (sum.a > 0.0)
        imageStore(accumulated, at, imageLoad(accumulated, at) + sum);
}
