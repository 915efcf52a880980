// What is painted and, while photographs are still to come, the points' own colour where none paints a surface.
#include "shared/pixel.glsl"
#include "shared/srgb.glsl"
uniform sampler2D painted;    // gather.frag
uniform sampler2D splat_color, normals;
uniform bool points_only, loading;

// As shared/pixel.glsl says of finished pixels.
vec4 own_color(ivec2 at)
{
    vec4 color = points_only ? pixel_unpainted() : texelFetch(painted, at, 0);
    bool splat = texelFetch(normals, at, 0).a > 0.9;
    if ((points_only || loading) && !pixel_is_finished(color) && pixel_blur(color) == 0.0 && splat)
        return pixel_finished(srgb_decode(texelFetch(splat_color, at, 0).rgb), true);
    return color;
}
