// The gradient of the loss by a splat's values, by the chain rule from its shares in the tiles, and a step of
// Adam (Kingma 2015) against it.
#include "soft/splat.glsl"

layout(local_size_x = ORL_POINT_GROUP) in;
layout(rgba32f, binding = 6) readonly uniform imageBuffer projected;
layout(std430, binding = 2) readonly buffer splat_bounds {
    uint bounds[];
};
layout(std430, binding = 3) readonly buffer splat_places {
    int places[]; // first the start of each splat's list and the end of the last one, then its entries
};
layout(rgba32f, binding = 5) readonly uniform imageBuffer shares;
// ORL_SOFT_VEC4S of each splat: running means of its gradient, and of its square; row 1, w of the first: number of
// steps.
layout(rgba32f, binding = 3) uniform imageBuffer mean;
layout(rgba32f, binding = 4) uniform imageBuffer square;

const float FORGET_1 = 0.9, FORGET_2 = 0.99;
// Step sizes. Places move by parts of the size that a photograph's pixel has there; sizes stay between
// SIGMA_MIN and SIGMA_MAX of it.
const float STEP_PLACE = 0.25, STEP_SIGMA = 0.08, STEP_TURN = 0.02, STEP_OPACITY = 0.05, STEP_COLOR = 0.06;
const float SIGMA_MIN = 0.05, SIGMA_MAX = 16.0;

void main()
{
    int i = own_item();
    if (i >= splat_count || bounds[ORL_SOFT_BOUND_WORDS * i] == 0u)
        return;
    vec4 first = vec4(0.0);
    vec2 second = vec2(0.0);
    vec3 color_sum = vec3(0.0);
    for (int k = places[i]; k < places[i + 1]; k++) {
        int from = ORL_SOFT_SHARE_VEC4S * places[k];
        first += imageLoad(shares, from);
        second += imageLoad(shares, from + 1).xy;
        color_sum += imageLoad(shares, from + 2).rgb;
    }
    vec4 seen_a = imageLoad(projected, ORL_SOFT_SEEN_VEC4S * i), seen_b = imageLoad(projected, ORL_SOFT_SEEN_VEC4S * i + 1);
    int above = int(imageLoad(projected, ORL_SOFT_SEEN_VEC4S * i + 2).a);
    float a = seen_a.z, b = seen_a.w, c = seen_b.x, opacity = seen_b.y, z = seen_b.z;
    splat s = splat_at(i);
    vec3 p = view_rotation() * (s.position - eye.xyz);
    vec3 by_harmonic = HARMONIC_0 * color_sum * vec3(above & 1, above >> 1 & 1, above >> 2 & 1);

    // Exponent -0.5 (a x^2 + c y^2) - b x y, of the offset (x, y) from the centre.
    vec2 by_centre = vec2(a * first.y + b * first.z, b * first.y + c * first.z);
    mat2 inverse = mat2(a, b, b, c);
    mat2 by_inverse = -0.5 * mat2(first.w, second.x, second.x, second.y);
    mat2 by_covariance = -inverse * by_inverse * inverse;
    mat2x3 jacobian = splat_jacobian(p), m = splat_footprint(s, p);
    vec3 by_m0 = 2.0 * (by_covariance[0][0] * m[0] + by_covariance[1][0] * m[1]);
    vec3 by_m1 = 2.0 * (by_covariance[0][1] * m[0] + by_covariance[1][1] * m[1]);
    vec3 by_sigma = by_m0 * m[0] + by_m1 * m[1]; // by the logarithm of sigma

    // m[r] = sigma * (axes^T view^T jacobian[r]): by the axes, then by the quaternion.
    mat3 axes = splat_axes(s.turn), to_world = transpose(view_rotation());
    mat3 by_axes = outerProduct(to_world * jacobian[0], by_m0 * s.sigma) +
                   outerProduct(to_world * jacobian[1], by_m1 * s.sigma); // [column][row]
    float w = s.turn.x, x = s.turn.y, y = s.turn.z, zz = s.turn.w;
    mat3 g = transpose(by_axes); // g[row][column]
    vec4 by_turn = 2.0 * vec4(
        -zz * g[0][1] + y * g[0][2] + zz * g[1][0] - x * g[1][2] - y * g[2][0] + x * g[2][1],
        y * g[0][1] + zz * g[0][2] + y * g[1][0] - 2.0 * x * g[1][1] - w * g[1][2] + zz * g[2][0] + w * g[2][1] -
            2.0 * x * g[2][2],
        -2.0 * y * g[0][0] + x * g[0][1] + w * g[0][2] + x * g[1][0] + zz * g[1][2] - w * g[2][0] + zz * g[2][1] -
            2.0 * y * g[2][2],
        -2.0 * zz * g[0][0] - w * g[0][1] + x * g[0][2] + w * g[1][0] - 2.0 * zz * g[1][1] + y * g[1][2] +
            x * g[2][0] + y * g[2][1]);
    by_turn = (by_turn - dot(by_turn, s.turn) * s.turn) / s.turn_length;

    // The centre and the Jacobian change with the place.
    mat3 to_camera = view_rotation();
    vec3 by_j0 = to_camera * (axes * (s.sigma * by_m0)), by_j1 = to_camera * (axes * (s.sigma * by_m1));
    vec2 f = focal.xy;
    vec3 by_camera = vec3(f * by_centre / z - vec2(by_j0.z, by_j1.z) * f / (z * z),
                          -dot(f * by_centre, p.xy) / (z * z) - (by_j0.x * f.x + by_j1.y * f.y) / (z * z) +
                              2.0 * (by_j0.z * f.x * p.x + by_j1.z * f.y * p.y) / (z * z * z));
    vec3 by_place = to_world * by_camera;

    vec4 own[ORL_SOFT_VEC4S] = vec4[ORL_SOFT_VEC4S](
        vec4(by_place, first.x * (1.0 - opacity)), vec4(by_sigma, 0.0), by_turn, vec4(by_harmonic, 0.0));
    int at = ORL_SOFT_VEC4S * i;
    float steps = imageLoad(mean, at + 1).w + 1.0, pixel = splat_row(i, 1).w;
    pixel = pixel > 0.0 ? pixel : z / focal.x;
    vec4 size[ORL_SOFT_VEC4S] = vec4[ORL_SOFT_VEC4S](
        vec4(vec3(STEP_PLACE * pixel), STEP_OPACITY), vec4(vec3(STEP_SIGMA), 0.0), vec4(STEP_TURN),
        vec4(STEP_COLOR));
    float grown_1 = 1.0 / (1.0 - pow(FORGET_1, steps)), grown_2 = 1.0 / (1.0 - pow(FORGET_2, steps));
    for (int k = 0; k < ORL_SOFT_VEC4S; k++) {
        vec4 one = FORGET_1 * imageLoad(mean, at + k) + (1.0 - FORGET_1) * own[k];
        vec4 two = FORGET_2 * imageLoad(square, at + k) + (1.0 - FORGET_2) * own[k] * own[k];
        vec4 row = splat_row(i, k) - eye.w * size[k] * (grown_1 * one) / (sqrt(grown_2 * two) + 1e-12);
        if (k == 1) {
            row = vec4(clamp(row.xyz, log(SIGMA_MIN * pixel), log(SIGMA_MAX * pixel)), pixel);
            one.w = steps;
        }
        imageStore(mean, at + k, one);
        imageStore(square, at + k, two);
        imageStore(splats, at + k, row);
    }
}
