// The mean of all samples, each by its weight and its confidence: of the room, whose pictures must
// not differ by photographs, so that none is compared with the others.
#include "gather/each.glsl"
#include "gather/radiance/alone.glsl"
#include "gather/sum.glsl"

void combine_begin(ivec2 at)
{
    sum = imageLoad(accumulated, at);
}

void combine_add(photo source, Answer a)
{
    vec4 texel = photo_sample(source, a.pixel, a.mip);
    float weight = a.weight > 0.0 && texel.a > 0.0 ? a.weight * confidence_alone(source, texel)
                                                   : 0.0;
    sum += weight > 0.0 ? vec4(texel.rgb, 1.0) * weight : vec4(0.0);
}
