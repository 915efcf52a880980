// Values of the pyramid that guesses depth, for the renderer and for the page: inverse depth in x and its slope in yz,
// per pixel of the level, each times the weight in a. Inverse depth is linear on a plane.

// Share of its slope that a surface keeps for a block of twice the size: the farther from the
// surface, the less its slope says.
const float SLOPE_KEPT = 0.8;

// A surface that is seen at a flatter angle, as a cosine, counts as if it faced the view: what its
// slope would give grows without limit.
const float FACING_MIN = 0.1;

// The value of a surface for the centre of its 2x2 pixels, `by` pixels away. Its weight is so steep towards far
// surfaces that a hole continues the farther side of its rim, the visible background, rather than what lies between
// the two sides. ray: of the pixel, at unit depth; focal: fx, fy; typical: depth of weight 1.
vec4 slope_seed(float z, vec3 normal, vec3 ray, vec2 focal, float typical, vec2 by)
{
    float facing = dot(normal, ray);
    vec2 slope = normal.xy / (focal * z * facing);
    slope = abs(facing) > FACING_MIN * length(ray) ? slope : vec2(0.0);
    float far = z / typical, far2 = far * far, far4 = far2 * far2, far8 = far4 * far4;
    float weight = clamp(far8 * far4 * far2, 1e-15, 1e15); // the 14th power; sums fit floats
    return vec4(1.0 / z + dot(slope, by), 2.0 * slope, 1.0) * weight;
}

// The same value, moved to where another pixel of the level is.
vec4 slope_moved(vec4 value, vec2 by)
{
    value.x += dot(value.yz, by);
    return value;
}

// For a pixel of the coarser level, whose centre is `by` pixels away.
vec4 slope_pulled(vec4 value, vec2 by)
{
    value = slope_moved(value, by);
    value.yz *= 2.0 * SLOPE_KEPT;
    return value;
}

// Weights that differ by many powers of ten would let the farther value win as far as its bilinear
// weight reaches, and there end in a line. So values are interpolated with the fourth roots of their
// weights. The weight itself is interpolated likewise, and keeps its scale.
vec4 slope_soft(vec4 value)
{
    return value.a > 0.0 ? value * (sqrt(sqrt(value.a)) / value.a) : vec4(0.0);
}

vec4 slope_hard(vec4 value)
{
    value.yz *= 0.5; // pixels of the finer level are half as large
    return value * (value.a * value.a * value.a);
}

// The guessed depth of a pixel, negative, no farther than the ground. value: its weight is above 0; least: inverse
// depth, since surfaces that recede would continue beyond infinity; ground: dot(xyz, ray) is the inverse depth of the
// ground, w the least that counts.
float slope_guess(vec4 value, float least, vec4 ground, vec3 ray)
{
    float on_ground = dot(ground.xyz, ray);
    return -1.0 / max(max(value.r / value.a, least), on_ground > ground.w ? on_ground : 0.0);
}
