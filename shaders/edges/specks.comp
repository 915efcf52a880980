// Gives each speck of the pixels that specks_find.comp listed the colour of what surrounds it.
#include "edges/speck.glsl"
#include "edges/listed.glsl"

layout(rg8, binding = 1) readonly uniform image2D painted; // gather/tiled.comp

vec3 edge_color(uvec4 edge)
{
    ivec2 pixel = edge_pixel(edge), last = imageSize(color) - 1;
    float light[25], varies[25];
    for (int k = 0; k < 25; k++) {
        vec4 there = imageLoad(painted, clamp(pixel + ivec2(k % 5, k / 5) - 2, ivec2(0), last));
        light[k] = there.g;
        varies[k] = there.r;
    }
    int taken = 12;
    if (speck_stands_out(light)) {
        for (int k = 0; k < 25; k++) // what was filled or blurred has other colours now
            light[k] = speck_light(imageLoad(color, clamp(pixel + ivec2(k % 5, k / 5) - 2, ivec2(0), last)).rgb);
        taken = speck_taken(light, varies);
    }
    return imageLoad(color, clamp(pixel + ivec2(taken % 5, taken / 5) - 2, ivec2(0), last)).rgb;
}
