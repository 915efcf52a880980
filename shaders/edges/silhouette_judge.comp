// Depth from splats reaches past silhouettes by a few pixels. The photographs show there what is
// behind, each another part of it: they differ more than on the depth behind the edge, and the
// best of them looks like that, not like the surface next to it. So each pixel before an edge
// votes on belonging behind it; silhouette_cut.comp counts.
#include "gather/penalty.glsl"
#include "gather/hidden.glsl"
#include "gather/sample/srgb.glsl"
#include "edges/edge_list.glsl"

layout(local_size_x = EDGE_GROUP) in;
layout(r32f, binding = 0) readonly uniform image2D view_depth; // < 0: guessed background
layout(r32f, binding = 1) writeonly uniform image2D votes;     // of pixels that are listed
layout(std430, binding = 1) readonly buffer tile_lists {
    int chosen[];
};

// Variances of square roots of light: photographs differ clearly when by this much more.
const float CLEARLY = 4.0, NOISE = 0.01;
// Fewer photographs than this cannot differ.
const float VOICES_LEAST = 1.3;
// Pixels from the edge at which the surface surely is itself, beyond the reach of wrong depth.
const float INNER = 2.0;
const float VOTE_MOST = 2.0;

// What the photographs of a tile say of a point. Colours: square roots of light.
struct opinion {
    vec3 mean, best_color;
    float variance, voices; // voices: how many photographs have a say
    int best;               // the one with the most say; -1: none
};

vec3 look(photo shot, vec2 pixel, float z, vec3 p)
{
    vec3 color = photo_bilinear(shot, pixel, floor(photo_mip(shot, z, p.z))).rgb;
    return sqrt(photo_aligned(shot, pixel, color));
}

opinion ask(int list, vec3 p)
{
    opinion o = opinion(vec3(0.0), vec3(0.0), 0.0, 0.0, -1);
    vec4 sum = vec4(0.0);
    float squares = 0.0, weights = 0.0, most = 0.0;
    int c = 0, i = chosen[list];
    do { // the condition last: see tiled.comp
        photo shot = photo_at(max(i, 0));
        vec2 pixel;
        float z;
        bool inside = photo_project(shot, p, pixel, z);
        float weight = photo_unhidden_share(shot, photo_depths(shot, pixel), z) *
                       photo_border(shot, pixel, false) / (photo_penalty(shot, p) + 0.05);
        weight = inside && i >= 0 ? weight : 0.0;
        vec3 color = look(shot, pixel, z, p);
        sum += vec4(color, 1.0) * weight;
        squares += dot(color, color) * weight;
        weights += weight * weight;
        o.best = weight > most ? i : o.best;
        o.best_color = weight > most ? color : o.best_color;
        most = max(most, weight);
        c++;
        i = c < asked ? chosen[list + c] : -1;
    } while (i >= 0);
    sum.a = max(sum.a, 1e-30);
    o.voices = sum.a * sum.a / max(weights, 1e-30);
    o.mean = sum.rgb / sum.a;
    float variance = max(squares / sum.a - dot(o.mean, o.mean), 0.0);
    o.variance = variance * o.voices / max(o.voices - 1.0, 0.5);
    return o;
}

vec3 ray(ivec2 at)
{
    return vec3((vec2(at) + 0.5 - view_focal.zw) / view_focal.xy, 1.0);
}

// Is the best photograph's colour here like the surface's farther inside (< 0), or like what is
// behind (> 0)? In powers of two.
float likeness(opinion here, opinion there, ivec2 inner)
{
    float z, depth = abs(imageLoad(view_depth, inner).r);
    if (!(depth > 0.0))
        return 0.0;
    vec2 pixel;
    vec3 p = ray(inner) * depth;
    photo shot = photo_at(here.best);
    photo_project(shot, p, pixel, z);
    vec3 off_surface = here.best_color - look(shot, pixel, z, p);
    vec3 off_behind = here.best_color - there.mean;
    return log2((dot(off_surface, off_surface) + NOISE) / (dot(off_behind, off_behind) + NOISE));
}

float vote(uvec4 edge)
{
    ivec2 at = edge_pixel(edge), tile = at / CHOICE_TILE;
    int list = (tile.y * tiles_across + tile.x) * CANDIDATES;
    opinion here = ask(list, ray(at) * imageLoad(view_depth, at).r);
    opinion there = ask(list, ray(at) * abs(uintBitsToFloat(edge.y)));
    if (min(here.voices, there.voices) < VOICES_LEAST)
        return 0.0;
    vec2 inward = normalize(unpackHalf2x16(edge.z) + 1e-4) * (float(reach) + INNER);
    float differ = log2(max(here.variance, 1e-6) / (CLEARLY * there.variance + NOISE));
    return clamp(differ + likeness(here, there, at + ivec2(round(inward))), -VOTE_MOST, VOTE_MOST);
}

void main()
{
    uint place = gl_GlobalInvocationID.x;
    while (place < edges_listed()) {
        imageStore(votes, edge_pixel(edges[place]), vec4(vote(edges[place])));
        place += EDGE_GROUP * EDGE_GROUPS_MAX;
    }
}
