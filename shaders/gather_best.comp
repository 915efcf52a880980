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

// The best photographs of a pixel, ascending by penalty, and the penalty of the one after
// the fourth. Components, not arrays: those are slow where registers cannot be indexed.
struct ranking {
    vec4 penalty;
    ivec4 photo;
    float next;
};

// Puts (penalty, photo) in place k and hands on what was there, if that is worse.
#define SWAP_IN(k)                                   \
    if (penalty < r.penalty.k) {                     \
        float worse = r.penalty.k;                   \
        int other = r.photo.k;                       \
        r.penalty.k = penalty;                       \
        r.photo.k = photo;                           \
        penalty = worse;                             \
        photo = other;                               \
    }

void insert(float penalty, int photo, inout ranking r)
{
    SWAP_IN(x)
    SWAP_IN(y)
    SWAP_IN(z)
    SWAP_IN(w)
    r.next = min(r.next, penalty);
}

// The least penalty that is left out.
float limit_of(ranking r)
{
    return choice.x < 1.5 ? r.penalty.y
         : choice.x < 2.5 ? r.penalty.z
         : choice.x < 3.5 ? r.penalty.w
                          : r.next;
}

ranking rank(int list, vec3 p, bool guessed)
{
    ranking r = ranking(vec4(NOT_SEEN), ivec4(-1), NOT_SEEN);
    int count = int(choice_more.x);
    for (int c = 0; c < count; c++) {
        int i = chosen[list + c];
        if (i < 0)
            break;
        vec2 pixel;
        float z;
        bool inside = photo_project(i, p, pixel, z);
        float penalty = photo_penalty(i, p);
        // Not worse than the limit even if it saw the surface for sure.
        if (inside && penalty < limit_of(r)) {
            vec4 seen = photo_depths(i, pixel);
            float sure = photo_border(i, pixel);
            if (guessed)
                sure *= photo_unhidden_share(seen, z);
            else if (flags.x == 1)
                sure *= photo_sees(seen, z);
            if (sure > 1e-4)
                insert(penalty / sure, i, r);
        }
    }
    return r;
}

// One photograph's colour and its weight.
vec4 look(int i, float penalty, float least, float limit, float sharpness, vec3 p)
{
    if (!(penalty < limit))
        return vec4(0.0);
    // Full weight until the penalty comes near that of the first left out.
    float fade = limit == NOT_SEEN ? 1.0 : min(1.0, 4.0 * (1.0 - penalty / limit));
    vec2 pixel;
    float z;
    photo_project(i, p, pixel, z);
    return vec4(photo_sample(i, pixel, photo_mip(i, z, p.z)).rgb,
                pow(least / penalty, sharpness) * fade);
}

// Sum of colour * weight, weight, where samples far from the consensus lose weight: passers-by,
// leaves, reflections. Roots make the consensus of photographs and not of the best one alone,
// and differences of light about as the eye sees them.
vec4 blend(vec4 a, vec4 b, vec4 c, vec4 d, float severity)
{
    vec4 weight = vec4(a.a, b.a, c.a, d.a), vote = sqrt(weight);
    float votes = dot(vote, vec4(1.0));
    if (severity > 0.0 && votes > 0.0) {
        mat4x3 root = mat4x3(sqrt(a.rgb), sqrt(b.rgb), sqrt(c.rgb), sqrt(d.rgb));
        vec3 mean = root * vote / votes;
        for (int k = 0; k < 4; k++) {
            vec3 off = root[k] - mean;
            weight[k] /= 1.0 + dot(off, off) * severity;
        }
    }
    return vec4(a.rgb, 1.0) * weight.x + vec4(b.rgb, 1.0) * weight.y +
           vec4(c.rgb, 1.0) * weight.z + vec4(d.rgb, 1.0) * weight.w;
}

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= area.x || at.y >= area.y)
        return;
    float stored = imageLoad(view_depth, at).r;
    bool guessed = stored < 0.0;
    vec3 p = vec3((vec2(at) + 0.5 - view_focal.zw) / view_focal.xy, 1.0) * abs(stored);
    if (p.z > 0.0) {
        // A group lies within one tile, so that each photograph's data are the same for all of it.
        ivec2 corner = ivec2(gl_WorkGroupID.xy) * ivec2(ORL_PIXEL_GROUP_X, ORL_PIXEL_GROUP_Y);
        ivec2 tile = corner / CHOICE_TILE;
        ranking r = rank((tile.y * area.w + tile.x) * CANDIDATES, p, guessed);
        float sharpness = guessed ? choice.w : choice.y, limit = limit_of(r), least = r.penalty.x;
        vec4 a = look(r.photo.x, r.penalty.x, least, limit, sharpness, p);
        vec4 b = look(r.photo.y, r.penalty.y, least, limit, sharpness, p);
        vec4 c = look(r.photo.z, r.penalty.z, least, limit, sharpness, p);
        vec4 d = look(r.photo.w, r.penalty.w, least, limit, sharpness, p);
        // On guessed depth photographs disagree by nature.
        vec4 sum = blend(a, b, c, d, guessed ? 0.0 : choice_more.y);
        if (sum.a > 0.0)
            imageStore(accumulated, at, sum);
    }
}
