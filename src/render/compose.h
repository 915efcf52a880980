// Private to src/render: the passes between the painter and the finished picture.
#ifndef ORL_RENDER_COMPOSE_H
#define ORL_RENDER_COMPOSE_H

#include "render/frame/frame.h"

// A pass after the painter. The passes run in the order of the list.
struct post_pass {
    const char *name;
    bool (*applies)(const struct frame *frame); // NULL: always
    void (*run)(const struct frame *frame);
};
// Terminated by a NULL name.
extern const struct post_pass orl_post_passes[];

#endif
