// Makes the finished frame: the blended colour, or the filled colour where no sample was blended.
// One invocation handles 2x2 pixels.
// FINISHED: the painter has finished all pixels but those that are unpainted or lie on estimated
// background depth, and has marked their work groups. One work group then handles ORL_COMPOSE_RUN of them: a
// software renderer takes longer to start a work group than to find that it has nothing to do.
// RADIANCE: colour on estimated depth is blurred where `trusted` asks for it.
#define BLOCK_IMAGE
#include "shared/pixel.glsl"
#include "shared/render_blocks.h"
#include "fill/softened.glsl"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
// Input: encoded as in shared/pixel.glsl, as finished pixels with FINISHED, else as blended pixels.
// Output: colour, coverage.
#ifdef FINISHED
layout(rgba16f, binding = 0) uniform image2D picture;
#else
layout(rgba32f, binding = 0) uniform image2D picture;
#endif
layout(rgba32f, binding = 1) readonly uniform image2D filled;
layout(r32f, binding = 2) readonly uniform image2D depth; // < 0: estimated

#include "fill/fill.glsl"
#ifdef FINISHED
#include "gather/unfinished.glsl"
#endif
#ifdef RADIANCE
layout(rgba32f, binding = 3) readonly uniform image2D trusted; // z: see gather/radiance/merge.glsl
#endif
#if defined(FINISHED) || defined(RADIANCE)
// Sums over 2x2 pixels of (colour, 1) where depth is estimated, with mipmaps.
layout(binding = 0) uniform sampler2D guesses;
#endif

void compose(ivec2 parent)
{
    if (2 * parent.x >= image_size.x || 2 * parent.y >= image_size.y)
        return;
    vec4 finer[4];
    fill_finer(parent, finer);
    for (int k = 0; k < 4; k++) { // outside, loads give 0 and stores do nothing
        ivec2 at = 2 * parent + ivec2(k & 1, k >> 1);
        vec4 pixel = imageLoad(picture, at);
        bool known = fills == 1 && finer[k].a > 0.0;
        vec3 around = known ? finer[k].rgb / finer[k].a : vec3(0.0);
#ifdef FINISHED
        float blur = pixel_blur(pixel);
        if (!pixel_is_finished(pixel))
            imageStore(picture, at,
                       pixel_finished(blur > 0.0 ? softened(guesses, at, image_size, pixel.rgb, blur) : around, false));
#else
        bool on_surface = imageLoad(depth, at).r > 0.0;
        float weight = pixel_weight(pixel);
        vec3 own = weight > 0.0 ? pixel.rgb / weight : vec3(0.0);
        own = layers == 1 ? pixel.rgb + (1.0 - weight) * around : own;
#ifdef RADIANCE
        float blur = imageLoad(trusted, at).z - 1.0;
        own = blur > 0.0 ? softened(guesses, at, image_size, own, blur) : own;
#endif
        // A pixel whose light is only a lower bound takes the light around it if that is brighter.
        own = weight > 0.0 && !pixel_at_least(pixel) ? own : max(own, around);
        // With the splats' own colours, a surface between splats counts as covered.
        imageStore(picture, at,
                   pixel_finished(own, on_surface && (weight > 0.0 || points_show == 1)));
#endif
    }
}

void main()
{
#ifdef FINISHED
    int across = (image_size.x + 2 * ORL_PIXEL_GROUP_X - 1) / (2 * ORL_PIXEL_GROUP_X);
    int row = int(gl_WorkGroupID.y), first = int(gl_WorkGroupID.x) * ORL_COMPOSE_RUN;
    uint left = 0u; // one bit for each group of the gather
    for (int k = 0; k < ORL_COMPOSE_RUN; k++)
        left |= first + k < across ? unfinished_groups[row * across + first + k] << k : 0u;
    do { // the condition comes last: see gather/tiled.comp
        int group = left != 0u ? first + findLSB(left) : across; // across: outside the picture
        compose(ivec2(group, row) * ivec2(gl_WorkGroupSize.xy) + ivec2(gl_LocalInvocationID.xy));
        left &= left - 1u;
    } while (left != 0u);
#else
    compose(ivec2(gl_GlobalInvocationID.xy));
#endif
}
