// A soft splat: an ellipsoid whose opacity falls as a Gaussian, and how a view shows it (Zwicker 2001, EWA
// splatting; Kerbl 2023, 3D Gaussian splatting), for the renderer and for the page. The file that includes this one
// defines focal and view_rotation().

#include "soft/opacity.glsl"

const float HARMONIC_0 = 0.28209479; // the constant spherical harmonic, as in files of Gaussian splatting
// Variance that every splat's projection gains, pixels^2, so that none is narrower than a pixel (Kerbl 2023).
const float LOW_PASS = 0.3;
const float NEAR = 1e-3;   // of the scene's units: nothing nearer is drawn
const float OUTSIDE = 0.3; // of the picture: the affine approximation does not hold farther outside

struct splat {
    vec3 position, sigma; // world; standard deviations along the axes
    float opacity;
    vec4 turn;            // unit quaternion wxyz
    float turn_length;    // of the quaternion as stored
};

// Columns: the splat's axes in the world.
mat3 splat_axes(vec4 q)
{
    float w = q.x, x = q.y, y = q.z, z = q.w;
    return mat3(1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y),
                2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x),
                2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y));
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

// The colour, sRGB, of this coefficient.
vec3 splat_color(vec3 harmonic)
{
    return 0.5 + HARMONIC_0 * harmonic;
}

// Shows a splat, without its colour, in a view of this size. p: its place in the camera frame; pixel: the size of a
// photograph's pixel there, pixels of the view; reach: how far from the centre it is drawn. False: it is not seen.
bool splat_seen(splat s, vec3 p, vec2 size, float pixel, out seen_splat seen, out vec2 reach)
{
    seen = seen_splat(focal.xy * p.xy / p.z + focal.zw, vec3(0.0), 0.0, vec3(0.0));
    reach = vec2(0.0);
    if (!(p.z > NEAR) || s.opacity < OPACITY_MIN)
        return false;
    if (any(lessThan(seen.centre, -OUTSIDE * size)) || any(greaterThan(seen.centre, (1.0 + OUTSIDE) * size)))
        return false;
    mat2x3 m = splat_footprint(s, p);
    float xx = dot(m[0], m[0]), xy = dot(m[0], m[1]), yy = dot(m[1], m[1]);
    // The splat was adjusted as LOW_PASS pixels of a photograph made it, which are so many of this view's. No splat is
    // sharper than that; in a view of fewer pixels it is blurred over one, and as much fainter.
    float adjusted = LOW_PASS * (pixel * pixel), blur = max(adjusted, LOW_PASS);
    float determinant_adjusted = (xx + adjusted) * (yy + adjusted) - xy * xy;
    xx += blur;
    yy += blur;
    float determinant = xx * yy - xy * xy;
    if (!(determinant > 0.0))
        return false;
    seen.opacity = s.opacity * sqrt(clamp(determinant_adjusted / determinant, 0.0, 1.0));
    seen.inverse = vec3(yy, -xy, xx) / determinant;
    if (seen.opacity < OPACITY_MIN)
        return false;
    // As far as its opacity is drawn.
    reach = sqrt(2.0 * log(seen.opacity / OPACITY_MIN) * vec2(xx, yy));
    return !any(lessThan(seen.centre + reach, vec2(0.0))) && !any(greaterThan(seen.centre - reach, size));
}
