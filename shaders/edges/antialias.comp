// Averages each pixel that antialias_find.comp listed with its 3x3 neighbourhood. The first run writes
// into the list, since neighbours still need the original colours; the run with WRITE copies the list to
// the picture. HALF: the picture has half floats.
#include "edges/edge.glsl"
#include "edges/edge_list.glsl"

layout(local_size_x = EDGE_GROUP) in;
#ifdef HALF
layout(rgba16f, binding = 0) uniform image2D color; // w: coverage
#else
layout(rgba32f, binding = 0) uniform image2D color;
#endif

vec3 average(uvec4 edge)
{
    vec3 around[9];
    for (int n = 0; n < 9; n++)
        around[n] = imageLoad(color, edge_pixel(edge) + ivec2(n % 3, n / 3) - 1).rgb;
    return edge_mean(around, uintBitsToFloat(edge.y));
}

void main()
{
    uint place = gl_GlobalInvocationID.x;
    while (place < edges_listed()) {
#ifdef WRITE
        ivec2 at = edge_pixel(edges[place]);
        imageStore(color, at, vec4(uintBitsToFloat(edges[place].yzw), imageLoad(color, at).a));
#else
        edges[place].yzw = floatBitsToUint(average(edges[place]));
#endif
        place += EDGE_GROUP * gl_NumWorkGroups.x;
    }
}
