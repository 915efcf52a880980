// Costs of the planes of each cell, as shaders/guess/cost.comp makes them: four to a texel, side by side.
#include "gather/photo.glsl"

uniform sampler2D view_depth; // < 0: guessed
uniform highp usampler2D tiles; // choose.frag
uniform int CELL;
uniform float min_inverse;
layout(location = 0) out vec4 costs;

float depth_at(ivec2 at)
{
    ivec2 area = textureSize(view_depth, 0);
    return at.x < area.x && at.y < area.y ? texelFetch(view_depth, at, 0).x : 0.0;
}

int photo_to_ask(ivec2 cell, int c)
{
    return photo_listed(texelFetch(tiles, cell * CELL / TILE, 0).xy, c);
}

#include "guess/cost.glsl"

void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy), cell = ivec2(at.x / TEXELS, at.y);
    float estimate = open_estimate(cell);
    costs = estimate > 0.0 ? plane_costs(cell, estimate, AT_ONCE * (at.x % TEXELS)) : vec4(CLOSED);
}
