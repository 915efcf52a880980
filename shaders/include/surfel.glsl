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

// Depth at which the ray (target, 1) meets the plane of the disc whose centre lies on the
// ray (centre, 1), within the disc's depth range; 0: behind the eye. `inside`: the ray meets
// the disc itself. The projected disc is Marroquim's ellipse; meeting it with the ray is
// exact under perspective.
float surfel_depth_at(surfel s, vec2 centre, vec2 target, out bool inside)
{
    float along = dot(s.normal.xy, target) + s.normal.z;
    float plane = s.depth * (dot(s.normal.xy, centre) + s.normal.z);
    // Nearly edge-on discs have no stable depth: treat them as facing the viewer.
    bool edge_on = along * along < 0.01 * (dot(target, target) + 1.0);
    float depth = edge_on ? s.depth : plane / along;
    depth = clamp(depth, s.depth - s.radius, s.depth + s.radius);
    vec2 offset = target * depth - centre * s.depth;
    float behind = depth - s.depth;
    inside = dot(offset, offset) + behind * behind <= s.radius * s.radius;
    return max(depth, 0.0);
}
