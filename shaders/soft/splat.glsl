// A soft splat: an ellipsoid whose opacity falls as a Gaussian, and its projection (Zwicker 2001, EWA
// splatting; Kerbl 2023, 3D Gaussian splatting).
#define BLOCK_SOFT
#include "shared/soft_blocks.h"

// ORL_SOFT_VEC4S of each. Buffers are read as images: storage reads take a software renderer several times as long.
layout(rgba32f, binding = 2) uniform imageBuffer splats;

vec4 splat_row(int i, int row)
{
    return imageLoad(splats, ORL_SOFT_VEC4S * i + row);
}

// Opacities below this are not drawn, and none is above OPACITY_MAX.
const float OPACITY_MIN = 1.0 / 255.0, OPACITY_MAX = 0.99;
// A ray that less than this of passes through all splats so far ends.
const float PASSES_MIN = 1e-3;
// Spherical harmonics of degrees 0 and 1.
const float HARMONIC_0 = 0.28209479, HARMONIC_1 = 0.48860251;

struct splat {
    vec3 position, sigma; // world; standard deviations along the axes
    float opacity;
    vec4 turn;            // unit quaternion wxyz
    float turn_length;    // of the quaternion as stored
};

splat splat_at(int i)
{
    vec4 a = splat_row(i, 0), b = splat_row(i, 1), q = splat_row(i, 2);
    float size = max(length(q), 1e-12);
    return splat(a.xyz, exp(b.xyz), 1.0 / (1.0 + exp(-a.w)), q / size, size);
}

// Coefficient k of the colour, of 4.
vec3 splat_harmonic(int i, int k)
{
    vec4 a = splat_row(i, 3), b = splat_row(i, 4), c = splat_row(i, 5);
    return k == 0 ? a.rgb : k == 1 ? vec3(a.a, b.rg) : k == 2 ? vec3(b.ba, c.r) : c.gba;
}

// Columns: the splat's axes in the world.
mat3 splat_axes(vec4 q)
{
    float w = q.x, x = q.y, y = q.z, z = q.w;
    return mat3(1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y),
                2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x),
                2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y));
}

mat3 view_rotation()
{
    return transpose(mat3(rotation[0].xyz, rotation[1].xyz, rotation[2].xyz));
}

// The affine approximation of the projection at a point of the camera frame: rows of its Jacobian.
mat2x3 splat_jacobian(vec3 p)
{
    return mat2x3(focal.x / p.z, 0.0, -focal.x * p.x / (p.z * p.z),
                  0.0, focal.y / p.z, -focal.y * p.y / (p.z * p.z));
}

// Rows of the map from the splat's own unit sphere to pixels.
mat2x3 splat_footprint(splat s, vec3 p)
{
    mat2x3 jacobian = splat_jacobian(p);
    mat3 to_axes = transpose(splat_axes(s.turn)), to_world = transpose(view_rotation());
    return mat2x3(s.sigma * (to_axes * (to_world * jacobian[0])), s.sigma * (to_axes * (to_world * jacobian[1])));
}
