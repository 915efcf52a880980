// Confidence in a sample by itself, by clipping and by noise.
#include "gather/radiance/trust.glsl"

// Squared relative error of a photograph due to noise; inverse: 1 / radiance.
float noise_of(photo source, vec3 inverse)
{
    return relative_variance(source.gain.rgb * inverse, source.noise);
}

// A geometric weight is also an inverse variance, in units of 1 / model_variance. Errors of the
// model and of noise add up, and a photograph taken from the viewpoint has noise only. The bound
// max(weight, 1) never excuses noise by bad geometry, since samples of bad geometry are unreliable
// anyway. clip: confidence weight with respect to clipping.
float confident_weight(float weight, float clip, float noise)
{
    // Clipped samples with minimal confidence are ranked by it, whatever their geometry.
    float trace = min(1024.0 * clip, 1.0);
    return clip * clip * clip * trace * trace * weight /
           (1.0 + max(weight, 1.0) * noise / model_variance);
}

// texel: of photo_sample. The noise is that of the light that the sample itself shows.
float confidence_alone(photo source, vec4 texel)
{
    return confident_weight(1.0, texel.a, noise_of(source, 1.0 / texel.rgb));
}
