// The mean of the four samples of greatest weight, each with weight 1 - w5 / w, where w5 is the
// fifth greatest weight. A photograph has faded out when another replaces it (Buehler 2001, 4.2).
// Two sweeps: the first finds the five greatest weights of a pixel, the second adds the samples.
#include "gather/each.glsl"

const int KEPT = 5;
// Minimum weight relative to full weight, so that samples that tie for the fifth place still paint
// when there are no others.
const float TRACE = 1e-5;

#if SWEEP == 0

float best[KEPT]; // in descending order

void combine_begin(ivec2 at)
{
    vec4 first = imageLoad(state_0, at);
    best = float[](first.x, first.y, first.z, first.w, imageLoad(state_1, at).x);
}

void combine_add(photo source, Answer a)
{
    float weight = a.weight;
    for (int k = 0; k < KEPT; k++) {
        float other = best[k];
        best[k] = max(weight, other);
        weight = min(weight, other);
    }
}

void combine_end(ivec2 at, Point point)
{
    imageStore(state_0, at, vec4(best[0], best[1], best[2], best[3]));
    imageStore(state_1, at, vec4(best[4]));
}

#else

#include "gather/sum.glsl"

float limit;

void combine_begin(ivec2 at)
{
    limit = imageLoad(state_1, at).x;
    sum = imageLoad(accumulated, at);
}

void combine_add(photo source, Answer a)
{
    vec3 color = photo_sample(source, a.pixel, a.mip).rgb;
    bool counts = a.weight > 0.0 && a.weight >= limit;
    sum += counts ? vec4(color, 1.0) * (1.0 + TRACE - limit / a.weight) : vec4(0.0);
}

#endif
