// What a level of the pyramid of hole filling says of the pixels of an image of twice the size. The including file
// defines fill_wants and fill_pixel. One invocation handles 2x2 pixels of each of ORL_FILL_RUN work groups side by side:
// a software renderer runs what fills pixels for all invocations of a work group if it does for one.
// FAR: the values are those of fill/slope.glsl.
#include "shared/image.glsl"

layout(rgba32f, binding = 0) readonly uniform image2D filled;
#include "fill/fill.glsl"

bool fill_wants(ivec2 at); // whether the pixel has no value of its own
void fill_pixel(ivec2 at, vec4 value); // gives it one; value.a: 0: nothing is known

ivec2 fill_parent(int k)
{
    ivec2 group = ivec2(int(gl_WorkGroupID.x) * ORL_FILL_RUN + k, gl_WorkGroupID.y);
    return group * ivec2(gl_WorkGroupSize.xy) + ivec2(gl_LocalInvocationID.xy);
}

void main()
{
    uint left = 0u; // a bit for each work group in which a pixel is to be filled
    for (int k = 0; k < ORL_FILL_RUN; k++) {
        ivec2 at = 2 * fill_parent(k);
        bool wants = fill_wants(at) || fill_wants(at + ivec2(1, 0)) || fill_wants(at + ivec2(0, 1)) ||
                     fill_wants(at + ivec2(1, 1));
        left |= wants && all(lessThan(at, image_size)) ? 1u << k : 0u;
    }
    do { // the condition comes last: see gather/tiled.comp
        ivec2 parent = left != 0u ? fill_parent(findLSB(left)) : image_size; // image_size: outside
        vec4 finer[4];
        fill_finer(parent, finer);
        for (int k = 0; k < 4; k++) { // outside, loads give 0 and stores do nothing
            ivec2 at = 2 * parent + ivec2(k & 1, k >> 1);
            if (fill_wants(at))
                fill_pixel(at, finer[k]);
        }
        left &= left - 1u;
    } while (left != 0u);
}
