// An unordered list of pixels at depth discontinuities. One pass fills it, and the next passes work
// on the listed pixels only.
layout(std430, binding = 2) buffer edge_list {
    uint edge_groups, one_y, one_z, edge_count; // the first three: dispatch size of the next passes
    uvec4 edges[]; // x: the pixel; y, z, w: data of the passes
};
#define EDGE_GROUP 64 // work group size of the next passes
const uint EDGE_GROUPS_MAX = 65535u; // supported by every device; the stride of work groups

void edge_add(ivec2 at, uvec3 what)
{
    uint place = atomicAdd(edge_count, 1u);
    if (place >= uint(edges.length())) // the picture is larger than one buffer can list
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
