// The weighted mean of all samples. When the photographs come in several batches, each batch
// adds to the sums of the one before.
#include "gather/each.glsl"
#include "gather/sum.glsl"

void combine_begin(ivec2 at)
{
    sum = imageLoad(accumulated, at);
}

void combine_add(photo source, Answer a)
{
    vec3 color = photo_sample(source, a.pixel, a.mip).rgb;
    sum += a.weight > 0.0 ? vec4(color, 1.0) * a.weight : vec4(0.0);
}
