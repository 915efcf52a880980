// The work groups of gather/tiled.comp that have unfinished pixels, row by row, for compose.comp, whose invocations
// handle the same pixels.
layout(std430, binding = 2) buffer unfinished {
    uint unfinished_groups[]; // 1: the group has some, else 0
};
