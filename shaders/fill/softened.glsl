// The blur of colour on guessed depth, for the renderer and for the page.
#include "shared/constants.h"

// Blurred as far as it may be displaced, since wrong details are worse than none. Only pixels of guessed depth are
// mixed: colour on known depth is in its place. guesses: sums of (colour, 1) over 2x2 pixels where depth is guessed,
// with mipmaps; size: of the picture, pixels; blur: the logarithm of its width in pixels.
vec3 softened(sampler2D guesses, ivec2 at, ivec2 size, vec3 sharp, float blur)
{
    blur = clamp(blur, 0.0, log2(max(ORL_BLUR_MAX * float(max(size.x, size.y)), 1.0)));
    vec2 where = (vec2(at) + 0.5) / vec2((size + 1) / 2 * 2);
    vec4 around = textureLod(guesses, where, max(blur - 1.0, 0.0));
    // The weight may vanish where a driver's mipmaps omit an isolated pixel.
    vec3 soft = around.a > 1e-6 ? around.rgb / around.a : sharp;
    return mix(sharp, soft, min(blur, 1.0));
}
