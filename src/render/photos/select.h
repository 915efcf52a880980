// Private to src/render: selection of the photographs that a frame asks.
#ifndef ORL_RENDER_SELECT_H
#define ORL_RENDER_SELECT_H

#include "render/frame/method.h"
#include "render/photos/photos.h"

// True if the frame may be painted from the photograph.
bool orl_frame_may_use(const struct frame *frame, size_t photo);
// The penalty of shaders/shared/penalty.h for a photograph and a world point; negative if the point
// is outside the photograph. eye: the view's camera centre; view_focal: its fx, pixels.
double orl_photo_penalty(const struct orl_view *photo, const double eye[3], double view_focal,
                         const double point[3]);

#endif
