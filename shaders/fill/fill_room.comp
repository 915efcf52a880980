// Completes the room: a place that no photograph shows takes the colours of the walls around it.
#include "fill/apply.glsl"

layout(rgba32f, binding = 1) uniform image2D room; // blended pixels of shared/pixel.glsl

bool fill_wants(ivec2 at)
{
    return imageLoad(room, at).a == 0.0;
}

void fill_pixel(ivec2 at, vec4 value)
{
    if (value.a > 0.0)
        imageStore(room, at, vec4(value.rgb / value.a, 1.0));
}
