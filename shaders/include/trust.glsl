// How far samples of photographs can be believed (src/render/radiance.h says the same in C).

// Variance of one channel at linear exposure x, white being 1. noise: x: per photon,
// y: of reading out, z: share of 8-bit rounding.
vec3 noise_variance(vec3 x, vec4 noise)
{
    x = max(x, 0.0);
    // Step of an 8-bit sRGB value, within a tenth where rounding matters.
    vec3 step = max(vec3(1.0 / 12.92), 1.6 * sqrt(x)) / 255.0;
    return noise.x * x + noise.y + noise.z * step * step / 12.0;
}

// Expected squared relative error, mean of the channels, of a photograph whose linear
// exposure for this radiance is x.
float relative_variance(vec3 x, vec4 noise)
{
    vec3 level = max(x, 1e-9);
    return dot(noise_variance(x, noise) / (level * level), vec3(1.0 / 3.0));
}
