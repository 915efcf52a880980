// A pixel of a soft splat, which is blended over those behind it.
#include "soft/opacity.glsl"
flat in vec2 centre;
flat in vec4 shape;
flat in vec3 color;
layout(location = 0) out vec4 covers; // sRGB colour, opacity

void main()
{
    covers = vec4(color, seen_opacity(seen_splat(centre, shape.xyz, shape.w, color), gl_FragCoord.xy - centre));
}
