// The median of each channel over the painted pixels of the 3x3 neighbourhood: Orzan 2005, 4.4.4
// and 4.5.2. HOLES: fills only surface pixels that no photograph painted, from 5x5 pixels.
#include "shared/image.glsl"

#ifdef HOLES
#define REACH 2
#else
#define REACH 1
#endif
const int SIDE = 2 * REACH + 1, COUNT = SIDE * SIDE;

layout(rgba32f, binding = 0) readonly uniform image2D picture; // colour, coverage
layout(rgba32f, binding = 1) writeonly uniform image2D filtered;
layout(r32f, binding = 2) readonly uniform image2D depth; // <= 0: no surface

// The median of the covered values, `count` of them. Equal values are ordered by index.
float median(float values[COUNT], float coverage[COUNT], int count)
{
    float middle = 0.0;
    for (int i = 0; i < COUNT; i++) {
        int below = 0;
        for (int j = 0; j < COUNT; j++)
            below += coverage[j] > 0.0 &&
                     (values[j] < values[i] || (values[j] == values[i] && j < i)) ? 1 : 0;
        middle = coverage[i] > 0.0 && below == count / 2 ? values[i] : middle;
    }
    return middle;
}

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= image_size.x || at.y >= image_size.y)
        return;
    vec4 own = imageLoad(picture, at);
    bool surface = imageLoad(depth, at).r > 0.0;
#ifdef HOLES
    bool wanted = surface && !(own.a > 0.0);
#else
    bool wanted = surface;
#endif
    if (!wanted) {
        imageStore(filtered, at, own);
        return;
    }
    float red[COUNT], green[COUNT], blue[COUNT], coverage[COUNT];
    int count = 0;
    for (int k = 0; k < COUNT; k++) {
        vec4 other = imageLoad(picture, at + ivec2(k % SIDE, k / SIDE) - REACH); // 0 outside
        red[k] = other.r;
        green[k] = other.g;
        blue[k] = other.b;
        coverage[k] = other.a;
        count += other.a > 0.0 ? 1 : 0;
    }
    vec3 color = vec3(median(red, coverage, count), median(green, coverage, count),
                      median(blue, coverage, count));
    imageStore(filtered, at, count > 0 ? vec4(color, own.a) : own);
}
