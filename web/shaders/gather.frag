// Blends the best few photographs into each pixel, as shaders/gather/tiled.comp does.
uniform float outlier_severity; // 1 / opt.outliers^2; 0: no outlier rejection
#include "gather/penalty.glsl"
#include "gather/hidden.glsl"
#include "gather/blend.glsl"
#include "shared/pixel.glsl"

uniform sampler2D view_depth; // < 0: guessed
uniform highp usampler2D tiles; // choose.frag
uniform float away; // 1, but less near the place of a photograph that shows what all together give
layout(location = 0) out vec4 painted; // shared/pixel.glsl, finished
// r, g: number of the best photograph, high and low byte; b: SOFT: luma of soft splats in the photographs;
// a: 0: nothing, else a half and half of how much that photograph varies about the place
layout(location = 1) out vec4 source;

float surface_share(photo source, surface_point s, vec4 seen, float z)
{
    return photo_seen_share(seen, z);
}

float surface_penalty(float penalty)
{
    return length(vec2(penalty, SURFACE_PENALTY * away));
}

#include "gather/consider.glsl"

void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy);
    float stored = texelFetch(view_depth, at, 0).x;
    bool guessed = stored < 0.0;
    painted = pixel_unpainted();
    source = vec4(0.0);
    if (stored == 0.0)
        return;
    surface_point s = surface_point(vec3((vec2(at) + 0.5 - view_focal.zw) / view_focal.xy, 1.0) * abs(stored),
                  guessed ? 1.0 : 0.0);
    ranking r;
    clear(r);
    uvec2 list = texelFetch(tiles, at / TILE, 0).xy;
    for (int c = 0; c <= KEPT; c++) {
        int i = photo_listed(list, c);
        rank(consider(i, photo_at(max(i, 0)), s), c, r);
    }
    float varies, luma, blur;
    vec4 color = blend(s, r, varies, luma, blur);
    if (!(color.a > 0.0))
        return;
    painted = guessed && blur > 0.0 ? pixel_to_blur(color.rgb, blur) : pixel_finished(color.rgb, !guessed);
    float number = photo_at(r.of[0].index).file.x;
    source = vec4(floor(number / 256.0) / 255.0, mod(number, 256.0) / 255.0, 0.0, 0.5 + 0.5 * varies);
#ifdef SOFT
    source.b = luma;
#endif
}
