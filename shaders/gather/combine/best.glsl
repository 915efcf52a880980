// The one sample of greatest weight: Princ 2014, 2.3.3. Streams: a batch goes on from the greatest
// weight of the batches before it. Of samples that tie, the first photograph's is taken.
#include "gather/each.glsl"

vec4 best; // shared/pixel.glsl, blended

void combine_begin(ivec2 at)
{
    best = imageLoad(accumulated, at);
}

void combine_add(photo source, Answer a)
{
    vec3 color = photo_sample(source, a.pixel, a.mip).rgb;
    best = a.weight > best.a ? vec4(color, 1.0) * a.weight : best;
}

void combine_end(ivec2 at, Point point)
{
    if (best.a > 0.0)
        imageStore(accumulated, at, pixel_blended(best.rgb, best.a, false));
}
