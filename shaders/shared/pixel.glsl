// What the fourth channel of a picture says while it is being painted.

// --- blended pixels, of painters that add samples: colour * weight, weight; 0: nothing paints ---

// at_least: there is this much light or more, since most of it clips. Half a picture knows its
// weight's sign only once all photographs have been asked.
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

// --- finished pixels, of painters that divide themselves: colour, coverage ---

vec4 pixel_finished(vec3 color, bool on_surface)
{
    return vec4(color, on_surface ? 1.0 : 0.0);
}

// Left for the fill.
vec4 pixel_unpainted()
{
    return vec4(0.0, 0.0, 0.0, -1.0);
}

// Left to be blurred: painted on guessed depth. blur: log2 of pixels, > 0.
vec4 pixel_to_blur(vec3 color, float blur)
{
    return vec4(color, -1.0 - blur);
}

bool pixel_is_finished(vec4 pixel)
{
    return pixel.a >= 0.0;
}

// Of one that is not finished; 0: it is unpainted.
float pixel_blur(vec4 pixel)
{
    return -1.0 - pixel.a;
}
