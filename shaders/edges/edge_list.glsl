// An unordered list of pixels at depth discontinuities. One pass fills it, and the next passes work
// on the listed pixels only.
layout(std430, binding = 2) buffer edge_list {
    uint edge_count;
    uvec4 edges[]; // x: the pixel; y, z, w: data of the passes
};
#define EDGE_GROUP 64 // work group size of the next passes

void edge_add(ivec2 at, uvec3 what)
{
    uint place = atomicAdd(edge_count, 1u);
    if (place < uint(edges.length())) // the picture may be larger than one buffer can list
        edges[place] = uvec4(uint(at.x) | uint(at.y) << 16, what);
}

uint edges_listed()
{
    return min(edge_count, uint(edges.length()));
}

ivec2 edge_pixel(uvec4 edge)
{
    return ivec2(edge.x & 0xffffu, edge.x >> 16);
}
