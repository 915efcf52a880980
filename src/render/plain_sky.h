// Private to src/render: the plain sky of views of a scene whose photographs are of different days.
#ifndef ORL_RENDER_PLAIN_SKY_H
#define ORL_RENDER_PLAIN_SKY_H

#include "render/frame.h"
#include "render/method.h"
#include "shared/render_blocks.h"

// True if this frame has a plain sky: the method asks for it, and photographs show one.
bool orl_sky_applies(const struct frame *frame);
// Sets what the painter needs to know about the sky: of the frame, and of one of its photographs, whose
// gain `data` has.
void orl_sky_describe(const struct frame *frame, struct gather_block *block);
void orl_sky_describe_photo(const struct frame *frame, const struct orl_photo *photo,
                            struct photo_data *data);
// Finds how far the view's columns are open to the sky. `d`: a dispatch of the painter, which then reads
// the columns.
enum orl_result orl_sky_find(const struct frame *frame, struct orl_dispatch *d) ORL_CHECK_RESULT;

#endif
