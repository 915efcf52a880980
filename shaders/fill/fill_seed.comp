// Writes the finest level of the pyramid of hole filling, at half the picture's size: the weighted
// sum of the known values among 2x2 pixels. The defines choose the value:
// SEED_DEPTH: inverse depth and its slope, as in fill/slope.glsl.
// SEED_LEAST: light of pixels for which it is only a lower bound.
// SEED_BRIGHTER: logarithm of light that is as bright as the lower bound that SEED_LEAST has spread
// to this pixel, so that a clipped area does not become as dark as the wall beside it.
// SEED_SURFACES: colour on surfaces.
// SEED_GUESSES: colour on estimated background depth, for the blur. Without a define: colour.
#include "shared/image.glsl"
#include "shared/pixel.glsl"

#ifdef SEED_DEPTH
#include "fill/slope.glsl"
layout(r32f, binding = 0) readonly uniform image2D known;
layout(rgba16f, binding = 2) readonly uniform image2D normals; // 0: unknown
#else
layout(rgba32f, binding = 0) readonly uniform image2D known; // blended pixels of shared/pixel.glsl
#endif
#ifdef SEED_GUESSES
layout(rgba32f, binding = 2) readonly uniform image2D trusted; // z: see gather/radiance/merge.glsl
#endif
#ifdef SEED_SURFACES
layout(r32f, binding = 2) readonly uniform image2D depth;
#endif
#ifdef SEED_BRIGHTER
layout(rgba32f, binding = 1) uniform image2D seeded; // updated in place

const float BRIGHT_FROM = 0.65; // of the lower bound, since samples may clip in part only
vec3 least = vec3(0.0);
#else
layout(rgba32f, binding = 1) writeonly uniform image2D seeded;
#endif

vec4 seed(ivec2 at)
{
    vec4 value = imageLoad(known, at); // 0 outside
#ifdef SEED_DEPTH
    vec3 ray = vec3((vec2(at) + 0.5 - focal.zw) / focal.xy, 1.0);
    return value.r > 0.0 ? slope_seed(value.r, imageLoad(normals, at).xyz, ray, focal.xy, depth_scale,
                                      0.5 - vec2(at & 1))
                         : vec4(0.0);
#elif defined(SEED_GUESSES)
    float weight = pixel_weight(value);
    return weight > 0.0 && imageLoad(trusted, at).z > 0.0 ? vec4(value.rgb / weight, 1.0)
                                                          : vec4(0.0);
#elif defined(SEED_LEAST)
    return pixel_at_least(value) ? vec4(value.rgb / pixel_weight(value), 1.0) : vec4(0.0);
#elif defined(SEED_BRIGHTER)
    vec3 light = value.rgb / max(value.a, 1e-30);
    vec3 share = light / max(least, 1e-9);
    float weight = smoothstep(BRIGHT_FROM, 1.0, min(min(share.r, share.g), share.b));
    return value.a > 0.0 ? vec4(log2(max(light, 1e-9)), 1.0) * weight : vec4(0.0);
#else
#ifdef SEED_SURFACES
    value *= imageLoad(depth, at).r > 0.0 ? 1.0 : 0.0;
#endif
    return value.a > 0.0 ? value / value.a : vec4(0.0);
#endif
}

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= image_size.x || at.y >= image_size.y)
        return;
#ifdef SEED_BRIGHTER
    vec4 around = imageLoad(seeded, at);
    if (!(around.a > 0.0)) // no pixel of the picture is clipped
        return;
    least = around.rgb / around.a;
#endif
    ivec2 f = 2 * at;
    imageStore(seeded, at, seed(f) + seed(f + ivec2(1, 0)) + seed(f + ivec2(0, 1)) +
                               seed(f + ivec2(1, 1)));
}
