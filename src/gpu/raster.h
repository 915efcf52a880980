// Drawing with the graphics pipeline: triangles, with a depth test, into several targets.
#ifndef ORL_GPU_RASTER_H
#define ORL_GPU_RASTER_H

#include "oriel/gpu.h"

enum { ORL_RASTER_TARGETS_MAX = 2, ORL_RASTER_INPUTS_MAX = 3 };

// One vertex input; array index = its location in the vertex program.
struct orl_raster_input {
    const struct orl_buf *buf; // NULL: not used
    size_t offset, stride;     // bytes
    int components;            // 1 to 4
    GLenum type;               // GL_FLOAT, GL_UNSIGNED_BYTE (normalised: 255 reads as 1) or
                               // GL_UNSIGNED_INT (which reads as an integer)
    bool per_instance;         // advances with the instance, not with the vertex
};

// One draw into textures of one size. They are cleared first: colours to 0, depth to 1. With `over`
// they keep what they have, and colours premultiplied by alpha are laid over it in order.
struct orl_raster {
    struct orl_prog *prog;     // from orl_prog_get_raster
    const void *params;        // contents of the uniform block at binding 0
    size_t params_size;
    struct orl_raster_input inputs[ORL_RASTER_INPUTS_MAX];
    const struct orl_buf *indices; // 32-bit; NULL: vertices in order
    size_t count;                  // number of indices, or of vertices
    size_t instances;              // how often they are drawn; 0 counts as 1
    bool over;                     // blends, see above
    const struct orl_tex *textures[ORL_BINDINGS_MAX];     // what both programs read, by binding
    const struct orl_tex *images[ORL_BINDINGS_MAX];
    const struct orl_tex *targets[ORL_RASTER_TARGETS_MAX]; // by output location; floating point
    const struct orl_tex *depth;   // GL_DEPTH_COMPONENT32F; NULL: no depth test
};
// As after orl_gpu_dispatch, errors are sticky, and later programs see what the draw has written.
void orl_gpu_raster(struct orl_gpu *gpu, const struct orl_raster *raster);

#endif
