// Picks the plane of each open cell. What the renderer's smooth.comp keeps of the paths along a line of cells is
// made anew for each cell, from the closed cell before it on, since a fragment cannot hand on what it has.
#include "guess/path.glsl"
#include "guess/pick.glsl"

uniform sampler2D costs; // guess_cost.frag
layout(location = 0) out float picked; // share of the guess's inverse depth; 1: the guess itself

bool is_open(ivec2 cell)
{
    ivec2 area = textureSize(costs, 0) / ivec2(TEXELS, 1);
    return all(greaterThanEqual(cell, ivec2(0))) && all(lessThan(cell, area)) &&
           texelFetch(costs, ivec2(TEXELS * cell.x, cell.y), 0).x != CLOSED;
}

void costs_of(ivec2 cell, out float own[PLANES])
{
    for (int t = 0; t < TEXELS; t++) {
        vec4 some = texelFetch(costs, ivec2(TEXELS * cell.x + t, cell.y), 0);
        for (int n = 0; n < 4 && 4 * t + n < PLANES; n++)
            own[4 * t + n] = some[n];
    }
}

void main()
{
    ivec2 cell = ivec2(gl_FragCoord.xy);
    picked = 1.0;
    if (!is_open(cell))
        return;
    float own[PLANES], path[PLANES], sums[PLANES];
    for (int k = 0; k < PLANES; k++)
        sums[k] = 0.0;
    for (int along = 0; along < 4; along++) {
        ivec2 ahead = (1 - 2 * (along & 1)) * (along < 2 ? ivec2(1, 0) : ivec2(0, 1));
        int steps = 0;
        while (is_open(cell - (steps + 1) * ahead))
            steps++;
        float least = 0.0;
        for (int k = 0; k < PLANES; k++)
            path[k] = 0.0;
        for (; steps >= 0; steps--) {
            costs_of(cell - steps * ahead, own);
            path_step(own, path, least);
        }
        for (int k = 0; k < PLANES; k++)
            sums[k] += path[k];
    }
    picked = picked_share(sums);
}
