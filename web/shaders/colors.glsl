// What is painted, and the points' own colour where no photograph paints a surface.
#include "srgb.glsl"
uniform sampler2D painted;    // gather.frag
uniform sampler2D splat_color, normals;
uniform bool points_only;

// Colour, and how gather.frag marks it.
vec4 own_color(ivec2 at)
{
    vec4 color = points_only ? vec4(0.0, 0.0, 0.0, -1.0) : texelFetch(painted, at, 0);
    bool splat = texelFetch(normals, at, 0).a > 0.9;
    if (color.a == -1.0 && splat)
        return vec4(srgb_decode(texelFetch(splat_color, at, 0).rgb), 1.0);
    return color;
}
