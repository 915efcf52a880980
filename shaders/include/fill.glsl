// Reading the filling pyramid, whose finest level has half the picture's size. Included where
// FILL_LEVEL names the level's image.

// What a pixel of the next finer level gets: bilinear, as Gortler 1996's push.
vec4 fill_finer(ivec2 at)
{
    ivec2 parent = at / 2, side = 2 * (at & 1) - 1, last = imageSize(FILL_LEVEL) - 1;
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 4; i++) {
        ivec2 step = ivec2(i & 1, i >> 1);
        float share = (step.x == 0 ? 0.75 : 0.25) * (step.y == 0 ? 0.75 : 0.25);
        sum += share * imageLoad(FILL_LEVEL, clamp(parent + side * step, ivec2(0), last));
    }
    return sum;
}
