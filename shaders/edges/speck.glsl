// Specks, for the renderer and for the page: pixels that stand out of what surrounds them, although nothing does in
// the photographs at the places that they are read from. There the depth of single pixels is wrong.

// Least difference from the surroundings, in fourth roots of light.
const float SPECK_FROM = 0.05;
// A speck differs so many times as much as photographs vary from one pixel to the next.
const float SPECK_VARIES = 2.0;

// Fourth root of luma, from linear light.
float speck_light(vec3 color)
{
    return sqrt(sqrt(dot(color, vec3(0.299, 0.587, 0.114))));
}

// Whether another pixel is darker, and whether it is lighter: 1 or 0.
ivec2 speck_others(float own, float other)
{
    return ivec2(other < own - SPECK_FROM ? 1 : 0, other > own + SPECK_FROM ? 1 : 0);
}

// Whether a pixel can be a speck: three or more of the 3x3 around are darker, or lighter. Few pixels do.
// light: of speck_light, row by row.
bool speck_suspect(float light[9])
{
    ivec2 others = ivec2(0);
    for (int k = 0; k < 9; k++)
        others += speck_others(light[4], light[k]);
    return max(others.x, others.y) >= 3;
}

// Whether it differs from the median of the 5x5 around: most are darker, or most are lighter.
bool speck_stands_out(float light[25])
{
    ivec2 others = ivec2(0);
    for (int k = 0; k < 25; k++)
        others += speck_others(light[12], light[k]);
    return max(others.x, others.y) > 12;
}

// Index of the median.
int speck_median(float values[25])
{
    int median = 12;
    for (int i = 0; i < 25; i++) {
        int before = 0;
        for (int k = 0; k < 25; k++)
            before += (k < i ? values[k] <= values[i] : values[k] < values[i]) ? 1 : 0;
        median = before == 12 ? i : median;
    }
    return median;
}

// Index of the one of 5x5 pixels, row by row, whose colour the middle takes; 12: its own. light: of speck_light;
// varies: how much the best photograph of each varies about its place.
int speck_taken(float light[25], float varies[25])
{
    int median = speck_median(light);
    int below = 0; // pixels whose photographs vary less than the middle differs from the median
    float differs = abs(light[12] * light[12] - light[median] * light[median]);
    for (int k = 0; k < 25; k++)
        below += SPECK_VARIES * varies[k] < differs ? 1 : 0;
    return speck_stands_out(light) && below > 12 ? median : 12;
}
