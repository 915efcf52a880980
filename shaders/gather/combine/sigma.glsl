// The weighted mean of the samples that are no outliers by the standard deviation test: Orzan 2005,
// 4.3.1. A sample is one if it lies farther than opt.sigma standard deviations from the mean in any
// channel of the photographs' own encoding, and at least three photographs see the point. Where no
// sample is left the pixel stays unpainted. Two sweeps: the first takes the mean and the deviation.
#include "gather/each.glsl"
#include "shared/srgb.glsl"

const bool SOFT_BORDER = false;
const float LEAST_SAMPLES = 3.0;
// Far less than a step of 8 bits: rounding is no outlier where all samples are alike.
const float ROUNDING = 1e-4;

vec4 sum; // of values, and their number; then of colour * weight, and weight

#if SWEEP == 0

vec3 squares;

void combine_begin(ivec2 at)
{
    sum = imageLoad(state_0, at);
    squares = imageLoad(state_1, at).rgb;
}

void combine_add(photo shot, Answer a)
{
    vec3 value = srgb_encode(photo_sample(shot, a.pixel, a.mip).rgb);
    bool sees = a.weight > 0.0;
    sum += sees ? vec4(value, 1.0) : vec4(0.0);
    squares += sees ? value * value : vec3(0.0);
}

void combine_end(ivec2 at, Point point)
{
    imageStore(state_0, at, sum);
    imageStore(state_1, at, vec4(squares, 0.0));
}

#else

vec3 mean, allowed;

void combine_begin(ivec2 at)
{
    vec4 all = imageLoad(state_0, at);
    mean = all.rgb / max(all.a, 1.0);
    vec3 variance = imageLoad(state_1, at).rgb / max(all.a, 1.0) - mean * mean;
    allowed = opt.sigma * sqrt(max(variance, 0.0)) + ROUNDING;
    allowed = all.a >= LEAST_SAMPLES ? allowed : vec3(1e30);
    sum = imageLoad(accumulated, at);
}

void combine_add(photo shot, Answer a)
{
    vec3 color = photo_sample(shot, a.pixel, a.mip).rgb;
    bool inlier = all(lessThanEqual(abs(srgb_encode(color) - mean), allowed));
    sum += inlier && a.weight > 0.0 ? vec4(color, 1.0) * a.weight : vec4(0.0);
}

void combine_end(ivec2 at, Point point)
{
    if (sum.a > 0.0)
        imageStore(accumulated, at, pixel_blended(sum.rgb, sum.a, false));
}

#endif
