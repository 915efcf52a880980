// The picture that a program changes pixel by pixel: linear colour, coverage. FINISHED: the painter has finished all
// pixels but those that are unpainted.
#include "shared/image.glsl"

#ifdef FINISHED
layout(rgba16f, binding = 0) uniform image2D picture;
#else
layout(rgba32f, binding = 0) uniform image2D picture;
#endif
