// Private to src/render: a finished frame from the device to host memory.
#ifndef ORL_RENDER_READ_BACK_H
#define ORL_RENDER_READ_BACK_H

#include "render/frame/frame.h"

// Reads all layers except params->leave_out. `staging` is reused for frames of the same kind.
enum orl_result orl_read_back(const struct frame *frame, struct orl_image *staging,
                              struct orl_frame *out);

#endif
