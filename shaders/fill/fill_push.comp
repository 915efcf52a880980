// Fills pixels without a value bilinearly from the coarser level (Gortler 1996, push).
#include "fill/apply.glsl"

layout(rgba32f, binding = 1) uniform image2D fine;

void fill_pixel(ivec2 at, vec4 value)
{
    if (value.a > 0.0 && !(imageLoad(fine, at).a > 0.0))
        imageStore(fine, at, value);
}
