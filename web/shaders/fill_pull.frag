// Sum of 2x2 finer pixels (Gortler 1996, pull).
// far: of depths and their slopes, as in shaders/fill/fill_pull.comp.
uniform sampler2D fine;
uniform bool far;
layout(location = 0) out vec4 coarse;

const float SLOPE_KEPT = 0.8; // for a block of twice the size

// The value of a finer pixel for the block, whose centre lies `by` finer pixels away.
vec4 fine_value(ivec2 at, vec2 by)
{
    vec4 value = texelFetch(fine, at, 0);
    if (far) {
        value.x += dot(value.yz, by);
        value.yz *= 2.0 * SLOPE_KEPT;
    }
    return value;
}

void main()
{
    ivec2 at = 2 * ivec2(gl_FragCoord.xy), area = textureSize(fine, 0);
    coarse = vec4(0.0);
    for (int i = 0; i < 4; i++) {
        ivec2 child = ivec2(i & 1, i >> 1), from = at + child;
        if (from.x < area.x && from.y < area.y)
            coarse += fine_value(from, 0.5 - vec2(child));
    }
}
