// What photographs of several exposures say of a surface point, shared by the passes that blend
// them into one radiance.
// BEST: weights of blend=best, otherwise Airieau's. A program for each, and selects rather than
// branches: software renderers run both sides of a condition.
#define RADIANCE
#include "gather/airieau.glsl"
#include "gather/photo_choice.glsl"
#include "gather/trust.glsl"

#define MODEL radiance.y // variance of relative error at full exposure

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

// How much of a sample is the surface at z, squared: what lies before it may be a thousand
// times as bright. 0: hidden.
float seen_share(photo shot, vec4 seen, float z, bool guessed)
{
    vec4 same = clamp(2.0 - abs(seen - z) / (z * options.x), 0.0, 1.0);
    float share = dot(mix(same, vec4(choice.z), lessThanEqual(seen, vec4(0.0))), vec4(0.25));
    return guessed ? photo_unhidden_share(shot, seen, z) : share * share;
}

// What the method makes of a photograph that sees the point, in units of what it makes of one
// whose model error is MODEL: a tenth of a radian away, or a tenth of the distance nearer or
// farther. Where depth is only guessed, photographs disagree: the best one dominates.
float geometric_weight(photo shot, vec3 p, bool guessed)
{
#ifdef BEST
    float penalty = photo_penalty(shot, p);
    float share = guessed ? 0.1 / penalty
                          : photo_surface_penalty(0.1) / photo_surface_penalty(penalty);
    // What sums and products stay finite with, and no photograph gets lost with.
    float weight = clamp(pow(share, guessed ? choice.w : choice.y), 1e-10, 1e18);
    return guessed ? weight * photo_beside(penalty) : weight;
#else
    float weight = airieau_weight(p, shot.eye.xyz) * (0.1 + options.y);
    float squared = weight * weight, fourth = squared * squared;
    return guessed ? fourth * fourth : weight;
#endif
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
    vec3 d = log2(max(a, radiance.z) / max(b, radiance.z));
    return dot(d, d) / 3.0;
}

// How much light varies around a sample in its photograph, squared stops: what a misplacement of
// a pixel or two may change. Beside what clips there is no telling.
float unrest(photo shot, Sample s)
{
    vec4 around = photo_radiance(shot, s.pixel, s.mip + 3.0);
    return 16.0 * stops2(s.color, around.rgb) + 64.0 * (1.0 - around.a);
}

// What photograph i, which is `shot`, says of a point before the view.
Sample ask(photo shot, int i, vec3 p, bool guessed)
{
    Sample s;
    s.shot = i;
    float z;
    bool sees = photo_project(shot, p, s.pixel, z);
    z = sees ? z : p.z; // no logarithm of less than 0
    s.mip = photo_mip(shot, z, p.z);
    vec4 texel = photo_radiance(shot, s.pixel, s.mip);
    s.color = texel.rgb;
    s.clip = texel.a;
    float share = flags.x == 1 ? seen_share(shot, photo_depths(shot, s.pixel), z, guessed) : 1.0;
    float weight = geometric_weight(shot, p, guessed) * photo_border(shot, s.pixel, guessed) * share;
    s.weight = sees && texel.a > 0.0 ? weight : 0.0;
    return s;
}

// Its weight, by noise where there is as much light as it says itself.
float weight_alone(photo shot, Sample s)
{
    return total_weight(s, noise_of(shot, 1.0 / s.color));
}

vec3 surface_point(ivec2 at, float depth)
{
    return vec3((vec2(at) + 0.5 - view_focal.zw) / view_focal.xy, 1.0) * depth;
}
