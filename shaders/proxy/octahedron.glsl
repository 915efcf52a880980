// Octahedral encoding of unit vectors as two numbers in [-1, 1] (Meyer et al. 2010).
vec2 octahedron_encode(vec3 n)
{
    n /= abs(n.x) + abs(n.y) + abs(n.z) + 1e-20;
    vec2 wrapped = (1.0 - abs(n.yx)) * vec2(n.x >= 0.0 ? 1.0 : -1.0, n.y >= 0.0 ? 1.0 : -1.0);
    return n.z >= 0.0 ? n.xy : wrapped;
}

vec3 octahedron_decode(vec2 e)
{
    vec3 n = vec3(e, 1.0 - abs(e.x) - abs(e.y));
    float fold = max(-n.z, 0.0);
    n.x += n.x >= 0.0 ? -fold : fold;
    n.y += n.y >= 0.0 ? -fold : fold;
    return normalize(n);
}
