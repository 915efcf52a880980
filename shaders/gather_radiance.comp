// Blends photographs of several exposures into one radiance: the geometric weight of each
// times its trust, so that clipped and noisy samples lose to better ones pixel by pixel.
#include "include/radiance_sample.glsl"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in; // a tile
layout(r32f, binding = 0) readonly uniform image2D view_depth; // < 0: guessed background
layout(rgba32f, binding = 1) uniform image2D accumulated;      // colour * weight, weight
layout(rg32f, binding = 2) uniform image2D trusted;            // weight * trust, weight
layout(std430, binding = 1) readonly buffer tile_lists {
    int chosen[]; // choose_radiance.comp
};

const vec3 LUMINANCE = vec3(0.2126, 0.7152, 0.0722);
const float LEAST_SHARE_FOUND = 0.02; // of the tile's best: with less a pixel asks all the others

// The heaviest samples of a pixel. Only ever indexed by loops that compilers unroll: memory that
// each invocation addresses by itself costs more than all the rest on a software renderer.
Sample samples[ORL_RADIANCE_KEPT];
int photos[ORL_RADIANCE_KEPT];
float weights[ORL_RADIANCE_KEPT]; // 0: no sample
#define EACH_SAMPLE(k) for (int k = 0; k < ORL_RADIANCE_KEPT; k++)

void put(int at, int i, Sample s, float weight)
{
    EACH_SAMPLE(k) {
        if (k == at) {
            samples[k] = s;
            photos[k] = i;
            weights[k] = weight;
        }
    }
}

// In place of the lightest sample, if that is lighter.
void put_among(int i, Sample s, float weight)
{
    int least = -1;
    float lightest = weight;
    EACH_SAMPLE(k) {
        if (weights[k] < lightest) {
            lightest = weights[k];
            least = k;
        }
    }
    put(least, i, s, weight);
}

// The heaviest weight.
float ask_photos(vec3 p, bool guessed)
{
    EACH_SAMPLE(k) {
        samples[k] = Sample(vec3(0.0), 0.0, 0.0, 1.0, vec2(0.0), 0.0);
        photos[k] = 0;
        weights[k] = 0.0;
    }
    float heaviest = 0.0;
    int list = ORL_RADIANCE_LIST * int(gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x);
    for (int n = 0; n < ORL_RADIANCE_KEPT; n++) {
        int i = chosen[list + n];
        Sample s;
        if (i < 0)
            break;
        photo shot = photo_at(i);
        if (!ask(shot, p, guessed, s))
            continue;
        float weight = total_weight(s, noise_of(shot, s.color), guessed);
        s.unrest = unrest(shot, s);
        put(n, i, s, weight);
        heaviest = max(heaviest, weight);
    }
    // What no probe saw: a small surface that the chosen photographs see badly or not.
    if (heaviest > LEAST_SHARE_FOUND * intBitsToFloat(chosen[list + ORL_RADIANCE_KEPT]))
        return heaviest;
    for (int i = 0; i < area.z; i++) {
        Sample s;
        bool known = false;
        for (int n = 0; n < ORL_RADIANCE_KEPT; n++)
            known = known || chosen[list + n] == i;
        photo shot = photo_at(i);
        if (known || !ask(shot, p, guessed, s))
            continue;
        float weight = total_weight(s, noise_of(shot, s.color), guessed);
        s.unrest = unrest(shot, s);
        put_among(i, s, weight);
        heaviest = max(heaviest, weight);
    }
    return heaviest;
}

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
        if (below <= 0.5 * total && below + weights[k] > 0.5 * total)
            median = samples[k].color;
    }
    return median;
}

// Largest weight that a method of the best few leaves out.
float left_out()
{
    int kept = flags.z == 1 ? int(choice.x) : ORL_RADIANCE_KEPT;
    float limit = 0.0;
    EACH_SAMPLE(k) {
        int above = 0;
        EACH_SAMPLE(j)
            above += int(weights[j] > weights[k] || (weights[j] == weights[k] && j < k));
        limit = above == kept ? weights[k] : limit;
    }
    return limit;
}

// Final weights and their sum; returns the sum of weight * trust.
float weigh(bool guessed, out float total)
{
    // How far each sample is to be trusted depends on how much light there was, which its
    // own noise must not decide: the median says.
    vec3 level = max(median_color(), radiance.z);
    float noise[ORL_RADIANCE_KEPT], trust = 0.0;
    EACH_SAMPLE(k) {
        noise[k] = noise_of(photo_at(photos[k]), level);
        weights[k] = total_weight(samples[k], noise[k], guessed);
    }
    float limit = left_out();
    total = 0.0;
    EACH_SAMPLE(k) {
        weights[k] = max(weights[k] - limit, 0.0); // so that none appears at once
        // Things that moved between the photographs. 1 / ln(2)^2 makes relative error stops.
        if (radiance.x > 0.0) {
            float excess = stops2(samples[k].color, level) /
                           (radiance.x * radiance.x + 2.0814 * noise[k] + samples[k].unrest);
            weights[k] /= 1.0 + excess * excess;
        }
        total += weights[k];
        trust += weights[k] * samples[k].clip * MODEL / (MODEL + noise[k]);
    }
    return trust;
}

// Colour * weight, weight of sample k.
vec4 sampled(int n, float total)
{
    Sample s = samples[0];
    int i = photos[0];
    float weight = weights[0];
    EACH_SAMPLE(k) {
        if (k == n) {
            s = samples[k];
            i = photos[k];
            weight = weights[k];
        }
    }
    if (flags.y == 1 && weight > 0.02 * total)
        s.color = photo_sharper(photo_at(i), s.pixel, s.mip, s.color);
    return vec4(s.color, 1.0) * weight;
}

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= area.x || at.y >= area.y)
        return;
    float depth = imageLoad(view_depth, at).r;
    if (depth == 0.0 || !(ask_photos(surface_point(at, abs(depth)), depth < 0.0) > 0.0))
        return;
    float total, trust = weigh(depth < 0.0, total);
    vec4 sum = vec4(0.0);
    for (int n = 0; n < ORL_RADIANCE_KEPT; n++)
        sum += sampled(n, total);
    imageStore(accumulated, at, imageLoad(accumulated, at) + sum);
    imageStore(trusted, at, imageLoad(trusted, at) + vec4(trust, total, 0.0, 0.0));
}
