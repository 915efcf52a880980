// The best few photographs of a pixel and their blend, for the painter `tiled` and for the page. The
// file that includes this one defines KEPT, the most photographs that a pixel may blend, and fills the
// ranking.
#include "gather/penalty.glsl"
#include "gather/guess_blur.glsl"
#include "gather/sample/srgb.glsl"

// A pixel's surface point.
struct surface_point {
    vec3 p;      // z 0: no surface
    float guess; // 1: on estimated background depth, else 0; no bool: docs/develop/shaders.md
};

bool is_guess(surface_point s)
{
    return s.guess > 0.0;
}

// A photograph that shows the surface point.
struct observation {
    float penalty;
    int index;  // index of the photograph
    vec2 pixel; // projection of the point into the photograph
    float mip;
};

// The photographs that a pixel asks: the best one stands first, and the worst one, which is left out, last.
struct ranking {
    observation of[KEPT + 1];
};

void clear(out ranking r)
{
    for (int k = 0; k <= KEPT; k++)
        r.of[k] = observation(NOT_SEEN, 0, vec2(0.0), 0.0);
}

// Puts the better one first. The code selects rather than branches, here and below: a branch costs a software
// renderer a mask on every value that outlives it.
void order(inout observation a, inout observation b)
{
    bool swap = b.penalty < a.penalty;
    observation c = a;
    a = observation(swap ? b.penalty : a.penalty, swap ? b.index : a.index, swap ? b.pixel : a.pixel,
                    swap ? b.mip : a.mip);
    b = observation(swap ? c.penalty : b.penalty, swap ? c.index : b.index, swap ? c.pixel : b.pixel,
                    swap ? c.mip : b.mip);
}

// Takes the c-th photograph, from 0. After the last one the ranking is complete.
void rank(observation s, int c, inout ranking r)
{
    r.of[c] = s;
    if (c > 0)
        order(r.of[0], r.of[c]);
    if (c == KEPT)
        for (int k = 1; k < KEPT; k++)
            order(r.of[k], r.of[KEPT]);
}

// Weight of the k-th photograph.
float observation_weight(ranking r, int k)
{
    observation one = r.of[k];
    float next = r.of[KEPT].penalty;
    // The weight is full until the penalty comes near that of the first photograph left out. A
    // trace of weight remains at equality, so that photographs that tie for the last place paint.
    float fade = next == NOT_SEEN ? 1.0 : min(1.0, 4.0 * (1.00001 - one.penalty / next));
    return one.penalty < NOT_SEEN ? pow(r.of[0].penalty / one.penalty, opt.sharpness) * fade : 0.0;
}

// Colour, and 1 if there is a sample; varies: how much the best photograph varies about its place; luma: the mean of w
// of what is shown; blur: for estimated depth. Every photograph is read: see order. Samples far from the consensus lose
// weight: pedestrians, leaves, reflections. The square roots of the weights make it a consensus of all photographs
// rather than of the best one; the square roots of light make differences roughly perceptually uniform. One fetch takes
// about the same detail from all photographs of a surface, so the best one lends its own to the others, less the farther
// it is from the consensus.
vec4 blend(surface_point s, ranking r, out float varies, out float luma, out float blur)
{
    vec4 shown[KEPT], detail = vec4(0.0), vote = vec4(0.0), sum = vec4(0.0);
    float weights[KEPT];
    varies = 0.0;
    for (int k = 0; k < KEPT; k++) {
        observation one = r.of[k];
        shown[k] = photo_ranked(photo_at(one.index), k, one.pixel, one.mip, detail, varies);
        weights[k] = observation_weight(r, k);
        vote += vec4(sqrt(shown[k].rgb), 1.0) * sqrt(weights[k]);
    }
    vec3 mean = vote.rgb / max(vote.a, 1e-30);
    vec2 apart = vec2(0.0); // sum of squares * weight, sum of weights
    float first = weights[0], kept = 0.0, total = 0.0; // of the best one's weight, the share that it keeps
    for (int k = 0; k < KEPT; k++) {
        vec3 off = sqrt(shown[k].rgb) - mean;
        float share = 1.0 / (1.0 + dot(off, off) * outlier_severity), weight = weights[k] * share;
        apart += vec2(dot(off, off), 1.0) * weights[k];
        sum += shown[k] * weight;
        total += weight;
        kept = k == 0 ? share : kept;
    }
    apart.y = max(apart.y, 1e-30);
    // A photograph fades at its border, but its depth is no less certain there.
    float fade = photo_border(photo_at(r.of[0].index), r.of[0].pixel);
    blur = guess_blur(s.p, r.of[0].penalty * fade, sqrt(apart.x / apart.y), first / apart.y);
    vec4 color = sum + kept * detail * (sum - kept * first * shown[0]);
    color /= max(total, 1e-30);
    luma = color.a;
    return total > 0.0 ? vec4(color.rgb, 1.0) : vec4(0.0);
}
