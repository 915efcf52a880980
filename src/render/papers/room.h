// Private to src/render: the place around the subject, with the photographs projected on it (Li
// 2003, section 5.1).
#ifndef ORL_RENDER_ROOM_H
#define ORL_RENDER_ROOM_H

#include "render/frame/frame.h"

// Paints it (RGBA32F, of the view's size) in the encoding of blended pixels: the scene's room, or where it has none a
// shell around the scene. With pictures of the place without the subject these are projected, else
// the photographs, except where the subject is before the walls. Photographs that see a wall count
// alike (equation 1). In radiance photographs
// are projected, each weighted by its confidence: pictures of the empty place have no exposure.
// Overwrites the frame's chosen photographs. *absent: how many it lacks in a progressive frame, else 0.
enum orl_result orl_room_paint(struct frame *frame, struct orl_tex *room, size_t *absent) ORL_CHECK_RESULT;
// Shows it in the frame's picture where nothing was painted before it.
void orl_room_show(const struct frame *frame, const struct orl_tex *room);

#endif
