// Combines photographs of several exposures into one radiance. Each sample's weight is its
// geometric weight times its confidence, so that at every pixel better samples outweigh clipped and
// noisy ones. Each pixel asks the photographs of its tile, which radiance/choose.comp has listed,
// and keeps the samples of greatest weight.
// LIMITED: weights fall to zero at the first sample left out, for methods of the best few photographs.
#include "gather/radiance/samples.glsl"
#ifdef LIMITED
#include "gather/penalty.glsl"
#include "gather/guess_blur.glsl"
#endif

// state_0: weight * confidence, weight; on estimated background depth 1 + log2 of the required blur
// in pixels, else 0.
layout(std430, binding = 1) readonly buffer tile_lists {
    int chosen[]; // written by radiance/choose.comp
};

const vec3 LUMINANCE = vec3(0.2126, 0.7152, 0.0722);
const float LEAST_SHARE_FOUND = 0.02; // of the tile's best weight; below it a pixel asks all others
// Samples that differ from the others by so many stops, beyond noise and edges, count half.
const float GHOSTS = 1.0;
const float DOUBT_FROM = 0.1; // excess up to which a sample loses at most 1 % of its weight
const float CLIPS_BELOW = 0.5; // mean confidence with respect to clipping
const float SHARP_FROM = 0.02; // least fraction of the weight of a sample that is read again

// The samples of greatest weight of a pixel. All indices are of loops that compilers unroll: on a
// software renderer, memory that each invocation indexes by itself costs more than all the rest.
Sample samples[ORL_RADIANCE_KEPT];
float weights[ORL_RADIANCE_KEPT]; // 0: no sample
#define EACH_SAMPLE(k) for (int k = 0; k < ORL_RADIANCE_KEPT; k++)

// --- photographs that a pixel asks: those of the tile and, if their weights are small, all others,
// for a small surface that no probe point of the tile met ---

int listed[ORL_RADIANCE_KEPT], asked_count, other; // other: index among all; -1: in the list
float enough, heaviest;
bool on_guess;

void combine_begin(ivec2 at)
{
    EACH_SAMPLE(k) {
        samples[k] = Sample(vec3(0.0), 0.0, 0.0, vec2(0.0), 0.0, 0);
        weights[k] = 0.0;
    }
    int list = ORL_RADIANCE_LIST * int(gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x);
    EACH_SAMPLE(k)
        listed[k] = chosen[list + k];
    enough = LEAST_SHARE_FOUND * intBitsToFloat(chosen[list + ORL_RADIANCE_KEPT]);
    heaviest = 0.0;
    asked_count = 0;
    on_guess = imageLoad(view_depth, at).r < 0.0;
}

int photo_first()
{
    other = listed[0] < 0 ? 0 : -1;
    return max(listed[0], 0);
}

int photo_next(int before)
{
    int i = -1;
    asked_count++;
    EACH_SAMPLE(k)
        i = k == asked_count ? listed[k] : i;
    if (i < 0 && (other >= 0 || !(heaviest > enough))) {
        other++;
        i = other < photo_count ? other : -1;
    }
    return i;
}

Sample either(bool first, Sample a, Sample b)
{
    return Sample(first ? a.color : b.color, first ? a.clip : b.clip, first ? a.weight : b.weight,
                  first ? a.pixel : b.pixel, first ? a.mip : b.mip, first ? a.source : b.source);
}

// Replaces the sample of least weight, if the new one has more.
void put(Sample s, float weight)
{
    int least = -1;
    float lightest = weight;
    EACH_SAMPLE(k) {
        bool lighter = weights[k] < lightest;
        lightest = lighter ? weights[k] : lightest;
        least = lighter ? k : least;
    }
    EACH_SAMPLE(k) {
        samples[k] = either(k == least, s, samples[k]);
        weights[k] = k == least ? weight : weights[k];
    }
}

void combine_add(photo source, Answer a)
{
    bool known = false;
    EACH_SAMPLE(k)
        known = known || listed[k] == a.source;
    Sample s = sample_of(source, a, on_guess);
    float weight = known && other >= 0 ? 0.0 : weight_alone(source, s);
    put(s, weight);
    heaviest = max(heaviest, weight);
}

// --- combination of the samples ---

// Radiance of the sample at the weighted median of brightness.
vec3 median_color()
{
    float total = 0.0, brightness[ORL_RADIANCE_KEPT];
    EACH_SAMPLE(k) {
        brightness[k] = dot(samples[k].color, LUMINANCE);
        total += weights[k];
    }
    vec3 median = vec3(0.0);
    EACH_SAMPLE(k) {
        float below = 0.0, mine = brightness[k];
        EACH_SAMPLE(j)
            below += brightness[j] < mine || (brightness[j] == mine && j < k) ? weights[j] : 0.0;
        bool middle = below <= 0.5 * total && below + weights[k] > 0.5 * total;
        median = middle ? samples[k].color : median;
    }
    return median;
}

// The weight at which a method of the best few photographs leaves a sample out: the least of those kept.
float left_out()
{
#ifdef LIMITED
    float least = weights[0];
    EACH_SAMPLE(k)
        least = min(least, weights[k]);
    return least;
#else
    return 0.0;
#endif
}

Sample sample_at(int one)
{
    Sample s = samples[0];
    EACH_SAMPLE(k)
        s = either(k == one, samples[k], s);
    return s;
}

// Deghosting: reduces the weights of objects that moved between the photographs. level: radiance
// to compare with; noise: squared relative error of each sample.
void lessen_ghosts(vec3 level, float noise[ORL_RADIANCE_KEPT])
{
    float off[ORL_RADIANCE_KEPT], allowed[ORL_RADIANCE_KEPT]; // squared stops
    int doubtful = 0; // one bit per sample
    EACH_SAMPLE(k) {
        off[k] = stops2(samples[k].color, level);
        // The factor 1 / ln(2)^2 converts squared relative error to squared stops.
        allowed[k] = GHOSTS * GHOSTS + 2.0814 * noise[k];
        doubtful |= weights[k] > 0.0 && off[k] > DOUBT_FROM * allowed[k] ? 1 << k : 0;
    }
    do { // for doubtful samples only, since it reads a texel
        int one = findLSB(doubtful); // -1: none
        Sample s = sample_at(one);
        float more = unrest(photo_at(s.source), s);
        EACH_SAMPLE(k) {
            float excess = off[k] / (allowed[k] + more);
            weights[k] *= k == one ? 1.0 / (1.0 + excess * excess) : 1.0;
        }
        doubtful &= doubtful - 1;
    } while (doubtful != 0);
}

// A sample that is darker than the lower bound given by clipped samples shows another surface: a
// photograph taken from the side may show a tree in front of the sky. To the extent that unclipped
// samples are contradicted in this way, clipped samples regain their geometric weight. On known
// surfaces this takes a majority of at least two clipped samples, since a single one is often
// clipped only because it lies beside an edge.
void heed_clipped(bool guessed)
{
    float all = 0.0, best = 0.0, least = 0.0; // sum and maximum of geometric weights; luminance
    EACH_SAMPLE(k) {
        float weight = samples[k].clip < CLIPS_BELOW ? samples[k].weight : 0.0;
        all += weight;
        least = weight > best ? dot(samples[k].color, LUMINANCE) : least;
        best = max(best, weight);
    }
    float other = 0.0, contradicted = 0.0;
    EACH_SAMPLE(k) {
        float weight = samples[k].clip < CLIPS_BELOW ? 0.0 : weights[k];
        float below = log2(max(least, min_radiance) /
                           max(dot(samples[k].color, LUMINANCE), min_radiance));
        other += weight;
        contradicted += weight * smoothstep(GHOSTS, 2.0 * GHOSTS, below);
    }
    other = max(other, 1e-30);
    float majority = smoothstep(1.0, 3.0, (all - best) / other);
    float share = contradicted / other * (guessed ? 1.0 : majority);
    EACH_SAMPLE(k)
        weights[k] += samples[k].clip < CLIPS_BELOW ? share * samples[k].weight : 0.0;
}

// Computes the final weights. Returns their sums multiplied by the confidence, by the confidence
// with respect to clipping, and by 1.
vec3 weigh(bool guessed)
{
    // The confidence of a sample depends on the amount of light. The median estimates that amount,
    // so that the sample's own noise has no influence.
    vec3 level = max(median_color(), min_radiance), inverse = 1.0 / level;
    float noise[ORL_RADIANCE_KEPT];
    EACH_SAMPLE(k) {
        noise[k] = noise_of(photo_at(samples[k].source), inverse);
        weights[k] = confident_weight(samples[k].weight, samples[k].clip, noise[k]);
    }
    heed_clipped(guessed);
    // Subtracting slightly less than the limit keeps samples that tie with it. Weights still fall
    // to almost zero before a sample is replaced.
    float limit = 0.999 * left_out();
    EACH_SAMPLE(k)
        weights[k] = max(weights[k] - limit, 0.0);
    lessen_ghosts(level, noise);
    vec3 sums = vec3(0.0);
    EACH_SAMPLE(k)
        sums += weights[k] * vec3(samples[k].clip *
                                  vec2(model_variance / (model_variance + noise[k]), 1.0), 1.0);
    return sums;
}

// Sum of colour * weight. Samples of sufficient weight are read again with the bicubic filter.
vec3 blend(float total)
{
    vec3 sum = vec3(0.0);
    int sharp = 0; // one bit per sample
    EACH_SAMPLE(k) {
        bool counts = opt.sampling == ORL_BICUBIC && weights[k] > SHARP_FROM * total;
        sharp |= counts ? 1 << k : 0;
        sum += counts ? vec3(0.0) : samples[k].color * weights[k];
    }
    do {
        int one = findLSB(sharp); // -1: none
        Sample s = sample_at(one);
        float weight = 0.0;
        EACH_SAMPLE(k)
            weight = k == one ? weights[k] : weight;
        sum += photo_sharper(photo_at(s.source), s.pixel, s.mip, s.color) * weight;
        sharp &= sharp - 1;
    } while (sharp != 0);
    return sum;
}

// The blur that colour on estimated depth needs, log2 of pixels.
float blur_of(vec3 p, float total)
{
#ifdef LIMITED
    vec4 vote = vec4(0.0);
    float heaviest = 0.0;
    int best = 0;
    EACH_SAMPLE(k) {
        vote += vec4(sqrt(samples[k].color), 1.0) * sqrt(weights[k]);
        best = weights[k] > heaviest ? samples[k].source : best;
        heaviest = max(heaviest, weights[k]);
    }
    vec3 mean = vote.rgb / max(vote.a, 1e-30);
    float squares = 0.0;
    EACH_SAMPLE(k) {
        vec3 off = sqrt(samples[k].color) - mean;
        squares += dot(off, off) * weights[k];
    }
    float all = max(total, 1e-30);
    return guess_blur(p, photo_penalty(photo_at(best), p), sqrt(squares / all), heaviest / all);
#else
    return 0.0;
#endif
}

void combine_end(ivec2 at, Point point)
{
    vec3 sums = weigh(point.guessed);
    float total = sums.z;
    vec4 before = imageLoad(accumulated, at);
    bool clips = before.a + (sums.y < CLIPS_BELOW * total ? -total : total) < 0.0;
    imageStore(accumulated, at,
               pixel_blended(before.rgb + blend(total), pixel_weight(before) + total, clips));
    vec4 trust = imageLoad(state_0, at);
    float blur = point.guessed && total > trust.y ? 1.0 + blur_of(point.p, total) : trust.z;
    imageStore(state_0, at, vec4(trust.xy + vec2(sums.x, total), blur, 0.0));
}
