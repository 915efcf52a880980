// Intersects a grid of voxels with one camera's partial hull: the cone of its silhouette.
#define BLOCK_CARVE
#include "shared/hull_blocks.h"

layout(local_size_x = 128) in;
layout(std430, binding = 0) buffer Field {
    float field[]; // distance to the hull's surface, negative inside, scene units
};
layout(binding = 0) uniform sampler2D silhouette; // signed distance, pixels, positive outside

void main()
{
    // In one direction alone there would be more work groups than a device must allow.
    ivec2 id = ivec2(gl_GlobalInvocationID.xy);
    if (id.x >= side * side)
        return;
    int index = id.x + side * side * id.y;
    vec4 at = vec4(vec3(id.x % side, id.x / side, id.y) + 0.5, 1.0);
    vec3 q = vec3(dot(camera_from_voxels[0], at), dot(camera_from_voxels[1], at),
                  dot(camera_from_voxels[2], at));
    float apart = -q.z; // a camera sees nothing behind it
    if (q.z > 0.0) {
        vec2 pixel = focal.xy * q.xy / q.z + focal.zw;
        vec2 within = clamp(pixel, vec2(0.5), vec2(size) - 0.5);
        float distance = textureLod(silhouette, within / vec2(size), 0.0).r;
        // A subject that leaves the picture may spread by 45 degrees beyond it.
        float past = length(pixel - within);
        distance += open == 1 && past > 0.5 ? -past : past;
        apart = distance * q.z / max(focal.x, focal.y);
    }
    field[index] = max(field[index], clamp(apart, -most, most));
}
