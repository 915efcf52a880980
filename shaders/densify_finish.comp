// Planes to depth and normal maps, where they match; with GEOMETRIC, where the sources'
// depths agree too.
#include "include/densify.glsl"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(rgba32f, binding = 0) readonly uniform image2D planes;
layout(r32f, binding = 1) readonly uniform image2D costs;
layout(rgba32ui, binding = 2) readonly uniform uimage2D view_costs;
layout(rgba32f, binding = 3) writeonly uniform image2D maps; // normal, depth

const int SMOOTH_RADIUS = 2;
#ifdef GEOMETRIC
const int FIT_RADIUS = 9, FIT_STEP = 3; // odd, so that both colours of the sweeps count
#endif

#ifdef GEOMETRIC
// x: sources whose own depth is that of this plane, and which look alike; y: sources
// that see through the place to something clearly farther.
ivec2 count_opinions(vec3 plane, vec2 pixel, uvec4 views)
{
    ivec2 count = ivec2(0);
    for (int view = 0; view < SOURCES; view++) {
        vec4 q = vec4(pixel, 1.0, plane.x);
        float depth = dot(forward[3 * view + 2], q);
        if (!(extent[view].z > 0.0) || !(depth > 0.0))
            continue;
        vec2 texel = vec2(dot(forward[3 * view], q), dot(forward[3 * view + 1], q)) / depth;
        vec2 inside = texel - float(PADDING) + 0.5;
        if (any(lessThan(inside, vec2(0.0))) || any(greaterThan(inside, extent[view].xy)))
            continue;
        float seen = source_inverse_depth(view, texel);
        if (!(seen > 0.0))
            continue;
        if (geometric_cost(view, texel, pixel) < tune.z * limit.y) {
            if (cost_unpack(get_byte(views, view)) < limit.z)
                count.x++;
        } else if (seen * depth < 0.95 * plane.x) {
            count.y++;
        }
    }
    return count;
}
#endif

// Averages planes that pass through the same place: matching leaves each with noise of a
// fraction of a pixel in depth and several degrees in its normal.
vec3 smoothed_plane(ivec2 at, vec3 plane)
{
    vec3 sum = plane;
    float total = 1.0;
    for (int j = -SMOOTH_RADIUS; j <= SMOOTH_RADIUS; j++)
        for (int i = -SMOOTH_RADIUS; i <= SMOOTH_RADIUS; i++) {
            ivec2 q = at + ivec2(i, j);
            if (q == at || any(lessThan(q, ivec2(0))) || any(greaterThanEqual(q, area.xy)))
                continue;
            vec3 other = imageLoad(planes, q).xyz;
            other.x -= dot(other.yz, vec2(i, j));
            float apart = (other.x - plane.x) / range.z;
            float weight = max(1.0 - 4.0 * apart * apart, 0.0);
            sum += weight * other;
            total += weight;
        }
    return sum / total;
}

#ifdef GEOMETRIC
// Slopes of the plane through the places around: those of single patches are several
// degrees off. Depths that are not near the plane belong to something else.
vec2 fitted_slopes(ivec2 at, vec3 plane)
{
    float total = 1.0;
    vec3 mean = vec3(0.0);    // of w - plane.x, x and y
    vec3 squares = vec3(0.0); // of xx, xy, yy
    vec2 products = vec2(0.0), slopes = plane.yz;
    for (int j = -FIT_RADIUS; j <= FIT_RADIUS; j += FIT_STEP)
        for (int i = -FIT_RADIUS; i <= FIT_RADIUS; i += FIT_STEP) {
            ivec2 q = at + ivec2(i, j);
            if (any(lessThan(q, ivec2(0))) || any(greaterThanEqual(q, area.xy)))
                continue;
            vec3 other = imageLoad(planes, q).xyz;
            vec2 offset = vec2(i, j);
            float w = other.x - plane.x;
            float there = (w - dot(other.yz, offset)) / range.z;
            float here = (w - dot(plane.yz, offset)) / range.z;
            float weight = max(1.0 - 2.0 * there * there, 0.0) * max(1.0 - 4.0 * here * here, 0.0);
            total += weight;
            mean += weight * vec3(w, offset);
            squares += weight * vec3(i * i, i * j, j * j);
            products += weight * w * offset;
            slopes += weight * other.yz;
        }
    mean /= total;
    slopes /= total;
    squares = squares / total - vec3(mean.y * mean.y, mean.y * mean.z, mean.z * mean.z);
    products = products / total - mean.x * mean.yz;
    // The patches' own slopes count like pixels two away.
    squares.xz += 4.0;
    products += 4.0 * slopes;
    return vec2(squares.z * products.x - squares.y * products.y,
                squares.x * products.y - squares.y * products.x) /
           (squares.x * squares.z - squares.y * squares.y);
}
#endif

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
#ifdef GEOMETRIC
    ivec2 count = count_opinions(plane, pixel, imageLoad(view_costs, at));
    keep = keep && count.y <= count.x && (count.x >= 2 || (count.x == 1 && cost < limit.w));
#endif
    if (keep) {
        plane = smoothed_plane(at, plane);
#ifdef GEOMETRIC
        plane.yz = fitted_slopes(at, plane);
#endif
        map = vec4(-normalize(plane_normal(plane, pixel)), 1.0 / plane.x);
    }
    imageStore(maps, at, map);
}
