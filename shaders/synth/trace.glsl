// Intersects rays with the scene.
#include "synth/view.glsl"
#include "synth/noise.glsl"
#include "synth/primitives.glsl"
#include "synth/monument.glsl"
#include "synth/vehicle.glsl"
#include "synth/town.glsl"

const float FAR_T = 120.0;
const int TRACE_STEPS = 160;
// Greatest distance of a hit from the true surface, relative to depth.
const float TRACE_TOLERANCE = 1e-4;

// Marches from t along `ray` (not of unit length) to where a cone around it first may touch a
// surface; at least `end` if there is none before. cone: radius per unit t; 0: the ray alone.
float march(vec3 origin, vec3 ray, float t, float end, float cone)
{
    float pace = 1.0 / (length(ray) + cone);
    for (int i = 0; i < TRACE_STEPS && t < end; i++) {
        float d = solids(origin + ray * t) - cone * t;
        if (d < TRACE_TOLERANCE * t)
            return t;
        t += d * pace;
    }
    return t;
}

// Depth up to which no ray of the cone meets a surface.
float free_way(vec3 origin, vec3 ray, float start, float cone)
{
    float end = cone > ray.y ? min(origin.y / (cone - ray.y), FAR_T) : FAR_T;
    return min(march(origin, ray, start, end, cone), end);
}

// Depth of the first surface; SKY_T if there is none.
float trace(vec3 origin, vec3 ray, float start)
{
    float ground = ray.y < 0.0 ? -origin.y / ray.y : SKY_T;
    float end = min(ground, FAR_T);
    float t = march(origin, ray, start, end, 0.0);
    return t < end ? t : ground < FAR_T ? ground : SKY_T;
}
