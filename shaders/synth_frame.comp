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

float distance_at(vec3 p)
{
    return min(solids(p), p.y);
}

// A pixel's samples share normal and light while they stay on one tangent plane,
// to within this share of a pixel.
const float SLIDE_TOLERANCE = 0.2;

vec3 surface_normal(vec3 p, float reach)
{
    vec3 n = vec3(0.0);
    for (int i = 0; i < 4; i++) { // corners of a tetrahedron
        vec3 e = vec3(i == 0 || i == 3 ? 1.0 : -1.0, i == 1 || i == 3 ? 1.0 : -1.0,
                      i == 2 || i == 3 ? 1.0 : -1.0);
        n += e * distance_at(p + reach * e);
    }
    return normalize(n);
}

struct Hit {
    float t; // depth, SKY_T: none
    vec3 p, n;
    vec2 light;
};

Hit find_hit(vec3 ray, float start)
{
    Hit hit = Hit(trace(eye.xyz, ray, start), vec3(0.0), vec3(0.0), vec2(0.0));
    if (hit.t < SKY_T) {
        hit.p = eye.xyz + ray * hit.t;
        hit.n = surface_normal(hit.p, 3e-4 * hit.t);
        hit.light = light_at(hit.p, hit.n);
    }
    return hit;
}

// Moves a hit along its tangent plane to another ray of the pixel; false where
// the surface is not there.
bool slide(vec3 ray, inout Hit hit)
{
    float facing = dot(ray, hit.n);
    if (hit.t >= SKY_T || facing > -0.05)
        return false;
    float t = dot(hit.p - eye.xyz, hit.n) / facing;
    vec3 p = eye.xyz + ray * t;
    if (abs(distance_at(p)) > SLIDE_TOLERANCE * t / camera.x)
        return false;
    hit.t = t;
    hit.p = p;
    return true;
}

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy) + ivec2(0, size.z);
    if (pixel.x >= size.x || pixel.y >= size.w)
        return;
    // All samples of the pixel share the way to where the first of them may hit.
    float cone = 0.42 / min(camera.x, camera.y);
    float start = imageLoad(start_image, pixel / 8).x;
    start = free_way(eye.xyz, ray_through(vec2(pixel) + 0.5), start, cone);
    vec3 sum = vec3(0.0);
    Hit centre = Hit(SKY_T, vec3(0.0), vec3(0.0), vec2(0.0));
    for (int i = 0; i < SAMPLE_COUNT; i++) {
        vec3 ray = ray_through(vec2(pixel) + samples[i]);
        Hit hit = centre;
        if (i == 0 || !slide(ray, hit))
            hit = find_hit(ray, start);
        if (i == 0)
            centre = hit;
        float footprint = hit.t / camera.x;
        if (hit.t < SKY_T)
            sum += radiance(hit.p, hit.n, material_at(hit.p, hit.n, footprint), hit.light);
        else
            sum += sky(ray);
    }
    vec3 n = vec3(dot(centre.n, right.xyz), dot(centre.n, down.xyz), dot(centre.n, forward.xyz));
    imageStore(radiance_image, pixel, vec4(sum / float(SAMPLE_COUNT), 1.0));
    imageStore(truth_image, pixel, vec4(n, centre.t < SKY_T ? centre.t : 0.0));
}
