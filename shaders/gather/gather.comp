// Blends photographs into the frame: projects every pixel's surface point into each, asks whether
// it saw that point, and gives its weighted colour to the method's way of combining.
#include "gather/photo.glsl"
#include "shared/pixel.glsl"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(r32f, binding = 0) readonly uniform image2D view_depth; // < 0: guessed background
layout(rgba32f, binding = 1) uniform image2D accumulated;      // shared/pixel.glsl, blended
layout(rgba16f, binding = 4) readonly uniform image2D view_normal; // drawn where this is read
layout(rgba32f, binding = 2) uniform image2D state_0;          // the combination's own
layout(rgba32f, binding = 3) uniform image2D state_1;

// The method:
#include <sample>     // vec4 photo_sample(shot, pixel, mip): colour and trust
#include <visibility> // float visible_surface(shot, point, seen, z), visible_guess: 0 to 1
#include <weight>     // float weight_of(shot, point): in any unit
#include "gather/ask.glsl"
#include <combine>    // combine_begin, _add, _end; photo_first, photo_next: whom a pixel asks

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= view_size.x || at.y >= view_size.y)
        return;
    float depth = imageLoad(view_depth, at).r;
    if (depth == 0.0)
        return;
    Point point = Point(surface_point(at, abs(depth)), imageLoad(view_normal, at).xyz, depth < 0.0);
    combine_begin(at);
    int i = photo_first();
    do { // the condition last: see tiled.comp
        photo shot = photo_at(i);
        combine_add(shot, ask(shot, i, point, SOFT_BORDER));
        i = photo_next(i);
    } while (i >= 0);
    combine_end(at, point);
}
