// Blends the best few photographs into each pixel. Weights fall continuously to zero at the first
// photograph left out, at the borders of photographs, and where the surface becomes occluded.
#include "gather/penalty.glsl"
#include "gather/hidden.glsl"
#include "gather/blend.glsl"
#include "shared/constants.h"
#include "shared/pixel.glsl"
#include <visibility>

// KEPT: most photographs that a pixel may blend, opt.photos_per_pixel.
// One invocation handles 2x2 pixels, so that it loads the parameters of a photograph once for four.
layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(r32f, binding = 0) readonly uniform image2D view_depth; // < 0: estimated background depth
layout(rgba16f, binding = 1) writeonly uniform image2D painted; // finished, as in shared/pixel.glsl
layout(rgba32f, binding = 2) writeonly uniform image2D seeds; // sums over 2x2
layout(rgba32f, binding = 3) writeonly uniform image2D guesses; // the same, of estimated depth
layout(std430, binding = 1) readonly buffer tile_lists {
    int chosen[];
};

float surface_share(photo source, surface_point s, vec4 seen, float z)
{
    return visible_surface(source, Point(s.p, vec3(0.0), false), seen, z);
}

float surface_penalty(float penalty)
{
    return photo_surface_penalty(penalty);
}

#include "gather/consider.glsl"

#ifdef SPECKS
#include "edges/speck.glsl"
layout(rg8, binding = 5) writeonly uniform image2D specks; // as struct edges has it
#endif
#ifdef SOFT
layout(r16f, binding = 4) writeonly uniform image2D soft_luma; // blended; < 0: there is none
#endif

void main()
{
    ivec2 corner = 2 * ivec2(gl_GlobalInvocationID.xy);
    if (corner.x >= view_size.x || corner.y >= view_size.y)
        return;
    surface_point points[4];
    ranking rankings[4];
    for (int k = 0; k < 4; k++) {
        ivec2 at = corner + ivec2(k & 1, k >> 1);
        float stored = imageLoad(view_depth, at).r; // 0 outside
        points[k] = surface_point(vec3((vec2(at) + 0.5 - view_focal.zw) / view_focal.xy, 1.0) * abs(stored),
                        stored < 0.0 ? 1.0 : 0.0);
        clear(rankings[k]);
    }
    ivec2 tile = corner / tile_side; // of all four pixels, since the tile's side is even
    int list = (tile.y * tiles_across + tile.x) * ORL_CANDIDATES;
    for (int c = 0; c <= KEPT; c++) {
        int i = chosen[list + c];
        photo source = photo_at(max(i, 0));
        for (int k = 0; k < 4; k++)
            rank(consider(i, source, points[k]), c, rankings[k]);
    }
    float lumas[4], varies[4];
#ifdef SPECKS
    float light[4]; // 0 where nothing is painted
#endif
    vec4 colors[4], seed = vec4(0.0), guess = vec4(0.0);
    float blur = 0.0; // the same for all four: single sharp pixels in a blurred area look like dirt
    for (int k = 0; k < 4; k++) {
        float own;
        colors[k] = blend(points[k], rankings[k], varies[k], lumas[k], own);
#ifdef SPECKS
        light[k] = colors[k].a > 0.0 ? max(speck_light(colors[k].rgb), 1.0 / 255.0) : 0.0;
#endif
        vec4 guessed = is_guess(points[k]) ? colors[k] : vec4(0.0);
        seed += colors[k] * (is_guess(points[k]) ? 1.0 : ORL_SURFACE_SEED);
        guess += guessed;
        blur = guessed.a > 0.0 ? max(blur, own) : blur;
    }
    for (int k = 0; k < 4; k++) {
        bool has_color = colors[k].a > 0.0;
        bool blurs = has_color && is_guess(points[k]) && blur > 0.0;
        lumas[k] = has_color ? lumas[k] : -1.0;
        colors[k] = !has_color ? pixel_unpainted()
                    : blurs    ? pixel_to_blur(colors[k].rgb, blur)
                               : pixel_finished(colors[k].rgb, !is_guess(points[k]));
    }
    // Stores come last: a value that outlives a store costs a software renderer a load. Stores that
    // lie outside the picture do nothing.
    for (int k = 0; k < 4; k++)
        imageStore(painted, corner + ivec2(k & 1, k >> 1), colors[k]);
#ifdef SPECKS
    for (int k = 0; k < 4; k++)
        imageStore(specks, corner + ivec2(k & 1, k >> 1), vec4(varies[k], light[k], 0.0, 0.0));
#endif
#ifdef SOFT
    for (int k = 0; k < 4; k++)
        imageStore(soft_luma, corner + ivec2(k & 1, k >> 1), vec4(lumas[k]));
#endif
    imageStore(seeds, corner / 2, seed);
    if (guess.a > 0.0) // the host has cleared the image, which costs less than stores
        imageStore(guesses, corner / 2, guess);
}
