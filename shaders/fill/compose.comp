// The finished frame: blended colour, or the fill where nothing was blended. 2x2 pixels an
// invocation.
// REST: gather_best.comp did all but the pixels that nothing paints, and those on guessed depth, of
// some work groups.
// RADIANCE: gather_radiance.comp did what is blended.
#define BLOCK_IMAGE
#include "shared/render_blocks.h"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
// In: colour * weight, weight; weight negative where there is at least that much light, and as
// much as around it if that is more (gather_radiance.comp, where fill_lift.comp found none as
// bright). REST: see gather_best.comp. Out: colour, coverage.
#ifdef REST
layout(rgba16f, binding = 0) uniform image2D accumulated;
#else
layout(rgba32f, binding = 0) uniform image2D accumulated;
#endif
layout(rgba32f, binding = 1) readonly uniform image2D filled;
layout(r32f, binding = 2) readonly uniform image2D depth; // < 0: guessed

#define FILL_LEVEL filled
#include "fill/fill.glsl"
#ifdef REST
#include "gather/unfinished.glsl"
#endif
#ifdef RADIANCE
layout(rgba32f, binding = 3) readonly uniform image2D trusted; // z: see gather_radiance.comp
#endif
#if defined(REST) || defined(RADIANCE)
// What is painted on guessed depth: sums of 2x2, colour, 1; and mipmaps.
layout(binding = 0) uniform sampler2D guesses;

// Colour on guessed depth, blurred as far as it may lie from its place: wrong details are worse
// than none. With others like it alone, since what has depth is in its place.
vec3 softened(ivec2 at, vec3 sharp, float blur)
{
    float most = log2(GUESS_BLUR_MOST * float(max(area.x, area.y)));
    blur = clamp(blur, 0.0, max(most, 0.0));
    vec2 where = (vec2(at) + 0.5) / vec2((area.xy + 1) / 2 * 2);
    vec4 around = textureLod(guesses, where, max(blur - 1.0, 0.0));
    // Next to none: a pixel alone in what a driver's mipmaps leave out.
    vec3 soft = around.a > 1e-6 ? around.rgb / around.a : sharp;
    return mix(sharp, soft, min(blur, 1.0));
}
#endif

void compose(uvec2 group)
{
    ivec2 parent = ivec2(group * gl_WorkGroupSize.xy + gl_LocalInvocationID.xy);
    if (2 * parent.x >= area.x || 2 * parent.y >= area.y)
        return;
    vec4 finer[4];
    fill_finer(parent, finer);
    for (int k = 0; k < 4; k++) { // outside, loads give 0 and stores do nothing
        ivec2 at = 2 * parent + ivec2(k & 1, k >> 1);
        vec4 sum = imageLoad(accumulated, at);
        bool fills = area.w == 1 && finer[k].a > 0.0;
        vec3 filled = fills ? finer[k].rgb / finer[k].a : vec3(0.0);
#ifdef REST
        if (sum.a < 0.0)
            imageStore(accumulated, at,
                       vec4(sum.a < -1.0 ? softened(at, sum.rgb, -1.0 - sum.a) : filled, 0.0));
#else
        float on_surface = imageLoad(depth, at).r > 0.0 ? 1.0 : 0.0;
        vec3 own = sum.a != 0.0 ? sum.rgb / abs(sum.a) : vec3(0.0);
#ifdef RADIANCE
        float blur = imageLoad(trusted, at).z - 1.0;
        own = blur > 0.0 ? softened(at, own, blur) : own;
#endif
        // Splat colours between splats count as covered by them.
        imageStore(accumulated, at,
                   vec4(sum.a > 0.0 ? own : max(own, filled),
                        sum.a != 0.0 || area.z == 1 ? on_surface : 0.0));
#endif
    }
}

void main()
{
#ifdef REST
    uint row = uint(area.x + 2 * ORL_PIXEL_GROUP_X - 1) / (2 * ORL_PIXEL_GROUP_X);
    uint place = gl_WorkGroupID.x;
    do {
        uint number = unfinished_groups[place];
        compose(uvec2(number % row, number / row));
        place += UNFINISHED_DISPATCH_MAX;
    } while (place < unfinished_count);
#else
    compose(gl_WorkGroupID.xy);
#endif
}
