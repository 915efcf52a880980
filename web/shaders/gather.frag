// Blends the best few photographs into each pixel, as shaders/gather/tiled.comp does.
#include "gather/penalty.glsl"
#include "gather/hidden.glsl"
#include "gather/guess_blur.glsl"
#include "gather/sample/srgb.glsl"
#include "shared/pixel.glsl"

uniform sampler2D view_depth; // < 0: guessed
uniform highp usampler2D tiles; // choose.frag
uniform int candidates;
uniform float outliers, photos_per_pixel;
uniform float away; // 1, but less near the place of a photograph that shows what all together give
layout(location = 0) out vec4 painted; // shared/pixel.glsl, finished
layout(location = 1) out vec4 source; // r, g: number of the best photograph, high and low byte; a: 1

const int KEPT = 4;

struct sight {
    float penalty;
    int index;
    vec2 pixel;
    float mip;
};

const float GUESS_SURE_MIN = 0.1;

sight consider(int i, vec3 p, bool guessed)
{
    photo source = photo_at(i);
    vec2 pixel;
    float z;
    if (!photo_project(source, p, pixel, z))
        return sight(NOT_SEEN, i, vec2(0.0), 0.0);
    vec4 seen = photo_depths(source, pixel);
    float penalty = photo_penalty(source, p);
    float sees = guessed ? photo_unhidden_share(source, seen, z) *
                             photo_past_share(source, seen, z) * photo_beside(penalty)
                       : photo_seen_share(seen, z);
    penalty = guessed ? penalty : length(vec2(penalty, SURFACE_PENALTY * away));
    float sure = sees * photo_border(source, pixel);
    bool paints = sees > (guessed ? GUESS_SURE_MIN : 1e-4);
    return sight(paints ? penalty / sure : NOT_SEEN, i, pixel, photo_mip(source, z, p.z));
}

vec4 look(sight one, float least, float limit, bool guessed)
{
    if (!(one.penalty < NOT_SEEN && one.penalty <= limit))
        return vec4(0.0);
    // Falls to zero where the first photograph left out is as good: nothing pops.
    float fade = limit == NOT_SEEN ? 1.0 : min(1.0, 4.0 * (1.00001 - one.penalty / limit));
    photo source = photo_at(one.index);
    vec3 color = photo_sample(source, one.pixel, one.mip).rgb;
    return vec4(color, pow(least / one.penalty, guessed ? GUESS_SHARPNESS : opt.sharpness) * fade);
}

const float GUESS_SEVERITY = 4.0;

void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy);
    float stored = texelFetch(view_depth, at, 0).x;
    bool guessed = stored < 0.0;
    painted = pixel_unpainted();
    source = vec4(0.0);
    if (stored == 0.0)
        return;
    vec3 p = vec3((vec2(at) + 0.5 - view_focal.zw) / view_focal.xy, 1.0) * abs(stored);
    sight best[KEPT];
    for (int k = 0; k < KEPT; k++)
        best[k] = sight(NOT_SEEN, 0, vec2(0.0), 0.0);
    float next = NOT_SEEN;
    uvec2 list = texelFetch(tiles, at / TILE, 0).xy;
    for (int c = 0; c < candidates; c++) {
        int i = photo_listed(list, c);
        if (i < 0)
            break;
        sight s = consider(i, p, guessed);
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
    vec3 color = sum.rgb / sum.a;
    painted = blur > 0.0 ? pixel_to_blur(color, blur) : pixel_finished(color, !guessed);
    float number = photo_at(best[0].index).file.x;
    source = vec4(floor(number / 256.0) / 255.0, mod(number, 256.0) / 255.0, 0.0, 1.0);
}
