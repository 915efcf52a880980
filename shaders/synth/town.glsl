// The surroundings of the monument: fragments in the foreground, houses, trees.

struct House {
    vec3 centre;    // of the walls' box
    vec3 half_size;
    float roof;     // rise of the gable above the walls, ridge along x; 0: flat
};
const int HOUSE_COUNT = 8;
const House houses[HOUSE_COUNT] = House[](
    House(vec3(-10.5, 4.0, -14.0), vec3(4.5, 4.0, 3.0), 1.5),
    House(vec3(-1.0, 3.2, -19.0), vec3(5.0, 3.2, 3.0), 1.6),
    House(vec3(8.5, 4.8, -15.5), vec3(4.2, 4.8, 3.5), 1.7),
    House(vec3(4.6, 8.5, -25.0), vec3(1.9, 8.5, 1.9), 2.2),
    House(vec3(-20.0, 3.6, -4.0), vec3(3.0, 3.6, 6.0), 1.6),
    House(vec3(20.5, 4.2, -5.0), vec3(3.0, 4.2, 6.0), 1.8),
    House(vec3(-20.0, 5.0, -19.0), vec3(5.0, 5.0, 5.0), 1.6),
    House(vec3(21.0, 3.4, -21.0), vec3(6.0, 3.4, 5.0), 1.6));

const int TREE_COUNT = 5;
const vec4 trees[TREE_COUNT] = vec4[]( // x, z, height, girth
    vec4(-6.6, -7.5, 7.2, 0.85), vec4(-15.6, -8.0, 8.4, 1.0), vec4(13.6, -9.0, 8.8, 1.05),
    vec4(10.4, -9.6, 6.4, 0.8), vec4(15.3, -11.5, 7.0, 0.9));

const float WINDOW_X = 2.1, WINDOW_Y = 2.7; // spacing of windows, metres

// Position within the window grid of a facade: xy: relative to the window's middle, zw: the
// window's cell.
vec4 window_cell(vec2 uv)
{
    vec2 spacing = vec2(WINDOW_X, WINDOW_Y);
    vec2 cell = floor(uv / spacing);
    return vec4(uv - (cell + 0.5) * spacing, cell);
}

float house(vec3 p, House h)
{
    vec3 q = p - h.centre;
    float walls = box(q, h.half_size, 0.03);
    float gable_top = h.half_size.y + h.roof * (1.0 - abs(q.z) / h.half_size.z);
    float slope = h.half_size.z / length(vec2(h.half_size.z, h.roof));
    float gable = max(box(q, h.half_size + vec3(0.0, h.roof, 0.0), 0.0),
                      (q.y - gable_top) * slope);
    float d = min(walls, gable);
    if (d < 0.6) {
        bool front = abs(q.z) / h.half_size.z > abs(q.x) / h.half_size.x;
        vec2 uv = vec2(front ? p.x : p.z, p.y - 0.2);
        vec4 w = window_cell(uv);
        if (q.y < h.half_size.y - 0.4)
            d = max(d, -max(box2(w.xy - vec2(0.0, 0.1), vec2(0.45, 0.72)), -walls - 0.22));
    }
    float roof = max(abs((q.y - gable_top - 0.06) * slope) - 0.08,
                     box(q, h.half_size + vec3(0.4, h.roof + 0.5, 0.45), 0.0));
    return min(d, roof);
}

// A bay window (an oriel) on the house to the right.
float bay_window(vec3 p)
{
    vec3 q = p - vec3(6.6, 5.4, -11.7);
    float bound = length(q) - 2.4;
    if (bound > 0.5)
        return bound;
    vec2 plan = vec2(abs(q.x), q.z);
    float sides = max(max(plan.y - 0.9, plan.x - 1.1), dot(plan, vec2(0.7071)) - 1.15);
    float body = max(sides, abs(q.y) - 1.2);
    body = max(body, -max(max(abs(abs(q.x) - 0.27) - 0.2, abs(q.y - 0.1) - 0.75), 0.75 - q.z));
    float foot = max(sides + 0.55 * max(-1.2 - q.y, 0.0), abs(q.y + 1.6) - 0.42);
    float cap = max(sides + 0.8 * (q.y - 1.45), abs(q.y - 1.55) - 0.4);
    float d = min(body, min(0.8 * foot, 0.7 * cap));
    return min(d, max(sides - 0.1, abs(abs(q.y) - 1.22) - 0.06));
}

float tree(vec3 p, vec4 t)
{
    vec3 q = p - vec3(t.x, 0.55 * t.z, t.y);
    float d = ellipsoid(q, vec3(t.w, 0.52 * t.z, t.w));
    if (d > 0.5)
        return d - 0.25;
    float leaves = 0.16 * noise(p * 2.7) + 0.09 * noise(p * 7.0) + 0.04 * noise(p * 15.0);
    return 0.6 * min(d + leaves, max(length(q.xz) - 0.14, q.y));
}

float town(vec3 p)
{
    float d = 1e3;
    for (int i = 0; i < HOUSE_COUNT; i++) {
        float bound = box(p - houses[i].centre - vec3(0.0, 0.7, 0.0),
                          houses[i].half_size + vec3(0.5, 1.8, 0.6), 0.0);
        if (bound < d)
            d = min(d, bound > 0.5 ? bound : house(p, houses[i]));
    }
    d = min(d, bay_window(p));
    return d;
}

float forest(vec3 p)
{
    float d = 1e3;
    for (int i = 0; i < TREE_COUNT; i++)
        d = min(d, tree(p, trees[i]));
    return d;
}

// Fallen stones, a capital, a pair of bollards and the low wall around the square.
float fragments(vec3 p)
{
    float bound = box(p - vec3(0.0, 0.8, 1.5), vec3(8.6, 0.9, 3.2), 0.0);
    float wall = min(box(p - vec3(-12.6, 0.55, -6.0), vec3(0.3, 0.55, 9.0), 0.03),
                     box(p - vec3(12.8, 0.55, -7.0), vec3(0.3, 0.55, 8.0), 0.03));
    if (bound > 0.5)
        return min(bound, wall);
    vec3 q = p - vec3(-6.3, 0.4, 2.6);
    q.xz = mat2(0.8, 0.6, -0.6, 0.8) * q.xz;
    float angle = atan(q.z, q.y);
    float drum = max(length(q.yz) - 0.42 + 0.02 * abs(sin(9.0 * angle)), abs(q.x) - 0.62);
    q = p - vec3(6.6, 0.3, 1.9);
    q.xz = mat2(0.9, -0.436, 0.436, 0.9) * q.xz;
    q.xy = mat2(0.985, 0.17, -0.17, 0.985) * q.xy;
    float block = box(q, vec3(0.62, 0.36, 0.42), 0.04);
    block = max(block, -(dot(q, normalize(vec3(-1.0, 1.0, 0.6))) - 0.52) * -1.0 - 0.02);
    q = p - vec3(7.35, 0.2, 2.75);
    float small_block = box(q, vec3(0.3, 0.26, 0.24), 0.05);
    float d = min(0.85 * drum, min(block, small_block));
    vec3 b = vec3(abs(p.x) - 4.4, p.y, p.z - 3.3);
    float post = max(length(b.xz) - 0.17 + 0.03 * b.y, abs(b.y - 0.35) - 0.37);
    post = min(post, length(b - vec3(0.0, 0.78, 0.0)) - 0.18);
    post = min(post, torus_y(b - vec3(0.0, 0.6, 0.0), 0.14, 0.035));
    post = min(post, box(b - vec3(0.0, 0.06, 0.0), vec3(0.25, 0.07, 0.25), 0.02));
    d = min(d, post);
    if (d < 0.08)
        d += 0.012 * noise(p * 6.0);
    return min(d, wall);
}

#ifdef BARS
const float BAR_SPACING = 1.6, BAR_TOP = 5.0, BAR_Z = 2.6;
const int BARS_ASIDE = 3; // on each side of the middle one

// A row of upright round bars before the monument.
float bars(vec3 p)
{
    float x = p.x - BAR_SPACING * clamp(round(p.x / BAR_SPACING), float(-BARS_ASIDE),
                                        float(BARS_ASIDE));
    return max(length(vec2(x, p.z - BAR_Z)) - view_light.z, p.y - BAR_TOP);
}
#endif

const int PART_MONUMENT = 0, PART_FRAGMENTS = 1, PART_TOWN = 2, PART_TREES = 3, PART_GROUND = 4,
          PART_BARS = 5, PART_VEHICLE = 6;

// All surfaces except the ground, whose intersection with rays has a closed form.
float solids(vec3 p)
{
    float d = min(monument(p), fragments(p));
    // No tree stands in front of z = -6.3, and no house within the square.
    if (p.z + 6.3 < d)
        d = min(d, forest(p));
    if (min(16.5 - abs(p.x), p.z + 10.5) < d)
        d = min(d, town(p));
#ifdef BARS
    d = min(d, bars(p));
#endif
#ifdef VEHICLE
    d = min(d, vehicle(p));
#endif
    return d;
}

int part_at(vec3 p)
{
    float m = monument(p), f = fragments(p), t = town(p), v = forest(p), g = p.y;
    float least = min(min(min(m, f), min(t, v)), g);
#ifdef BARS
    if (bars(p) < least)
        return PART_BARS;
#endif
#ifdef VEHICLE
    if (vehicle(p) < least)
        return PART_VEHICLE;
#endif
    if (least == g)
        return PART_GROUND;
    if (least == m)
        return PART_MONUMENT;
    return least == f ? PART_FRAGMENTS : least == t ? PART_TOWN : PART_TREES;
}
