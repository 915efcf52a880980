// Turns planes into depth and normal maps where the matching cost is low enough. GEOMETRIC: also
// requires consistency with the depth maps of the sources. SMOOTH: also averages depth, for the
// final result, which no later pass refines.
#include "densify/densify.glsl"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(rgba32f, binding = 0) readonly uniform image2D planes;
layout(r32f, binding = 1) readonly uniform image2D costs;
layout(rgba32ui, binding = 2) readonly uniform uimage2D fits; // of densify/fit.comp
layout(rgba32f, binding = 3) writeonly uniform image2D maps; // confidence * normal, depth

const int FIT_ASIDE = 6, FIT_DIAGONAL = 5, SMOOTH_RADIUS = 2;

// Returns the plane with the slopes of the best fit: of the planes fitted around this pixel and
// around eight pixels nearby, the one with the least misfit that passes through this pixel's depth.
// Shifted windows may lie on one side of a depth discontinuity (Kuwahara et al. 1976). The slopes
// of single patches are several degrees off.
vec3 fitted_plane(ivec2 at, vec3 plane)
{
    vec3 chosen = plane;
    float least = 1e6;
    for (int k = 0; k < 9; k++) {
        ivec2 offset = ivec2(k % 3 - 1, k / 3 - 1);
        offset *= offset.x != 0 && offset.y != 0 ? FIT_DIAGONAL : FIT_ASIDE;
        ivec2 q = at + offset;
        if (any(lessThan(q, ivec2(0))) || any(greaterThanEqual(q, area.xy)))
            continue;
        vec4 fit = uintBitsToFloat(imageLoad(fits, q));
        fit.x -= dot(fit.yz, vec2(offset));
        float apart = (fit.x - plane.x) / range.z;
        float misfit = fit.w < 1e8 && 2.0 * apart * apart < 1.0 ? fit.w : 1e9;
        misfit = (misfit + 0.5 * apart * apart) * (k == 4 ? 1.0 : 1.1);
        if (misfit < least) {
            least = misfit;
            chosen.yz = fit.yz;
        }
    }
    return chosen;
}

// Averages the inverse depth with that of neighbouring planes that pass through the same point.
float smoothed_depth(ivec2 at, vec3 plane)
{
    float sum = plane.x, total = 1.0;
    for (int j = -SMOOTH_RADIUS; j <= SMOOTH_RADIUS; j++)
        for (int i = -SMOOTH_RADIUS; i <= SMOOTH_RADIUS; i++) {
            ivec2 q = at + ivec2(i, j);
            if (q == at || any(lessThan(q, ivec2(0))) || any(greaterThanEqual(q, area.xy)))
                continue;
            vec3 other = imageLoad(planes, q).xyz;
            other.x -= dot(other.yz, vec2(i, j));
            float apart = (other.x - plane.x) / range.z;
            float weight = max(1.0 - 4.0 * apart * apart, 0.0);
            sum += weight * other.x;
            total += weight;
        }
    return sum / total;
}

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy) + ivec2(0, area.z);
    if (at.x >= area.x || at.y >= area.w)
        return;
    vec2 pixel = pixel_centre(at);
    vec3 plane = imageLoad(planes, at).xyz;
    vec4 map = vec4(0.0);
    float cost = imageLoad(costs, at).r;
    bool keep = texelFetch(reference, at, 0).g > 0.0 && plane.x > 0.0 && cost < limit.x;
    // Confidence: 0.5 at zero cost, 0.25 at the greatest cost that is kept. Geometric consistency
    // raises it to at most twice that: each further source that agrees halves the rest.
    float confidence = 0.5 * (1.0 - 0.5 * cost / limit.x);
#ifdef GEOMETRIC
    consistency asked = ask_sources(plane, pixel);
    confidence *= 2.0 * max(1.0 - exp2(-float(asked.agree - asked.against)), 0.1);
    keep = keep && asked.against <= asked.agree &&
           (asked.agree >= 2 || (asked.agree == 1 && cost < limit.w));
#endif
    if (keep) {
        vec3 fitted = fitted_plane(at, plane);
#ifdef SMOOTH
        fitted.x = smoothed_depth(at, plane);
#endif
        plane = fitted;
        map = vec4(-confidence * normalize(plane_normal(plane, pixel)), 1.0 / plane.x);
    }
    imageStore(maps, at, map);
}
