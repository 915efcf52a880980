// Asking a photograph about a surface point: shaders/gather/photo.glsl and photo_choice.glsl for
// WebGL.
uniform sampler2D photo_rows;       // a row of 9 texels for each photograph of the frame; the last: its number
uniform mediump sampler2DArray photo_color; // mipmapped, sRGB: reads are linear light
uniform sampler2DArray photo_depth; // parts of its nearest depth; < 0: guessed, 0: none
uniform vec4 focal;                 // of the view
uniform float depth_tolerance, border_px, mip_most;
uniform vec2 slot_size;             // of photo_color, pixels

const float NOT_SEEN = 1e30;

struct photo {
    vec4 from_view[3]; // rows: rotation | translation, photograph's camera from the view's
    vec4 eye;          // its centre in the view's camera frame; w: slot
    vec4 focal;
    vec4 size;         // width, height; of its depth
    vec4 gain;         // rgb; w: its nearest depth
    vec4 lens;         // relative illumination: factors of r^2, r^4, r^6; w: r^2 per pixel^2
};

photo photo_at(int i)
{
    return photo(vec4[3](texelFetch(photo_rows, ivec2(0, i), 0), texelFetch(photo_rows, ivec2(1, i), 0),
                         texelFetch(photo_rows, ivec2(2, i), 0)),
                 texelFetch(photo_rows, ivec2(3, i), 0), texelFetch(photo_rows, ivec2(4, i), 0),
                 texelFetch(photo_rows, ivec2(5, i), 0), texelFetch(photo_rows, ivec2(6, i), 0),
                 texelFetch(photo_rows, ivec2(7, i), 0));
}

bool photo_project(photo shot, vec3 p, out vec2 pixel, out float z)
{
    vec4 ph = vec4(p, 1.0);
    vec3 q = vec3(dot(shot.from_view[0], ph), dot(shot.from_view[1], ph),
                  dot(shot.from_view[2], ph));
    z = q.z;
    pixel = vec2(-1.0);
    if (!(q.z > 0.0))
        return false;
    pixel = shot.focal.xy * q.xy / q.z + shot.focal.zw;
    vec2 border = min(pixel, shot.size.xy - pixel);
    return min(border.x, border.y) > 0.5;
}

const float GUESS_BORDERS = 4.0;

float photo_border(photo shot, vec2 pixel, bool guessed)
{
    vec2 border = min(pixel, shot.size.xy - pixel) - 0.5;
    float width = max(guessed ? GUESS_BORDERS * border_px : border_px, 0.5);
    return clamp(min(border.x, border.y) / width, 0.0, 1.0);
}

// The photograph's own depth at the four texels around a pixel.
vec4 photo_depths(photo shot, vec2 pixel)
{
    vec2 at = clamp(pixel * shot.size.zw / shot.size.xy, vec2(0.5), shot.size.zw - 0.5);
    ivec2 low = ivec2(floor(at - 0.5)), high = min(low + 1, ivec2(shot.size.zw) - 1);
    int slot = int(shot.eye.w);
    return shot.gain.w * vec4(texelFetch(photo_depth, ivec3(low, slot), 0).x,
                              texelFetch(photo_depth, ivec3(high.x, low.y, slot), 0).x,
                              texelFetch(photo_depth, ivec3(low.x, high.y, slot), 0).x,
                              texelFetch(photo_depth, ivec3(high, slot), 0).x);
}

float photo_mip(photo shot, float z, float view_depth)
{
    return clamp(log2(shot.focal.x * view_depth / (z * focal.x)), 0.0, mip_most);
}

vec3 photo_texel(vec2 at, float slot, float lod)
{
    return textureLod(photo_color, vec3(at, slot), lod).rgb;
}

// Catmull-Rom from bilinear fetches (Sigg and Hadwiger 2005).
vec3 photo_bicubic(photo shot, vec2 pixel, float mip)
{
    float lod = floor(mip + 0.5), slot = shot.eye.w;
    vec2 size_at = max(floor(slot_size / exp2(lod)), vec2(1.0));
    vec2 at = pixel / slot_size * size_at - 0.5;
    vec2 base = floor(at), f = at - base;
    vec2 w0 = f * (-0.5 + f * (1.0 - 0.5 * f));
    vec2 w1 = 1.0 + f * f * (-2.5 + 1.5 * f);
    vec2 w2 = f * (0.5 + f * (2.0 - 1.5 * f));
    vec2 w3 = f * f * (-0.5 + 0.5 * f);
    vec2 w12 = w1 + w2;
    vec2 p0 = (base - 0.5) / size_at, p3 = (base + 2.5) / size_at;
    vec2 p12 = (base + 0.5 + w2 / w12) / size_at;
    vec3 sum = photo_texel(vec2(p12.x, p0.y), slot, lod) * (w12.x * w0.y) +
               photo_texel(vec2(p0.x, p12.y), slot, lod) * (w0.x * w12.y) +
               photo_texel(p12, slot, lod) * (w12.x * w12.y) +
               photo_texel(vec2(p3.x, p12.y), slot, lod) * (w3.x * w12.y) +
               photo_texel(vec2(p12.x, p3.y), slot, lod) * (w12.x * w3.y);
    float total = w12.x * w0.y + w0.x * w12.y + w12.x * w12.y + w3.x * w12.y + w12.x * w3.y;
    return max(sum / total, 0.0);
}

// Brings linear colour to the scene's exposure and white balance, the lens's fall-off undone.
vec3 photo_aligned(photo shot, vec2 pixel, vec3 color)
{
    vec2 off = pixel - shot.focal.zw;
    vec3 lens = shot.lens.xyz;
    float r2 = dot(off, off) * shot.lens.w;
    float light = 1.0 + r2 * (lens.x + r2 * (lens.y + r2 * lens.z));
    vec3 gain = shot.gain.rgb / max(light, 0.1);
    vec3 more = gain - 1.0, third = min(more, vec3(0.5)), c = min(color, vec3(1.0));
    return gain * color / (1.0 + c * (more - third + third * c * c));
}

// Unstructured lumigraph penalty (Buehler 2001, 4.2).
float photo_penalty(photo shot, vec3 p)
{
    vec3 to_photo = shot.eye.xyz - p;
    float here = length(p), there = length(to_photo);
    float angle = acos(clamp(dot(-p, to_photo) / (here * there), -1.0, 1.0));
    float coarser = there / here * (focal.x / shot.focal.x) - 1.0;
    return angle + 0.1 * max(coarser, 0.0) + 0.005;
}

const float SURFACE_PENALTY = 0.3;

float photo_surface_penalty(float penalty)
{
    return length(vec2(penalty, SURFACE_PENALTY));
}

const float GUESS_PARALLAX = 0.05;

// How much of the photograph around a pixel has nothing standing before z.
float photo_unhidden_share(photo shot, vec4 seen, float z)
{
    vec4 front = (z - seen) / (z * depth_tolerance); // in tolerances
    vec4 nearer = -1.0 / min(seen, vec4(-1e-9)) - 1.0 / z;
    vec4 behind_guess = nearer * (length(shot.eye.xyz) / GUESS_PARALLAX);
    front = mix(front, behind_guess, lessThan(seen, vec4(0.0)));
    vec4 share = mix(clamp(2.0 - front, 0.0, 1.0), vec4(1.0), equal(seen, vec4(0.0)));
    return dot(share, vec4(0.25));
}

const float GUESS_PENALTY_MOST = 0.9;

float photo_beside(float penalty)
{
    return clamp(3.0 * (1.0 - penalty / GUESS_PENALTY_MOST), 0.0, 1.0);
}
