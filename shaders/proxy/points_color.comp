// The `points` method: a pixel whose own splat is in front takes that splat's colour. Runs once for
// each chunk of points and writes the pixels that this chunk won.
#include "proxy/splat.glsl"
#include "shared/srgb.glsl"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(rg32ui, binding = 0) readonly uniform uimageBuffer attributes; // normal, colour
layout(r32ui, binding = 1) readonly uniform uimage2D splat_index;
layout(rgba16f, binding = 2) readonly uniform image2D normal; // w: 1 if the splat is in front
layout(rgba32f, binding = 3) writeonly uniform image2D accumulated;

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= view_size.x || at.y >= view_size.y)
        return;
    uint point = imageLoad(splat_index, at).x - uint(first_point);
    if (point >= uint(point_count) || imageLoad(normal, at).w < 0.5)
        return;
    vec3 color = unpackUnorm4x8(imageLoad(attributes, int(point)).y).rgb;
    imageStore(accumulated, at, vec4(srgb_decode(color), 1.0));
}
