// Private to src/render: photographs for the frames of a viewer, which must not wait for them.
#ifndef ORL_RENDER_PROGRESSIVE_H
#define ORL_RENDER_PROGRESSIVE_H

#include "render/frame.h"

// For a progressive frame: brings chosen photographs to the device, the most useful first, within
// the frame's time, and removes those from frame->chosen that are not there. Sets the count of
// missing photographs. depth: the frame needs their depth, too.
enum orl_result orl_progressive_admit(struct frame *frame, bool depth) ORL_CHECK_RESULT;
// Gives pixels that no photograph has painted the colours of the proxy, if photographs are missing.
void orl_progressive_underpaint(const struct frame *frame);

#endif
