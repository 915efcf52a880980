// Work groups of gather/tiled.comp that left pixels to compose.comp.
layout(std430, binding = 2) buffer unfinished {
    uint dispatched, one_y, one_z, unfinished_count; // the first three: work groups of compose.comp
    uint unfinished_groups[]; // then, for each group, whether it is listed
};
const uint UNFINISHED_DISPATCH_MAX = 65535u; // that any device takes; each goes on by that

// `groups`: how many there are.
void unfinished_add(uint group, uint groups)
{
    if (atomicExchange(unfinished_groups[groups + group], 1u) == 0u) {
        uint place = atomicAdd(unfinished_count, 1u);
        unfinished_groups[place] = group;
        atomicMax(dispatched, min(place + 1u, UNFINISHED_DISPATCH_MAX));
    }
}
