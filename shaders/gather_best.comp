// Blends the best few photographs into each pixel: weights fall continuously to zero at
// the first photograph left out, at borders and where the surface gets hidden.
#include "include/photo_choice.glsl"

// KEPT: photographs that a pixel may blend, 2 or 4: a software renderer samples all of them.
#if KEPT > 2
#define KEPT_VEC vec4
#define KEPT_IVEC ivec4
#else
#define KEPT_VEC vec2
#define KEPT_IVEC ivec2
#endif

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

// The best photographs of a pixel, ascending by penalty, and the penalty of the one after the
// last of them. Components, not arrays: those are slow where registers cannot be indexed.
struct ranking {
    KEPT_VEC penalty;
    KEPT_IVEC photo;
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
#if KEPT > 2
    SWAP_IN(z)
    SWAP_IN(w)
#endif
    r.next = min(r.next, penalty);
}

// The least penalty that is left out.
float limit_of(ranking r)
{
    if (choice.x < 1.5)
        return r.penalty.y;
#if KEPT > 2
    if (choice.x < 3.5)
        return choice.x < 2.5 ? r.penalty.z : r.penalty.w;
#endif
    return r.next;
}

// Asks photograph `i`.
void consider(int i, vec3 p, bool guessed, inout ranking r)
{
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

ranking rank(int list, vec3 p, bool guessed)
{
    ranking r = ranking(KEPT_VEC(NOT_SEEN), KEPT_IVEC(-1), NOT_SEEN);
    int c = 0, count = int(choice_more.x), i = chosen[list];
    if (i < 0)
        return r;
    // The condition last: a software renderer runs a loop's body once more to find one at its
    // beginning false.
    do {
        consider(i, p, guessed, r);
        c++;
        i = c < count ? chosen[list + c] : -1;
    } while (i >= 0);
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

// Adds a sample, or rather colour * weight, weight, to `sum`, with less weight the farther it is
// from the consensus.
void add(vec4 one, vec3 mean, float severity, inout vec4 sum)
{
    vec3 off = sqrt(one.rgb) - mean;
    sum += vec4(one.rgb, 1.0) * (one.a / (1.0 + dot(off, off) * severity));
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
#if KEPT > 2
        vec4 c = look(r.photo.z, r.penalty.z, least, limit, sharpness, p);
        vec4 d = look(r.photo.w, r.penalty.w, least, limit, sharpness, p);
#endif
        // Samples far from the consensus lose weight: passers-by, leaves, reflections. Roots make
        // the consensus of photographs and not of the best one alone, and differences of light
        // about as the eye sees them. On guessed depth photographs disagree by nature.
        float severity = guessed ? 0.0 : choice_more.y;
        vec4 vote = vec4(sqrt(a.rgb), 1.0) * sqrt(a.a) + vec4(sqrt(b.rgb), 1.0) * sqrt(b.a);
#if KEPT > 2
        vote += vec4(sqrt(c.rgb), 1.0) * sqrt(c.a) + vec4(sqrt(d.rgb), 1.0) * sqrt(d.a);
#endif
        vec3 mean = vote.rgb / max(vote.a, 1e-30);
        vec4 sum = vec4(0.0);
        add(a, mean, severity, sum);
        add(b, mean, severity, sum);
#if KEPT > 2
        add(c, mean, severity, sum);
        add(d, mean, severity, sum);
#endif
        if (sum.a > 0.0)
            imageStore(accumulated, at, sum);
    }
}
