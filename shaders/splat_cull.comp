// Which points of which blocks to draw: none of blocks outside the picture, and of blocks
// that fall several points to a pixel only a first part. One invocation a block. The order of
// the list differs from run to run; the frame does not depend on it.
#include "include/splat.glsl"

layout(local_size_x = ORL_POINT_GROUP) in;
layout(rgba32f, binding = 0) readonly uniform imageBuffer blocks; // middle, density;
                                                                  // half extent
layout(std430, binding = 0) buffer draw_arguments {
    uint group_count, one_y, one_z, item_count;
};
layout(std430, binding = 1) writeonly buffer draw_items {
    uint items[]; // first point / ORL_ITEM_POINTS
};
layout(std430, binding = 2) writeonly buffer block_drawn {
    uint drawn[]; // points of each block that is drawn
};

// Wholly on the outer side of a plane through the eye?
bool outside(vec3 middle, vec3 extent, vec3 plane)
{
    return dot(plane, middle) + dot(abs(plane), extent) < 0.0;
}

void main()
{
    int block = int(gl_GlobalInvocationID.x);
    int count = min(size.z - block * ORL_BLOCK_POINTS, ORL_BLOCK_POINTS);
    if (count <= 0)
        return;
    vec4 middle_density = imageLoad(blocks, 2 * block);
    vec3 extent = imageLoad(blocks, 2 * block + 1).xyz;
    vec3 middle = splat_camera_position(middle_density.xyz);
    // Bounds along the camera's axes, a little wider for rounding.
    extent = vec3(dot(abs(rotation[0].xyz), extent), dot(abs(rotation[1].xyz), extent),
                  dot(abs(rotation[2].xyz), extent));
    extent += 1e-5 * (abs(middle) + extent);
    vec2 last = vec2(size.xy) - focal.zw;
    if (middle.z + extent.z <= eye.w ||
        outside(middle, extent, vec3(focal.x, 0.0, focal.z)) ||
        outside(middle, extent, vec3(-focal.x, 0.0, last.x)) ||
        outside(middle, extent, vec3(0.0, focal.y, focal.w)) ||
        outside(middle, extent, vec3(0.0, -focal.y, last.y)))
        return;
    // Points per pixel where the block is nearest and faces the viewer: at least as many
    // fall anywhere else.
    float pixel_size = max(middle.z - extent.z, 0.0) / min(focal.x, focal.y);
    float per_pixel = middle_density.w * pixel_size * pixel_size;
    float share = options.z > 0.0 ? min(options.z / max(per_pixel, 1e-30), 1.0) : 1.0;
    uint parts = uint(ceil(float(count) * share / float(ORL_ITEM_POINTS)));
    parts = clamp(parts, 1u, uint(count + ORL_ITEM_POINTS - 1) / ORL_ITEM_POINTS);
    drawn[block] = min(parts * ORL_ITEM_POINTS, uint(count));
    uint first = atomicAdd(item_count, parts);
    for (uint i = 0u; i < parts; i++)
        items[first + i] = uint(block) * (ORL_BLOCK_POINTS / ORL_ITEM_POINTS) + i;
    uint per_group = ORL_POINT_GROUP * ORL_SPLAT_POINTS / ORL_ITEM_POINTS;
    atomicMax(group_count, (first + parts + per_group - 1u) / per_group);
}
