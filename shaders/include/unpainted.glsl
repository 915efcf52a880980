// Work groups of gather_best.comp that left pixels to compose.comp.
layout(std430, binding = 2) buffer unpainted {
    uint dispatched, one_y, one_z, unpainted_count; // the first three: work groups of compose.comp
    uint unpainted_groups[]; // then, for each group, whether it is listed
};
const uint UNPAINTED_DISPATCH_MAX = 65535u; // that any device takes; each goes on by that

// `groups`: how many there are.
void unpainted_add(uint group, uint groups)
{
    if (atomicExchange(unpainted_groups[groups + group], 1u) == 0u) {
        uint place = atomicAdd(unpainted_count, 1u);
        unpainted_groups[place] = group;
        atomicMax(dispatched, min(place + 1u, UNPAINTED_DISPATCH_MAX));
    }
}
