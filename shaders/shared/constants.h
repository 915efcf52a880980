// Numbers that the renderer and the published page share: read by C, by shaders, and by web/js/renderer.js, which takes
// them from this text.
#ifndef ORL_CONSTANTS_H
#define ORL_CONSTANTS_H

// A splat this large, as a share of the picture's height, that is nearer than any photograph was to
// a surface, is an outlier that the viewer has come upon: no surface is known so coarsely.
#define ORL_OUTLIER_SHARE 0.0625
// Pixels over which photographs fade out at their borders, by the weight `lumigraph`.
#define ORL_BORDER_PX 2.0
// Photographs that are listed for each tile of the screen: one more than a pixel can blend.
#define ORL_CANDIDATES 5
// Photographs that a frame is painted from, at most; the page numbers them by one byte. Radiance asks all.
#define ORL_PHOTOS_PER_FRAME 32
// Ground farther than so many of the photographs' heights above it is ignored: what stands on it hides it.
#define ORL_GROUND_REACH 20.0
// The farthest estimate of background depth, as a multiple of a typical depth of the scene.
#define ORL_GUESS_FARTHEST 1000.0
// How much a painted surface counts beside painted background in the colours of what no photograph shows: that is
// background nearly always, not a part of the surface before it.
#define ORL_SURFACE_SEED 0.1
// The largest blur of guessed depth as a share of the picture's longer side: with a larger one, holes of a surface would
// take the colours of what is beside it.
#define ORL_BLUR_MAX 0.012
// Cells in which estimated depths are tried, along the longer side of the picture, at least.
#define ORL_GUESS_CELLS 48
// The coarse part of what soft splats correct is a mean over a photograph's longer side divided by this: colours
// of splats are less exact than those of photographs, their structure is more so where a surface is wrong.
#define ORL_SOFT_COARSE 80.0
// Of soft splats as they are published: logarithms of standard deviations lie between minus this and this, and
// coefficients of colour are at most this.
#define ORL_SOFT_SIGMA_LOG 20.0
#define ORL_SOFT_COLOR_MOST 2.5

#endif
