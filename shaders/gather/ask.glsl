// Asks a photograph about a surface point, for any method. Included after the method's <visibility>
// and <weight>.
#include "gather/photo.glsl"

// A photograph's answer before its colours are read.
struct Answer {
    int source;   // the photograph
    vec2 pixel;   // projection of the point, pixels
    float mip;
    float weight; // 0: the photograph does not show the point
};

// Asks photograph i, the source, about a point. The code selects rather than branches, since software
// renderers run both sides of a condition.
Answer ask(photo source, int i, Point at)
{
    Answer a;
    a.source = i;
    float z;
    bool inside = photo_project(source, at.p, a.pixel, z);
    z = inside ? z : at.p.z; // keeps the logarithm's argument positive
    a.mip = photo_mip(source, z, at.p.z);
    vec4 seen = photo_depths(source, a.pixel);
    float visible = at.guessed ? visible_guess(source, at, seen, z) : visible_surface(source, at, seen, z);
    float weight = weight_of(source, at) * photo_border(source, a.pixel) * visible;
    a.weight = inside ? weight : 0.0;
    return a;
}

vec3 surface_point(ivec2 at, float depth)
{
    return vec3((vec2(at) + 0.5 - view_focal.zw) / view_focal.xy, 1.0) * depth;
}
