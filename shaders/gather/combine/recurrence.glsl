// The mean of all samples as hardware of 2003 could have it (Li 2003, equations 2 and 3): sample i
// takes the share A(i - 1) of the pixel, with A(0) = 1 and A(i) = 0.06 + A(i - 1) / 2 in place of
// 1 / i. The frame buffer has 8 bits a channel: colours in sRGB, and A.
#include "gather/each.glsl"
#include "shared/srgb.glsl"

// Source alpha is 128 of 255, and times 0.12 gives the paper's 0.06.
const float HALF = 128.0 / 255.0, CONSTANT = 0.12;

vec3 color;
float share; // A; 0 in the image: no sample yet
bool any_sample;

void combine_begin(ivec2 at)
{
    vec4 before = imageLoad(accumulated, at);
    color = before.rgb;
    any_sample = before.a > 0.0;
    share = any_sample ? imageLoad(state_0, at).x : 1.0;
}

void combine_add(photo source, Answer a)
{
    vec3 sample_color = photo_sample(source, a.pixel, a.mip).rgb;
    bool counts = a.weight > 0.0;
    vec3 mixed = clamp(mix(color, sample_color, share), 0.0, 1.0);
    vec3 stored = srgb_decode(floor(srgb_encode(mixed) * 255.0 + 0.5) / 255.0);
    color = counts ? stored : color;
    share = counts ? floor(min((CONSTANT + share) * HALF, 1.0) * 255.0 + 0.5) / 255.0 : share;
    any_sample = any_sample || counts;
}

void combine_end(ivec2 at, Point point)
{
    if (any_sample) {
        imageStore(accumulated, at, pixel_blended(color, 1.0, false));
        imageStore(state_0, at, vec4(share));
    }
}
