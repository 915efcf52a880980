// A pixel whose light is only a lower bound takes the equally bright light around it, and is then
// known. fill_seed.comp and the passes after it have spread that light as logarithms.
#include "fill/apply.glsl"
#include "shared/pixel.glsl"

layout(rgba32f, binding = 1) uniform image2D accumulated; // blended pixels of shared/pixel.glsl

bool fill_wants(ivec2 at)
{
    return pixel_at_least(imageLoad(accumulated, at));
}

void fill_pixel(ivec2 at, vec4 value)
{
    vec4 sum = imageLoad(accumulated, at);
    float weight = pixel_weight(sum);
    vec3 light = exp2(value.rgb / value.a);
    if (value.a > 0.0)
        imageStore(accumulated, at, pixel_blended(max(sum.rgb, light * weight), weight, false));
}
