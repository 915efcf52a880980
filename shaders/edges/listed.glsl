// Gives the pixels of a list the colours of edge_color, which the including file defines. The first run
// writes into the list, since neighbours still need the original colours; the run with WRITE copies the
// list to the picture. HALF: the picture has half floats.
#include "edges/edge_list.glsl"

layout(local_size_x = EDGE_GROUP) in;
#ifdef HALF
layout(rgba16f, binding = 0) uniform image2D color; // w: coverage
#else
layout(rgba32f, binding = 0) uniform image2D color;
#endif

vec3 edge_color(uvec4 edge); // from the other data of the pixel

void main()
{
    uint place = gl_GlobalInvocationID.x;
    while (place < edges_listed()) {
#ifdef WRITE
        ivec2 at = edge_pixel(edges[place]);
        imageStore(color, at, vec4(uintBitsToFloat(edges[place].yzw), imageLoad(color, at).a));
#else
        edges[place].yzw = floatBitsToUint(edge_color(edges[place]));
#endif
        place += EDGE_GROUP * gl_NumWorkGroups.x;
    }
}
