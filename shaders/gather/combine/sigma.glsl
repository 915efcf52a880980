// The weighted mean of the inliers of the standard deviation test: Orzan 2005, 4.3.1. With at least
// three samples, an outlier lies farther than SIGMA standard deviations from the mean in any
// channel of the photographs' own encoding. A pixel without inliers stays unpainted. Two sweeps:
// the first computes the mean and the standard deviation, the second adds the inliers.
#include "gather/each.glsl"
#include "shared/srgb.glsl"

const float SIGMA = 1.17;
const float LEAST_SAMPLES = 3.0;
// Tolerance for rounding where all samples are alike; much less than a step of 8 bits.
const float ROUNDING = 1e-4;

#if SWEEP == 0

vec4 sum; // of values, and their number
vec3 squares;

void combine_begin(ivec2 at)
{
    sum = imageLoad(state_0, at);
    squares = imageLoad(state_1, at).rgb;
}

void combine_add(photo source, Answer a)
{
    vec3 value = srgb_encode(photo_sample(source, a.pixel, a.mip).rgb);
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
#include "gather/sum.glsl"

vec3 mean, allowed;

void combine_begin(ivec2 at)
{
    vec4 all = imageLoad(state_0, at);
    mean = all.rgb / max(all.a, 1.0);
    vec3 variance = imageLoad(state_1, at).rgb / max(all.a, 1.0) - mean * mean;
    allowed = SIGMA * sqrt(max(variance, 0.0)) + ROUNDING;
    allowed = all.a >= LEAST_SAMPLES ? allowed : vec3(1e30);
    sum = imageLoad(accumulated, at);
}

void combine_add(photo source, Answer a)
{
    vec3 color = photo_sample(source, a.pixel, a.mip).rgb;
    bool inlier = all(lessThanEqual(abs(srgb_encode(color) - mean), allowed));
    sum += inlier && a.weight > 0.0 ? vec4(color, 1.0) * a.weight : vec4(0.0);
}

#endif
