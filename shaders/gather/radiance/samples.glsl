// What photographs of several exposures say of a surface point, and how far each is believed.
// Included after "gather/ask.glsl". Selects rather than branches: software renderers run both sides
// of a condition.
#include "gather/radiance/trust.glsl"

#define MODEL model_variance

struct Sample {
    vec3 color;   // radiance
    float clip;   // trust as far as clipping goes
    float weight; // geometric; 0: the photograph does not see the point
    vec2 pixel;
    float mip;
    int shot;     // the photograph
};

// Squared relative error of a photograph by noise, where this is one over radiance.
float noise_of(photo shot, vec3 inverse)
{
    return relative_variance(shot.gain.rgb * inverse, shot.noise);
}

// A geometric weight is an inverse variance too, in units of 1 / MODEL: errors of the model and
// of noise add up, and a photograph taken from here has none but its noise.
// The other way round, noise is never forgiven for bad geometry: its samples stray anyway.
float total_weight(Sample s, float noise)
{
    // Traces of trust in clipped samples must tell them apart whatever their geometry.
    float trace = min(1024.0 * s.clip, 1.0);
    return s.clip * s.clip * s.clip * trace * trace * s.weight /
           (1.0 + max(s.weight, 1.0) * noise / MODEL);
}

// Squared difference in stops, mean of the channels.
float stops2(vec3 a, vec3 b)
{
    vec3 d = log2(max(a, least_radiance) / max(b, least_radiance));
    return dot(d, d) / 3.0;
}

// How much light varies around a sample in its photograph, squared stops: what a misplacement of
// a pixel or two may change. Beside what clips there is no telling.
float unrest(photo shot, Sample s)
{
    vec4 around = photo_sample(shot, s.pixel, s.mip + 3.0);
    return 16.0 * stops2(s.color, around.rgb) + 64.0 * (1.0 - around.a);
}

// The colours that go with an answer. Its weight is in units of a photograph whose error by a wrong
// surface is that of the model: a tenth of a radian away, or a tenth of the distance.
Sample sample_of(photo shot, Answer a, bool guessed)
{
    Sample s;
    s.shot = a.shot;
    s.pixel = a.pixel;
    s.mip = a.mip;
    vec4 texel = photo_sample(shot, a.pixel, a.mip);
    s.color = texel.rgb;
    s.clip = texel.a;
    s.weight = texel.a > 0.0 ? a.weight / weight_unit(guessed) : 0.0;
    return s;
}

// Its weight, by noise where there is as much light as it says itself.
float weight_alone(photo shot, Sample s)
{
    return total_weight(s, noise_of(shot, 1.0 / s.color));
}
