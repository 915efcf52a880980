// Finds how far each column of the view is open to the sky: until surfaces have covered so many of
// its pixels that they cannot be stray points.
#include "gather/photo.glsl"
#include "gather/sky.glsl"

layout(local_size_x = 64) in;
layout(r32f, binding = 0) readonly uniform image2D view_depth; // < 0: estimated background depth

const int STRAY = 400; // of so many pixels of a column, one may be a stray point

void main()
{
    int column = int(gl_GlobalInvocationID.x);
    ivec2 size = columns_size();
    if (column >= size.x)
        return;
    int at = 0, covered = 0, most = size.y / STRAY;
    do { // the condition comes last: see tiled.comp
        covered += imageLoad(view_depth, pixel_of_place(ivec2(column, at))).r > 0.0 ? 1 : 0;
        at++;
    } while (at < size.y && covered <= most);
    open_until[column] = covered > most ? at - covered : at;
}
