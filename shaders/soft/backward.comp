// How the loss changes with what each splat of a tile gives to its pixels. One invocation takes a whole tile, in
// the order in which blend.comp takes the splats: no sum depends on the order in which invocations run, and
// nothing is shared between them.
#include "soft/tile.glsl"

layout(local_size_x = ORL_SOFT_TILE_GROUP) in;
layout(rgba32f, binding = 0) readonly uniform image2D blended;
layout(rgba32f, binding = 1) readonly uniform image2D gradient; // of the loss by a pixel's colour
layout(rgba32f, binding = 5) writeonly uniform imageBuffer shares; // ORL_SOFT_SHARE_VEC4S for each entry of the lists

// What a splat gives to a pixel: its share, and gradient by the exponent of its Gaussian. change: gradient by the
// pixel's colour; behind: what the splats that follow give to the loss's change.
vec2 take(seen_splat s, vec2 off, vec3 change, inout float passes, inout float behind)
{
    float opacity = passes < PASSES_MIN ? 0.0 : seen_opacity(s, off);
    float share = passes * opacity, own = dot(change, s.color);
    behind -= share * own;
    float by_opacity = passes * own - behind / (1.0 - opacity);
    passes -= share;
    return vec2(share, opacity < OPACITY_MAX ? by_opacity * opacity : 0.0);
}

void main()
{
    int tile = own_item();
    if (tile >= tile_count())
        return;
    ivec2 origin = first_pixel(tile);
    vec3 change[PIXELS];
    float passes[PIXELS], behind[PIXELS];
    for (int i = 0; i < PIXELS; i++) {
        ivec2 at = origin + pixel_of_tile(i);
        vec3 by_color = imageLoad(gradient, at).rgb; // 0 outside
        change[i] = by_color;
        behind[i] = dot(by_color, imageLoad(blended, at).rgb);
        passes[i] = 1.0;
    }
    int end = listed_at(tile + 1);
    for (int k = listed_at(tile); k < end; k++) {
        seen_splat s = seen_at(listed_at(k));
        vec2 off = vec2(origin) + 0.5 - s.centre;
        vec4 first = vec4(0.0); // ORL_SOFT_SHARE_VEC4S
        vec2 second = vec2(0.0);
        vec3 color_sum = vec3(0.0);
        for (int i = 0; i < PIXELS; i++) {
            vec2 at = off + vec2(pixel_of_tile(i));
            vec2 given = take(s, at, change[i], passes[i], behind[i]);
            first += given.y * vec4(1.0, at, at.x * at.x);
            second += given.y * at.y * at;
            color_sum += given.x * change[i];
        }
        int to = ORL_SOFT_SHARE_VEC4S * (k - tile_count() - 1);
        imageStore(shares, to, first);
        imageStore(shares, to + 1, vec4(second, 0.0, 0.0));
        imageStore(shares, to + 2, vec4(color_sum, 0.0));
    }
}
