// Estimates depth in the holes of a photograph's depth map.
#include "proxy/kept.glsl"
#include "proxy/holes.glsl"

float kept_depth(ivec2 at)
{
    float here = known(at);
    if (here > 0.0)
        return here;
    return hole_depth(at, drawn_size);
}
