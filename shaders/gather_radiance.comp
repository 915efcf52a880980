// Blends photographs of several exposures into one radiance: the geometric weight of each
// times its trust, so that clipped and noisy samples lose to better ones pixel by pixel.
#define RADIANCE
#include "include/airieau.glsl"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(r32f, binding = 0) readonly uniform image2D view_depth; // < 0: guessed background
layout(rgba32f, binding = 1) uniform image2D accumulated;      // colour * weight, weight
layout(rg32f, binding = 2) uniform image2D trusted;            // weight * trust, weight

// Candidates of a pixel, best first; the last one only sets where weights start from.
const int KEEP = 8;
struct Sample {
    float weight, mip;
    vec2 pixel;
    int photo;
};
Sample best[KEEP + 1];

void offer(Sample candidate)
{
    int at = KEEP;
    while (at > 0 && best[at - 1].weight < candidate.weight) {
        best[at] = best[at - 1];
        at--;
    }
    best[at] = candidate;
}

void find_candidates(vec3 p, bool guessed)
{
    for (int k = 0; k <= KEEP; k++)
        best[k] = Sample(0.0, 0.0, vec2(0.0), 0);
    for (int i = 0; i < area.z; i++) {
        Sample s;
        float z;
        s.photo = i;
        if (!photo_project(i, p, s.pixel, z))
            continue;
        s.weight = airieau_weight(p, photos[i].eye.xyz);
        if (guessed)
            s.weight = pow(s.weight * options.y, 8.0);
        s.weight *= photo_border(i, s.pixel);
        // Trust is at most 1: what is too light already needs no looking up.
        if (!(s.weight > best[KEEP].weight))
            continue;
        s.mip = photo_mip(i, z, p.z);
        s.weight *= photo_bilinear(i, s.pixel, s.mip).a;
        if (!(s.weight > best[KEEP].weight))
            continue;
        if (flags.x == 1 && !photo_sees(photo_depths(i, s.pixel), z, guessed))
            continue;
        offer(s);
    }
}

// Squared difference in stops, mean of the channels.
float stops2(vec3 a, vec3 b)
{
    vec3 d = log2(max(a, 1e-12)) - log2(max(b, 1e-12));
    return dot(d, d) / 3.0;
}

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= area.x || at.y >= area.y)
        return;
    float stored = imageLoad(view_depth, at).r;
    float depth = abs(stored);
    if (!(depth > 0.0))
        return;
    vec3 p = vec3((vec2(at) + 0.5 - view_focal.zw) / view_focal.xy, 1.0) * depth;
    find_candidates(p, stored < 0.0);

    // Weights start from the best candidate left out, so that none appears at once.
    vec4 color[KEEP];
    float brightness[KEEP], weight[KEEP], total = 0.0;
    int count = 0;
    for (; count < KEEP && best[count].weight > best[KEEP].weight; count++) {
        Sample s = best[count];
        color[count] = photo_sample(s.photo, s.pixel, s.mip);
        brightness[count] = dot(color[count].rgb, vec3(0.2126, 0.7152, 0.0722));
        weight[count] = s.weight - best[KEEP].weight;
        total += weight[count];
    }
    if (!(total > 0.0))
        return;

    // What moved between the photographs: samples that differ from the weighted median by
    // more than noise and `ghosts` stops lose their weight.
    int median = 0;
    for (int k = 0; k < count; k++) {
        float below = 0.0;
        for (int j = 0; j < count; j++)
            below += brightness[j] < brightness[k] || (brightness[j] == brightness[k] && j < k)
                         ? weight[j] : 0.0;
        if (below <= 0.5 * total && below + weight[k] > 0.5 * total)
            median = k;
    }
    vec4 sum = vec4(0.0);
    float trust = 0.0;
    for (int k = 0; k < count; k++) {
        float w = weight[k];
        if (radiance.x > 0.0) {
            // Trust is model / (model + noise), as variances of relative error (radiance.h).
            float noise = radiance.y * (1.0 / max(color[k].a, 1e-7) - 1.0);
            float allowed = radiance.x * radiance.x + 2.0814 * noise; // 1 / ln(2)^2: in stops
            float excess = stops2(color[k].rgb, color[median].rgb) / allowed;
            w /= 1.0 + excess * excess;
        }
        sum += vec4(color[k].rgb, 1.0) * w;
        trust += w * color[k].a;
    }
    imageStore(accumulated, at, imageLoad(accumulated, at) + sum);
    imageStore(trusted, at, imageLoad(trusted, at) + vec4(trust, sum.a, 0.0, 0.0));
}
