// One push step: fills empty and occluded pixels of a finer level from those of the four nearest
// coarser surfels that cover them (Airieau 2012, 5.1).
// One invocation takes the four fine pixels around a corner where four coarse pixels meet. These
// coarse pixels are the bilinear neighbours of all four, so they are read and prepared once.
// LAST: the finest level; the output is depth at pixel centres, with NORMALS also normals.
#define BLOCK_PYRAMID
#include "shared/render_blocks.h"
#include "proxy/octahedron.glsl"
#include "proxy/surfel.glsl"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(rgba32f, binding = 0) readonly uniform image2D coarse_a;
layout(rg32ui, binding = 1) readonly uniform uimage2D coarse_b;
#ifdef LAST
#ifdef NORMALS
layout(rg32ui, binding = 2) readonly uniform uimage2D splats; // surfel_pack_own
layout(r32f, binding = 3) writeonly uniform image2D depth_out;     // 0: none
layout(rgba16f, binding = 4) writeonly uniform image2D normal_out; // w: 1 on a splat
#else
layout(r32f, binding = 3) uniform image2D depth_out; // in: surfel_own_depth
#endif
#else
layout(rgba32f, binding = 2) uniform image2D fine_a;
layout(rg32ui, binding = 3) writeonly uniform uimage2D fine_b;
#endif

vec2 camera_ray(vec2 pixel)
{
    return (pixel - camera.zw) / camera.xy;
}

#include "proxy/push.glsl"

void main()
{
    // The coarse pixel above and left of the corner; -1 at the border.
    ivec2 corner = ivec2(gl_GlobalInvocationID.xy) - 1;
    if (2 * corner.x + 1 >= level_size.x || 2 * corner.y + 1 >= level_size.y)
        return;
    surfel disc[4];
    vec2 centre[4], ray[4];
    for (int i = 0; i < 4; i++) {
        ivec2 from = corner + ivec2(i & 1, i >> 1);
        // Loads outside the level give zero, which is an empty pixel.
        disc[i] = surfel_unpack(imageLoad(coarse_a, from), imageLoad(coarse_b, from));
        centre[i] = level_centre(from, level_number + 1) + disc[i].displacement;
        ray[i] = camera_ray(centre[i]);
    }
#ifdef LAST
    float depths[4];
    vec4 normals[4];
#endif
    for (int i = 0; i < 4; i++) {
        ivec2 at = 2 * corner + 1 + ivec2(i & 1, i >> 1);
        vec4 weight = i == 0 ? vec4(0.5625, 0.1875, 0.1875, 0.0625)
                    : i == 1 ? vec4(0.1875, 0.5625, 0.0625, 0.1875)
                    : i == 2 ? vec4(0.1875, 0.0625, 0.5625, 0.1875)
                             : vec4(0.0625, 0.1875, 0.1875, 0.5625);
        vec2 target = level_centre(at, level_number);
#ifdef LAST
#ifdef NORMALS
        uvec2 own = imageLoad(splats, at).xy;
        float own_depth = uintBitsToFloat(own.x);
#else
        float own_depth = imageLoad(depth_out, at).x;
#endif
        surfel s = filled(target, supported(own_depth, disc), disc, centre, ray, weight);
        bool kept = s.radius == 0.0, inside;
        s.normal = normalize(s.normal);
        float depth = surfel_depth_at(s, camera_ray(target + s.displacement), camera_ray(target),
                                      inside);
        depths[i] = kept ? own_depth : depth;
#ifdef NORMALS
        vec3 normal = kept ? octahedron_decode(unpackSnorm2x16(own.y)) : s.normal;
        bool any = !kept || own_depth > 0.0;
        normals[i] = any ? vec4(normal, kept ? 1.0 : 0.0) : vec4(0.0);
#endif
#else
        float own_near = imageLoad(fine_a, at).x;
        surfel s = filled(target, own_near, disc, centre, ray, weight);
        // Stores outside the level do nothing.
        if (s.radius > 0.0) {
            imageStore(fine_a, at, surfel_pack_a(s));
            imageStore(fine_b, at, surfel_pack_b(s));
        }
#endif
    }
#ifdef LAST
    for (int i = 0; i < 4; i++) { // stores come last: see gather/tiled.comp
        ivec2 at = 2 * corner + 1 + ivec2(i & 1, i >> 1);
        imageStore(depth_out, at, vec4(depths[i]));
#ifdef NORMALS
        imageStore(normal_out, at, normals[i]);
#endif
    }
#endif
}
