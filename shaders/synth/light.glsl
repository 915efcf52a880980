// Illumination of a late afternoon: a warm sun, a blue sky and light reflected by the ground. A
// white surface that faces the sun has a radiance of about 2.
const vec3 SUN_DIRECTION = vec3(-0.5407, 0.5946, 0.5951);
const vec3 SUN = vec3(2.05, 1.70, 1.26);
const vec3 SKY_LIGHT = vec3(0.20, 0.26, 0.36);
const vec3 GROUND_LIGHT = vec3(0.20, 0.16, 0.12);
const int SHADOW_STEPS = 36;
const float SHADOW_REACH = 16.0, MONUMENT_TOP = 9.3, TOWN_TOP = 20.0;
const float SUN_SHARPNESS = 28.0; // 1 / width of the penumbra per metre of distance

vec3 sky(vec3 direction)
{
    vec3 d = normalize(direction);
    float height = clamp(d.y, 0.0, 1.0);
    vec3 colour = mix(vec3(0.80, 0.80, 0.78), vec3(0.20, 0.37, 0.68), pow(height, 0.5));
    float glow = max(dot(d, SUN_DIRECTION), 0.0);
    colour += 0.25 * vec3(1.0, 0.8, 0.5) * glow * glow * glow * glow;
    // Thin clouds on a plane far above.
    vec3 at = vec3(d.xz / (height + 0.18), 3.0);
    float cloud = noise(at * 1.1) + 0.5 * noise(at * 2.7) + 0.25 * noise(at * 6.1) +
                  0.12 * noise(at * 13.0);
    float cover = smoothstep(0.05, 1.0, cloud) * smoothstep(0.02, 0.3, height);
    return mix(colour, vec3(1.05, 1.0, 0.95), 0.75 * cover);
}

float sunlight(vec3 p, vec3 n)
{
    if (dot(n, SUN_DIRECTION) <= 0.0)
        return 0.0;
    float light = 1.0, t = 0.03;
    vec3 origin = p + 0.015 * n;
    // In front of the trees nothing is higher than the monument.
    float top = p.z > -6.3 ? MONUMENT_TOP : TOWN_TOP;
    float end = min(SHADOW_REACH, (top - origin.y) / SUN_DIRECTION.y);
    for (int i = 0; i < SHADOW_STEPS && t < end && light > 0.0; i++) {
        float d = solids(origin + SUN_DIRECTION * t);
        light = min(light, 0.5 + 0.5 * SUN_SHARPNESS * d / t);
        t += max(d, 0.02 + 0.01 * t);
    }
    light = clamp(light, 0.0, 1.0);
    return light * light * (3.0 - 2.0 * light);
}

// Ambient occlusion: the open share of the sky, from the growth of free space along the normal.
float openness(vec3 p, vec3 n)
{
    float closed = 0.0, weight = 1.0, reach = 0.05;
    for (int i = 0; i < 5; i++) {
        vec3 q = p + n * reach;
        float free_space = min(solids(q), q.y);
        closed += weight * clamp(1.0 - free_space / reach, 0.0, 1.0);
        weight *= 0.72;
        reach *= 2.2;
    }
    return clamp(1.0 - 0.42 * closed, 0.05, 1.0);
}

// Light that reaches a point: x: visible share of the sun, y: of the sky.
vec2 light_at(vec3 p, vec3 n)
{
    return vec2(sunlight(p, n), openness(p, n));
}

// Where higher contrast darkens the scene: in the middle of the passage and on the far side of the
// square, as under a black cloud. From 0 to 1, without visible edges.
float deep_shade(vec3 p)
{
    float passage = smoothstep(0.0, 1.1, min(-p.z, p.z + 2.2)) * fall(1.35, 1.6, abs(p.x)) *
                    fall(4.6, 5.0, p.y);
    return max(passage, smoothstep(7.0, 18.0, -p.z));
}

vec3 radiance(vec3 p, vec3 n, Material m, vec2 light)
{
    vec3 bent = normalize(n + m.bump - n * dot(n, m.bump));
    float open = light.y;
    float sun = exp2(0.25 * view_light.x), shade = exp2(-view_light.x * deep_shade(p));
    vec3 sum = sun * SUN * max(dot(bent, SUN_DIRECTION), 0.0) * light.x +
               SKY_LIGHT * open * (0.55 + 0.45 * bent.y) +
               GROUND_LIGHT * (0.3 + 0.7 * open) * (0.5 - 0.5 * bent.y) +
               0.04 * SUN * (1.0 - open) * open;
    return m.albedo * sum * shade;
}
