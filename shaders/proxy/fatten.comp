// Fattens the outlines of a depth map by FATTEN_PX pixels, as Li 2003, 5.2.2 does by drawing
// edges as thick lines first: a line lies farther back than its surface by a larger offset than the
// shadow test allows, so that it covers what is behind an outline and not the surface beside it.
#include "proxy/kept.glsl"

const int FATTEN_PX = 2;

float kept_depth(ivec2 at)
{
    float here = known(at), line = 1e30;
    for (int y = -FATTEN_PX; y <= FATTEN_PX; y++)
        for (int x = -FATTEN_PX; x <= FATTEN_PX; x++) {
            float found = known(at + ivec2(x, y));
            bool reaches = x * x + y * y <= FATTEN_PX * FATTEN_PX && found > 0.0;
            line = min(line, reaches ? found * line_offset : 1e30);
        }
    float nearest = min(here > 0.0 ? here : 1e30, line);
    return nearest < 1e30 ? nearest : 0.0;
}
