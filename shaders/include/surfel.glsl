// A pixel of the pull-push pyramid (Airieau 2012 section 5.1; Marroquim 2007).
// surfel_a: nearest and farthest depth of the interval, depth of the centre, radius;
// radius 0: empty. surfel_b: normal (octahedron, camera frame), displacement of the
// projected centre from this pixel's centre, in level 0 pixels.
const float SURFEL_MIN_RADIUS_PX = 1.5;

struct surfel {
    float near, far, depth, radius;
    vec3 normal;
    vec2 displacement;
};

surfel surfel_unpack(vec4 a, vec4 b)
{
    return surfel(a.x, a.y, a.z, a.w, octahedron_decode(b.xy), b.zw);
}

vec4 surfel_pack_a(surfel s)
{
    return vec4(s.near, s.far, s.depth, s.radius);
}

vec4 surfel_pack_b(surfel s)
{
    return vec4(octahedron_encode(s.normal), s.displacement);
}

// Centre of a pixel of a level, in level 0 pixels.
vec2 level_centre(ivec2 pixel, int level)
{
    return (vec2(pixel) + 0.5) * float(1 << level);
}

// Depth at which the ray through `target` (level 0 pixels) meets the plane of the disc
// whose centre projects to `centre`, within the disc's depth range; 0: behind the eye.
// `inside`: the ray meets the disc itself. The projected disc is Marroquim's ellipse;
// meeting it with the ray is exact under perspective.
float surfel_depth_at(surfel s, vec2 centre, vec2 target, vec4 camera, out bool inside)
{
    vec3 centre_ray = vec3((centre - camera.zw) / camera.xy, 1.0);
    vec3 ray = vec3((target - camera.zw) / camera.xy, 1.0);
    float along = dot(s.normal, ray);
    float plane = s.depth * dot(s.normal, centre_ray);
    // Nearly edge-on discs have no stable depth: treat them as facing the viewer.
    bool edge_on = abs(along) < 0.1 * length(ray);
    float depth = edge_on ? s.depth : plane / along;
    depth = clamp(depth, s.depth - s.radius, s.depth + s.radius);
    vec3 offset = ray * depth - centre_ray * s.depth;
    inside = dot(offset, offset) <= s.radius * s.radius;
    return max(depth, 0.0);
}
