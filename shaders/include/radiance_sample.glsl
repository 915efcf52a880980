// What photographs of several exposures say of a surface point, shared by the passes that blend
// them into one radiance.
#define RADIANCE
#include "include/airieau.glsl"
#include "include/photo_choice.glsl"
#include "include/trust.glsl"

#define MODEL radiance.y // variance of relative error at full exposure

struct Sample {
    vec3 color;   // radiance
    float clip;   // trust as far as clipping goes
    float weight; // geometric
    float unrest; // squared stops
    vec2 pixel;
    float mip;
};

// Exposure at which a photograph would have taken a radiance.
vec3 exposure_of(photo shot, vec3 color)
{
    return color / shot.gain.rgb;
}

// Squared relative error of a photograph by noise, where the radiance is about this.
float noise_of(photo shot, vec3 color)
{
    return relative_variance(exposure_of(shot, color), shot.noise);
}

// How much of a sample is the surface at z, squared: what lies before it may be a thousand
// times as bright. 0: hidden.
float seen_share(photo shot, vec4 seen, float z, bool guessed)
{
    if (guessed)
        return photo_unhidden_share(shot, seen, z);
    vec4 same = clamp(2.0 - abs(seen - z) / (z * options.x), 0.0, 1.0);
    float share = dot(mix(same, vec4(choice.z), lessThanEqual(seen, vec4(0.0))), vec4(0.25));
    return share * share;
}

// What the method makes of a photograph that sees the point.
float geometric_weight(photo shot, vec3 p, bool guessed)
{
    if (flags.z == 1)
        return pow(1.0 / photo_penalty(shot, p), guessed ? choice.w : choice.y);
    float weight = airieau_weight(p, shot.eye.xyz);
    // Where depth is only guessed, photographs disagree: let the best one dominate.
    return guessed ? pow(weight * options.y, 8.0) : weight;
}

// The same of a photograph whose model error is MODEL: a tenth of a radian away, or a tenth
// of the distance nearer or farther.
float usual_weight(bool guessed)
{
    if (flags.z == 1)
        return pow(10.0, guessed ? choice.w : choice.y);
    float weight = 1.0 / (0.1 + options.y);
    return guessed ? pow(weight * options.y, 8.0) : weight;
}

// A geometric weight is an inverse variance too, in units of usual_weight / MODEL: errors of
// the model and of noise add up, and a photograph taken from here has none but its noise.
// The other way round, noise is never forgiven for bad geometry: its samples stray anyway.
float total_weight(Sample s, float noise, bool guessed)
{
    // Traces of trust in clipped samples must tell them apart whatever their geometry.
    float trace = min(1024.0 * s.clip, 1.0);
    return s.clip * s.clip * s.clip * trace * trace * s.weight /
           (1.0 + max(s.weight / usual_weight(guessed), 1.0) * noise / MODEL);
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

// What a photograph says of a point; false when it does not see it.
bool ask(photo shot, vec3 p, bool guessed, out Sample s)
{
    float z;
    s.weight = 0.0;
    if (!photo_project(shot, p, s.pixel, z))
        return false;
    s.weight = geometric_weight(shot, p, guessed) * photo_border(shot, s.pixel);
    if (!(s.weight > 0.0))
        return false;
    if (flags.x == 1)
        s.weight *= seen_share(shot, photo_depths(shot, s.pixel), z, guessed);
    if (!(s.weight > 0.0))
        return false;
    s.mip = photo_mip(shot, z, p.z);
    vec4 texel = photo_radiance(shot, s.pixel, s.mip);
    s.color = texel.rgb;
    s.clip = texel.a;
    return texel.a > 0.0;
}

vec3 surface_point(ivec2 at, float depth)
{
    return vec3((vec2(at) + 0.5 - view_focal.zw) / view_focal.xy, 1.0) * depth;
}
