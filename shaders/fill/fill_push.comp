// Fills pixels without a value bilinearly from the coarser level (Gortler 1996, push).
#include "fill/apply.glsl"

layout(rgba32f, binding = 1) uniform image2D fine;

bool fill_wants(ivec2 at)
{
    return !(imageLoad(fine, at).a > 0.0);
}

void fill_pixel(ivec2 at, vec4 value)
{
    imageStore(fine, at, value);
}
