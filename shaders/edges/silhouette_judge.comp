// Depth from splats reaches past silhouettes by a few pixels. There the photographs show the
// background, each a different part of it. So they differ more when projected to the foreground
// depth than to the background depth, and the best photograph resembles the background rather than
// the surface beside it. Each foreground pixel at an edge votes for or against the background;
// silhouette_cut.comp counts the votes.
#include "gather/penalty.glsl"
#include "gather/hidden.glsl"
#include "gather/sample/srgb.glsl"
#include "edges/edge_list.glsl"

layout(local_size_x = EDGE_GROUP) in;
layout(r32f, binding = 0) readonly uniform image2D view_depth; // < 0: estimated background depth
layout(r32f, binding = 1) writeonly uniform image2D votes;     // votes of the listed pixels
layout(std430, binding = 1) readonly buffer tile_lists {
    int chosen[];
};

// Variances are of square roots of light. Photographs differ clearly when the variance is CLEARLY
// times as large.
const float CLEARLY = 4.0, NOISE = 0.01;
// Least effective number of photographs from which a variance can be computed.
const float VOICES_LEAST = 1.3;
// Distance beyond opt.silhouette, in pixels, at which the foreground surface is certain.
const float INNER = 2.0;
const float VOTE_MOST = 2.0;

// Statistics of the samples that a tile's photographs give for a point. Colours are square roots
// of light.
struct opinion {
    vec3 mean, best_color;
    float variance, voices; // voices: effective number of photographs
    int best;               // photograph of greatest weight; -1: none
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
    do { // the condition comes last: see tiled.comp
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

// Compares the best photograph's colour with that of the surface farther inside and with that of
// the background. Log2 of a ratio of squared differences: < 0: like the surface, > 0: like the
// background.
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
    ivec2 at = edge_pixel(edge), tile = at / tile_side;
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
