// Depth from splats reaches past silhouettes by a few pixels: each pixel before an edge of depth
// votes on belonging behind it, as shaders/edges/silhouette_find.comp and silhouette_judge.comp do.
#include "gather/penalty.glsl"
#include "gather/hidden.glsl"
#include "gather/sample/srgb.glsl"

uniform sampler2D view_depth; // < 0: guessed
uniform highp usampler2D tiles; // choose.frag
uniform int candidates, silhouette;
layout(location = 0) out vec2 vote_behind; // y: the depth behind the edge; 0: no edge

const float EDGE_RATIO = 1.03, CLEARLY = 4.0, NOISE = 0.01, VOICES_LEAST = 1.3, INNER = 2.0;
const float VOTE_MOST = 2.0;

// What the photographs of a tile say of a point. Colours: square roots of light.
struct opinion {
    vec3 mean, best_color;
    float variance, voices;
    int best; // the one with the most say; -1: none
};

float depth_at(ivec2 at)
{
    ivec2 area = textureSize(view_depth, 0);
    bool inside = at.x >= 0 && at.y >= 0 && at.x < area.x && at.y < area.y;
    return inside ? texelFetch(view_depth, at, 0).x : 0.0;
}

vec3 look(photo shot, vec2 pixel, float z, vec3 p)
{
    vec3 color = photo_bilinear(shot, pixel, floor(photo_mip(shot, z, p.z))).rgb;
    return sqrt(photo_aligned(shot, pixel, color));
}

opinion ask(uvec2 list, vec3 p)
{
    opinion o = opinion(vec3(0.0), vec3(0.0), 0.0, 0.0, -1);
    vec4 sum = vec4(0.0);
    float squares = 0.0, weights = 0.0, most = 0.0;
    for (int c = 0; c < candidates; c++) {
        int i = photo_listed(list, c);
        if (i < 0)
            break;
        photo shot = photo_at(i);
        vec2 pixel;
        float z;
        if (!photo_project(shot, p, pixel, z))
            continue;
        float weight = photo_unhidden_share(shot, photo_depths(shot, pixel), z) *
                       photo_border(shot, pixel, false) / (photo_penalty(shot, p) + 0.05);
        vec3 color = look(shot, pixel, z, p);
        sum += vec4(color, 1.0) * weight;
        squares += dot(color, color) * weight;
        weights += weight * weight;
        if (weight > most) {
            o.best = i;
            o.best_color = color;
            most = weight;
        }
    }
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

float likeness(opinion here, opinion there, ivec2 inner)
{
    float z, depth = abs(depth_at(inner));
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

void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy);
    float own = depth_at(at), behind = own, before = abs(own);
    vec2 inward = vec2(0.0); // to where the surface of this pixel goes on
    vote_behind = vec2(0.0);
    if (!(own > 0.0))
        return;
    for (int y = -silhouette; y <= silhouette; y++)
        for (int x = -silhouette; x <= silhouette; x++) {
            float other = depth_at(at + ivec2(x, y)), far = abs(other);
            behind = far > abs(behind) ? other : behind;
            before = far > 0.0 ? min(far, before) : before;
            inward += vec2(x, y) * (far < EDGE_RATIO * own ? 1.0 : -1.0);
        }
    float far = abs(behind);
    if (!(far > EDGE_RATIO * before && own * own < far * before))
        return;
    vote_behind.y = behind;
    uvec2 list = texelFetch(tiles, at / TILE, 0).xy;
    opinion here = ask(list, ray(at) * own), there = ask(list, ray(at) * far);
    if (min(here.voices, there.voices) < VOICES_LEAST)
        return;
    inward = normalize(inward + 1e-4) * (float(silhouette) + INNER);
    float differ = log2(max(here.variance, 1e-6) / (CLEARLY * there.variance + NOISE));
    float vote = differ + likeness(here, there, at + ivec2(round(inward)));
    vote_behind.x = clamp(vote, -VOTE_MOST, VOTE_MOST);
}
