// Blends the best few photographs into each pixel, as shaders/gather/gather_best.comp does.
#include "photo.glsl"

uniform sampler2D view_depth; // < 0: guessed
uniform highp usampler2D tiles; // choose.frag
uniform int candidates;
uniform float outliers, unknown_trust, sharpness, guess_sharpness, guess_blur_share, photos_per_pixel;
uniform vec4 ground;
// Colour; 1 on a surface, 0 on guessed depth, -1: nothing paints it, -1 - log2 of the blur in pixels.
layout(location = 0) out vec4 painted;
layout(location = 1) out vec4 source; // r, g: number of the best photograph, high and low byte; a: 1

const int KEPT = 4;

struct sight {
    float penalty;
    int index;
    vec2 pixel;
    float mip;
};

float photo_seen_share(vec4 seen, float z)
{
    vec4 off = abs(seen - z) / (z * depth_tolerance);
    vec4 share = clamp(2.0 - off, 0.0, 1.0);
    float agrees = max(max(share.x, share.y), max(share.z, share.w));
    return all(lessThanEqual(seen, vec4(0.0))) ? unknown_trust : agrees;
}

const float GUESS_SURE_LEAST = 0.1;

sight consider(int i, vec3 p, bool guessed)
{
    photo shot = photo_at(i);
    vec2 pixel;
    float z;
    if (!photo_project(shot, p, pixel, z))
        return sight(NOT_SEEN, i, vec2(0.0), 0.0);
    vec4 seen = photo_depths(shot, pixel);
    float penalty = photo_penalty(shot, p);
    float sees = guessed ? photo_unhidden_share(shot, seen, z) * photo_beside(penalty)
                         : photo_seen_share(seen, z);
    penalty = guessed ? penalty : photo_surface_penalty(penalty);
    float sure = sees * photo_border(shot, pixel, guessed);
    bool paints = sure > (guessed ? GUESS_SURE_LEAST : 1e-4);
    return sight(paints ? penalty / sure : NOT_SEEN, i, pixel, photo_mip(shot, z, p.z));
}

vec4 look(sight one, float least, float limit, bool guessed)
{
    if (!(one.penalty < NOT_SEEN && one.penalty <= limit))
        return vec4(0.0);
    // Falls to zero where the first photograph left out is as good: nothing pops.
    float fade = limit == NOT_SEEN ? 1.0 : min(1.0, 4.0 * (1.00001 - one.penalty / limit));
    photo shot = photo_at(one.index);
    vec3 color = photo_aligned(shot, one.pixel, photo_bicubic(shot, one.pixel, one.mip));
    return vec4(color, pow(least / one.penalty, guessed ? guess_sharpness : sharpness) * fade);
}

const float GUESS_DIFFERENCE = 0.1, GUESS_ALONE = 0.5, GROUND_DOUBT = 0.3, GUESS_SEVERITY = 4.0;

float guess_blur(vec3 p, float penalty, float difference, float share)
{
    float alone = clamp(5.0 * share - 4.0, 0.0, 1.0);
    float doubt = clamp(max(difference / GUESS_DIFFERENCE, GUESS_ALONE * alone), 0.0, 1.0);
    float depths = p.z * dot(ground.xyz, vec3(p.xy / p.z, 1.0));
    doubt *= abs(depths - 1.0) < 1e-3 ? GROUND_DOUBT : 1.0;
    return log2(max(guess_blur_share * focal.x * penalty * doubt, 1.0));
}

void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy);
    float stored = texelFetch(view_depth, at, 0).x;
    bool guessed = stored < 0.0;
    painted = vec4(0.0, 0.0, 0.0, -1.0);
    source = vec4(0.0);
    if (stored == 0.0)
        return;
    vec3 p = vec3((vec2(at) + 0.5 - focal.zw) / focal.xy, 1.0) * abs(stored);
    sight best[KEPT];
    for (int k = 0; k < KEPT; k++)
        best[k] = sight(NOT_SEEN, 0, vec2(0.0), 0.0);
    float next = NOT_SEEN;
    uvec2 list = texelFetch(tiles, at / TILE, 0).xy;
    for (int c = 0; c < candidates; c++) {
        uint i = (c < 4 ? list.x : list.y) >> uint(8 * (c & 3)) & 255u;
        if (i == 255u)
            break;
        sight s = consider(int(i), p, guessed);
        for (int k = 0; k < KEPT; k++) {
            if (s.penalty < best[k].penalty) {
                sight other = best[k];
                best[k] = s;
                s = other;
            }
        }
        next = min(next, s.penalty);
    }
    float limit = next;
    for (int k = 1; k < KEPT; k++)
        limit = photos_per_pixel == float(k) ? best[k].penalty : limit;
    vec4 samples[KEPT], vote = vec4(0.0), sum = vec4(0.0);
    for (int k = 0; k < KEPT; k++) {
        samples[k] = look(best[k], best[0].penalty, limit, guessed);
        vote += vec4(sqrt(samples[k].rgb), 1.0) * sqrt(samples[k].a);
    }
    vec3 mean = vote.rgb / max(vote.a, 1e-30);
    vec2 apart = vec2(0.0);
    float severity = (outliers > 0.0 ? 1.0 / (outliers * outliers) : 0.0) *
                     (guessed ? GUESS_SEVERITY : 1.0);
    for (int k = 0; k < KEPT; k++) {
        vec3 off = sqrt(samples[k].rgb) - mean;
        sum += vec4(samples[k].rgb, 1.0) * (samples[k].a / (1.0 + dot(off, off) * severity));
        apart += vec2(dot(off, off), 1.0) * samples[k].a;
    }
    if (!(sum.a > 0.0))
        return;
    apart.y = max(apart.y, 1e-30);
    float blur = guessed ? guess_blur(p, best[0].penalty, sqrt(apart.x / apart.y),
                                      samples[0].a / apart.y) : 0.0;
    painted = vec4(sum.rgb / sum.a, blur > 0.0 ? -1.0 - blur : guessed ? 0.0 : 1.0);
    float number = texelFetch(photo_rows, ivec2(8, best[0].index), 0).x;
    source = vec4(floor(number / 256.0) / 255.0, mod(number, 256.0) / 255.0, 0.0, 1.0);
}
