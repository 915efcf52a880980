// Draws one synthetic photograph with its ground truth: linear radiance averaged over the pixel,
// and depth (z in camera space, 0: sky) and normal (camera frame) at its centre.
layout(local_size_x = 8, local_size_y = 8) in;
#include "synth/trace.glsl"
#include "synth/material.glsl"
#include "synth/light.glsl"
layout(r32f, binding = 0) readonly uniform image2D start_image;
layout(rgba32f, binding = 1) writeonly uniform image2D radiance_image;
layout(rgba32f, binding = 2) writeonly uniform image2D truth_image; // normal, depth

// Sample positions: the centre, then the corners of a rotated square.
const int SAMPLE_COUNT = 5;
const vec2 samples[SAMPLE_COUNT] = vec2[](vec2(0.5), vec2(0.375, 0.125), vec2(0.875, 0.375),
                                          vec2(0.625, 0.875), vec2(0.125, 0.625));

float distance_at(vec3 p)
{
    return min(solids(p), p.y);
}

// The samples of a pixel share normal and light while they lie on one tangent plane, within this
// fraction of a pixel.
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
    float t; // depth; SKY_T: no surface
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

// Moves a hit along its tangent plane to another ray of the pixel; false if the surface is not
// there.
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

#ifdef HIGH_CONTRAST
// Where light changes by stops, five samples are too few: a sliver of sunlight in deep shade may
// fall between them and still be most of a pixel's light. Samples at the corners detect such
// pixels. A sheared grid, in which no two samples share a row or a column, then replaces the five.
const int CORNER_COUNT = 4, FINE = 5; // samples in each direction
const int FIRST_COUNT = SAMPLE_COUNT + CORNER_COUNT;
const float STEADY = 2.0; // ratio of brightest to darkest sample up to which five are enough

vec2 sample_at(int i)
{
    if (i < SAMPLE_COUNT)
        return samples[i];
    int k = i - SAMPLE_COUNT;
    if (k < CORNER_COUNT)
        return vec2(k % 2, k / 2);
    k -= CORNER_COUNT;
    vec2 cell = vec2(k % FINE, k / FINE);
    return (cell + (cell.yx + 0.5) / float(FINE)) / float(FINE);
}
#else
const int FIRST_COUNT = SAMPLE_COUNT;
#define sample_at(i) samples[i]
#endif

#if defined(GLOSS) || defined(VEHICLE)
// What a mirror at the hit shows: one reflection, of surfaces as if without gloss.
vec3 mirrored(Hit hit, vec3 ray)
{
    const float LIFT = 0.02; // metres, so that the ray leaves its own surface
    vec3 way = reflect(ray, hit.n), from = hit.p + LIFT * hit.n;
    float t = trace(from, way, LIFT);
    if (t >= SKY_T)
        return sky(way);
    vec3 p = from + way * t, n = surface_normal(p, 3e-4 * hit.t);
    return radiance(p, n, material_at(p, n, (hit.t + t) / camera.x), light_at(p, n));
}
#endif

vec3 color_of(Hit hit, vec3 ray)
{
    if (hit.t >= SKY_T)
        return sky(ray);
    vec3 color = radiance(hit.p, hit.n, material_at(hit.p, hit.n, hit.t / camera.x), hit.light);
#ifdef GLOSS
    if (part_at(hit.p) == PART_MONUMENT)
        color = mix(color, mirrored(hit, normalize(ray)), view_light.y);
#endif
#ifdef VEHICLE
    if (part_at(hit.p) == PART_VEHICLE) {
        vec3 way = normalize(ray);
        float facing = clamp(1.0 + dot(way, hit.n), 0.0, 1.0);
        float mirror = vehicle_surface(hit.p).a; // more at grazing angles (Schlick 1994)
        mirror += mirror > 0.0 ? (1.0 - mirror) * pow(facing, 5.0) : 0.0;
        color = mix(color, mirrored(hit, way), mirror);
    }
#endif
    return color;
}

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy) + ivec2(0, size.z);
    if (pixel.x >= size.x || pixel.y >= size.w)
        return;
    // All samples of the pixel start from the nearest depth at which one of them may hit a surface.
    float cone = (FIRST_COUNT > SAMPLE_COUNT ? 0.72 : 0.42) / min(camera.x, camera.y);
    float start = imageLoad(start_image, pixel / 8).x;
    start = free_way(eye.xyz, ray_through(vec2(pixel) + 0.5), start, cone);
    vec3 sum = vec3(0.0);
#ifdef HIGH_CONTRAST
    vec3 fine = vec3(0.0);
    vec2 range = vec2(1e30, 0.0);
#endif
    Hit centre = Hit(SKY_T, vec3(0.0), vec3(0.0), vec2(0.0));
    int end = FIRST_COUNT;
    for (int i = 0; i < end; i++) {
        vec3 ray = ray_through(vec2(pixel) + sample_at(i));
        Hit hit = centre;
        if (i == 0 || !slide(ray, hit))
            hit = find_hit(ray, start);
        if (i == 0)
            centre = hit;
        vec3 color = color_of(hit, ray);
        if (i < SAMPLE_COUNT)
            sum += color;
#ifdef HIGH_CONTRAST
        if (i >= FIRST_COUNT)
            fine += color;
        float light = dot(color, vec3(1.0));
        range = vec2(min(range.x, light), max(range.y, light));
        if (i + 1 == FIRST_COUNT && range.y > STEADY * range.x)
            end = FIRST_COUNT + FINE * FINE;
#endif
    }
    vec3 mean = sum / float(SAMPLE_COUNT);
#ifdef HIGH_CONTRAST
    if (end > FIRST_COUNT)
        mean = fine / float(FINE * FINE);
#endif
    vec3 n = vec3(dot(centre.n, right.xyz), dot(centre.n, down.xyz), dot(centre.n, forward.xyz));
    float kind = 0.0; // 1: of a plain wall, 2: of the vehicle
#ifdef PLAIN
    if (centre.t < SKY_T && is_plain(centre.p, part_at(centre.p)))
        kind = 1.0;
#endif
#ifdef VEHICLE
    if (centre.t < SKY_T && part_at(centre.p) == PART_VEHICLE)
        kind = 2.0;
#endif
    imageStore(radiance_image, pixel, vec4(mean, kind));
    imageStore(truth_image, pixel, vec4(n, centre.t < SKY_T ? centre.t : 0.0));
}
