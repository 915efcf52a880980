// Lists the points to draw. Blocks outside the picture are skipped; of blocks that project several
// points to a pixel only a first part is drawn. One invocation handles one block. The order of the
// list differs between runs, but the frame does not depend on it.
#include "proxy/splat.glsl"

layout(local_size_x = ORL_POINT_GROUP) in;
layout(rgba32f, binding = 0) readonly uniform imageBuffer blocks; // ORL_BLOCK_VEC4S each
layout(std430, binding = 0) buffer draw_arguments {
    uint group_count, one_y, one_z, item_count;
};
layout(std430, binding = 1) writeonly buffer draw_items {
    uint items[]; // see ORL_ITEM_BLOCK_BITS
};
layout(std430, binding = 2) writeonly buffer block_enlarged {
    float enlarged[]; // factor on the radii of each block that is drawn
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
    vec4 middle_density = imageLoad(blocks, ORL_BLOCK_VEC4S * block);
    vec4 extent_count = imageLoad(blocks, ORL_BLOCK_VEC4S * block + 1);
    vec3 normal = imageLoad(blocks, ORL_BLOCK_VEC4S * block + 2).xyz;
    vec3 middle = splat_camera_vector(middle_density.xyz - eye.xyz), extent = extent_count.xyz;
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
    // Points per pixel at the block's nearest depth, which is a lower bound for the whole block. A
    // slanted surface covers fewer pixels by the cosine of its angle. A short mean normal means
    // that the normals differ, so that the angle is unreliable.
    vec3 away = middle_density.xyz - eye.xyz;
    float facing = abs(dot(normal, away)) / max(length(away), 1e-30);
    facing = clamp(facing + 1.0 - length(normal), 0.1, 1.0);
    float pixel_size = max(middle.z - extent.z, 0.0) / min(focal.x, focal.y);
    float per_pixel = middle_density.w * pixel_size * pixel_size / facing;
    float share = points_per_pixel > 0.0 ? min(points_per_pixel / max(per_pixel, 1e-30), 1.0) : 1.0;
    uint count = uint(extent_count.w);
    uint parts = uint(ceil(extent_count.w * share / float(ORL_ITEM_POINTS)));
    parts = clamp(parts, 1u, (count + ORL_ITEM_POINTS - 1u) / ORL_ITEM_POINTS);
    // Enlarges the drawn points so that they cover the area of the omitted ones.
    float drawn = min(float(parts * ORL_ITEM_POINTS), extent_count.w);
    enlarged[block] = sqrt(extent_count.w / drawn);
    uint first = atomicAdd(item_count, parts);
    for (uint i = 0u; i < parts; i++)
        items[first + i] = i << ORL_ITEM_BLOCK_BITS | uint(block);
    uint per_group = ORL_POINT_GROUP * ORL_SPLAT_POINTS / ORL_ITEM_POINTS;
    atomicMax(group_count, (first + parts + per_group - 1u) / per_group);
}
