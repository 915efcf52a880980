// Noise model of the samples of photographs; src/render/photos/radiance.c is the same in C.

// The squared step between 8-bit sRGB values, in linear exposure, is STEP_LINEAR in the linear part
// of the curve. Elsewhere it is STEP_SLOPE times the exposure, within a fifth where rounding
// matters.
const float STEP_LINEAR = 1.0 / (12.92 * 12.92), STEP_SLOPE = 1.6 * 1.6;
const float ROUNDING = 1.0 / (255.0 * 255.0 * 12.0);

// Expected squared relative error of a photograph, averaged over the channels. inverse: 1 / linear
// exposure, which is a factor of every term. noise: x: shot noise, y: read noise, z: share of the
// noise of 8-bit rounding.
float relative_variance(vec3 inverse, vec4 noise)
{
    vec3 v = min(inverse, 1e9);
    vec3 rounded = max(STEP_LINEAR * v, STEP_SLOPE) * (noise.z * ROUNDING);
    return dot(v * (noise.x + noise.y * v + rounded), vec3(1.0 / 3.0));
}
