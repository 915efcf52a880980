// Makes the finished frame: the blended colour, or the filled colour where no sample was blended.
// FINISHED: the painter has finished all pixels but those that are unpainted or lie on estimated background depth.
// RADIANCE: colour on estimated depth is blurred where `trusted` asks for it.
#include "fill/apply.glsl"
#include "shared/pixel.glsl"
#include "fill/softened.glsl"

// Input: encoded as in shared/pixel.glsl, as finished pixels with FINISHED, else as blended pixels.
// Output: colour, coverage.
#ifdef FINISHED
layout(rgba16f, binding = 1) uniform image2D picture;
#else
layout(rgba32f, binding = 1) uniform image2D picture;
#endif
layout(r32f, binding = 2) readonly uniform image2D depth; // < 0: estimated
#ifdef RADIANCE
layout(rgba32f, binding = 3) readonly uniform image2D trusted; // z: see gather/radiance/merge.glsl
#endif
#if defined(FINISHED) || defined(RADIANCE)
// Sums over 2x2 pixels of (colour, 1) where depth is estimated, with mipmaps.
layout(binding = 0) uniform sampler2D guesses;
#endif

bool fill_wants(ivec2 at)
{
#ifdef FINISHED
    return !pixel_is_finished(imageLoad(picture, at));
#else
    return true;
#endif
}

void fill_pixel(ivec2 at, vec4 value)
{
    vec4 pixel = imageLoad(picture, at);
    vec3 around = fills == 1 && value.a > 0.0 ? value.rgb / value.a : vec3(0.0);
#ifdef FINISHED
    float blur = pixel_blur(pixel);
    vec3 color = blur > 0.0 ? softened(guesses, at, image_size, pixel.rgb, blur) : around;
    imageStore(picture, at, pixel_finished(color, false));
#else
    bool on_surface = imageLoad(depth, at).r > 0.0;
    float weight = pixel_weight(pixel);
    vec3 own = weight > 0.0 ? pixel.rgb / weight : vec3(0.0);
    own = layers == 1 ? pixel.rgb + (1.0 - weight) * around : own;
#ifdef RADIANCE
    float blur = imageLoad(trusted, at).z - 1.0;
    own = blur > 0.0 ? softened(guesses, at, image_size, own, blur) : own;
#endif
    // A pixel whose light is only a lower bound takes the light around it if that is brighter.
    own = weight > 0.0 && !pixel_at_least(pixel) ? own : max(own, around);
    // With the splats' own colours, a surface between splats counts as covered.
    imageStore(picture, at, pixel_finished(own, on_surface && (weight > 0.0 || points_show == 1)));
#endif
}
