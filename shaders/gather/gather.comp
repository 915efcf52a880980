// Blends photographs into the frame: projects the surface point of every pixel into each
// photograph, tests whether the photograph sees that point, and passes the weighted colour to the
// method's combination.
#include "gather/photo.glsl"
#include "shared/pixel.glsl"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(r32f, binding = 0) readonly uniform image2D view_depth; // < 0: estimated background depth
layout(rgba32f, binding = 1) uniform image2D accumulated;      // blended, as in shared/pixel.glsl
layout(rgba16f, binding = 4) readonly uniform image2D view_normal; // see reads_normals
layout(rgba32f, binding = 2) uniform image2D state_0;          // private to the combination
layout(rgba32f, binding = 3) uniform image2D state_1;

// The slots of the method:
#include <sample>     // vec4 photo_sample(source, pixel, mip): colour and confidence weight
#include <visibility> // float visible_surface(source, point, seen, z), visible_guess: 0 to 1
#include <weight>     // float weight_of(source, point): weight in any unit
#include "gather/ask.glsl"
#ifdef ROOM // 1: where there is no surface; 2: everywhere
#include "gather/room.glsl"
#endif
#include <combine>    // combine_begin, _add, _end; photo_first, photo_next: order of photographs

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= view_size.x || at.y >= view_size.y)
        return;
    float depth = imageLoad(view_depth, at).r;
#ifdef ROOM
    depth = ROOM == 2 || !(depth > 0.0) ? -room_depth(at) : 0.0;
#endif
    if (depth == 0.0)
        return;
    Point point = Point(surface_point(at, abs(depth)), imageLoad(view_normal, at).xyz, depth < 0.0);
    combine_begin(at);
    int i = photo_first();
    do { // the condition comes last: see tiled.comp
        photo source = photo_at(i);
        combine_add(source, ask(source, i, point));
        i = photo_next(i);
    } while (i >= 0);
    combine_end(at, point);
}
