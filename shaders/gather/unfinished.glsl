// The work groups of gather/tiled.comp that have unfinished pixels, for those of compose.comp, which cover the
// same pixels.
layout(std430, binding = 2) buffer unfinished {
    uint unfinished_groups[]; // 1: the group has some, else 0
};

uint unfinished_group()
{
    return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
}
