// At half the picture's size: colour to fill holes with, and colour on guessed depth to blur it.
#include "colors.glsl"
#include "shared/constants.h"
layout(location = 0) out vec4 seeded;
layout(location = 1) out vec4 guesses;

void main()
{
    ivec2 at = 2 * ivec2(gl_FragCoord.xy), area = textureSize(normals, 0);
    seeded = vec4(0.0);
    guesses = vec4(0.0);
    for (int i = 0; i < 4; i++) {
        ivec2 from = at + ivec2(i & 1, i >> 1);
        if (from.x >= area.x || from.y >= area.y)
            continue;
        vec4 own = own_color(from);
        bool unpainted = !pixel_is_finished(own) && pixel_blur(own) == 0.0;
        vec4 color = unpainted ? vec4(0.0) : vec4(own.rgb, 1.0);
        bool surface = own.a > 0.5;
        seeded += color * (surface ? ORL_SURFACE_SEED : 1.0);
        guesses += surface ? vec4(0.0) : color * 0.25; // half floats
    }
}
