// Private to src/render: the selection of Princ 2014.
#ifndef ORL_RENDER_PRINC_H
#define ORL_RENDER_PRINC_H

#include "render/frame/method.h"

// Photographs beside those by direction, for surfaces that these see too obliquely.
enum { ORL_PRINC_EXTRAS = 3 };

extern const struct orl_selection orl_select_princ;

#endif
