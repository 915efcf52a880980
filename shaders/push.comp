// One push step: empty and occluded pixels of a finer level are filled from those of
// the four nearest coarser pixels whose disc they lie in (Airieau 2012, 5.1).
// One invocation takes the four fine pixels around a corner where four coarse pixels meet:
// those are the bilinear neighbours of all four, so they are read and prepared once.
#define BLOCK_PYRAMID
#include "include/render_blocks.h"
#include "include/octahedron.glsl"
#include "include/surfel.glsl"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(rgba32f, binding = 0) uniform image2D fine_a;
layout(rgba32f, binding = 1) writeonly uniform image2D fine_b;
layout(rgba32f, binding = 2) readonly uniform image2D coarse_a;
layout(rgba32f, binding = 3) readonly uniform image2D coarse_b;

// centre: of the discs, level 0 pixels; ray: to them, at unit depth.
void fill(ivec2 at, vec4 own, surfel disc[4], vec2 centre[4], vec2 ray[4], vec4 weight)
{
    vec2 target = level_centre(at, level.z);
    vec2 target_ray = (target - camera.zw) / camera.xy;
    float front = 1e38, front_far = 0.0;
    bool hit[4];
    for (int i = 0; i < 4; i++) {
        bool inside;
        float depth = surfel_depth_at(disc[i], ray[i], target_ray, inside);
        // A disc smaller than a pixel on screen still closes empty pixels around its
        // centre, as EWA's low-pass filter does: otherwise slanted surfaces are full of
        // pinholes. It hides nothing there.
        vec2 off = centre[i] - target;
        bool closes = own.w <= 0.0 && dot(off, off) <= SURFEL_MIN_RADIUS_PX * SURFEL_MIN_RADIUS_PX;
        hit[i] = disc[i].radius > 0.0 && depth > 0.0 && (inside || closes);
        bool nearer = hit[i] && disc[i].near < front;
        front = nearer ? disc[i].near : front;
        front_far = nearer ? disc[i].far : front_far;
    }
    // A pixel with a surface of its own keeps it unless a nearer disc hides it.
    if (front_far == 0.0 || (own.w > 0.0 && own.x <= front_far))
        return;
    surfel sum = surfel(front, front_far, 0.0, 0.0, vec3(0.0), vec2(0.0));
    float total = 0.0;
    for (int i = 0; i < 4; i++) {
        float w = hit[i] && disc[i].near <= front_far ? weight[i] : 0.0;
        sum.far = max(sum.far, w > 0.0 ? disc[i].far : 0.0);
        sum.depth += w * disc[i].depth;
        sum.radius += w * disc[i].radius;
        sum.normal += w * disc[i].normal;
        sum.displacement += w * (centre[i] - target);
        total += w;
    }
    float scale = 1.0 / total;
    sum.depth *= scale;
    sum.radius *= scale;
    sum.displacement *= scale;
    if (!(dot(sum.normal, sum.normal) > 1e-12 * total * total))
        sum.normal = vec3(0.0, 0.0, -1.0);
    imageStore(fine_a, at, surfel_pack_a(sum));
    imageStore(fine_b, at, surfel_pack_b(sum));
}

void main()
{
    // The coarse pixel above and left of the corner; -1 at the border.
    ivec2 corner = ivec2(gl_GlobalInvocationID.xy) - 1;
    if (2 * corner.x + 1 >= level.x || 2 * corner.y + 1 >= level.y)
        return;
    surfel disc[4];
    vec2 centre[4], ray[4];
    vec4 own[4];
    float least = 1e38; // depth up to which a pixel's own surface is certainly not hidden
    for (int i = 0; i < 4; i++) {
        ivec2 from = corner + ivec2(i & 1, i >> 1);
        // Outside: zero, thus empty.
        disc[i] = surfel_unpack(imageLoad(coarse_a, from), imageLoad(coarse_b, from));
        centre[i] = level_centre(from, level.z + 1) + disc[i].displacement;
        ray[i] = (centre[i] - camera.zw) / camera.xy;
        own[i] = imageLoad(fine_a, 2 * corner + 1 + ivec2(i & 1, i >> 1));
        least = disc[i].radius > 0.0 ? min(least, disc[i].far) : least;
    }
    for (int i = 0; i < 4; i++) {
        ivec2 at = 2 * corner + 1 + ivec2(i & 1, i >> 1);
        vec4 weight = i == 0 ? vec4(0.5625, 0.1875, 0.1875, 0.0625)
                    : i == 1 ? vec4(0.1875, 0.5625, 0.0625, 0.1875)
                    : i == 2 ? vec4(0.1875, 0.0625, 0.5625, 0.1875)
                             : vec4(0.0625, 0.1875, 0.1875, 0.5625);
        if (all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, level.xy)) &&
            !(own[i].w > 0.0 && own[i].x <= least))
            fill(at, own[i], disc, centre, ray, weight);
    }
}
