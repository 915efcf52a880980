// Private to src/render: which photographs a frame asks.
#ifndef ORL_RENDER_SELECT_H
#define ORL_RENDER_SELECT_H

#include "render/method.h"
#include "render/photos.h"

extern const struct selection orl_select_all, orl_select_nearest, orl_select_preselect;

// The penalty of shaders/shared/penalty.h of a photograph for a point of the world that it shows;
// negative where it does not. view_focal: fx of the view, pixels.
double orl_photo_penalty(const struct orl_view *photo, const double eye[3], double view_focal,
                         const double point[3]);

#endif
