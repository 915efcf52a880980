// Shows the room where nothing was painted before it.
#include "fill/picture.glsl"
#include "shared/pixel.glsl"

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
