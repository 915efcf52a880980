// Private to src/render: the selection of Princ 2014.
#ifndef ORL_RENDER_PRINC_H
#define ORL_RENDER_PRINC_H

#include "render/method.h"

extern const struct orl_selection orl_select_princ;

#endif
