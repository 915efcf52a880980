// Materials: colours in linear light from solid (world-space) noise, so that no stone looks like
// another. Needs Params.
struct Material {
    vec3 albedo;
    vec3 bump; // added to the normal
};

// One stone of a wall laid in courses: x: distance to the joint in metres, y: which side of the
// stone is near (-1 lower edge .. 1 upper), and the hash of the stone.
struct Stone {
    float joint, edge;
    uint id;
};

float joint_jitter(int column, int row)
{
    return 0.45 * hash1(ivec3(column, row, 7));
}

Stone ashlar(vec2 uv, float course, float width, int wall)
{
    Stone s;
    float v = uv.y / course;
    v += 0.16 * sin(2.1 * v + float(wall)); // courses of different height
    int row = int(floor(v));
    float f = v - float(row);
    float w = width * (0.75 + 0.6 * hash1(ivec3(row, wall, 3)));
    float u = uv.x / w + 13.0 * hash1(ivec3(row, wall, 5));
    int column = int(floor(u));
    if (u - float(column) < joint_jitter(column, row * 64 + wall))
        column--;
    float left = u - float(column) - joint_jitter(column, row * 64 + wall);
    float right = float(column + 1) + joint_jitter(column + 1, row * 64 + wall) - u;
    s.joint = min(min(left, right) * w, min(f, 1.0 - f) * course);
    s.edge = 2.0 * f - 1.0;
    s.id = hash_cell(ivec3(column, row, wall));
    return s;
}

// Coordinates along the surface, for the axis that is closest to its normal.
vec2 wall_uv(vec3 p, vec3 n, out int wall)
{
    vec3 a = abs(n);
    wall = a.z > max(a.x, a.y) ? 1 : a.x > a.y ? 2 : 3;
    return wall == 1 ? p.xy : wall == 2 ? p.zy : p.xz;
}

// Limestone: clouds, veins, pits and lichen over the base colour of each stone.
Material stone(vec3 p, vec3 n, Stone s, float footprint, float age)
{
    Material m;
    vec3 chance = spread(s.id);
    vec3 base = mix(vec3(0.60, 0.49, 0.35), vec3(0.50, 0.45, 0.38), chance.x);
    base *= 0.66 + 0.6 * chance.y;
    base = mix(base, vec3(0.62, 0.43, 0.27), 0.35 * smoothstep(0.7, 1.0, chance.z));
    // Each stone is cut from another place of the quarry.
    vec3 q = p + 9.0 * (chance - 0.5);
    vec4 clouds = octaves(q * vec3(1.0, 1.7, 1.0), 2.3, 4, 0.7, footprint);
    vec4 grain = octaves(p, 31.0, 4, 0.75, footprint);
    float tone = 0.20 * clouds.w + 0.17 * grain.w;
    m.albedo = base * exp(tone) * (1.0 + 0.07 * clouds.w * vec3(1.0, 0.1, -1.0));
    m.bump = -0.045 * grain.xyz - 0.05 * clouds.xyz;
    // Veins and cracks lie at the zero crossings of a noise.
    float vein = abs(noise(q * 3.1) + 0.5 * noise(q * 8.7) + 0.2 * noise(q * 23.0));
    m.albedo *= 1.0 - 0.4 * fall(0.0, 0.045, vein) * visible(12.0, footprint);
    // Travertine pits are longer than they are high.
    float pit = noise(p * vec3(17.0, 38.0, 17.0)) + 0.4 * noise(p * 71.0);
    m.albedo *= 1.0 - 0.55 * smoothstep(0.66, 0.95, pit) * visible(17.0, footprint);
    // Joints are recessed and dirty; the upper edge of a stone catches light.
    float line = 0.007 + 0.5 * footprint;
    float joint = fall(0.0, line, s.joint) * min(1.0, 0.010 / line);
    m.albedo *= 1.0 - 0.75 * joint;
    // Soot and rain leave streaks below ledges and a black crust under projections.
    float streak = noise(vec3(p.x * 5.0, p.y * 0.55, p.z * 5.0)) +
                   0.6 * noise(vec3(p.x * 13.0, p.y * 1.2, p.z * 13.0));
    float dirt = smoothstep(0.0, 1.1, streak + age) * clamp(1.0 - abs(n.y), 0.0, 1.0);
    m.albedo = mix(m.albedo, m.albedo * vec3(0.36, 0.35, 0.34), 0.75 * dirt);
    m.albedo *= n.y < -0.5 ? 0.7 : 1.0;
    // Pale grey and ochre lichen grows mostly where rain water stays.
    float patches = noise(p * 2.9 + 40.0) + 0.55 * noise(p * 9.0) + 0.4 * noise(p * 27.0);
    float lichen = smoothstep(0.62, 0.9, patches + 0.25 * n.y);
    vec3 lichen_colour = mix(vec3(0.55, 0.55, 0.48), vec3(0.52, 0.38, 0.12),
                             smoothstep(0.0, 0.5, noise(p * 1.7 + 80.0)));
    m.albedo = mix(m.albedo, lichen_colour, 0.7 * lichen);
    return m;
}

Stone monument_stone(vec3 p, vec3 n)
{
    int wall;
    vec2 uv = wall_uv(p, n, wall);
    vec2 c = vec2(abs(abs(p.x) - BAY_X) - COLUMN_OFFSET, p.z - COLUMN_Z);
    float outline = arch_outline(p.xy, ARCH_SPRING);
    bool front = wall == 1 && p.y > ARCH_SPRING && outline < 1.67 && p.y < 5.2;
    bool vault = abs(n.z) < 0.5 && outline < 1.34 && p.y > ARCH_SPRING && p.z < 0.2;
    if (front || vault) { // voussoirs
        float angle = atan(p.y - ARCH_SPRING, p.x) * 1.5;
        return ashlar(vec2(vault ? p.z : 0.2 * outline, angle), 0.36, vault ? 0.8 : 9.0, 4);
    }
    if (length(c) < 0.34 && p.y > 1.75 && p.y < 5.1) // column drums
        return ashlar(vec2(0.5, p.y), 0.95, 40.0, p.x > 0.0 ? 5 : 6);
    if (p.y < 0.56)
        return ashlar(uv, wall == 3 ? 0.5 : 0.18, 1.1, wall + 8);
    return ashlar(uv, p.y > 5.2 ? 0.45 : 0.36, p.y > 5.2 ? 1.3 : 0.75,
                  wall + (abs(p.z - 0.5) < 0.4 ? 12 : 16));
}

// Exposure to soot, which gathers under the cornices and in the passage.
float monument_age(vec3 p)
{
    float under = max(smoothstep(5.0, 5.85, p.y) * step(p.y, 6.0),
                      smoothstep(7.6, 8.0, p.y) * step(p.y, 8.05));
    float low = fall(0.5, 1.2, p.y);
    float passage = 0.5 * fall(-0.8, 0.0, p.z);
    return 0.65 * max(max(under, low), passage) - 0.55;
}

Material paving(vec3 p, float footprint)
{
    // Slabs are laid in slightly rotated rows, worn and stained.
    vec2 uv = mat2(0.966, 0.259, -0.259, 0.966) * p.xz;
    Stone s = ashlar(uv, 0.55, 0.8, 30);
    vec3 chance = spread(s.id);
    Material m;
    vec4 clouds = octaves(p + 7.0 * chance, 1.9, 4, 0.7, footprint);
    vec4 grain = octaves(p, 29.0, 3, 0.8, footprint);
    m.albedo = mix(vec3(0.34, 0.31, 0.27), vec3(0.43, 0.37, 0.29), chance.x);
    m.albedo *= (0.65 + 0.6 * chance.y) * exp(0.22 * clouds.w + 0.16 * grain.w);
    m.bump = -0.02 * grain.xyz - 0.03 * clouds.xyz;
    float line = 0.012 + 0.5 * footprint;
    float joint = fall(0.0, line, s.joint) * min(1.0, 0.016 / line);
    float moss = smoothstep(0.0, 0.6, noise(p * 0.9) + 0.5 * noise(p * 4.3));
    m.albedo = mix(m.albedo, mix(vec3(0.07, 0.06, 0.05), vec3(0.10, 0.13, 0.04), moss),
                   0.85 * joint);
    float stain = noise(p * 0.8 + 5.0) + 0.6 * noise(p * 2.3) + 0.4 * noise(p * 7.7);
    m.albedo *= 1.0 - 0.45 * smoothstep(0.25, 0.9, stain);
    float pale = noise(p * 1.3 + 31.0) + 0.5 * noise(p * 5.1) + 0.35 * noise(p * 19.0);
    m.albedo = mix(m.albedo, vec3(0.50, 0.47, 0.40), 0.4 * smoothstep(0.5, 1.0, pale));
    return m;
}

int nearest_house(vec3 p)
{
    int best = 0;
    float least = 1e9;
    for (int i = 0; i < HOUSE_COUNT; i++) {
        float d = box(p - houses[i].centre - vec3(0.0, 0.5 * houses[i].roof, 0.0),
                      houses[i].half_size + vec3(0.0, 0.5 * houses[i].roof, 0.0), 0.0);
        if (d < least) {
            least = d;
            best = i;
        }
    }
    return best;
}

Material plaster(vec3 p, vec3 n, int which, float footprint)
{
    const vec3 tints[5] = vec3[](vec3(0.62, 0.44, 0.23), vec3(0.58, 0.34, 0.22),
                                 vec3(0.64, 0.55, 0.40), vec3(0.50, 0.40, 0.28),
                                 vec3(0.60, 0.40, 0.30));
    Material m;
    vec4 clouds = octaves(p, 0.6, 6, 0.75, footprint);
    vec4 grain = octaves(p, 23.0, 2, 0.8, footprint);
    m.albedo = tints[which % 5] * exp(0.22 * clouds.w + 0.1 * grain.w);
    m.bump = -0.02 * clouds.xyz;
    // The bricks show where plaster has fallen.
    int wall;
    vec2 uv = wall_uv(p, n, wall);
    float fallen = noise(p * 0.55 + 11.0) + 0.5 * noise(p * 1.9) + 0.3 * noise(p * 6.1) +
                   0.35 * fall(0.0, 2.5, p.y);
    if (fallen > 0.42) {
        Stone brick = ashlar(uv, 0.11, 0.26, 40 + wall);
        vec3 chance = spread(brick.id);
        float mortar = fall(0.0, 0.012 + 0.5 * footprint, brick.joint) *
                       visible(4.0, footprint);
        vec3 red = mix(vec3(0.36, 0.15, 0.08), vec3(0.48, 0.27, 0.15), chance.x);
        red *= 0.6 + 0.7 * chance.y;
        m.albedo = mix(red, vec3(0.45, 0.40, 0.33), 0.7 * mortar) * exp(0.2 * clouds.w);
    }
    float streak = noise(vec3(p.x * 2.0, p.y * 0.3, p.z * 2.0)) +
                   0.6 * noise(vec3(p.x * 7.0, p.y * 0.8, p.z * 7.0));
    m.albedo *= 1.0 - 0.5 * smoothstep(0.0, 1.1, streak);
    return m;
}

Material window(vec4 w, float footprint)
{
    Material m;
    m.bump = vec3(0.0);
    vec3 chance = spread(hash_cell(ivec3(w.zw, 61)));
    vec3 wood = chance.x < 0.5 ? vec3(0.07, 0.14, 0.10)
                               : mix(vec3(0.16, 0.09, 0.05), vec3(0.12, 0.16, 0.2), chance.y);
    float slats = 0.75 + 0.25 * sin(w.y * 60.0) * visible(10.0, footprint);
    bool closed = chance.z < 0.45;
    float cross_bar = min(abs(w.x), abs(abs(w.y - 0.1) - 0.24));
    bool frame = cross_bar < 0.03 || abs(w.x) > 0.4 || abs(w.y - 0.1) > 0.66;
    vec3 glass = vec3(0.03, 0.04, 0.05) * (0.5 + chance.y);
    m.albedo = closed ? wood * slats * (abs(w.x) < 0.02 ? 0.4 : 1.0)
                      : frame ? vec3(0.42, 0.38, 0.32) : glass;
    return m;
}

Material tiles(vec3 p, float footprint)
{
    vec2 cell = floor(vec2(p.x / 0.24, length(p.zy) / 0.36));
    vec3 chance = spread(hash_cell(ivec3(cell, 71)));
    Material m;
    m.albedo = mix(vec3(0.42, 0.19, 0.10), vec3(0.52, 0.33, 0.20), chance.x);
    m.albedo *= mix(1.0, 0.55 + 0.8 * chance.y, visible(2.5, footprint));
    float ridge = cos(6.2832 * p.x / 0.24);
    m.albedo *= 1.0 + 0.3 * ridge * visible(5.0, footprint);
    m.albedo *= exp(0.3 * octaves(p, 0.8, 5, 0.75, footprint).w);
    m.bump = vec3(-0.4 * sin(6.2832 * p.x / 0.24) * visible(5.0, footprint), 0.0, 0.0);
    return m;
}

Material town_material(vec3 p, vec3 n, float footprint)
{
    int which = nearest_house(p);
    House h = houses[which];
    vec3 q = p - h.centre;
    if (n.y > 0.3 && q.y > h.half_size.y - 0.7)
        return tiles(p, footprint);
    bool front = abs(q.z) / h.half_size.z > abs(q.x) / h.half_size.x;
    vec4 w = window_cell(vec2(front ? p.x : p.z, p.y - 0.2));
    float depth = max(abs(q.x) - h.half_size.x, abs(q.z) - h.half_size.z);
    if (depth < -0.15 && abs(n.y) < 0.5 && q.y < h.half_size.y - 0.3)
        return window(w, footprint);
    Material m = plaster(p, n, which, footprint);
    float surround = box2(w.xy - vec2(0.0, 0.1), vec2(0.45, 0.72));
    if (depth > -0.1 && surround < 0.14 && q.y < h.half_size.y - 0.4)
        m.albedo = vec3(0.55, 0.50, 0.42) * exp(0.25 * octaves(p, 4.0, 4, 0.7, footprint).w);
    return m;
}

Material leaves(vec3 p, float footprint)
{
    Material m;
    vec4 n = octaves(p, 2.5, 5, 0.85, footprint);
    m.albedo = mix(vec3(0.05, 0.08, 0.03), vec3(0.13, 0.17, 0.06), 0.5 + 0.5 * n.w) *
               exp(0.35 * n.w);
    m.bump = -0.05 * n.xyz;
    return m;
}

#ifdef PLAIN
const float PLAIN_CELL = 1.2; // side of the cubes in which walls are plain or not, metres

// Walls without texture: a share of the cubes of space that walls lie in.
bool is_plain(vec3 p, int part)
{
    ivec3 cell = ivec3(floor(p / PLAIN_CELL));
    return part != PART_GROUND && part != PART_TREES && part != PART_VEHICLE &&
           spread(hash_cell(cell)).x < view_light.w;
}
#endif

Material material_at(vec3 p, vec3 n, float footprint)
{
    int part = part_at(p);
#ifdef PLAIN
    if (is_plain(p, part))
        return Material(vec3(0.46, 0.42, 0.36), vec3(0.0));
#endif
#ifdef BARS
    if (part == PART_BARS)
        return Material(vec3(0.10, 0.14, 0.12) * (fract(2.0 * p.y) < 0.5 ? 1.0 : 2.5), vec3(0.0));
#endif
#ifdef VEHICLE
    if (part == PART_VEHICLE)
        return Material(vehicle_surface(p).rgb, vec3(0.0));
#endif
    if (part == PART_GROUND)
        return paving(p, footprint);
    if (part == PART_TOWN)
        return town_material(p, n, footprint);
    if (part == PART_TREES)
        return leaves(p, footprint);
    int wall;
    vec2 uv = wall_uv(p, n, wall);
    bool arch = part == PART_MONUMENT;
    Stone s = ashlar(uv, 0.42, 0.9, 20 + wall);
    if (arch)
        s = monument_stone(p, n);
    else if (abs(p.x) < 9.0)
        s.joint = 1.0; // single stones
    Material m = stone(p, n, s, footprint, arch ? monument_age(p) : -0.4);
    // The letters hold traces of bronze.
    if (arch && p.z < -0.16 && p.z > -0.4 && abs(p.x) < 1.36 && abs(p.y - 7.2) < 0.5)
        m.albedo = mix(m.albedo, vec3(0.13, 0.085, 0.05),
                       0.9 * fall(0.0, 0.004 + 0.5 * footprint, inscription(p)));
    return m;
}
