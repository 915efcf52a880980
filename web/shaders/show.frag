// One layer of the finished frame as sRGB. The canvas has its bottom row first: FLIP.
#include "shared/srgb.glsl"
#include "antialias.glsl"
uniform sampler2D normals, source;
uniform int layer;     // as LAYERS of renderer.js
uniform float typical; // depth
uniform float exposure; // factor on light
uniform int tone;      // as TONES of renderer.js
uniform bool antialiases;
uniform vec2 corner;   // of the frame in the target
layout(location = 0) out vec4 color;

// Far apart for numbers that are near one another.
vec3 distinct(float number)
{
    float hue = fract(number * 0.618034);
    return clamp(abs(fract(hue + vec3(0.0, 2.0 / 3.0, 1.0 / 3.0)) * 6.0 - 3.0) - 1.0, 0.0, 1.0);
}

const float WHITE = 8.0; // luminance that Reinhard's curve makes white

// The curves of src/render/output/tone.c.
vec3 toned(vec3 light)
{
    if (tone == 1) {
        float l = dot(light, vec3(0.2126, 0.7152, 0.0722));
        return light * (1.0 + l / (WHITE * WHITE)) / (1.0 + l);
    }
    vec3 x = 0.6 * light;
    return tone == 2 ? x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14) : light;
}

void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy - corner);
#ifdef FLIP
    at.y = textureSize(depth, 0).y - 1 - at.y;
#endif
    vec3 light = antialiases ? antialiased(at) : texelFetch(composed, at, 0).rgb;
    vec3 plain = srgb_encode(toned(light * exposure));
    float z = texelFetch(depth, at, 0).x;
    vec4 normal = texelFetch(normals, at, 0), from = texelFetch(source, at, 0);
    float near = 1.0 / (1.0 + abs(z) / typical);
    color = vec4(plain, 1.0);
    if (layer == 1)
        color.rgb = z > 0.0 ? vec3(near) : vec3(0.0, 0.0, 0.25 * near);
    else if (layer == 2)
        color.rgb = normal.a > 0.0 ? normal.rgb : vec3(0.0);
    else if (layer == 3)
        color.rgb = texelFetch(composed, at, 0).a > 0.5 ? plain : mix(plain, vec3(0.9, 0.2, 0.1), 0.6);
    else if (layer == 4)
        color.rgb = from.a > 0.0 ? mix(distinct(round(from.r * 255.0) * 256.0 + round(from.g * 255.0)), plain, 0.4) : plain * 0.3;
}
