// Private to src/render: what the names of a method's slots stand for.
#ifndef ORL_RENDER_METHOD_H
#define ORL_RENDER_METHOD_H

#include "render/render.h"

struct frame;

// Which photographs a frame asks.
struct selection {
    const char *name;
    // Writes their indices, ascending, to frame->chosen. At most `most` where the selection
    // bounds them; `all` does not.
    enum orl_result (*choose)(struct frame *frame, size_t most);
};

// How the samples of a pixel become one colour (shaders/gather/combine), and how that streams
// where not all photographs are on the device at once: sums go on from turn to turn; what needs
// to know all samples before it can weigh one asks them all twice.
struct combine {
    const char *name;
    int sweeps; // 1 or 2; 0: only its painter knows it
    int states; // images that a pixel keeps between sweeps, [0, 2]
};

// Who turns a surface into colours.
struct painter {
    const char *name;
    const char *needs; // choices that it takes alone, as option_list.h's readers; all must hold
    bool finishes;     // leaves finished pixels but those that it lists (shaders/shared/pixel.glsl);
                       // not of radiance
    bool (*reads_normals)(const struct frame *frame); // the surface's; NULL: never
    enum orl_result (*paint)(struct frame *frame);
};

// By the names in `params`, which orl_render_params_check has passed.
const struct selection *orl_selection_of(const struct orl_render_params *params);
const struct combine *orl_combine_of(const struct orl_render_params *params);
const struct painter *orl_painter_of(const struct orl_render_params *params);
const struct proxy_kind *orl_proxy_kind_of(const struct orl_render_params *params);

// The `index`-th name that the slot `key` may have; false: there are no more.
bool orl_slot_name(const char *key, size_t index, char name[ORL_OPTION_NAME_BYTES]);
// Does "key=name" hold, of an option that is read or of sample?
bool orl_render_params_equal(const struct orl_render_params *params, const char *condition);

#endif
