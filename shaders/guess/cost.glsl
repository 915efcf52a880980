// Costs of the planes of an open cell: how many photographs see past it, how much those of its tile
// differ when they are projected to it (plane sweep of Collins 1996), and how far it is from the depth
// that was estimated from the surfaces around. The file that includes this one defines
//   float depth_at(ivec2 at): the view's depth; < 0: estimated, 0: outside;
//   int photo_to_ask(ivec2 cell, int c): number c of the photographs of the cell's tile; -1: no more;
// and min_inverse, the inverse depth of the farthest estimate.
#include "gather/penalty.glsl"
#include "gather/hidden.glsl"
#include "gather/sample/srgb.glsl"
#include "guess/planes.glsl"

const int AT_ONCE = 4; // planes for which the parameters of a photograph are loaded once
const int ASKED = 3;   // photographs of a tile, at most: its worst ones say no more of the depth
// Cost of photographs that differ, at most, and at which difference in square roots of light. It is
// less than the cost of being seen past: photographs that show the sky or a black cloth agree at any
// depth, and those that show different things at one depth do not say which depth is right.
const float DIFFER_COST = 0.3, DIFFER_MAX = 0.15;
// Cost of leaving the estimate by FAR planes or more, and by fewer in proportion.
const float PRIOR = 0.2, FAR = 4.0;

// Mean inverse depth of the estimates at 4x4 places of a cell; 0: there are none.
float open_estimate(ivec2 cell)
{
    float sum = 0.0, count = 0.0;
    for (int k = 0; k < 16; k++) {
        ivec2 at = CELL * cell + (2 * ivec2(k & 3, k >> 2) + 1) * CELL / 8;
        float z = depth_at(at);
        sum += z < 0.0 ? -1.0 / z : 0.0;
        count += z < 0.0 ? 1.0 : 0.0;
    }
    return count > 0.0 ? sum / count : 0.0;
}

// What the photographs say of a point.
struct statistics {
    vec4 sum;      // colour * weight, weight
    float squares; // of colours, times weight
    float weights; // squares of the weights
    float past;    // weight of the photographs that see a surface behind the point
};

void ask(photo source, bool listed, vec3 p, inout statistics o)
{
    vec2 pixel;
    float z;
    bool inside = photo_project(source, p, pixel, z) && listed;
    vec4 seen = photo_depths(source, pixel);
    vec4 behind = clamp((seen - z) * (1.0 / (z * opt.depth_tolerance)) - 1.0, 0.0, 1.0);
    float past = dot(behind, vec4(0.25)), penalty = photo_penalty(source, p);
    float weight = photo_border(source, pixel) * photo_beside(penalty) / (penalty + 0.05);
    weight = inside ? weight : 0.0;
    float open = weight * photo_unhidden_share(source, seen, z), counts = open * (1.0 - past);
    // A texel of this level is as large as half a cell.
    float mip = photo_mip(source, z, p.z) + log2(0.5 * float(CELL));
    vec3 color = photo_bilinear(source, pixel, floor(min(mip, last_mip) + 0.5)).rgb;
    color = sqrt(photo_light(source, pixel, color));
    o.sum += vec4(color, 1.0) * counts;
    o.squares += dot(color, color) * counts;
    o.weights += counts * counts;
    o.past += open * past;
}

// The share of the photographs that see past the point, of those in which nothing hides it, plus
// how much the others differ: most if fewer than two are left.
float cost_of(statistics o)
{
    float weight = max(o.sum.a, 1e-30);
    float effective = weight * weight / max(o.weights, 1e-30); // effective number of photographs
    vec3 mean = o.sum.rgb / weight;
    float variance = max(o.squares / weight - dot(mean, mean), 0.0) * effective /
                     max(effective - 1.0, 0.5);
    float differ = min(sqrt(variance) / DIFFER_MAX, 1.0);
    return DIFFER_COST * mix(1.0, differ, clamp(effective - 1.0, 0.0, 1.0)) +
           o.past / max(o.past + o.sum.a, 1e-30);
}

// Costs of the planes from `first` on; estimate: of the cell, as open_estimate has it.
vec4 plane_costs(ivec2 cell, float estimate, int first)
{
    vec2 centre = (vec2(cell) + 0.5) * float(CELL);
    vec3 ray = vec3((centre - view_focal.zw) / view_focal.xy, 1.0);
    statistics planes[AT_ONCE];
    for (int n = 0; n < AT_ONCE; n++)
        planes[n] = statistics(vec4(0.0), 0.0, 0.0, 0.0);
    int c = 0, i = photo_to_ask(cell, 0);
    do { // the condition comes last: see tiled.comp
        photo source = photo_at(max(i, 0));
        for (int n = 0; n < AT_ONCE; n++)
            ask(source, i >= 0,
                ray / max(estimate * plane_share(first + n), min_inverse),
                planes[n]);
        c++;
        i = c < ASKED ? photo_to_ask(cell, c) : -1;
    } while (i >= 0);
    vec4 costs;
    for (int n = 0; n < AT_ONCE; n++)
        costs[n] = cost_of(planes[n]) + PRIOR * min(float(first + n) / FAR, 1.0);
    return costs;
}
