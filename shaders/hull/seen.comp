// Notes which voxels a photograph sees, as a whole or in part, from the depth of the voxels in it.
#define BLOCK_SEEN
#include "shared/hull_blocks.h"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Centres {
    float centres[]; // three for each voxel, world
};
layout(std430, binding = 1) buffer Seen {
    uint seen[]; // see struct voxel_state
};
layout(r32f, binding = 0) readonly uniform image2D depth;

const int SAMPLES = 5; // of a voxel's square, each way, at most
// A voxel is not hidden by others that are nearer by no more than this many voxels. Billboards of a
// surface that the photograph sees up to 45 degrees aslant overlap so far.
const float TOLERANCE = 2.0;

void main()
{
    int index = int(gl_GlobalInvocationID.x);
    if (index >= voxel_count)
        return;
    vec3 d = vec3(centres[3 * index], centres[3 * index + 1], centres[3 * index + 2]) - eye.xyz;
    vec3 p = vec3(dot(rotation[0].xyz, d), dot(rotation[1].xyz, d), dot(rotation[2].xyz, d));
    if (!(p.z > voxel))
        return;
    vec2 middle = focal.xy * p.xy / p.z + focal.zw;
    vec2 width = focal.xy * (voxel / p.z);
    ivec2 n = clamp(ivec2(ceil(width)), ivec2(1), ivec2(SAMPLES));
    int visible = 0;
    for (int y = 0; y < n.y; y++)
        for (int x = 0; x < n.x; x++) {
            vec2 at = middle + width * ((vec2(x, y) + 0.5) / vec2(n) - 0.5);
            bool within = all(greaterThanEqual(at, vec2(0.0))) && all(lessThan(at, vec2(size)));
            float nearest = within ? imageLoad(depth, ivec2(at)).r : 0.0;
            visible += within && nearest > p.z - TOLERANCE * voxel ? 1 : 0;
        }
    uint set = 1u << bit;
    if (visible == n.x * n.y)
        seen[2 * words * index + word] |= set;
    if (visible > 0)
        seen[2 * words * index + words + word] |= set;
}
