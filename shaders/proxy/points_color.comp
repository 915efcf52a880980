// The `points` method: a pixel whose own splat is in front takes that splat's colour. Runs once for
// each chunk of points and writes the pixels that this chunk won. One invocation handles 2x2 pixels.
// UNDER: only pixels without a sample of a photograph take the colour, while photographs are loaded.
// FINISHED: the painter has finished the others, and summed up the seeds of hole filling.
#include "proxy/splat.glsl"
#include "shared/pixel.glsl"
#include "shared/srgb.glsl"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(r8ui, binding = 0) readonly uniform uimageBuffer colors; // three of each point: sRGB
layout(r32ui, binding = 1) readonly uniform uimage2D splat_index;
layout(rgba16f, binding = 2) readonly uniform image2D normal; // w: 1 if the splat is in front
#ifdef FINISHED
layout(rgba16f, binding = 3) uniform image2D picture;
layout(rgba32f, binding = 4) uniform image2D seeds; // sums over 2x2, as fill_seed.comp
#elif defined(UNDER)
layout(rgba32f, binding = 3) uniform image2D picture;
#else
layout(rgba32f, binding = 3) writeonly uniform image2D picture;
#endif

bool is_free(ivec2 at)
{
#ifdef FINISHED
    vec4 pixel = imageLoad(picture, at);
    return !pixel_is_finished(pixel) && pixel_blur(pixel) == 0.0;
#elif defined(UNDER)
    return pixel_weight(imageLoad(picture, at)) == 0.0;
#else
    return true;
#endif
}

// Colour with weight 1 of the splat in a pixel; 0 if another chunk or a photograph has the pixel.
vec4 splat_color(ivec2 at)
{
    uint point = imageLoad(splat_index, at).x - uint(first_point);
    if (point >= uint(point_count) || imageLoad(normal, at).w < 0.5 || !is_free(at))
        return vec4(0.0);
    int first = 3 * int(point);
    uvec3 color = uvec3(imageLoad(colors, first).x, imageLoad(colors, first + 1).x,
                        imageLoad(colors, first + 2).x);
    return vec4(srgb_decode(vec3(color) / 255.0), 1.0);
}

void main()
{
    ivec2 corner = 2 * ivec2(gl_GlobalInvocationID.xy);
    vec4 sum = vec4(0.0);
    for (int k = 0; k < 4; k++) {
        ivec2 at = corner + ivec2(k & 1, k >> 1);
        if (at.x >= view_size.x || at.y >= view_size.y)
            continue;
        vec4 color = splat_color(at);
        if (color.a > 0.0)
            imageStore(picture, at, color);
        sum += color;
    }
#ifdef FINISHED
    if (sum.a > 0.0)
        imageStore(seeds, corner / 2, imageLoad(seeds, corner / 2) + sum);
#endif
}
