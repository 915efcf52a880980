// Pixels at depth edges, in no order: listed by one pass, for the next ones to work on alone.
layout(std430, binding = 2) buffer edge_list {
    uint edge_groups, one_y, one_z, edge_count; // the first three: work groups of the next passes
    uvec4 edges[]; // x: the pixel; y, z, w: the passes' own
};
#define EDGE_GROUP 64 // invocations of a work group of the next passes
const uint EDGE_GROUPS_MAX = 65535u; // that any device takes; each goes on by that

void edge_add(ivec2 at, uvec3 what)
{
    uint place = atomicAdd(edge_count, 1u);
    if (place >= uint(edges.length())) // of pictures larger than one buffer has room for
        return;
    edges[place] = uvec4(uint(at.x) | uint(at.y) << 16, what);
    atomicMax(edge_groups, min(place / EDGE_GROUP + 1u, EDGE_GROUPS_MAX));
}

uint edges_listed()
{
    return min(edge_count, uint(edges.length()));
}

ivec2 edge_pixel(uvec4 edge)
{
    return ivec2(edge.x & 0xffffu, edge.x >> 16);
}
