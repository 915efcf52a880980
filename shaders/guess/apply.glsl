// Moves the estimated background depth of an open cell to where it was picked, interpolated between cells,
// no farther than the ground; for the renderer and for the page. The file that includes this one defines
//   float share_of(ivec2 cell): picked share of inverse depth; 1: unmoved; outside: of the nearest cell;
// and min_inverse, the inverse depth of the farthest estimate.

// depth: of the pixel, < 0.
float moved(ivec2 at, float depth)
{
    vec2 place = (vec2(at) + 0.5) / float(CELL) - 0.5, part = fract(place);
    float share = 0.0;
    for (int k = 0; k < 4; k++) {
        float other = share_of(ivec2(floor(place)) + ivec2(k & 1, k >> 1));
        float weight = ((k & 1) == 0 ? 1.0 - part.x : part.x) * (k < 2 ? 1.0 - part.y : part.y);
        share += other * weight;
    }
    float on_ground = dot(ground.xyz, vec3((vec2(at) + 0.5 - view_focal.zw) / view_focal.xy, 1.0));
    float inverse = max(share / -depth, min_inverse);
    return -1.0 / max(inverse, on_ground > ground.w ? on_ground : 0.0);
}
