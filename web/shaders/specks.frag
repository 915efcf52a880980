// The finished frame without specks, as shaders/edges/specks.comp removes them.
#include "edges/speck.glsl"
uniform sampler2D composed;
uniform sampler2D source; // gather.frag
layout(location = 0) out vec4 kept;

// The k-th of the pixels around, of which there are side x side.
ivec2 around(int k, int side)
{
    ivec2 at = ivec2(gl_FragCoord.xy) + ivec2(k % side, k / side) - side / 2;
    return clamp(at, ivec2(0), textureSize(composed, 0) - 1);
}

float light_at(ivec2 at)
{
    return speck_light(texelFetch(composed, at, 0).rgb);
}

void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy);
    kept = texelFetch(composed, at, 0);
    float near[9], light[25], varies[25];
    for (int k = 0; k < 9; k++)
        near[k] = light_at(around(k, 3));
    if (!(texelFetch(source, at, 0).a > 0.0) || !speck_suspect(near))
        return;
    for (int k = 0; k < 25; k++) {
        light[k] = light_at(around(k, 5));
        varies[k] = max(2.0 * texelFetch(source, around(k, 5), 0).a - 1.0, 0.0);
    }
    if (speck_stands_out(light))
        kept.rgb = texelFetch(composed, around(speck_taken(light, varies), 5), 0).rgb;
}
