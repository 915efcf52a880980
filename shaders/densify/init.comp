// Initialises every pixel with a plane and its cost in every source. The plane is the best of
// several random ones (FROM_RANDOM), comes from the coarser level (FROM_COARSE), or comes from
// finished depth and normal maps (FROM_MAPS).
#include "densify/densify.glsl"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(rgba32f, binding = 0) writeonly uniform image2D planes;
layout(r32f, binding = 1) writeonly uniform image2D costs;
layout(rgba32ui, binding = 2) writeonly uniform uimage2D view_costs;
#ifdef FROM_COARSE
layout(rgba32f, binding = 3) readonly uniform image2D coarse_planes;
#endif
#ifdef FROM_MAPS
layout(rgba32f, binding = 3) readonly uniform image2D maps; // normal, depth
#endif
#ifdef FROM_RANDOM
layout(r32f, binding = 3) readonly uniform image2D seeds; // 1/z of sparse points; 0: none
#endif

vec3 first_plane(ivec2 at, vec2 pixel, int attempt)
{
#ifdef FROM_RANDOM
    vec3 plane = random_plane(pixel);
    float seed = imageLoad(seeds, at).r;
    if ((attempt & 1) == 1 && seed > 0.0) {
        // A sparse point nearby suggests a similar depth.
        float w = clamp(seed * (1.0 + 0.3 * random_signed()), range.x, range.y);
        plane *= w / plane.x;
    }
    return plane;
#endif
#ifdef FROM_COARSE
    ivec2 from = min(at / 2, imageSize(coarse_planes) - 1);
    vec3 plane = imageLoad(coarse_planes, from).xyz;
    plane.yz *= 0.5;
    plane.x += dot(plane.yz, pixel - 2.0 * pixel_centre(from));
    return plane;
#endif
#ifdef FROM_MAPS
    vec4 map = imageLoad(maps, at);
    if (!(map.w > 0.0))
        return random_plane(pixel);
    return plane_from_normal(1.0 / map.w, -map.xyz, pixel);
#endif
}

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy) + ivec2(0, area.z);
    if (at.x >= area.x || at.y >= area.w)
        return;
    vec2 pixel = pixel_centre(at);
    random_start(at);
    vec3 best_plane = vec3(0.0);
    float best = 2.0 * COST_MAX;
    uvec4 best_views = uvec4(0xffffffffu);
    if (texelFetch(reference, at, 0).g > 0.0) {
        load_patch(at);
        for (int attempt = 0; attempt < run.w; attempt++) {
            vec3 plane = first_plane(at, pixel, attempt);
            if (!plane_valid(plane, pixel))
                plane = vec3(clamp(plane.x, range.x, range.y), 0.0, 0.0);
#ifdef GEOMETRIC
            uvec4 views = uvec4(0u);
            float cost = agreed_cost(plane, pixel, 1e9);
#else
            uvec4 views = uvec4(0xffffffffu);
            float sum = 0.0, total = 1e-6;
            for (int view = 0; view < SOURCES; view++) {
                float cost = extent[view].z > 0.0 ? view_cost(view, plane, pixel) : COST_MAX;
                views = set_byte(views, view, cost_pack(cost));
                // A soft minimum, because it is still unknown which sources see the surface point.
                float weight = exp2(-8.0 * cost * cost);
                sum += weight * cost;
                total += weight;
            }
            float cost = (sum + 1e-6 * COST_MAX) / total;
#endif
            if (cost < best || attempt == 0) {
                best = cost;
                best_plane = plane;
                best_views = views;
            }
        }
    }
    imageStore(planes, at, vec4(best_plane, 0.0));
    imageStore(costs, at, vec4(best));
    imageStore(view_costs, at, best_views);
}
