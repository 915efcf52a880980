// Sums 2x2 finer pixels (Gortler 1996, pull).
// FAR: the values are those of fill/slope.glsl.
#include "shared/image.glsl"
#ifdef FAR
#include "fill/slope.glsl"
#endif

layout(rgba32f, binding = 0) readonly uniform image2D fine;
layout(rgba32f, binding = 1) writeonly uniform image2D coarse;

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= image_size.x || at.y >= image_size.y)
        return;
    vec4 sum = vec4(0.0);
    for (int k = 0; k < 4; k++) {
        ivec2 child = ivec2(k & 1, k >> 1);
        vec4 value = imageLoad(fine, 2 * at + child);
#ifdef FAR
        value = slope_pulled(value, 0.5 - vec2(child));
#endif
        sum += value;
    }
    imageStore(coarse, at, sum);
}
