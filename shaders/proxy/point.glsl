// Points as src/scene/point_code.c encodes them: 12 bytes in two buffers. A position is a number
// of steps from the corner of the point's block, which a texel gives together with the step.
const uint POINT_NONE = 0xffffu; // x of a point that is not there
const float POINT_CODES_PER_OCTAVE = 16.0;

vec3 point_steps(uvec2 code)
{
    return vec3(code.x & 0xffffu, code.x >> 16, code.y & 0xffffu);
}

bool point_exists(uvec2 code)
{
    return (code.x & 0xffffu) != POINT_NONE;
}

// In octahedral form.
vec2 point_normal(uvec2 code)
{
    return unpackSnorm4x8(code.y).zw;
}

// sRGB
vec3 point_color(uint attributes)
{
    return unpackUnorm4x8(attributes).rgb;
}

float point_radius(uint attributes, float step)
{
    uint code = attributes >> 24;
    return code == 0u ? 0.0 : step * exp2(float(code) / POINT_CODES_PER_OCTAVE);
}
