// Adds a finished picture to a sum in square roots of light. The last picture becomes the mean.
#include "fill/picture.glsl"

layout(rgba32f, binding = 1) uniform image2D sum; // square roots of colour, coverage of the first

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= image_size.x || at.y >= image_size.y)
        return;
    vec4 own = imageLoad(picture, at), before = imageLoad(sum, at);
    bool first = pictures.x == 0, last = pictures.x + 1 == pictures.y;
    vec4 now = first ? vec4(sqrt(max(own.rgb, 0.0)), own.a)
                     : vec4(before.rgb + sqrt(max(own.rgb, 0.0)), before.a);
    vec3 mean = now.rgb / float(pictures.y);
    if (last)
        imageStore(picture, at, vec4(mean * mean, now.a));
    else
        imageStore(sum, at, now);
}
