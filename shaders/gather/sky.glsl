// The sky of a view. Included after gather/photo.glsl. A column of the view runs from the side of the
// picture that is the nearest to upwards. A place is the column and the distance from that side, pixels.

layout(std430, binding = 3) buffer sky_columns {
    int open_until[]; // per column: how far it is open
};

bool columns_lie()
{
    return abs(up.x) > abs(up.y);
}

// Number of columns, and their length.
ivec2 columns_size()
{
    return columns_lie() ? view_size.yx : view_size;
}

ivec2 place_from_end(ivec2 place)
{
    bool from_end = (columns_lie() ? up.x : up.y) > 0.0;
    return from_end ? ivec2(place.x, columns_size().y - 1 - place.y) : place;
}

ivec2 pixel_of_place(ivec2 place)
{
    place = place_from_end(place);
    return columns_lie() ? place.yx : place;
}

ivec2 place_of_pixel(ivec2 pixel)
{
    return place_from_end(columns_lie() ? pixel.yx : pixel);
}

bool open_to_sky(ivec2 pixel)
{
    ivec2 place = place_of_pixel(pixel);
    return place.y < open_until[place.x];
}

// Sine of the elevation at which the sky begins, and is complete.
const vec2 SKY_ABOVE = vec2(0.02, 0.06);

float above_horizon(vec3 p)
{
    return smoothstep(SKY_ABOVE.x, SKY_ABOVE.y, dot(up.xyz, p) / length(p));
}

// A colour looks like a photograph's sky up to this distance from its mean, square roots of light,
// beyond its standard deviation; with twice the sum it does not.
const float SKY_NEAR = 0.1;

// How far a photograph shows the sky where it has this colour, and 1; 0 for one that shows none.
vec2 sky_vote(photo shot, vec3 color)
{
    float off = length(sqrt(color) - shot.noise.rgb);
    float like = 1.0 - smoothstep(1.0, 2.0, off / (SKY_NEAR + shot.offset.w));
    return shot.offset.w > 0.0 ? vec2(like, 1.0) : vec2(0.0);
}

// Share of the votes from which on a pixel is sky, in part and completely. Where fewer photographs show
// the sky, others show a tree, or what they do show is misplaced: none of it is certain.
const vec2 SKY_AGREED = vec2(0.5, 0.8);

// How much of a pixel the plain sky paints. votes: the sum.
float sky_share(vec3 p, vec2 votes)
{
    float agreed = smoothstep(SKY_AGREED.x, SKY_AGREED.y, votes.x / max(votes.y, 1e-6));
    return opt.plain_sky * agreed * above_horizon(p);
}
