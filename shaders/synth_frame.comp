// One synthetic photograph with its truth: linear radiance averaged over the
// pixel, depth (z in camera space, 0: sky) and normal (camera frame) at its centre.
layout(local_size_x = 8, local_size_y = 8) in;
#include "include/synth_view.glsl"
#include "include/synth_noise.glsl"
#include "include/synth_primitives.glsl"
#include "include/synth_monument.glsl"
#include "include/synth_town.glsl"
#include "include/synth_trace.glsl"
#include "include/synth_material.glsl"
#include "include/synth_light.glsl"
layout(r32f, binding = 0) readonly uniform image2D start_image;
layout(rgba32f, binding = 1) writeonly uniform image2D radiance_image;
layout(rgba32f, binding = 2) writeonly uniform image2D truth_image; // normal, depth

// The centre, then a rotated square.
const int SAMPLE_COUNT = 5;
const vec2 samples[SAMPLE_COUNT] = vec2[](vec2(0.5), vec2(0.375, 0.125), vec2(0.875, 0.375),
                                          vec2(0.625, 0.875), vec2(0.125, 0.625));

vec3 surface_normal(vec3 p, float reach)
{
    vec3 n = vec3(0.0);
    for (int i = 0; i < 4; i++) { // corners of a tetrahedron
        vec3 e = vec3(i == 0 || i == 3 ? 1.0 : -1.0, i == 1 || i == 3 ? 1.0 : -1.0,
                      i == 2 || i == 3 ? 1.0 : -1.0);
        vec3 q = p + reach * e;
        n += e * min(solids(q), q.y);
    }
    return normalize(n);
}

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy) + ivec2(0, size.z);
    if (pixel.x >= size.x || pixel.y >= size.w)
        return;
    float start = imageLoad(start_image, pixel / 8).x;
    vec3 sum = vec3(0.0);
    vec4 truth = vec4(0.0);
    for (int i = 0; i < SAMPLE_COUNT; i++) {
        vec3 ray = ray_through(vec2(pixel) + samples[i]);
        float t = trace(eye.xyz, ray, start);
        if (t >= SKY_T) {
            sum += sky(ray);
            continue;
        }
        vec3 p = eye.xyz + ray * t;
        vec3 n = surface_normal(p, 3e-4 * t);
        float footprint = t / camera.x;
        sum += radiance(p, n, material_at(p, n, footprint));
        if (i == 0)
            truth = vec4(dot(n, right.xyz), dot(n, down.xyz), dot(n, forward.xyz), t);
    }
    imageStore(radiance_image, pixel, vec4(sum / float(SAMPLE_COUNT), 1.0));
    imageStore(truth_image, pixel, truth);
}
