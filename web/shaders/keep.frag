// One level of a texture into the same level of a photograph. LUMA: its red, for the alpha of the photograph. SRGB: it is
// linear light as it is read, and kept as sRGB.
#include "shared/srgb.glsl"

uniform sampler2D shown; // mipmapped
uniform int level;
layout(location = 0) out vec4 kept;

void main()
{
    kept = texelFetch(shown, ivec2(gl_FragCoord.xy), level);
#ifdef LUMA
    kept = vec4(kept.r);
#endif
#ifdef SRGB
    kept.rgb = srgb_encode(kept.rgb);
#endif
}
