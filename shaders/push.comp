// One push step: empty and occluded pixels of a finer level are filled from those of
// the four nearest coarser pixels whose disc they lie in (Airieau 2012, 5.1).
#define BLOCK_PYRAMID
#include "include/render_blocks.h"
#include "include/octahedron.glsl"
#include "include/surfel.glsl"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(rgba32f, binding = 0) uniform image2D fine_a;
layout(rgba32f, binding = 1) uniform image2D fine_b;
layout(rgba32f, binding = 2) readonly uniform image2D coarse_a;
layout(rgba32f, binding = 3) readonly uniform image2D coarse_b;

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= level.x || at.y >= level.y)
        return;
    vec4 own = imageLoad(fine_a, at);
    vec2 centre = level_centre(at, level.z);
    ivec2 last = imageSize(coarse_a) - 1;
    // Bilinear neighbours in the coarser level: the parent and the ones on this side.
    ivec2 parent = at / 2, side = 2 * (at & 1) - 1;
    surfel found[4];
    float depths[4], weights[4];
    float front = 1e38, front_far = 0.0;
    for (int i = 0; i < 4; i++) {
        ivec2 step = ivec2(i & 1, i >> 1);
        ivec2 from = parent + side * step;
        weights[i] = (step.x == 0 ? 0.75 : 0.25) * (step.y == 0 ? 0.75 : 0.25);
        depths[i] = 0.0;
        if (any(lessThan(from, ivec2(0))) || any(greaterThan(from, last)))
            continue;
        vec4 a = imageLoad(coarse_a, from);
        if (!(a.w > 0.0))
            continue;
        found[i] = surfel_unpack(a, imageLoad(coarse_b, from));
        vec2 disc_centre = level_centre(from, level.z + 1) + found[i].displacement;
        bool inside;
        depths[i] = surfel_depth_at(found[i], disc_centre, centre, camera, inside);
        found[i].displacement = disc_centre - centre;
        // A disc smaller than a pixel on screen still closes empty pixels around its
        // centre, as EWA's low-pass filter does: otherwise slanted surfaces are full of
        // pinholes. It hides nothing there.
        bool closes = own.w <= 0.0 && length(disc_centre - centre) <= SURFEL_MIN_RADIUS_PX;
        if (!inside && !closes)
            depths[i] = 0.0;
        if (depths[i] > 0.0 && found[i].near < front) {
            front = found[i].near;
            front_far = found[i].far;
        }
    }
    // A pixel with a surface of its own keeps it unless a nearer disc hides it.
    if ((own.w > 0.0 && own.x <= front_far) || front_far == 0.0)
        return;
    surfel sum = surfel(front, front_far, 0.0, 0.0, vec3(0.0), vec2(0.0));
    float total = 0.0;
    for (int i = 0; i < 4; i++) {
        if (!(depths[i] > 0.0 && found[i].near <= front_far))
            continue;
        float w = weights[i];
        sum.far = max(sum.far, found[i].far);
        sum.depth += w * found[i].depth;
        sum.radius += w * found[i].radius;
        sum.normal += w * found[i].normal;
        sum.displacement += w * found[i].displacement;
        total += w;
    }
    sum.depth /= total;
    sum.radius /= total;
    sum.displacement /= total;
    sum.normal = dot(sum.normal, sum.normal) > 1e-12 ? normalize(sum.normal)
                                                     : vec3(0.0, 0.0, -1.0);
    imageStore(fine_a, at, surfel_pack_a(sum));
    imageStore(fine_b, at, surfel_pack_b(sum));
}
