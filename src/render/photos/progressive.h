// Private to src/render: photographs for the frames of a viewer, which must not wait for them.
#ifndef ORL_RENDER_PROGRESSIVE_H
#define ORL_RENDER_PROGRESSIVE_H

#include "render/frame/frame.h"

// For a progressive frame: brings chosen photographs to the device, the most useful first, within
// the frame's time, and removes those from frame->chosen that are not there. Sets the count of
// missing photographs. depth: the frame needs their depth, too.
enum orl_result orl_progressive_admit(struct frame *frame, bool depth) ORL_CHECK_RESULT;
// Before a frame's surface is drawn: may the frame need the proxy's colours, for which the surface
// must have normals? They cost about a tenth of a frame, so this is guessed from the frame before.
bool orl_progressive_underpaints(const struct frame *frame);

#endif
