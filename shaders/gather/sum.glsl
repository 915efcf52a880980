// A combination that is a sum of colour * weight and weight over the samples, and over all batches of photographs.
// combine_begin sets what the batches before have given.
vec4 sum = vec4(0.0);

void combine_end(ivec2 at, Point point)
{
    if (sum.a > 0.0)
        imageStore(accumulated, at, pixel_blended(sum.rgb, sum.a, false));
}
