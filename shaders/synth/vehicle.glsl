// What stereo finds hardest on a square: a vehicle of bright enamel, dark glass and darker tyres, a
// street lamp and two wires. They stand before the monument, in metres as it.
const vec3 VEHICLE_AT = vec3(1.5, 0.0, 4.6);
const float WHEEL_X = 1.25, WHEEL_Z = 0.72, WHEEL_RADIUS = 0.31;
const vec3 LAMP_AT = vec3(-2.4, 0.0, 4.0);
const float LAMP_TOP = 3.9, GLOBE_RADIUS = 0.21;

// The vehicle's own frame: x along it, y up from the ground.
vec3 in_vehicle(vec3 p)
{
    vec3 q = p - VEHICLE_AT;
    q.xz = mat2(0.94, 0.342, -0.342, 0.94) * q.xz;
    return q;
}

// Position relative to the nearest wheel's middle.
vec3 at_wheel(vec3 q)
{
    return vec3(abs(q.x) - WHEEL_X, q.y - WHEEL_RADIUS, abs(q.z) - WHEEL_Z);
}

float wheels(vec3 q)
{
    vec3 w = at_wheel(q);
    return max(length(w.xy) - WHEEL_RADIUS, abs(w.z) - 0.1);
}

float coachwork(vec3 q)
{
    vec3 w = at_wheel(q);
    float d = box(q - vec3(0.0, 0.6, 0.0), vec3(1.95, 0.32, 0.82), 0.16);
    return max(d, -max(length(w.xy) - WHEEL_RADIUS - 0.06, 0.6 - abs(q.z)));
}

float cabin(vec3 q)
{
    vec3 c = q - vec3(-0.2, 1.1, 0.0);
    float slant = dot(vec2(abs(c.x) - 1.0, c.y), vec2(0.78, 0.626));
    return max(box(c, vec3(1.4, 0.34, 0.7), 0.1), slant);
}

float lamp(vec3 p)
{
    vec3 q = p - LAMP_AT;
    float post = capsule(q, vec3(0.0), vec3(0.0, LAMP_TOP, 0.0), 0.045);
    return min(post, length(q - vec3(0.0, LAMP_TOP + GLOBE_RADIUS, 0.0)) - GLOBE_RADIUS);
}

// Two wires across the square, which sag.
float wires(vec3 p)
{
    float sag = 0.4 * (1.0 - p.x * p.x / 64.0);
    vec2 q = vec2(p.y - 5.0 + sag, abs(p.z - 3.2) - 0.25);
    return max(0.95 * (length(q) - 0.014), abs(p.x) - 8.0);
}

// All of it.
float vehicle(vec3 p)
{
    vec3 q = in_vehicle(p);
    float d = box(q - vec3(0.0, 0.8, 0.0), vec3(2.1, 0.85, 0.95), 0.0);
    if (d < 0.3)
        d = min(wheels(q), min(coachwork(q), cabin(q)));
    return min(d, min(lamp(p), wires(p)));
}

// Colour in linear light, and the share of its light that is a mirror's, at a point of a surface.
vec4 vehicle_surface(vec3 p)
{
    const vec4 ENAMEL = vec4(0.42, 0.016, 0.02, 0.1), GLASS = vec4(0.01, 0.012, 0.014, 0.5),
               TYRE = vec4(0.012, 0.012, 0.012, 0.0), METAL = vec4(0.35, 0.35, 0.36, 0.3);
    vec3 q = in_vehicle(p), c = q - vec3(-0.2, 1.1, 0.0);
    float d = min(lamp(p), wires(p));
    if (d < min(wheels(q), min(coachwork(q), cabin(q))))
        return length(p - LAMP_AT - vec3(0.0, LAMP_TOP + GLOBE_RADIUS, 0.0)) < GLOBE_RADIUS + 0.01
                   ? vec4(0.75, 0.74, 0.7, 0.05)
                   : vec4(0.03, 0.035, 0.03, 0.0);
    if (wheels(q) < min(coachwork(q), cabin(q)))
        return length(at_wheel(q).xy) < 0.17 ? METAL : TYRE;
    bool pillar = abs(abs(c.x) - 0.12) < 0.05 && abs(c.z) > 0.6;
    return cabin(q) < coachwork(q) && abs(c.y - 0.03) < 0.2 && !pillar ? GLASS : ENAMEL;
}
