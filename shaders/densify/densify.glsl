// Shared by the densifier's shaders: random numbers, planes, and the matching cost of a plane in
// one source photograph. The including program defines RADIUS, STEP, SOURCES and PADDING.
// GEOMETRIC adds a cost term for consistency with the depth maps of the sources.
#include "shared/densify_block.h"

const float COST_MAX = 2.0; // largest value of 1 - NCC
const int SIDE = 2 * RADIUS / STEP + 1;
const int FIRST = -((SIDE - 1) * STEP) / 2;
// Variance of sensor noise and rounding, in squared 8-bit values. It keeps textureless patches
// from matching anything.
const float NOISE_VARIANCE = 0.5;
// Bilateral weights: standard deviation of the colour difference, in 8-bit values. The standard
// deviation of the distance is the window's radius.
const float SIGMA_COLOR = 30.0;

layout(binding = 0) uniform sampler2D reference; // luma, mask
// One layer per source. Each texel packs the four values of its 2x2 neighbourhood, so that a
// bilinear sample is one fetch. Each layer is padded by repeating its edge.
layout(binding = 1) uniform usampler2DArray sources;
#ifdef GEOMETRIC
layout(binding = 2) uniform sampler2DArray source_depths; // 1/z; 0: no depth
#endif

// Geometric consistency terms that are added to a plane's cost. LONELY: greatest penalty where few
// sources agree on the plane; AGAINST: for each source that sees through it; NOBODY: where no
// source agrees.
const float LONELY = 0.1, AGAINST = 0.08, NOBODY = 0.4;

// --- random numbers (PCG, Jarzynski and Olano 2020) ---

uint random_state;

void random_start(ivec2 at)
{
    random_state = uint(at.y * area.x + at.x) * 747796405u + uint(run.x) +
                   uint(run.y) * 2891336453u;
}

float random_value()
{
    random_state = random_state * 747796405u + 2891336453u;
    uint word = ((random_state >> ((random_state >> 28) + 4u)) ^ random_state) * 277803737u;
    return float(int(((word >> 22) ^ word) >> 8)) * (1.0 / 16777216.0);
}

float random_signed()
{
    return 2.0 * random_value() - 1.0;
}

// --- planes ---

vec2 pixel_centre(ivec2 at)
{
    return vec2(at) + 0.5;
}

vec3 view_ray(vec2 pixel)
{
    return vec3((pixel - camera.zw) / camera.xy, 1.0);
}

// The plane's normal, unnormalised, pointing away from the camera: every point X on the plane
// satisfies dot(normal, X) = 1. At the pixel with ray r, dot(normal, r) = w.
vec3 plane_normal(vec3 plane, vec2 pixel)
{
    return vec3(plane.yz * camera.xy, plane.x + dot(plane.yz, camera.zw - pixel));
}

vec3 plane_from_normal(float w, vec3 away, vec2 pixel)
{
    return vec3(w, w * away.xy / (camera.xy * dot(away, view_ray(pixel))));
}

// True if the plane is within the depth range and is seen at less than 86 degrees from its normal.
// The ground in front of a viewer reaches such angles.
bool plane_valid(vec3 plane, vec2 pixel)
{
    vec3 n = plane_normal(plane, pixel), r = view_ray(pixel);
    return plane.x >= range.x && plane.x <= range.y &&
           plane.x * plane.x > 0.004 * dot(n, n) * dot(r, r);
}

vec3 random_plane(vec2 pixel)
{
    float w = mix(range.x, range.y, random_value());
    float turn = 6.2831853 * random_value(), tilt = 1.5 * sqrt(random_value());
    vec3 r = normalize(view_ray(pixel));
    vec3 e = normalize(vec3(r.z, 0.0, -r.x)), f = cross(r, e);
    return plane_from_normal(w, r + tilt * (cos(turn) * e + sin(turn) * f), pixel);
}

vec3 turned_plane(float w, vec3 plane, vec2 pixel, float amount)
{
    vec3 n = normalize(plane_normal(plane, pixel));
    vec3 offset = vec3(random_signed(), random_signed(), random_signed());
    n += amount * offset;
    // A plane that was turned too far faces away. Its zero inverse depth fails the range test.
    return dot(n, view_ray(pixel)) > 1e-3 ? plane_from_normal(w, n, pixel) : vec3(0.0);
}

// --- costs of single views: one byte each, quantised more finely near zero ---

uint cost_pack(float cost)
{
    return uint(int(255.0 * sqrt(min(cost, COST_MAX) / COST_MAX) + 0.5));
}

float cost_unpack(uint code)
{
    float root = float(int(code)) * (1.0 / 255.0);
    return COST_MAX * root * root;
}

uint get_byte(uvec4 words, int index)
{
    uint word = index < 8 ? (index < 4 ? words.x : words.y) : (index < 12 ? words.z : words.w);
    return (word >> (8 * (index & 3))) & 255u;
}

uvec4 set_byte(uvec4 words, int index, uint value)
{
    int shift = 8 * (index & 3);
    uint keep = ~(255u << shift), bits = value << shift;
    uvec4 changed = (words & uvec4(keep)) | uvec4(bits);
    int word = index >> 2;
    return uvec4(word == 0 ? changed.x : words.x, word == 1 ? changed.y : words.y,
                 word == 2 ? changed.z : words.z, word == 3 ? changed.w : words.w);
}

// --- the reference patch, fetched once per pixel ---

float patch_weight[SIDE * SIDE]; // bilateral weights, which sum to 1
float patch_signal[SIDE * SIDE]; // weight * (value - mean)
float patch_variance;

void load_patch(ivec2 at)
{
    float centre = 255.0 * texelFetch(reference, at, 0).r, total = 0.0, mean = 0.0;
    for (int j = 0; j < SIDE; j++)
        for (int i = 0; i < SIDE; i++) {
            ivec2 offset = ivec2(FIRST + STEP * i, FIRST + STEP * j);
            ivec2 q = clamp(at + offset, ivec2(0), area.xy - 1);
            float value = 255.0 * texelFetch(reference, q, 0).r;
            float color = (value - centre) / SIGMA_COLOR;
            vec2 space = vec2(offset) / float(RADIUS);
            float weight = exp2(-0.7213475 * (color * color + dot(space, space)));
            patch_weight[SIDE * j + i] = weight;
            patch_signal[SIDE * j + i] = value;
            total += weight;
            mean += weight * value;
        }
    mean /= total;
    patch_variance = 0.0;
    for (int k = 0; k < SIDE * SIDE; k++) {
        float weight = patch_weight[k] / total, value = patch_signal[k] - mean;
        patch_weight[k] = weight;
        patch_signal[k] = weight * value;
        patch_variance += weight * value * value;
    }
}

// --- the cost of a plane in one source ---

#ifdef GEOMETRIC
float source_inverse_depth(int view, vec2 texel)
{
    ivec2 limits = textureSize(source_depths, 0).xy - 1;
    ivec2 at = ivec2((texel + 0.5 - float(PADDING)) * extent[view].w);
    return texelFetch(source_depths, ivec3(clamp(at, ivec2(0), limits), view), 0).r;
}

// Forward-backward reprojection error (Schoenberger 2016, 4.2): the distance between the pixel and
// its image after projection into the source and back with the source's own inverse depth. In
// pixels, at most tune.w.
float reprojection_error(int view, vec2 texel, float w, vec2 pixel)
{
    vec2 p = (texel + 0.5 - float(PADDING)) * extent[view].w;
    vec4 q = vec4(p, 1.0, w);
    vec3 c = vec3(dot(backward[3 * view], q), dot(backward[3 * view + 1], q),
                  dot(backward[3 * view + 2], q));
    return c.z > 0.0 ? min(distance(c.xy / c.z, pixel), tune.w) : tune.w;
}
#endif

// 1 - bilaterally weighted NCC of the reference patch and its image in the source. Within the
// patch the homography is approximated as affine: over so few pixels the perspective part moves
// samples by less than a tenth of a pixel.
float view_cost(int view, vec3 plane, vec2 pixel)
{
    vec4 row0 = forward[3 * view], row1 = forward[3 * view + 1], row2 = forward[3 * view + 2];
    vec4 q = vec4(pixel, 1.0, plane.x);
    float depth = dot(row2, q);
    vec2 size = extent[view].xy;
    if (!(depth > 0.0))
        return COST_MAX;
    float inverse = 1.0 / depth;
    vec2 texel = vec2(dot(row0, q), dot(row1, q)) * inverse;
    vec2 along_x = vec2(row0.x + row0.w * plane.y, row1.x + row1.w * plane.y);
    vec2 along_y = vec2(row0.y + row0.w * plane.z, row1.y + row1.w * plane.z);
    along_x = (along_x - texel * (row2.x + row2.w * plane.y)) * inverse;
    along_y = (along_y - texel * (row2.y + row2.w * plane.z)) * inverse;
    // The centre must lie inside the picture and the warped patch inside the padding. The warp must
    // neither mirror the patch nor shrink its area to less than 4 %.
    vec2 inside = texel - float(PADDING) + 0.5;
    vec2 reach = float(RADIUS) * (abs(along_x) + abs(along_y));
    float growth = along_x.x * along_y.y - along_x.y * along_y.x;
    if (!(inside.x >= 0.0 && inside.y >= 0.0 && inside.x <= size.x && inside.y <= size.y &&
          max(reach.x, reach.y) < float(PADDING - 2) && growth > 0.04))
        return COST_MAX;

    float mean = 0.0, square = 0.0, product = 0.0;
    for (int j = 0; j < SIDE; j++)
        for (int i = 0; i < SIDE; i++) {
            vec2 at = texel + float(FIRST + STEP * i) * along_x + float(FIRST + STEP * j) * along_y;
            vec2 corner = floor(at), part = at - corner;
            uint quad = texelFetch(sources, ivec3(ivec2(corner), view), 0).r;
            vec4 value = vec4(float(int(quad & 255u)), float(int((quad >> 8) & 255u)),
                              float(int((quad >> 16) & 255u)), float(int(quad >> 24)));
            vec2 rows = value.xz + part.x * (value.yw - value.xz);
            float sampled = rows.x + part.y * (rows.y - rows.x);
            float weighted = patch_weight[SIDE * j + i] * sampled;
            mean += weighted;
            square += weighted * sampled;
            product += patch_signal[SIDE * j + i] * sampled;
        }
    float variance = max(square - mean * mean, 0.0);
    float cost = 1.0 - product * inversesqrt((patch_variance + NOISE_VARIANCE) *
                                             (variance + NOISE_VARIANCE));
    return clamp(cost, 0.0, COST_MAX);
}

#ifdef GEOMETRIC
// How consistent a plane is with the depth maps of the sources.
struct consistency {
    uvec3 views;  // the three sources that agree best, in descending order
    vec3 weights; // of these sources; 0: fewer than three agree
    vec3 errors;  // reprojection errors of these sources, pixels
    int agree;    // number of sources whose own depth matches the plane
    int against;  // number of sources that see through the plane to a clearly farther surface
};

consistency ask_sources(vec3 plane, vec2 pixel)
{
    consistency o = consistency(uvec3(0u), vec3(0.0), vec3(0.0), 0, 0);
    for (int view = 0; view < SOURCES; view++) {
        vec4 q = vec4(pixel, 1.0, plane.x);
        float depth = dot(forward[3 * view + 2], q);
        if (!(extent[view].z > 0.0) || !(depth > 0.0))
            continue;
        vec2 texel = vec2(dot(forward[3 * view], q), dot(forward[3 * view + 1], q)) / depth;
        vec2 inside = texel - float(PADDING) + 0.5;
        if (any(lessThan(inside, vec2(0.0))) || any(greaterThan(inside, extent[view].xy)))
            continue;
        float seen = source_inverse_depth(view, texel);
        if (!(seen > 0.0))
            continue;
        float error = reprojection_error(view, texel, seen, pixel);
        float weight = extent[view].z * (1.0 - error / tune.w);
        if (error < limit.y)
            o.agree++;
        else if (seen * depth < 0.95 * plane.x)
            o.against++;
        if (weight > o.weights.x) {
            o.views = uvec3(uint(view), o.views.xy);
            o.weights = vec3(weight, o.weights.xy);
            o.errors = vec3(error, o.errors.xy);
        } else if (weight > o.weights.y) {
            o.views.yz = uvec2(uint(view), o.views.y);
            o.weights.yz = vec2(weight, o.weights.y);
            o.errors.yz = vec2(error, o.errors.y);
        } else if (weight > o.weights.z) {
            o.views.z = uint(view);
            o.weights.z = weight;
            o.errors.z = error;
        }
    }
    return o;
}

// The patch is compared in the sources whose depth agrees, since these see the surface. A source
// that sees a nearer surface adds no penalty, since the plane is occluded in it.
float agreed_cost(vec3 plane, vec2 pixel, float best)
{
    consistency o = ask_sources(plane, pixel);
    float total = o.weights.x + o.weights.y + o.weights.z;
    float uncertainty = LONELY * exp2(-total) + AGAINST * float(min(o.against, 3));
    if (!(total > 0.0)) {
        uncertainty += NOBODY;
        o.views = uvec3(0u, 1u, 0u);
        bool second = SOURCES > 1 && extent[min(1, SOURCES - 1)].z > 0.0;
        o.weights = vec3(1.0, second ? 1.0 : 0.0, 0.0);
        total = o.weights.x + o.weights.y;
    }
    uncertainty += tune.z * dot(o.weights, o.errors) / total;
    float cost = uncertainty;
    for (int k = 0; k < 3; k++) {
        float weight = k == 0 ? o.weights.x : k == 1 ? o.weights.y : o.weights.z;
        int view = int(k == 0 ? o.views.x : k == 1 ? o.views.y : o.views.z);
        if (weight > 0.0 && cost < best)
            cost += weight / total * view_cost(view, plane, pixel);
    }
    return cost;
}
#endif
