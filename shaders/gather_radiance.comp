// Blends photographs of several exposures into one radiance: the geometric weight of each
// times its trust, so that clipped and noisy samples lose to better ones pixel by pixel.
#define RADIANCE
#include "include/airieau.glsl"
#include "include/photo_choice.glsl"
#include "include/trust.glsl"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(r32f, binding = 0) readonly uniform image2D view_depth; // < 0: guessed background
layout(rgba32f, binding = 1) uniform image2D accumulated;      // colour * weight, weight
layout(rg32f, binding = 2) uniform image2D trusted;            // weight * trust, weight

const vec3 LUMINANCE = vec3(0.2126, 0.7152, 0.0722);
#define MODEL radiance.y // variance of relative error at full exposure

struct Sample {
    vec3 color;   // radiance
    float clip;   // trust as far as clipping goes
    float weight; // geometric
    float usual;
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
float seen_share(vec4 seen, float z, bool guessed)
{
    if (guessed)
        return photo_unhidden_share(seen, z);
    vec4 same = clamp(2.0 - abs(seen - z) / (z * options.x), 0.0, 1.0);
    float share = dot(mix(same, vec4(choice.z), equal(seen, vec4(0.0))), vec4(0.25));
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
float total_weight(Sample s, float noise)
{
    // Traces of trust in clipped samples must tell them apart whatever their geometry.
    float trace = min(1024.0 * s.clip, 1.0);
    return s.clip * trace * trace * s.weight /
           (1.0 + max(s.weight / s.usual, 1.0) * noise / MODEL);
}

// What photograph `i` says of a point; false when it does not see it.
bool ask(int i, vec3 p, bool guessed, out Sample s)
{
    float z;
    photo shot = photo_at(i);
    s.weight = 0.0;
    if (!photo_project(shot, p, s.pixel, z))
        return false;
    s.usual = usual_weight(guessed);
    s.weight = geometric_weight(shot, p, guessed) * photo_border(shot, s.pixel);
    if (!(s.weight > 0.0))
        return false;
    if (flags.x == 1)
        s.weight *= seen_share(photo_depths(shot, s.pixel), z, guessed);
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

// --- the photographs that matter to this work group's pixels ---

const int PROBES_X = 4, PROBES_Y = 2;
const int PROBES = PROBES_X * PROBES_Y;
const int LANES = ORL_PIXEL_GROUP_X * ORL_PIXEL_GROUP_Y;
const float LEAST_SHARE = 0.01; // of the best photograph's weight
const float LEAST_SHARE_FOUND = 0.02; // with less than that a pixel asks all the others

shared uint scores[ORL_RADIANCE_PHOTOS]; // bits of the largest weight * trust among probes
shared int chosen[ORL_RADIANCE_KEPT];
shared int chosen_count;
shared uint best_score; // of all photographs at all probes

void probe(int i, int probe_index)
{
    ivec2 local = ivec2(probe_index % PROBES_X, probe_index / PROBES_X);
    ivec2 at = ivec2(gl_WorkGroupID.xy * gl_WorkGroupSize.xy) +
               (2 * local + 1) * ivec2(ORL_PIXEL_GROUP_X / (2 * PROBES_X),
                                       ORL_PIXEL_GROUP_Y / (2 * PROBES_Y));
    at = min(at, area.xy - 1);
    float depth = imageLoad(view_depth, at).r;
    Sample s;
    if (depth != 0.0 && ask(i, surface_point(at, abs(depth)), depth < 0.0, s))
        atomicMax(scores[i], floatBitsToUint(total_weight(s, noise_of(photo_at(i), s.color))));
}

void choose()
{
    int lane = int(gl_LocalInvocationIndex);
    for (int i = lane; i < area.z; i += LANES)
        scores[i] = 0u;
    if (lane == 0) {
        chosen_count = 0;
        best_score = 0u;
    }
    barrier();
    for (int k = lane; k < area.z * PROBES; k += LANES)
        probe(k / PROBES, k % PROBES);
    barrier();
    for (int i = lane; i < area.z; i += LANES) {
        uint mine = scores[i], most = mine;
        int rank = 0;
        atomicMax(best_score, mine);
        for (int j = 0; j < area.z; j++) {
            rank += int(scores[j] > mine || (scores[j] == mine && j < i));
            most = max(most, scores[j]);
        }
        if (rank < ORL_RADIANCE_KEPT && mine > 0u &&
            uintBitsToFloat(mine) >= LEAST_SHARE * uintBitsToFloat(most)) {
            chosen[rank] = i;
            atomicMax(chosen_count, rank + 1);
        }
    }
    barrier();
}

// --- one pixel ---

Sample samples[ORL_RADIANCE_KEPT];
float brightness[ORL_RADIANCE_KEPT];
int sample_photo[ORL_RADIANCE_KEPT];
float weights[ORL_RADIANCE_KEPT];
int sample_count = 0;

// Where a sample goes: behind the others, or in place of the lightest one.
int place_for(float weight)
{
    if (sample_count < ORL_RADIANCE_KEPT)
        return sample_count++;
    int least = 0;
    for (int k = 1; k < ORL_RADIANCE_KEPT; k++)
        least = weights[k] < weights[least] ? k : least;
    return weights[least] < weight ? least : -1;
}

void ask_chosen(vec3 p, bool guessed)
{
    float heaviest = 0.0;
    sample_count = 0;
    for (int k = 0; k < chosen_count; k++) {
        int at = sample_count, i = chosen[k];
        if (!ask(i, p, guessed, samples[at]))
            continue;
        sample_photo[at] = i;
        weights[at] = total_weight(samples[at], noise_of(photo_at(i), samples[at].color));
        heaviest = max(heaviest, weights[at]);
        sample_count++;
    }
    // What no probe saw: a small surface that the chosen photographs see badly or not.
    if (heaviest > LEAST_SHARE_FOUND * uintBitsToFloat(best_score))
        return;
    for (int i = 0; i < area.z; i++) {
        Sample s;
        bool known = false;
        for (int k = 0; k < chosen_count; k++)
            known = known || chosen[k] == i;
        if (known || !ask(i, p, guessed, s))
            continue;
        float weight = total_weight(s, noise_of(photo_at(i), s.color));
        int at = place_for(weight);
        if (at < 0)
            continue;
        samples[at] = s;
        sample_photo[at] = i;
        weights[at] = weight;
    }
}

// Radiance of the sample at the weighted median of brightness.
vec3 median_color()
{
    float total = 0.0;
    for (int k = 0; k < sample_count; k++) {
        brightness[k] = dot(samples[k].color, LUMINANCE);
        total += weights[k];
    }
    int median = 0;
    for (int k = 0; k < sample_count; k++) {
        float below = 0.0, mine = brightness[k];
        for (int j = 0; j < sample_count; j++)
            below += brightness[j] < mine || (brightness[j] == mine && j < k) ? weights[j] : 0.0;
        if (below <= 0.5 * total && below + weights[k] > 0.5 * total)
            median = k;
    }
    return samples[median].color;
}

// Squared difference in stops, mean of the channels.
float stops2(vec3 a, vec3 b, float floor_level)
{
    vec3 d = log2(max(a, floor_level)) - log2(max(b, floor_level));
    return dot(d, d) / 3.0;
}

// Largest weight that a method of the best few leaves out.
float left_out()
{
    int kept = flags.z == 1 ? int(choice.x) : ORL_RADIANCE_KEPT;
    float limit = 0.0;
    for (int k = 0; k < sample_count; k++) {
        int above = 0;
        for (int j = 0; j < sample_count; j++)
            above += int(weights[j] > weights[k] || (weights[j] == weights[k] && j < k));
        limit = above == kept ? weights[k] : limit;
    }
    return limit;
}

void blend(ivec2 at)
{
    // How far each sample is to be trusted depends on how much light there was, which its
    // own noise must not decide: the median says.
    vec3 level = max(median_color(), radiance.z);
    float noise[ORL_RADIANCE_KEPT];
    for (int k = 0; k < sample_count; k++) {
        noise[k] = noise_of(photo_at(sample_photo[k]), level);
        weights[k] = total_weight(samples[k], noise[k]);
    }
    float limit = left_out(), total = 0.0, trust = 0.0;
    for (int k = 0; k < sample_count; k++) {
        weights[k] = max(weights[k] - limit, 0.0); // so that none appears at once
        // Things that moved between the photographs. 1 / ln(2)^2 makes relative error stops.
        if (radiance.x > 0.0) {
            float excess = stops2(samples[k].color, level, radiance.z) /
                           (radiance.x * radiance.x + 2.0814 * noise[k]);
            weights[k] /= 1.0 + excess * excess;
        }
        total += weights[k];
        trust += weights[k] * samples[k].clip * MODEL / (MODEL + noise[k]);
    }
    vec4 sum = vec4(0.0);
    for (int k = 0; k < sample_count; k++) {
        vec3 color = samples[k].color;
        if (flags.y == 1 && weights[k] > 0.02 * total)
            color = photo_sharper(photo_at(sample_photo[k]), samples[k].pixel, samples[k].mip,
                                  color);
        sum += vec4(color, 1.0) * weights[k];
    }
    imageStore(accumulated, at, imageLoad(accumulated, at) + sum);
    imageStore(trusted, at, imageLoad(trusted, at) + vec4(trust, total, 0.0, 0.0));
}

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    choose();
    if (at.x >= area.x || at.y >= area.y)
        return;
    float depth = imageLoad(view_depth, at).r;
    if (depth == 0.0)
        return;
    ask_chosen(surface_point(at, abs(depth)), depth < 0.0);
    if (sample_count > 0)
        blend(at);
}
