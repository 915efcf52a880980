// Sum of 2x2 finer pixels (Gortler 1996, pull).
// far: the values are those of fill/slope.glsl.
#include "fill/slope.glsl"
uniform sampler2D fine;
uniform bool far;
layout(location = 0) out vec4 coarse;

void main()
{
    ivec2 at = 2 * ivec2(gl_FragCoord.xy), area = textureSize(fine, 0);
    coarse = vec4(0.0);
    for (int i = 0; i < 4; i++) {
        ivec2 child = ivec2(i & 1, i >> 1), from = at + child;
        if (from.x >= area.x || from.y >= area.y)
            continue;
        vec4 value = texelFetch(fine, from, 0);
        coarse += far ? slope_pulled(value, 0.5 - vec2(child)) : value;
    }
}
