// List of the work groups of gather/tiled.comp that have unfinished pixels, for compose.comp.
layout(std430, binding = 2) buffer unfinished {
    uint dispatched, one_y, one_z, unfinished_count; // the first three: dispatch of compose.comp
    uint unfinished_groups[]; // the list; then a flag per group that is 1 if listed
};
const uint UNFINISHED_DISPATCH_MAX = 65535u; // supported by every device; the stride of work groups

// Lists a work group once. `groups`: number of work groups of the dispatch.
void unfinished_add(uint group, uint groups)
{
    if (atomicExchange(unfinished_groups[groups + group], 1u) == 0u) {
        uint place = atomicAdd(unfinished_count, 1u);
        unfinished_groups[place] = group;
        atomicMax(dispatched, min(place + 1u, UNFINISHED_DISPATCH_MAX));
    }
}
