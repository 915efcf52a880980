// Half of a PatchMatch sweep. Pixels of one checkerboard colour try the planes of the best
// neighbours of the other colour (adaptive checkerboard, Xu and Tao 2019, 3.1) and random
// variations of their own plane. Costs are taken from the sources that see the surface point.
#include "densify/densify.glsl"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(rgba32f, binding = 0) uniform image2D planes;
layout(r32f, binding = 1) uniform image2D costs;
layout(rgba32ui, binding = 2) uniform uimage2D view_costs;

// --- candidates: the best pixel of each of eight regions, best first ---

uint region_offset = 0u; // (x + 32) | (y + 32) << 8
float region_cost = 0.0;

void region_try(ivec2 at, ivec2 offset)
{
    ivec2 q = at + offset;
    if (any(lessThan(q, ivec2(0))) || any(greaterThanEqual(q, area.xy)))
        return;
    float cost = imageLoad(costs, q).r;
    if (cost < region_cost) {
        region_cost = cost;
        region_offset = uint(offset.x + 32) | uint(offset.y + 32) << 8;
    }
}

const ivec2 DIRECTIONS[4] = ivec2[4](ivec2(0, -1), ivec2(1, 0), ivec2(0, 1), ivec2(-1, 0));
const int FAR[6] = int[6](3, 5, 7, 11, 15, 23);

// Packs tests.x candidates, 16 bits each.
uvec4 find_candidates(ivec2 at)
{
    float best_cost[8];
    uint best_offset[8];
    for (int k = 0; k < 4; k++) {
        ivec2 ahead = DIRECTIONS[k], aside = ivec2(ahead.y, ahead.x);
        region_cost = 1e9;
        region_offset = 0u;
        region_try(at, ahead);
        region_try(at, 2 * ahead + aside);
        region_try(at, 2 * ahead - aside);
        region_try(at, 3 * ahead + 2 * aside);
        region_try(at, 3 * ahead - 2 * aside);
        best_cost[k] = region_cost;
        best_offset[k] = region_offset;
        region_cost = 1e9;
        region_offset = 0u;
        for (int i = 0; i < 6; i++)
            region_try(at, FAR[i] * ahead);
        best_cost[k + 4] = region_cost;
        best_offset[k + 4] = region_offset;
    }
    uvec4 found = uvec4(0u);
    for (int k = 0; k < tests.x; k++) {
        float least = 1e9;
        uint offset = 0u;
        int which = -1;
        for (int i = 0; i < 8; i++)
            if (best_cost[i] < least) {
                least = best_cost[i];
                offset = best_offset[i];
                which = i;
            }
        for (int i = 0; i < 8; i++)
            if (i == which)
                best_cost[i] = 1e9;
        uint bits = offset << (16 * (k & 1));
        found |= uvec4(k < 2 ? bits : 0u, k >= 2 && k < 4 ? bits : 0u,
                        k >= 4 && k < 6 ? bits : 0u, k >= 6 ? bits : 0u);
    }
    return found;
}

// --- selection of the sources that see the surface point ---

// Sources that match well at this pixel and around it are assumed to see the surface point, which
// needs no further matching. Their weights fall gradually, so that one good source is enough where
// only one sees the point, and occluded sources have little influence.
struct selection {
    uint views;     // index of the k-th best source, 4 bits each
    uvec4 weights;  // one byte for each of these sources
};

// A neighbour outside the picture is replaced by the pixel itself.
ivec2 inside_or_self(ivec2 at, ivec2 offset)
{
    ivec2 q = at + offset;
    bool inside = all(greaterThanEqual(q, ivec2(0))) && all(lessThan(q, area.xy));
    return inside ? q : at;
}

selection select_views(ivec2 at)
{
    float score[SOURCES];
    for (int view = 0; view < SOURCES; view++)
        score[view] = 0.0;
    // Reads this pixel and pixels of the other colour; those of its own colour are being written.
    for (int i = 0; i < 9; i++) {
        ivec2 offset = i == 0 ? ivec2(0) : (i < 5 ? 1 : 3) * DIRECTIONS[(i - 1) & 3];
        uvec4 codes = imageLoad(view_costs, inside_or_self(at, offset));
        for (int view = 0; view < SOURCES; view++) {
            float good = max(1.0 - 1.2 * cost_unpack(get_byte(codes, view)), 0.0);
            score[view] += good * good;
        }
    }
    for (int view = 0; view < SOURCES; view++)
        score[view] = (score[view] + 0.02) * extent[view].z;
    selection chosen = selection(0u, uvec4(0u));
    float greatest = 0.0;
    for (int k = 0; k < tests.z; k++) {
        float most = -1.0;
        int which = 0;
        for (int view = 0; view < SOURCES; view++)
            if (score[view] > most) {
                most = score[view];
                which = view;
            }
        for (int view = 0; view < SOURCES; view++)
            if (view == which)
                score[view] = -1.0;
        greatest = k == 0 ? max(most, 1e-6) : greatest;
        chosen.views |= uint(which) << (4 * k);
        uint weight = most > 0.0 ? uint(int(clamp(250.0 * most / greatest, 0.0, 250.0))) + 5u : 0u;
        chosen.weights = set_byte(chosen.weights, k, weight);
    }
    return chosen;
}

// --- variations ---

// Takes the slopes from the inverse depths of the four neighbours, which have the other colour.
vec3 fitted_plane(ivec2 at, vec3 plane)
{
    ivec2 low = max(at - 1, ivec2(0)), high = min(at + 1, area.xy - 1); // or this pixel
    float left = imageLoad(planes, ivec2(low.x, at.y)).x;
    float right = imageLoad(planes, ivec2(high.x, at.y)).x;
    float up = imageLoad(planes, ivec2(at.x, low.y)).x;
    float down = imageLoad(planes, ivec2(at.x, high.y)).x;
    return vec3(plane.x, (right - left) / float(max(high.x - low.x, 1)),
                (down - up) / float(max(high.y - low.y, 1)));
}

vec3 varied_plane(ivec2 at, vec2 pixel, vec3 plane, int kind)
{
    float nudge = tune.x * range.z * random_signed();
    float w = plane.x + nudge;
    if (kind == 0) // depth
        return vec3(w, plane.yz * (w / plane.x));
    if (kind == 1) // normal
        return turned_plane(plane.x, plane, pixel, tune.y);
    if (kind == 2) // both
        return turned_plane(w, plane, pixel, tune.y);
    if (kind == 3)
        return fitted_plane(at, plane);
    vec3 other = random_plane(pixel);
    if (kind == 4) // new depth, same normal
        return plane * (other.x / plane.x);
    return other;
}

// A candidate's plane, continued to this pixel; away: from this pixel to the candidate. False: there is no such candidate.
bool candidate_plane(ivec2 at, uvec4 candidates, int k, out ivec2 away, out vec3 plane)
{
    uint word = k < 4 ? (k < 2 ? candidates.x : candidates.y) : (k < 6 ? candidates.z : candidates.w);
    uint offset = (word >> (16 * (k & 1))) & 0xffffu;
    away = ivec2(int(offset & 255u) - 32, int(offset >> 8) - 32);
    plane = imageLoad(planes, at + away).xyz;
    plane.x -= dot(plane.yz, vec2(away));
    return offset != 0u;
}

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy) + ivec2(0, area.z);
    at.x = 2 * at.x + ((at.y + run.z) & 1);
    if (at.x >= area.x || at.y >= area.w || !(texelFetch(reference, at, 0).g > 0.0))
        return;
    vec2 pixel = pixel_centre(at);
    random_start(at);
    load_patch(at);
    uvec4 candidates = find_candidates(at);
    vec3 best_plane = imageLoad(planes, at).xyz;
    ivec2 away;
#ifdef GEOMETRIC
    float best = imageLoad(costs, at).r;
    for (int turn = 0; turn < tests.x + tests.y; turn++) {
        vec3 plane = best_plane;
        if (turn < tests.x) {
            if (!candidate_plane(at, candidates, turn, away, plane))
                continue;
        } else {
            plane = varied_plane(at, pixel, best_plane, turn - tests.x);
        }
        if (!plane_valid(plane, pixel))
            continue;
        float cost = agreed_cost(plane, pixel, best);
        if (cost < best) {
            best = cost;
            best_plane = plane;
        }
    }
    imageStore(planes, at, vec4(best_plane, 0.0));
    imageStore(costs, at, vec4(best));
#else
    selection chosen = select_views(at);
    uvec4 best_views = imageLoad(view_costs, at);
    float best = 0.0, total = 0.0;
    for (int k = 0; k < tests.z; k++) {
        float weight = float(int(get_byte(chosen.weights, k)));
        int view = int(chosen.views >> (4 * k)) & 15;
        best += weight * cost_unpack(get_byte(best_views, view));
        total += weight;
    }
    // The last turn tries no plane: it updates the cost in one more source.
    for (int turn = 0; turn <= tests.x + tests.y; turn++) {
        bool refresh = turn == tests.x + tests.y;
        vec3 plane = best_plane;
        uvec4 views = best_views;
        if (turn < tests.x) {
            if (!candidate_plane(at, candidates, turn, away, plane))
                continue;
            views = imageLoad(view_costs, at + away);
        } else if (!refresh) {
            plane = varied_plane(at, pixel, best_plane, turn - tests.x);
        }
        if (!refresh && !plane_valid(plane, pixel))
            continue;
        float sum = 0.0;
        int count = refresh ? 1 : tests.z;
        for (int k = 0; k < count; k++) {
            int view = refresh ? int(uint(at.x + at.y / 2 + run.y) % uint(SOURCES))
                               : int(chosen.views >> (4 * k)) & 15;
            float cost = extent[view].z > 0.0 ? view_cost(view, plane, pixel) : COST_MAX;
            views = set_byte(views, view, cost_pack(cost));
            sum += float(int(get_byte(chosen.weights, k))) * cost;
            if (!refresh && sum >= best)
                break;
        }
        if (refresh || sum < best) {
            best = refresh ? best : sum;
            best_plane = plane;
            best_views = views;
        }
    }
    imageStore(planes, at, vec4(best_plane, 0.0));
    imageStore(costs, at, vec4(total > 0.0 ? best / total : COST_MAX));
    imageStore(view_costs, at, best_views);
#endif
}
