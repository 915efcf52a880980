// Copies one level of a texture into the same level of a photograph. LUMA: the red channel, into the alpha of the
// photograph. SRGB: the texture unit decodes the texture, and the photograph keeps sRGB.
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
