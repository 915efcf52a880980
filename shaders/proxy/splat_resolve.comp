// Makes levels 0 and 1 of the pyramid from the winning points. One invocation handles 2x2 pixels.
// CHUNKS: runs once for each chunk of points and writes the pixels that this chunk won; the last
// run leaves level 1 complete.
// NORMALS: level 0 has normals.
#include "shared/constants.h"
#include "proxy/splat.glsl"
#include "proxy/octahedron.glsl"
#include "proxy/surfel.glsl"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(rg32ui, binding = 0) readonly uniform uimageBuffer points; // proxy/point.glsl
layout(binding = 0) uniform samplerBuffer blocks; // ORL_BLOCK_VEC4S each
layout(r32ui, binding = 1) readonly uniform uimage2D splat_index;
layout(r32ui, binding = 2) readonly uniform uimage2D splat_layer;
#ifdef NORMALS
layout(rg32ui, binding = 3) writeonly uniform uimage2D splats; // surfel_pack_own
#else
layout(r32f, binding = 3) writeonly uniform image2D splats; // surfel_own_depth
#endif
layout(rgba32f, binding = 4) writeonly uniform image2D coarse_a;
layout(rg32ui, binding = 5) writeonly uniform uimage2D coarse_b;
#ifdef CHUNKS
layout(rgba32ui, binding = 6) uniform uimage2D won; // surfels of this and earlier chunks
#endif

vec2 splat_ray(vec2 pixel)
{
    return (pixel - focal.zw) / focal.xy;
}

surfel splat(ivec2 at, int point)
{
    uvec2 code = imageLoad(points, point).xy;
    vec4 corner = texelFetch(blocks, ORL_BLOCK_VEC4S * (point / ORL_BLOCK_POINTS) + 2);
    vec3 p = splat_camera_position(code, corner);
    vec2 pixel;
    splat_pixel(p, pixel);
    uint word = imageLoad(splat_layer, at).x;
    float count = float(word / SPLAT_LAYER_COUNT), steps = float(word % SPLAT_LAYER_COUNT);
    float behind = count > 1.0 ? min((steps / count + 0.5) / SPLAT_LAYER_STEPS, 1.0) : 0.0;
    p *= 1.0 + behind * front_layer;
    vec3 n = splat_camera_vector(octahedron_decode(unpackSnorm4x8(code.y).zw));
    float radius = point_radius(code, corner.w) * splat_scale;
    bool outlier = p.z < near && radius * focal.y > ORL_OUTLIER_SHARE * float(view_size.y) * p.z;
    radius = outlier ? 0.0 : radius;
    return surfel(p.z, p.z + radius, p.z, radius, dot(n, p) > 0.0 ? -n : n,
                  pixel - (vec2(at) + 0.5));
}

void main()
{
    ivec2 parent = ivec2(gl_GlobalInvocationID.xy);
    if (2 * parent.x >= view_size.x || 2 * parent.y >= view_size.y)
        return;
    surfel child[4];
#ifdef NORMALS
    uvec4 own[4];
#else
    vec4 own[4];
#endif
#ifdef CHUNKS
    int written = 0; // a bit for each child that this chunk decides
#endif
    for (int i = 0; i < 4; i++) {
        ivec2 at = 2 * parent + ivec2(i & 1, i >> 1);
        uint point = imageLoad(splat_index, at).x - uint(first_point);
        bool mine = point < uint(point_count) && at.x < view_size.x && at.y < view_size.y;
        // Without a branch, the view's parameters are loaded once for all four pixels.
        child[i] = splat(at, mine ? int(point) : 0);
        child[i].radius = mine ? child[i].radius : 0.0;
        vec2 centre = vec2(at) + 0.5;
        vec2 ray = splat_ray(centre + child[i].displacement), target = splat_ray(centre);
#ifdef NORMALS
        own[i] = surfel_pack_own(child[i], ray, target);
#else
        own[i] = vec4(surfel_own_depth(child[i], ray, target));
#endif
#ifdef CHUNKS
        mine = mine || first_point == 0;
        written |= mine ? 1 << i : 0;
        if (!mine)
            child[i] = surfel_unpack_splat(imageLoad(won, at));
        imageStore(won, at, surfel_pack_splat(child[i]));
#endif
    }
    surfel merged = surfel_merge(child, 0);
    // Stores come last: see gather/tiled.comp.
    for (int i = 0; i < 4; i++)
#ifdef CHUNKS
        if ((written >> i & 1) == 1)
#endif
            imageStore(splats, 2 * parent + ivec2(i & 1, i >> 1), own[i]);
    imageStore(coarse_a, parent, surfel_pack_a(merged));
    imageStore(coarse_b, parent, surfel_pack_b(merged));
}
