// Lists the blocks of points that may be in the picture. One invocation handles one block. The order of
// the list differs between runs, but the frame does not depend on it.
#include "proxy/splat.glsl"

layout(local_size_x = ORL_POINT_GROUP) in;
layout(rgba32f, binding = 0) readonly uniform imageBuffer blocks; // ORL_BLOCK_VEC4S each
layout(std430, binding = 0) buffer draw_arguments {
    uint group_count, one_y, one_z, listed_count;
};
layout(std430, binding = 1) writeonly buffer draw_list {
    uint listed[]; // blocks
};

// True if the box lies wholly on the outer side of a plane through the eye.
bool outside(vec3 middle, vec3 extent, vec3 plane)
{
    return dot(plane, middle) + dot(abs(plane), extent) < 0.0;
}

void main()
{
    int block = int(gl_GlobalInvocationID.x), block_count = point_count / ORL_BLOCK_POINTS;
    if (block >= block_count)
        return;
    vec3 centre = imageLoad(blocks, ORL_BLOCK_VEC4S * block).xyz;
    vec4 extent_count = imageLoad(blocks, ORL_BLOCK_VEC4S * block + 1);
    vec3 middle = splat_camera_vector(centre - eye.xyz), extent = extent_count.xyz;
    // Bounds along the camera's axes, slightly enlarged to allow for rounding.
    extent = vec3(dot(abs(rotation[0].xyz), extent), dot(abs(rotation[1].xyz), extent),
                  dot(abs(rotation[2].xyz), extent));
    extent += 1e-5 * (abs(middle) + extent);
    vec2 last = vec2(view_size) - focal.zw;
    if (extent_count.w == 0.0 || middle.z + extent.z <= eye.w ||
        outside(middle, extent, vec3(focal.x, 0.0, focal.z)) ||
        outside(middle, extent, vec3(-focal.x, 0.0, last.x)) ||
        outside(middle, extent, vec3(0.0, focal.y, focal.w)) ||
        outside(middle, extent, vec3(0.0, -focal.y, last.y)))
        return;
    uint at = atomicAdd(listed_count, 1u);
    listed[at] = uint(block);
    atomicMax(group_count, at / uint(ORL_SPLAT_POINTS) + 1u);
}
