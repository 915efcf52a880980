// Antialiasing where depth steps, for the renderer and for the page.

// Second difference of inverse depth between pixels of photographs, as a fraction of the largest
// inverse depth, at which antialiasing begins and at which it is full. The second difference of a
// plane is zero, and that of a curved surface grows with the square of a pixel's width.
const float STEP_FROM = 0.004, STEP_FULL = 0.012;

// Weight of a neighbour as a part of the pixel's own, in each direction; 0: the pixel stays as it is. It follows
// the variance of what a photograph's lens and pixels blur, in pixels of the view.
// inverse: inverse depth of the pixel; before, after: of the neighbours on both sides of it in four directions;
// footprint: pixels of a photograph in one of the view, each way.
float edge_aside(float inverse, vec4 before, vec4 after, float footprint)
{
    float area = footprint * footprint;
    vec4 bends = abs(before + after - 2.0 * inverse), largest = max(before, after);
    float bend = max(max(bends.x, bends.y), max(bends.z, bends.w));
    float most = max(max(max(largest.x, largest.y), max(largest.z, largest.w)), inverse);
    float share = (bend / (area * max(most, 1e-30)) - STEP_FROM) / (STEP_FULL - STEP_FROM);
    return 0.35 * clamp(share, 0.0, 1.0) / area;
}

// The mean of 3x3 colours, row by row, in square roots of light, so that a bright side does not swallow a dark one.
vec3 edge_mean(vec3 around[9], float aside)
{
    vec3 sum = vec3(0.0);
    for (int n = 0; n < 9; n++)
        sum += sqrt(max(around[n], 0.0)) * (n % 3 != 1 ? aside : 1.0) * (n / 3 != 1 ? aside : 1.0);
    sum /= (1.0 + 2.0 * aside) * (1.0 + 2.0 * aside);
    return sum * sum;
}
