// Private to src/render: photographs for the frames of a viewer, which must not wait for them.
#ifndef ORL_RENDER_PROGRESSIVE_H
#define ORL_RENDER_PROGRESSIVE_H

#include "render/frame.h"

// For a progressive frame: brings chosen photographs to the device, the most useful first, within
// the frame's time, and removes those from frame->chosen that are not there. Sets the count of
// missing photographs. depth: the frame needs their depth, too.
enum orl_result orl_progressive_admit(struct frame *frame, bool depth) ORL_CHECK_RESULT;
// Before a frame's surface is drawn: may the frame need the proxy's colours, for which the surface
// must have normals? They cost about a tenth of a frame, so this is guessed from the frame before.
bool orl_progressive_underpaints(const struct frame *frame);
// Gives pixels that no photograph has painted the colours of the proxy, if photographs are absent.
// Does nothing in the first frame of which that is so: without normals, the proxy has no colours.
enum orl_result orl_progressive_underpaint(const struct frame *frame) ORL_CHECK_RESULT;

#endif
