// How far samples of photographs can be believed (src/render/radiance.h says the same in C).

// Step between 8-bit sRGB values, squared, is that of the linear part, or, within a fifth where
// rounding matters, this many times linear exposure.
const float STEP_LINEAR = 1.0 / (12.92 * 12.92), STEP_SLOPE = 1.6 * 1.6;
const float ROUNDING = 1.0 / (255.0 * 255.0 * 12.0);

// Expected squared relative error, mean of the channels, of a photograph; inverse: of linear
// exposure, which every term of it divides by. noise: x: per photon, y: of reading out, z: share
// of 8-bit rounding.
float relative_variance(vec3 inverse, vec4 noise)
{
    vec3 v = min(inverse, 1e9);
    vec3 rounded = max(STEP_LINEAR * v, STEP_SLOPE) * (noise.z * ROUNDING);
    return dot(v * (noise.x + noise.y * v + rounded), vec3(1.0 / 3.0));
}
