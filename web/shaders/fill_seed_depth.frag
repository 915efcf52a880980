// Finest level of the pyramid that guesses depth, at half the picture's size: inverse depth and its
// slope, weighted so steeply towards far surfaces that a hole continues the farther side of its rim,
// as SEED_DEPTH of shaders/fill/fill_seed.comp.
uniform sampler2D known, normals; // push.frag
uniform vec4 view_focal;
uniform float typical;
layout(location = 0) out vec4 seeded;

const float FACING_MIN = 0.1;

// The depth's value for the centre of its block, `by` pixels away; see fill_finer.glsl.
vec4 seed_depth(float z, ivec2 at, vec2 by)
{
    vec4 stored = texelFetch(normals, at, 0);
    vec3 normal = stored.a > 0.0 ? 2.0 * stored.rgb - 1.0 : vec3(0.0);
    vec3 ray = vec3((vec2(at) + 0.5 - view_focal.zw) / view_focal.xy, 1.0);
    float facing = dot(normal, ray);
    vec2 slope = normal.xy / (view_focal.xy * z * facing);
    slope = abs(facing) > FACING_MIN * length(ray) ? slope : vec2(0.0);
    float weight = clamp(pow(z / typical, 14.0), 1e-15, 1e15); // sums fit floats
    return vec4(1.0 / z + dot(slope, by), 2.0 * slope, 1.0) * weight;
}

void main()
{
    ivec2 at = 2 * ivec2(gl_FragCoord.xy), area = textureSize(known, 0);
    seeded = vec4(0.0);
    for (int i = 0; i < 4; i++) {
        ivec2 child = ivec2(i & 1, i >> 1), from = at + child;
        float z = from.x < area.x && from.y < area.y ? texelFetch(known, from, 0).x : 0.0;
        seeded += z > 0.0 ? seed_depth(z, from, 0.5 - vec2(child)) : vec4(0.0);
    }
}
