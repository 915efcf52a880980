// Finds how far the rays of an 8x8 tile may go before any of them can meet a surface, by tracing
// one cone around the tile. The pixels of the tile then need only a few steps.
layout(local_size_x = 8, local_size_y = 8) in;
#include "synth/trace.glsl"
layout(r32f, binding = 0) writeonly uniform image2D start_image;

const float NEAR_T = 0.5;

void main()
{
    ivec2 tile = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(tile * 8, size.xy)))
        return;
    // Half the tile's diagonal plus half a pixel on each side, at unit depth.
    float cone = 6.4 / min(camera.x, camera.y);
    vec3 ray = ray_through(vec2(tile * 8 + 4));
    float t = free_way(eye.xyz, ray, NEAR_T, cone);
    imageStore(start_image, tile, vec4(t));
}
