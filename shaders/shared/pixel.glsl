// Encodings of the fourth channel of a picture while it is being painted.

// --- blended pixels, from painters that add samples: colour * weight, weight; 0: no sample ---

// at_least: the colour is a lower bound, since most samples are clipped. The sign of the weight is
// final only after all photographs have been asked.
vec4 pixel_blended(vec3 sum, float weight, bool at_least)
{
    return vec4(sum, at_least ? -weight : weight);
}

bool pixel_at_least(vec4 blended)
{
    return blended.a < 0.0;
}

float pixel_weight(vec4 blended)
{
    return abs(blended.a);
}

// --- finished pixels, from painters that normalise by the weight: colour, coverage ---

vec4 pixel_finished(vec3 color, bool on_surface)
{
    return vec4(color, on_surface ? 1.0 : 0.0);
}

// A pixel without samples, which hole filling paints.
vec4 pixel_unpainted()
{
    return vec4(0.0, 0.0, 0.0, -1.0);
}

// A pixel painted on estimated background depth, which is still to be blurred. blur: log2 of
// pixels, > 0. A half float must tell it from an unpainted one.
vec4 pixel_to_blur(vec3 color, float blur)
{
    return vec4(color, -1.0 - max(blur, 1.0 / 512.0));
}

bool pixel_is_finished(vec4 pixel)
{
    return pixel.a >= 0.0;
}

// Blur of an unfinished pixel, log2 of pixels; 0: the pixel is unpainted.
float pixel_blur(vec4 pixel)
{
    return -1.0 - pixel.a;
}
