// The monument: a triumphal arch whose front faces +z. Distances are in metres. The geometry is
// symmetric in x except for its weathering.

// Distance to the opening's outline in the xy plane: a round arch on straight jambs.
float arch_outline(vec2 q, float springing)
{
    return q.y < springing ? abs(q.x) : length(q - vec2(0.0, springing));
}

const float ARCH_SPRING = 3.35, ARCH_RADIUS = 1.3;
const float BAY_X = 2.9;         // middle of a side bay
const float COLUMN_OFFSET = 0.98; // columns stand at BAY_X +- this
const float COLUMN_Z = 0.55;

// The word ORIEL over the arch, centred, one unit high.
float letters(vec2 p)
{
    float o = abs(length(vec2(p.x + 1.62, p.y) * vec2(1.15, 1.0)) - 0.42);
    vec2 r = p + vec2(0.62, 0.0);
    float d = min(o, segment2(r, vec2(-0.24, -0.44), vec2(-0.24, 0.44)));
    vec2 bowl = r - vec2(-0.02, 0.21);
    d = min(d, bowl.x < 0.0 ? max(abs(abs(bowl.y) - 0.23), abs(bowl.x + 0.11) - 0.11)
                            : abs(length(bowl) - 0.23));
    d = min(d, segment2(r, vec2(-0.02, -0.02), vec2(0.26, -0.44)));
    d = min(d, segment2(p - vec2(0.08, 0.0), vec2(0.0, -0.44), vec2(0.0, 0.44)));
    vec2 e = p - vec2(0.72, 0.0);
    d = min(d, segment2(e, vec2(-0.2, -0.44), vec2(-0.2, 0.44)));
    e.y = abs(e.y);
    d = min(d, segment2(e, vec2(-0.2, 0.43), vec2(0.22, 0.43)));
    d = min(d, segment2(e, vec2(-0.2, 0.0), vec2(0.13, 0.0)));
    vec2 l = p - vec2(1.55, 0.0);
    d = min(d, segment2(l, vec2(-0.2, -0.44), vec2(-0.2, 0.44)));
    d = min(d, segment2(l, vec2(-0.2, -0.43), vec2(0.22, -0.43)));
    return d - 0.075;
}

// The word at its size in metres, for the recessed panel.
float inscription(vec3 p)
{
    return 0.62 * letters((p.xy - vec2(0.0, 7.2)) / 0.62);
}

// A draped standing figure, 1.55 m high, with its feet at the origin.
float figure(vec3 p)
{
    float height = clamp(p.y, 0.0, 1.15);
    float angle = atan(p.z, p.x);
    float folds = 0.022 * sin(9.0 * angle + 4.0 * p.y) * (1.0 - 0.5 * height);
    float radius = 0.27 - 0.13 * height + 0.05 * sin(5.0 * height);
    float d = max(length(p.xz * vec2(1.0, 1.15)) - radius - folds, abs(p.y - 0.55) - 0.55);
    d = smooth_min(d, ellipsoid(p - vec3(0.0, 1.08, 0.0), vec3(0.235, 0.22, 0.16)), 0.12);
    d = smooth_min(d, ellipsoid(p - vec3(0.0, 1.43, 0.02), vec3(0.095, 0.125, 0.11)), 0.06);
    d = smooth_min(d, capsule(p, vec3(0.22, 1.17, 0.0), vec3(0.3, 0.86, 0.06), 0.062), 0.05);
    d = smooth_min(d, capsule(p, vec3(0.3, 0.86, 0.06), vec3(0.1, 0.8, 0.22), 0.052), 0.05);
    d = smooth_min(d, capsule(p, vec3(-0.22, 1.17, 0.0), vec3(-0.31, 0.78, 0.03), 0.06), 0.05);
    d = smooth_min(d, capsule(p, vec3(-0.2, 1.2, 0.12), vec3(0.2, 0.55, 0.18), 0.045), 0.08);
    return 0.75 * min(d, box(p - vec3(0.0, -0.02, 0.0), vec3(0.3, 0.06, 0.27), 0.01));
}

float steps(vec3 q)
{
    float d = box(q - vec3(0.0, 0.09, -0.8), vec3(5.5, 0.09, 2.85), 0.012);
    d = min(d, box(q - vec3(0.0, 0.18, -0.8), vec3(5.2, 0.18, 2.55), 0.012));
    return min(d, box(q - vec3(0.0, 0.27, -0.8), vec3(4.9, 0.27, 2.25), 0.012));
}

float column(vec3 c)
{
    float d = box(c - vec3(0.0, 1.1, 0.0), vec3(0.42, 0.6, 0.42), 0.012);
    d = min(d, box(c - vec3(0.0, 0.64, 0.0), vec3(0.5, 0.11, 0.5), 0.03));
    d = min(d, box(c - vec3(0.0, 1.68, 0.0), vec3(0.49, 0.06, 0.49), 0.025));
    d = min(d, torus_y(c - vec3(0.0, 1.82, 0.0), 0.31, 0.075));
    d = min(d, torus_y(c - vec3(0.0, 1.95, 0.0), 0.29, 0.05));
    float r = length(c.xz);
    float rise = clamp((c.y - 1.9) / 2.7, 0.0, 1.0);
    float near_shaft = r - 0.29;
    if (near_shaft < 0.15) {
        float angle = atan(c.z, c.x);
        float flutes = 0.016 * abs(sin(9.0 * angle)) * smoothstep(2.05, 2.15, c.y);
        float shaft = r - (0.285 - 0.045 * rise * rise) + 0.016 - flutes;
        d = min(d, 0.85 * max(shaft, abs(c.y - 3.25) - 1.4));
        float bell = clamp((c.y - 4.6) / 0.5, 0.0, 1.0);
        float tiers = smoothstep(0.0, 0.35, bell) * (1.0 - smoothstep(0.4, 0.5, bell)) +
                      smoothstep(0.5, 0.9, bell);
        float leaves = 0.045 * tiers * (0.4 + abs(sin(4.0 * angle + (bell > 0.45 ? 0.8 : 0.0))));
        d = min(d, 0.6 * max(r - 0.25 - 0.1 * bell * bell - leaves, abs(c.y - 4.86) - 0.26));
    } else {
        d = min(d, max(near_shaft - 0.09, abs(c.y - 3.4) - 1.75));
    }
    d = min(d, torus_y(c - vec3(0.0, 4.6, 0.0), 0.25, 0.03));
    return min(d, box(c - vec3(0.0, 5.14, 0.0), vec3(0.4, 0.05, 0.4), 0.02));
}

// A niche with a figure, and a roundel above. b: position relative to the bay's middle.
float side_bay(vec3 b)
{
    float ring = abs(length(b.xy - vec2(0.0, 4.12)) - 0.5);
    float d = length(vec2(max(ring - 0.03, 0.0), b.z)) - 0.06;
    vec2 disc = b.xy - vec2(0.0, 4.12);
    float r = length(disc), angle = atan(disc.y, disc.x);
    float petals = 0.11 * fall(0.3, 0.46, r) * (0.45 + 0.55 * abs(cos(4.0 * angle))) *
                   (0.6 + 0.4 * cos(22.0 * r));
    d = min(d, 0.6 * max(b.z - petals, r - 0.5));
    float outline = arch_outline(b.xy, 2.5);
    d = min(d, max(length(vec2(max(abs(outline - 0.62) - 0.05, 0.0), b.z)) - 0.05, 1.3 - b.y));
    d = min(d, box(b - vec3(0.0, 1.28, 0.1), vec3(0.7, 0.07, 0.2), 0.02));
    return min(d, 0.95 * figure((b - vec3(0.0, 1.38, -0.2)) / 0.95));
}

float attic(vec3 q, vec3 c)
{
    float d = box(q - vec3(0.0, 7.15, -1.15), vec3(4.05, 0.95, 1.0), 0.015);
    d = min(d, box(c - vec3(0.0, 7.15, -0.7), vec3(0.4, 0.95, 0.25), 0.015));
    d = max(d, -box(q - vec3(0.0, 7.2, -0.15), vec3(1.38, 0.55, 0.07), 0.0));
    d = min(d, max(abs(box2(q.xy - vec2(0.0, 7.2), vec2(1.42, 0.59))) - 0.03,
                   abs(q.z + 0.15) - 0.05));
    vec3 panel = q - vec3(BAY_X, 7.2, -0.15);
    d = max(d, -box(panel, vec3(0.45, 0.55, 0.08), 0.0));
    if (abs(q.z) < 0.6 && abs(q.x) < 1.5)
        d = max(d, -max(inscription(q), abs(q.z + 0.22) - 0.045));
    d = min(d, box(q - vec3(0.0, 6.36, -1.15), vec3(4.2, 0.12, 1.12), 0.03));
    d = min(d, box(q - vec3(0.0, 8.08, -1.15), vec3(4.28, 0.06, 1.22), 0.02));
    d = min(d, box(c - vec3(0.0, 8.08, -0.6), vec3(0.5, 0.06, 0.4), 0.02));
    d = min(d, box(q - vec3(0.0, 8.2, -1.15), vec3(4.45, 0.07, 1.4), 0.03));
    d = min(d, box(q - vec3(0.0, 8.4, -1.15), vec3(2.3, 0.16, 0.8), 0.02));
    d = min(d, box(q - vec3(3.9, 8.4, -0.2), vec3(0.26, 0.16, 0.26), 0.02));
    vec3 cone = q - vec3(3.9, 8.86, -0.2);
    d = min(d, 0.8 * (ellipsoid(cone, vec3(0.22, 0.34, 0.22)) -
                      0.015 * sin(26.0 * cone.y) * sin(7.0 * atan(cone.z, cone.x))));
    return d;
}

// The walls with the passage and the niches.
float body(vec3 q, vec3 b, float outline)
{
    float d = box(q - vec3(0.0, 3.35, -1.1), vec3(4.3, 2.85, 1.1), 0.015);
    vec3 dome = b - vec3(0.0, 2.5, 0.0);
    float niche = max(length(vec3(dome.x, max(dome.y, 0.0), dome.z)) - 0.57, 1.35 - b.y);
    d = max(d, -niche);
    // Archivolt and jambs in two bands, impost, keystone.
    float band = abs(q.z + 1.1);
    d = min(d, max(abs(outline - 1.48) - 0.18, band - 1.16));
    d = min(d, max(abs(outline - 1.42) - 0.06, band - 1.2));
    d = min(d, box(q - vec3(1.55, ARCH_SPRING - 0.06, -1.1), vec3(0.3, 0.08, 1.24), 0.02));
    d = min(d, 0.9 * box(q - vec3(0.0, 4.85, 0.0),
                         vec3(0.2 + 0.25 * (q.y - 4.85), 0.4, 0.17), 0.015));
    d = max(d, ARCH_RADIUS - outline);
    // String course and dado of the side bays.
    d = min(d, box(b - vec3(0.0, 3.34, 0.0), vec3(1.4, 0.07, 0.08), 0.02));
    return min(d, box(b - vec3(0.0, 0.8, 0.0), vec3(1.4, 0.26, 0.08), 0.02));
}

// Architrave, dentils and cornice, breaking forward over each column.
float entablature(vec3 q, vec3 c)
{
    float d = box(q - vec3(0.0, 5.28, -1.1), vec3(4.36, 0.09, 1.16), 0.01);
    d = min(d, box(q - vec3(0.0, 5.46, -1.1), vec3(4.4, 0.09, 1.2), 0.01));
    d = min(d, box(c - vec3(0.0, 5.55, -0.2), vec3(0.36, 0.36, 0.52), 0.012));
    d = min(d, box(c - vec3(0.0, 5.46, -0.2), vec3(0.4, 0.09, 0.56), 0.012));
    vec3 tooth = q - vec3(0.0, 5.89, 0.1);
    tooth.x -= 0.22 * clamp(round(tooth.x / 0.22), 0.0, 19.0);
    d = min(d, box(tooth, vec3(0.06, 0.07, 0.12), 0.01));
    vec3 side_tooth = q - vec3(4.4, 5.89, -1.1);
    side_tooth.z -= 0.22 * clamp(round(side_tooth.z / 0.22), -5.0, 5.0);
    d = min(d, box(side_tooth, vec3(0.12, 0.07, 0.06), 0.01));
    d = min(d, box(q - vec3(0.0, 6.03, -1.1), vec3(4.6, 0.07, 1.4), 0.02));
    d = min(d, box(q - vec3(0.0, 6.15, -1.1), vec3(4.72, 0.06, 1.52), 0.03));
    d = min(d, box(c - vec3(0.0, 6.03, -0.1), vec3(0.5, 0.07, 0.62), 0.02));
    return min(d, box(c - vec3(0.0, 6.15, -0.1), vec3(0.6, 0.06, 0.72), 0.03));
}

float monument(vec3 p)
{
    vec3 q = vec3(abs(p.x), p.yz);
    float bound = box(q - vec3(0.0, 4.7, -0.8), vec3(5.5, 4.75, 2.85), 0.0);
    if (bound > 0.6)
        return bound;
    // Columns fold onto one another by symmetry within each bay.
    vec3 c = vec3(abs(q.x - BAY_X) - COLUMN_OFFSET, q.y, q.z - COLUMN_Z);
    vec3 b = q - vec3(BAY_X, 0.0, 0.0);
    float d = body(q, b, arch_outline(q.xy, ARCH_SPRING));
    // Each part is evaluated only if its bounds are nearer than the distance found so far.
    if (q.y - 0.56 < d)
        d = min(d, steps(q));
    if (box(c - vec3(0.0, 2.85, 0.0), vec3(0.52, 2.4, 0.52), 0.0) < d)
        d = min(d, column(c));
    if (box(b - vec3(0.0, 2.95, -0.05), vec3(0.75, 1.8, 0.55), 0.0) < d)
        d = min(d, side_bay(b));
    if (abs(q.y - 5.7) - 0.55 < d)
        d = min(d, entablature(q, c));
    if (6.2 - q.y < d) {
        d = min(d, attic(q, c));
        vec3 f = c - vec3(0.0, 6.27, -0.12);
        if (box(f - vec3(0.0, 0.8, 0.0), vec3(0.38, 0.85, 0.32), 0.0) < d)
            d = min(d, figure(f / 1.02) * 1.02);
    }
    // Weathering erodes the edges by a few millimetres, differently on every stone.
    if (d < 0.05)
        d += 0.006 * noise(p * 5.0) + 0.003 * noise(p * 17.0);
    return d;
}
