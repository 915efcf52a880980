// Blends the best few photographs into each pixel: weights fall continuously to zero at
// the first photograph left out, at borders and where the surface gets hidden.
#include "include/photo_choice.glsl"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(r32f, binding = 0) readonly uniform image2D view_depth; // < 0: guessed background
layout(rgba32f, binding = 1) writeonly uniform image2D accumulated; // colour * weight, weight
layout(std430, binding = 1) readonly buffer tile_lists {
    int chosen[];
};

// How surely the photograph saw this surface: 1 where its depth agrees, little where it
// has none, 0 where it saw something else.
float photo_sees(vec4 seen, float z)
{
    vec4 off = abs(seen - z) / (z * options.x);
    vec4 share = clamp(2.0 - off, 0.0, 1.0);
    float agrees = max(max(share.x, share.y), max(share.z, share.w));
    bool unknown = all(equal(seen, vec4(0.0)));
    return unknown ? choice.z : agrees;
}

struct ranking {
    float penalty[CANDIDATES];
    float least, limit; // the least penalty, and that of the first photograph left out
};

void rank(int list, vec3 p, bool guessed, out ranking r)
{
    int kept = int(choice.x);
    float limits[KEPT_MAX + 1]; // the least penalties, ascending
    for (int k = 0; k <= KEPT_MAX; k++)
        limits[k] = NOT_SEEN;
    for (int c = 0; c < CANDIDATES; c++) {
        r.penalty[c] = NOT_SEEN;
        int i = chosen[list + c];
        vec2 pixel;
        float z;
        if (i < 0 || !photo_project(i, p, pixel, z))
            continue;
        vec4 seen = photo_depths(i, pixel);
        float sure = photo_border(i, pixel);
        if (guessed)
            sure *= photo_unhidden_share(seen, z);
        else if (flags.x == 1)
            sure *= photo_sees(seen, z);
        if (!(sure > 1e-4))
            continue;
        float value = photo_penalty(i, p) / sure;
        r.penalty[c] = value;
        for (int k = 0; k <= kept; k++) {
            float larger = max(value, limits[k]);
            limits[k] = min(value, limits[k]);
            value = larger;
        }
    }
    r.least = limits[0];
    r.limit = limits[kept];
}

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= area.x || at.y >= area.y)
        return;
    float stored = imageLoad(view_depth, at).r;
    bool guessed = stored < 0.0;
    float depth = abs(stored);
    if (!(depth > 0.0))
        return;
    vec3 p = vec3((vec2(at) + 0.5 - view_focal.zw) / view_focal.xy, 1.0) * depth;
    int list = ((at.y / CHOICE_TILE) * area.w + at.x / CHOICE_TILE) * CANDIDATES;
    ranking r;
    rank(list, p, guessed, r);
    if (r.least == NOT_SEEN)
        return;
    float sharpness = guessed ? choice.w : choice.y;
    vec4 sum = vec4(0.0);
    for (int c = 0; c < CANDIDATES; c++) {
        if (!(r.penalty[c] < r.limit))
            continue;
        float fade = r.limit == NOT_SEEN ? 1.0 : 1.0 - r.penalty[c] / r.limit;
        float weight = pow(r.least / r.penalty[c], sharpness) * fade;
        int i = chosen[list + c];
        vec2 pixel;
        float z;
        photo_project(i, p, pixel, z);
        sum += vec4(photo_sample(i, pixel, photo_mip(i, z, depth)).rgb, 1.0) * weight;
    }
    if (sum.a > 0.0)
        imageStore(accumulated, at, sum);
}
