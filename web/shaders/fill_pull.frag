// Sum of 2x2 finer pixels (Gortler 1996, pull); the mean where a format has a small range.
uniform sampler2D fine;
uniform float factor;
layout(location = 0) out vec4 coarse;

void main()
{
    ivec2 at = 2 * ivec2(gl_FragCoord.xy), area = textureSize(fine, 0);
    coarse = vec4(0.0);
    for (int i = 0; i < 4; i++) {
        ivec2 from = at + ivec2(i & 1, i >> 1);
        if (from.x < area.x && from.y < area.y)
            coarse += texelFetch(fine, from, 0) * factor;
    }
}
