// Blends one photograph into the frame: projects every pixel's surface point into it,
// asks its depth map whether it saw that point, and adds its weighted colour.
#define BLOCK_GATHER
#include "include/render_blocks.h"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(binding = 0) uniform sampler2D photo;       // sRGB, mipmapped: reads are linear light
layout(binding = 1) uniform sampler2D photo_depth; // z, 0: none
layout(r32f, binding = 0) readonly uniform image2D view_depth; // < 0: guessed background
layout(rgba32f, binding = 1) uniform image2D accumulated;      // colour * weight, weight

// Shadow test (Airieau 2012, 5.2) against the four texels around the projection, so
// that slanted surfaces match themselves. Photographs without depth there pass.
bool photo_sees(vec2 uv, float z, bool guessed)
{
    vec4 seen = textureGather(photo_depth, uv);
    float tolerance = options.x * z;
    if (guessed) // only known to lie behind everything else
        return !any(bvec4(seen.x > 0.0 && seen.x < z - tolerance,
                          seen.y > 0.0 && seen.y < z - tolerance,
                          seen.z > 0.0 && seen.z < z - tolerance,
                          seen.w > 0.0 && seen.w < z - tolerance));
    return any(lessThanEqual(abs(seen - z), vec4(tolerance))) || all(equal(seen, vec4(0.0)));
}

// Catmull-Rom from bilinear fetches (Sigg and Hadwiger 2005): bilinear sampling would
// blur every photograph by the phase that it happens to be met at.
vec3 bicubic(vec2 pixel, float mip)
{
    float lod = floor(mip + 0.5);
    vec2 size_at = max(floor(photo_size.xy / exp2(lod)), vec2(1.0));
    vec2 at = pixel / photo_size.xy * size_at - 0.5;
    vec2 base = floor(at), f = at - base;
    vec2 w0 = f * (-0.5 + f * (1.0 - 0.5 * f));
    vec2 w1 = 1.0 + f * f * (-2.5 + 1.5 * f);
    vec2 w2 = f * (0.5 + f * (2.0 - 1.5 * f));
    vec2 w3 = f * f * (-0.5 + 0.5 * f);
    vec2 w12 = w1 + w2;
    vec2 p0 = (base - 0.5) / size_at, p3 = (base + 2.5) / size_at;
    vec2 p12 = (base + 0.5 + w2 / w12) / size_at;
    vec3 sum = textureLod(photo, vec2(p12.x, p0.y), lod).rgb * (w12.x * w0.y) +
               textureLod(photo, vec2(p0.x, p12.y), lod).rgb * (w0.x * w12.y) +
               textureLod(photo, p12, lod).rgb * (w12.x * w12.y) +
               textureLod(photo, vec2(p3.x, p12.y), lod).rgb * (w3.x * w12.y) +
               textureLod(photo, vec2(p12.x, p3.y), lod).rgb * (w12.x * w3.y);
    float total = w12.x * w0.y + w0.x * w12.y + w12.x * w12.y + w3.x * w12.y + w12.x * w3.y;
    return max(sum / total, 0.0); // the four corners, left out, weigh next to nothing
}

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= size.x || at.y >= size.y)
        return;
    float stored = imageLoad(view_depth, at).r;
    bool guessed = stored < 0.0;
    float depth = abs(stored);
    if (!(depth > 0.0))
        return;
    vec3 p = vec3((vec2(at) + 0.5 - view_focal.zw) / view_focal.xy, 1.0) * depth;
    vec4 ph = vec4(p, 1.0);
    vec3 q = vec3(dot(photo_from_view[0], ph), dot(photo_from_view[1], ph),
                  dot(photo_from_view[2], ph));
    if (!(q.z > 0.0))
        return;
    vec2 pixel = photo_focal.xy * q.xy / q.z + photo_focal.zw;
    vec2 border = min(pixel, photo_size.xy - pixel) - 0.5;
    if (!(min(border.x, border.y) > 0.0))
        return;
    vec2 uv = pixel / photo_size.xy;
    if (options.z > 0.5 && !photo_sees(uv, q.z, guessed))
        return;

    // Airieau 2012, 5.3: cos(theta) / delta, with delta relative to the viewing
    // distance and kept from zero, so that the weight has no unit and no pole.
    vec3 to_photo = photo_eye.xyz - p;
    float view_distance = length(p), photo_distance = length(to_photo);
    float cosine = dot(-p, to_photo) / (view_distance * photo_distance);
    float delta = abs(view_distance - photo_distance) / view_distance + options.y;
    float weight = max(cosine, 0.0) / delta;
    // Where depth is only guessed, photographs disagree: let the best one dominate.
    if (guessed)
        weight = pow(weight * options.y, 8.0);
    weight *= clamp(min(border.x, border.y) / max(photo_size.w, 0.5), 0.0, 1.0);
    if (!(weight > 0.0))
        return;
    float magnification = photo_focal.x * depth / (q.z * view_focal.x);
    float mip = clamp(log2(magnification), 0.0, photo_size.z);
    vec3 color = options.w > 0.5 ? bicubic(pixel, mip) : textureLod(photo, uv, mip).rgb;
    color *= gain.rgb;
    imageStore(accumulated, at, imageLoad(accumulated, at) + vec4(color * weight, weight));
}
