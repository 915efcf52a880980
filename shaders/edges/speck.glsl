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

int speck_differs(float light, float other)
{
    return abs(light - other) > SPECK_FROM ? 1 : 0;
}

// Whether a pixel can be a speck: it differs from three or more of the 3x3 around. Few pixels do.
// light: of speck_light, row by row.
bool speck_suspect(float light[9])
{
    int others = 0;
    for (int k = 0; k < 9; k++)
        others += speck_differs(light[k], light[4]);
    return others >= 3;
}

// Whether it differs from most of the 5x5 around, as it does if it differs from their median.
bool speck_stands_out(float light[25])
{
    int others = 0;
    for (int k = 0; k < 25; k++)
        others += speck_differs(light[k], light[12]);
    return others > 12;
}

// Index of the median.
int speck_median(float values[25])
{
    int median = 12;
    for (int i = 0; i < 25; i++) {
        int below = 0;
        for (int k = 0; k < 25; k++)
            below += values[k] < values[i] || (values[k] == values[i] && k < i) ? 1 : 0;
        median = below == 12 ? i : median;
    }
    return median;
}

// Index of the one of 5x5 pixels, row by row, whose colour the middle takes; 12: its own. light: of speck_light;
// varies: how much the best photograph of each varies about its place.
int speck_taken(float light[25], float varies[25])
{
    int median = speck_median(light);
    float own = light[12], most = light[median];
    bool speck = speck_differs(own, most) > 0 &&
                 abs(own * own - most * most) > SPECK_VARIES * varies[speck_median(varies)];
    return speck ? median : 12;
}
