// Fits for every pixel a plane to the surface points around it, and measures the misfit.
// densify/finish.comp chooses among these planes.
#include "densify/densify.glsl"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(rgba32f, binding = 0) readonly uniform image2D planes;
layout(r32f, binding = 1) readonly uniform image2D costs;
layout(rgba32ui, binding = 2) writeonly uniform uimage2D fits; // bits of w, its slopes, misfit

const int FIT_RADIUS = 9, FIT_STEP = 3; // an odd step, so that both checkerboard colours contribute
const float FIT_COUNT = 49.0;
// Weight of the patches' own slopes, equal to that of depth differences at this squared distance
// in pixels. Over a few pixels the slopes are more precise than the differences of depths.
const float SLOPE_WEIGHT = 200.0;
// Variance that noise alone causes, squared pixels.
const float FIT_FLOOR = 0.001;

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy) + ivec2(0, area.z);
    if (at.x >= area.x || at.y >= area.w)
        return;
    vec3 plane = imageLoad(planes, at).xyz;
    float total = 0.0, square = 0.0;
    vec3 mean = vec3(0.0);    // of w - plane.x, x and y
    vec3 squares = vec3(0.0); // of xx, xy, yy
    vec2 products = vec2(0.0), slopes = vec2(0.0);
    for (int j = -FIT_RADIUS; j <= FIT_RADIUS; j += FIT_STEP)
        for (int i = -FIT_RADIUS; i <= FIT_RADIUS; i += FIT_STEP) {
            ivec2 q = at + ivec2(i, j);
            if (any(lessThan(q, ivec2(0))) || any(greaterThanEqual(q, area.xy)))
                continue;
            vec3 other = imageLoad(planes, q).xyz;
            // Distance of each point from the plane of the other, as a shift of a match in pixels.
            vec2 offset = vec2(i, j);
            float w = (other.x - plane.x) / range.z;
            float there = w - dot(other.yz, offset) / range.z;
            float here = w - dot(plane.yz, offset) / range.z;
            float weight = max(1.0 - there * there, 0.0) * max(1.0 - 2.0 * here * here, 0.0);
            if (!(weight > 0.0) || !(imageLoad(costs, q).r < limit.x))
                continue;
            total += weight;
            mean += weight * vec3(w, offset);
            square += weight * w * w;
            squares += weight * vec3(i * i, i * j, j * j);
            products += weight * w * offset;
            slopes += weight * other.yz / range.z;
        }
    vec4 fit = vec4(plane, 1e9);
    if (total > 0.06 * FIT_COUNT) {
        mean /= total;
        slopes /= total;
        square = square / total - mean.x * mean.x;
        squares = squares / total - vec3(mean.y * mean.y, mean.y * mean.z, mean.z * mean.z);
        products = products / total - mean.x * mean.yz;
        vec2 p = products + SLOPE_WEIGHT * slopes;
        vec3 s = squares + SLOPE_WEIGHT * vec3(1.0, 0.0, 1.0);
        vec2 best = vec2(s.z * p.x - s.y * p.y, s.x * p.y - s.y * p.x) / (s.x * s.z - s.y * s.y);
        float misfit = square - 2.0 * dot(best, products) + best.x * best.x * squares.x +
                       2.0 * best.x * best.y * squares.y + best.y * best.y * squares.z;
        float full = FIT_COUNT / total;
        fit = vec4(plane.x + (mean.x - dot(best, mean.yz)) * range.z, best * range.z,
                   (max(misfit, 0.0) + FIT_FLOOR) * full * sqrt(full));
    }
    imageStore(fits, at, floatBitsToUint(fit));
}
