// Projects the splats into a view.
#include "soft/splat.glsl"

layout(local_size_x = ORL_POINT_GROUP) in;
layout(rgba32f, binding = 6) writeonly uniform imageBuffer projected;
layout(std430, binding = 2) writeonly buffer splat_bounds {
    uint bounds[];
};

const float NEAR = 1e-3;   // of the scene's units: nothing nearer is drawn
const float OUTSIDE = 0.3; // of the picture: the affine approximation does not hold farther outside

void main()
{
    int i = int(gl_GlobalInvocationID.x);
    if (i >= splat_count)
        return;
    bounds[ORL_SOFT_BOUND_WORDS * i] = 0u;
    splat s = splat_at(i);
    vec3 from_eye = s.position - eye.xyz, p = view_rotation() * from_eye;
    if (!(p.z > NEAR) || s.opacity < OPACITY_MIN)
        return;
    vec2 centre = focal.xy * p.xy / p.z + focal.zw, size = vec2(view_size);
    if (any(lessThan(centre, -OUTSIDE * size)) || any(greaterThan(centre, (1.0 + OUTSIDE) * size)))
        return;
    mat2x3 m = splat_footprint(s, p);
    float xx = dot(m[0], m[0]), xy = dot(m[0], m[1]), yy = dot(m[1], m[1]);
    // The splat was adjusted as low_pass pixels of a photograph made it, which are so many of this view's. No splat is
    // sharper than that; in a view of fewer pixels it is blurred over one, and as much fainter.
    float pixel = splat_row(i, 1).w * focal.x / p.z, adjusted = low_pass * (smooths > 0.0 ? pixel * pixel : 1.0);
    float blur = max(adjusted, low_pass);
    float determinant_adjusted = (xx + adjusted) * (yy + adjusted) - xy * xy;
    xx += blur;
    yy += blur;
    float determinant = xx * yy - xy * xy;
    if (!(determinant > 0.0))
        return;
    s.opacity *= sqrt(clamp(determinant_adjusted / determinant, 0.0, 1.0));
    if (s.opacity < OPACITY_MIN)
        return;
    // As far as its opacity is drawn.
    vec2 reach = sqrt(2.0 * log(s.opacity / OPACITY_MIN) * vec2(xx, yy));
    if (any(lessThan(centre + reach, vec2(0.0))) || any(greaterThan(centre - reach, size)))
        return;
    ivec2 last = (view_size - 1) / ORL_SOFT_TILE;
    uvec2 from = uvec2(clamp(ivec2((centre - reach) / float(ORL_SOFT_TILE)), ivec2(0), last));
    uvec2 to = uvec2(clamp(ivec2((centre + reach) / float(ORL_SOFT_TILE)), ivec2(0), last));
    vec3 d = normalize(from_eye);
    vec3 color = 0.5 + HARMONIC_0 * splat_harmonic(i, 0) +
                 HARMONIC_1 * (-d.y * splat_harmonic(i, 1) + d.z * splat_harmonic(i, 2) - d.x * splat_harmonic(i, 3));
    int above = (color.r > 0.0 ? 1 : 0) + (color.g > 0.0 ? 2 : 0) + (color.b > 0.0 ? 4 : 0);
    imageStore(projected, ORL_SOFT_SEEN_VEC4S * i, vec4(centre, yy / determinant, -xy / determinant));
    imageStore(projected, ORL_SOFT_SEEN_VEC4S * i + 1, vec4(xx / determinant, s.opacity, p.z, 0.0));
    imageStore(projected, ORL_SOFT_SEEN_VEC4S * i + 2, vec4(max(color, vec3(0.0)), float(above)));
    bounds[ORL_SOFT_BOUND_WORDS * i + 1] = from.x | from.y << 16;
    bounds[ORL_SOFT_BOUND_WORDS * i + 2] = to.x | to.y << 16;
    bounds[ORL_SOFT_BOUND_WORDS * i] = floatBitsToUint(p.z);
}
