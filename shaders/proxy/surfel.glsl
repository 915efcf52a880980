// A surfel: a disc with position, normal and radius, as a pixel of the pull-push pyramid holds it
// (Airieau 2012, 5.1; Marroquim 2007).
const float SURFEL_MIN_RADIUS_PX = 1.5;

struct surfel {
    float near, far;   // nearest and farthest depth of the interval that it occupies
    float depth;       // of the surfel's centre
    float radius;      // 0: empty
    vec3 normal;       // camera frame
    vec2 displacement; // of the projected centre from this pixel's centre, level 0 pixels
};

const surfel NO_SURFEL = surfel(0.0, 0.0, 0.0, 0.0, vec3(0.0, 0.0, -1.0), vec2(0.0));

// Centre of a pixel of a level, in level 0 pixels.
vec2 level_centre(ivec2 pixel, int level)
{
    return (vec2(pixel) + 0.5) * float(1 << level);
}

// --- storage in two texels ---

surfel surfel_unpack(vec4 a, uvec4 b)
{
    return surfel(a.x, a.y, a.z, a.w, octahedron_decode(unpackSnorm2x16(b.x)),
                  unpackHalf2x16(b.y));
}

vec4 surfel_pack_a(surfel s)
{
    return vec4(s.near, s.far, s.depth, s.radius);
}

uvec4 surfel_pack_b(surfel s)
{
    return uvec4(packSnorm2x16(octahedron_encode(s.normal)), packHalf2x16(s.displacement), 0u,
                 0u);
}

// The mean of surfels, from the sums of their members and of their weights. `near` and `far` stay.
surfel surfel_mean(surfel sum, float weight)
{
    float scale = 1.0 / weight;
    sum.depth *= scale;
    sum.radius *= scale;
    sum.displacement *= scale;
    if (!(dot(sum.normal, sum.normal) > 1e-12))
        sum.normal = NO_SURFEL.normal;
    return sum;
}

// --- pull ---

// Merges the 2x2 children of a pixel that lie inside the interval of the nearest one; the others
// are occluded (Airieau 2012, 5.1). Values are selected rather than multiplied by 0, since an empty
// child may hold any bits, including infinities.
surfel surfel_merge(surfel child[4], int child_level)
{
    float front = 1e38, front_far = 0.0;
    for (int i = 0; i < 4; i++) {
        bool nearer = child[i].radius > 0.0 && child[i].near < front;
        front = nearer ? child[i].near : front;
        front_far = nearer ? child[i].far : front_far;
    }
    surfel sum = surfel(front, front_far, 0.0, 0.0, vec3(0.0), vec2(0.0));
    float count = 0.0;
    for (int i = 0; i < 4; i++) {
        bool one = child[i].radius > 0.0 && child[i].near <= front_far;
        vec2 offset = (vec2(i & 1, i >> 1) - 0.5) * float(1 << child_level);
        sum.far = max(sum.far, one ? child[i].far : 0.0);
        sum.depth += one ? child[i].depth : 0.0;
        sum.radius += one ? child[i].radius : 0.0;
        sum.normal += one ? child[i].normal : vec3(0.0);
        sum.displacement += one ? child[i].displacement + offset : vec2(0.0);
        count += one ? 1.0 : 0.0;
    }
    if (count == 0.0)
        return NO_SURFEL;
    return surfel_mean(sum, count);
}

// --- push ---

// Depth at which the ray (target, 1) meets the plane of the surfel whose centre lies on the ray
// (centre, 1), clamped to the surfel's depth range; 0: behind the eye. `inside`: the ray meets the
// surfel itself. The projected surfel is the ellipse of Marroquim; its intersection with the ray is
// exact under perspective.
float surfel_depth_at(surfel s, vec2 centre, vec2 target, out bool inside)
{
    float along = dot(s.normal.xy, target) + s.normal.z;
    float plane = s.depth * (dot(s.normal.xy, centre) + s.normal.z);
    // A surfel seen nearly edge-on has no stable depth; it is treated as facing the viewer.
    bool edge_on = along * along < 0.01 * (dot(target, target) + 1.0);
    float depth = edge_on ? s.depth : plane / along;
    depth = clamp(depth, s.depth - s.radius, s.depth + s.radius);
    vec2 offset = target * depth - centre * s.depth;
    float behind = depth - s.depth;
    inside = dot(offset, offset) + behind * behind <= s.radius * s.radius;
    return max(depth, 0.0);
}

// --- storage of level 0 ---

// A splat's interval is [depth, depth + radius].
surfel surfel_unpack_splat(uvec4 words)
{
    float depth = uintBitsToFloat(words.x), radius = uintBitsToFloat(words.y);
    return surfel(depth, depth + radius, depth, radius,
                  octahedron_decode(unpackSnorm2x16(words.z)), unpackHalf2x16(words.w));
}

uvec4 surfel_pack_splat(surfel s)
{
    return uvec4(floatBitsToUint(s.depth), floatBitsToUint(s.radius),
                 packSnorm2x16(octahedron_encode(s.normal)), packHalf2x16(s.displacement));
}

// Depth at the pixel's centre where level 0 keeps its own splat; 0: no splat. centre, target: rays
// to the splat's centre and to the pixel's centre.
float surfel_own_depth(surfel s, vec2 centre, vec2 target)
{
    bool inside;
    float depth = surfel_depth_at(s, centre, target, inside);
    return s.radius > 0.0 ? depth : 0.0;
}

// The same depth, and the normal.
uvec4 surfel_pack_own(surfel s, vec2 centre, vec2 target)
{
    return uvec4(floatBitsToUint(surfel_own_depth(s, centre, target)),
                 packSnorm2x16(octahedron_encode(s.normal)), 0u, 0u);
}
