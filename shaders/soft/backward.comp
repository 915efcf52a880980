// How the loss changes with what each splat of a tile gives to its pixels. One invocation takes a whole tile, in
// the order in which blend.comp takes the splats: no sum depends on the order in which invocations run, and
// nothing is shared between them.
#include "soft/tile.glsl"

layout(local_size_x = ORL_SOFT_BACKWARD_GROUP) in;
layout(rgba32f, binding = 0) readonly uniform image2D blended;
layout(rgba32f, binding = 1) readonly uniform image2D gradient; // of the loss by a pixel's colour
layout(rgba32f, binding = 5) writeonly uniform imageBuffer shares; // ORL_SOFT_SHARE_VEC4S for each entry of the lists

const int PIXELS = ORL_SOFT_TILE * ORL_SOFT_TILE;
vec3 by_color[PIXELS];
float passes[PIXELS], behind[PIXELS]; // behind: what the splats that follow give to the loss's change

vec4 first;   // ORL_SOFT_SHARE_VEC4S
vec2 second;
vec3 color_sum;

void take(int i, seen_splat s, vec2 off)
{
    float opacity = passes[i] < PASSES_MIN ? 0.0 : seen_opacity(s, off);
    float share = passes[i] * opacity, own = dot(by_color[i], s.color);
    behind[i] -= share * own;
    float by_opacity = passes[i] * own - behind[i] / (1.0 - opacity);
    float by_exponent = opacity < OPACITY_MAX ? by_opacity * opacity : 0.0;
    first += by_exponent * vec4(1.0, off, off.x * off.x);
    second += by_exponent * off.y * off;
    color_sum += share * by_color[i];
    passes[i] -= share;
}

void main()
{
    int tile = int(gl_GlobalInvocationID.x);
    int tiles = tiles_across * ((view_size.y + ORL_SOFT_TILE - 1) / ORL_SOFT_TILE);
    if (tile >= tiles)
        return;
    ivec2 origin = ORL_SOFT_TILE * ivec2(tile % tiles_across, tile / tiles_across);
    for (int i = 0; i < PIXELS; i++) {
        ivec2 at = origin + ivec2(i % ORL_SOFT_TILE, i / ORL_SOFT_TILE);
        by_color[i] = imageLoad(gradient, at).rgb; // 0 outside
        behind[i] = dot(by_color[i], imageLoad(blended, at).rgb);
        passes[i] = 1.0;
    }
    int end = listed_at(tile + 1);
    for (int k = listed_at(tile); k < end; k++) {
        seen_splat s = seen_at(listed_at(k));
        vec2 off = vec2(origin) + 0.5 - s.centre;
        first = vec4(0.0);
        second = vec2(0.0);
        color_sum = vec3(0.0);
        for (int i = 0; i < PIXELS; i++)
            take(i, s, off + vec2(i % ORL_SOFT_TILE, i / ORL_SOFT_TILE));
        int to = ORL_SOFT_SHARE_VEC4S * (k - tiles - 1);
        imageStore(shares, to, first);
        imageStore(shares, to + 1, vec4(second, 0.0, 0.0));
        imageStore(shares, to + 2, vec4(color_sum, 0.0));
    }
}
