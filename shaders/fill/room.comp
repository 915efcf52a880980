// Shows the room where nothing was painted before it. FINISHED: the painter has finished all pixels
// but those that are unpainted.
#define BLOCK_IMAGE
#include "shared/pixel.glsl"
#include "shared/render_blocks.h"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
#ifdef FINISHED
layout(rgba16f, binding = 0) uniform image2D picture;
#else
layout(rgba32f, binding = 0) uniform image2D picture;
#endif
layout(rgba32f, binding = 1) readonly uniform image2D room; // blended
layout(r32f, binding = 2) readonly uniform image2D depth;

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= image_size.x || at.y >= image_size.y)
        return;
    vec4 wall = imageLoad(room, at), pixel = imageLoad(picture, at);
    bool before = imageLoad(depth, at).r > 0.0;
    if (!(wall.a > 0.0))
        return;
    vec3 color = wall.rgb / wall.a;
#ifdef FINISHED
    if (!before && !pixel_is_finished(pixel))
        imageStore(picture, at, pixel_finished(color, false));
#else
    if (layers == 1) {
        vec3 over = pixel.rgb + (1.0 - pixel.a) * color;
        imageStore(picture, at, pixel_blended(over, 1.0, false));
    } else if (!before) {
        imageStore(picture, at, pixel_blended(color, 1.0, false));
    }
#endif
}
