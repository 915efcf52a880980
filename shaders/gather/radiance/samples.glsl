// Samples of a surface point in photographs of several exposures, and their confidence weights.
// Included after "gather/ask.glsl". The code selects rather than branches, since software renderers
// run both sides of a condition.
#include "gather/radiance/alone.glsl"

struct Sample {
    vec3 color;   // radiance
    float clip;   // confidence weight with respect to clipping
    float weight; // geometric; 0: the photograph does not see the point
    vec2 pixel;
    float mip;
    int source;   // the photograph
};

// Squared difference in stops, averaged over the channels.
float stops2(vec3 a, vec3 b)
{
    vec3 d = log2(max(a, min_radiance) / max(b, min_radiance));
    return dot(d, d) / 3.0;
}

// Variation of light around a sample in its photograph, squared stops: the change that a
// misplacement of one or two pixels may cause. Beside clipped pixels it is unknown, thus large.
float unrest(photo source, Sample s)
{
    vec4 around = photo_sample(source, s.pixel, s.mip + 3.0);
    return 16.0 * stops2(s.color, around.rgb) + 64.0 * (1.0 - around.a);
}

// Reads the colours for an answer. The weight is in units of that of a photograph whose geometric
// error equals the model error: at an angle of a tenth of a radian, or farther by a tenth of the
// viewing distance.
Sample sample_of(photo source, Answer a, bool guessed)
{
    Sample s;
    s.source = a.source;
    s.pixel = a.pixel;
    s.mip = a.mip;
    vec4 texel = photo_sample(source, a.pixel, a.mip);
    s.color = texel.rgb;
    s.clip = texel.a;
    s.weight = texel.a > 0.0 ? a.weight / weight_unit(guessed) : 0.0;
    return s;
}

// Weight of a sample by itself: the noise is that of the light that the sample itself shows.
float weight_alone(photo source, Sample s)
{
    return confident_weight(s.weight, s.clip, noise_of(source, 1.0 / s.color));
}
