// The geometry of points as src/scene/point_code.c encodes it, in 8 bytes. A position is a number
// of steps from the corner of the point's block, which a texel gives together with the step. The upper
// half of code.y is the normal in octahedral form, two signed bytes.
const float POINT_CODES_PER_OCTAVE = 16.0;

vec3 point_steps(uvec2 code)
{
    return vec3(code.x & 0x1fffu, code.x >> 13 & 0x1fffu, code.x >> 26 | (code.y & 0x7fu) << 6);
}

bool point_exists(uvec2 code)
{
    return (code.y & 0x8000u) != 0u;
}

float point_radius(uvec2 code, float step)
{
    uint octaves = code.y >> 7 & 0xffu;
    return octaves == 0u ? 0.0 : step * exp2(float(octaves) / POINT_CODES_PER_OCTAVE);
}
