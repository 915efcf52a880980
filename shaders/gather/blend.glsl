// The best few photographs of a pixel and their blend, for the painter `tiled` and for the page. The
// file that includes this one defines KEPT, the most photographs that a pixel may blend, and fills the
// ranking.
#include "gather/penalty.glsl"
#include "gather/guess_blur.glsl"

// A pixel's surface point.
struct spot {
    vec3 p;      // z 0: no surface
    float guess; // 1: on estimated background depth, else 0; no bool: docs/develop/shaders.md
};

bool is_guess(spot s)
{
    return s.guess > 0.0;
}

// A photograph that shows the surface point.
struct sight {
    float penalty;
    int index;  // index of the photograph
    vec2 pixel; // projection of the point into the photograph
    float mip;
};

// The best photographs of a pixel in ascending order of penalty, and the next greater penalty.
struct ranking {
    sight best[KEPT];
    float next; // the limit of what is blended
};

void clear(out ranking r)
{
    r.next = NOT_SEEN;
    for (int k = 0; k < KEPT; k++)
        r.best[k] = sight(NOT_SEEN, 0, vec2(0.0), 0.0);
}

// The code selects rather than branches, here and below: a branch costs a software renderer a mask
// on every value that outlives it.
void insert(sight s, inout ranking r)
{
    for (int k = 0; k < KEPT; k++) {
        bool better = s.penalty < r.best[k].penalty;
        sight other = r.best[k];
        r.best[k] = sight(better ? s.penalty : other.penalty, better ? s.index : other.index,
                          better ? s.pixel : other.pixel, better ? s.mip : other.mip);
        s = sight(better ? other.penalty : s.penalty, better ? other.index : s.index,
                  better ? other.pixel : s.pixel, better ? other.mip : s.mip);
    }
    r.next = min(r.next, s.penalty);
}

// Weight of the k-th photograph.
float sight_weight(ranking r, int k)
{
    sight one = r.best[k];
    // The weight is full until the penalty comes near that of the first photograph left out. A
    // trace of weight remains at equality, so that photographs that tie for the last place paint.
    float fade = r.next == NOT_SEEN ? 1.0 : min(1.0, 4.0 * (1.00001 - one.penalty / r.next));
    bool counts = one.penalty < NOT_SEEN && one.penalty <= r.next;
    return counts ? pow(r.best[0].penalty / one.penalty, opt.sharpness) * fade : 0.0;
}

// What the photographs of a pixel show, best first, as photo_ranked reads it.
struct samples {
    vec4 shown[KEPT];
    float weight[KEPT];
    vec4 detail; // of the best one
};

// Colour, and 1 if there is a sample; luma: the mean of w of what is shown; blur: for estimated depth. Samples far from
// the consensus lose weight: pedestrians, leaves, reflections. The square roots of the weights make it a consensus of
// all photographs rather than of the best one; the square roots of light make differences roughly perceptually uniform.
// One fetch takes about the same detail from all photographs of a surface, so the best one lends its own to the others,
// less the farther it is from the consensus.
vec4 blend(spot s, ranking r, samples from, out float luma, out float blur)
{
    vec4 vote = vec4(0.0), sum = vec4(0.0);
    for (int k = 0; k < KEPT; k++)
        vote += vec4(sqrt(from.shown[k].rgb), 1.0) * sqrt(from.weight[k]);
    vec3 mean = vote.rgb / max(vote.a, 1e-30);
    vec2 apart = vec2(0.0); // sum of squares * weight, sum of weights
    float first = from.weight[0], kept = 0.0, total = 0.0; // of the best one's weight, the share that it keeps
    for (int k = 0; k < KEPT; k++) {
        vec3 off = sqrt(from.shown[k].rgb) - mean;
        float share = 1.0 / (1.0 + dot(off, off) * outlier_severity), weight = from.weight[k] * share;
        apart += vec2(dot(off, off), 1.0) * from.weight[k];
        sum += from.shown[k] * weight;
        total += weight;
        kept = k == 0 ? share : kept;
    }
    apart.y = max(apart.y, 1e-30);
    blur = guess_blur(s.p, r.best[0].penalty, sqrt(apart.x / apart.y), first / apart.y);
    vec4 shown = sum + kept * from.detail * (sum - kept * first * from.shown[0]);
    shown /= max(total, 1e-30);
    luma = shown.a;
    return total > 0.0 ? vec4(shown.rgb, 1.0) : vec4(0.0);
}
