// Whether a pixel of the rebuilt depth stays, and whether a hole closes, for the renderer and for the page.

// Depths that agree with a pixel's: least, most. With a hole's (0) every depth does.
vec2 support_range(float depth)
{
    return depth > 0.0 ? vec2(0.97, 1.03) * depth : vec2(1e-30, 1e30);
}

bool support_keeps(float depth, float agree, float min_support)
{
    return depth > 0.0 && agree >= min_support;
}

// Depths around 2x2 pixels, 6x6 in all: separate ones for each of the four would double the cost.
struct depths_around {
    float known, sum, near, far;
};

depths_around no_depths()
{
    return depths_around(0.0, 0.0, 1e30, 0.0);
}

void add_depth(inout depths_around a, float z)
{
    a.known += z > 0.0 ? 1.0 : 0.0;
    a.sum += z;
    a.near = min(a.near, z > 0.0 ? z : a.near);
    a.far = max(a.far, z);
}

// The depth of a pixel, which is kept or not. A hole is closed if most of its 5x5 neighbourhood has one surface.
float supported_depth(float depth, bool keep, float agree, depths_around a)
{
    bool close = depth == 0.0 && agree >= 13.0 && a.far < 1.06 * a.near;
    return keep ? depth : close ? a.sum / a.known : 0.0;
}
