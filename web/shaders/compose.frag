// The finished frame in linear light: what is painted, blurred on guessed depth as far as it may
// lie from its place, and the fill where nothing is. a: 1 on a surface.
#include "colors.glsl"
#include "fill_finer.glsl"
#include "fill/softened.glsl"
uniform sampler2D filled, guesses; // of seed_color.frag; guesses are mipmapped
layout(location = 0) out vec4 composed;

// The same for 2x2 pixels: single sharp pixels in what is blurred look like dirt.
float blur_around(ivec2 at)
{
    float blur = 0.0;
    for (int i = 0; i < 4; i++) {
        ivec2 from = min(at / 2 * 2 + ivec2(i & 1, i >> 1), textureSize(painted, 0) - 1);
        blur = max(blur, pixel_blur(texelFetch(painted, from, 0)));
    }
    return blur;
}

void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy), area = textureSize(normals, 0);
    vec4 own = own_color(at);
    if (!pixel_is_finished(own) && pixel_blur(own) == 0.0) {
        vec4 finer = fill_finer(filled, at);
        composed = pixel_finished(finer.a > 0.0 ? finer.rgb / finer.a : vec3(0.0), false);
        return;
    }
    float blur = own.a > 0.5 ? 0.0 : blur_around(at);
    vec3 color = blur > 0.0 ? softened(guesses, at, area, own.rgb, blur) : own.rgb;
    composed = pixel_finished(color, own.a > 0.5);
}
