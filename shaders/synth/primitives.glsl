// Signed distance functions, negative inside.
float box(vec3 p, vec3 half_size, float rounding)
{
    vec3 q = abs(p) - half_size + rounding;
    return length(max(q, 0.0)) + min(max(q.x, max(q.y, q.z)), 0.0) - rounding;
}

float box2(vec2 p, vec2 half_size)
{
    vec2 q = abs(p) - half_size;
    return length(max(q, 0.0)) + min(max(q.x, q.y), 0.0);
}

float capsule(vec3 p, vec3 a, vec3 b, float radius)
{
    vec3 pa = p - a, ba = b - a;
    return length(pa - ba * clamp(dot(pa, ba) / dot(ba, ba), 0.0, 1.0)) - radius;
}

float segment2(vec2 p, vec2 a, vec2 b)
{
    vec2 pa = p - a, ba = b - a;
    return length(pa - ba * clamp(dot(pa, ba) / dot(ba, ba), 0.0, 1.0));
}

float torus_y(vec3 p, float major, float minor)
{
    return length(vec2(length(p.xz) - major, p.y)) - minor;
}

// A bound of the distance to an ellipsoid, exact near its surface.
float ellipsoid(vec3 p, vec3 radii)
{
    float k0 = length(p / radii), k1 = length(p / (radii * radii));
    return k0 < 1e-4 ? -min(radii.x, min(radii.y, radii.z)) : k0 * (k0 - 1.0) / k1;
}

float smooth_min(float a, float b, float k)
{
    float h = max(k - abs(a - b), 0.0) / k;
    return min(a, b) - 0.25 * h * h * k;
}
