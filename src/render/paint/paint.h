// Private to src/render: the passes that make a picture's colours, and what they keep between frames.
#ifndef ORL_RENDER_PAINT_H
#define ORL_RENDER_PAINT_H

#include "render/frame/frame.h"
#include "shared/render_blocks.h"
#include "soft/soft_raster.h"

// --- gather.c: the shaders' parameters of photographs ---

enum { PHOTO_ROWS = 7 };  // image binding of shaders/gather/photo.glsl

struct gather {
    struct photo_data *list;    // parameters of the photographs of one dispatch
    struct orl_buf *photos;     // the same on the device, as RGBA32F texels
    struct orl_buf *tile_lists; // listed photographs of each tile
    char *options;              // owned: defines RENDER_OPTIONS (render_blocks.h)
};

enum orl_result orl_gather_init(struct orl_gpu *gpu, size_t photo_count, struct gather *gather);
void orl_gather_finish(struct orl_gpu *gpu, struct gather *gather);
// Side of the tiles that share a list of photographs, pixels. It follows the photographs' pixels, since
// a list that serves a larger part of the scene misses what one photograph sees between others.
int orl_tile_side(const struct frame *frame);
// Makes the parameters of a program that reads photographs, and uploads those of this dispatch:
// `count` photographs of frame->chosen from `first` on, which must be resident.
struct gather_block orl_gather_prepare(const struct frame *frame, size_t first, size_t count);
// The program of the shader `file` with the method's slots, the declaration of the options and `defines` (NULL: none).
struct orl_prog *orl_gather_prog(const struct frame *frame, const char *file, const char *defines);
// Empties the picture and what belongs to it.
void orl_gather_clear(const struct frame *frame);

// For a progressive frame: gives pixels that no photograph has painted the colours of the proxy, if
// photographs are absent. Does nothing in the first frame of which that is so: without normals, the proxy has
// no colours.
enum orl_result orl_gather_underpaint(const struct frame *frame) ORL_CHECK_RESULT;

// --- fill.c: background depth and colour for pixels that nothing covers, and input of the blur on estimated depth,
// done by shaders/fill/compose.comp ---

enum { FILL_LEVELS_MAX = 17 };

struct fill {
    struct image_block block; // parameters of the passes
    int levels;               // of the picture; further ones are left from a larger one
    // The pyramid: value * weight, weight. Level 0 has half the picture's size.
    struct orl_tex *level[FILL_LEVELS_MAX];
    struct orl_tex *guesses; // mipmapped sums over 2x2 pixels of (colour, 1) on estimated depth
};

// Makes the textures fit pictures of this size.
enum orl_result orl_fill_resize(struct orl_gpu *gpu, struct fill *fill, int width, int height) ORL_CHECK_RESULT;
void orl_fill_finish(struct orl_gpu *gpu, struct fill *fill);

// Invocations of a program of shaders/fill/apply.glsl for a picture of this size.
void orl_fill_size(int width, int height, int size[2]);

// Writes the estimated background depth ("guess" in identifiers), as negative values, where the
// surface has none. With fill=ground it is no farther than the scene's ground.
void orl_fill_depth(const struct frame *frame);
// Completes the picture of a room where no photograph shows it.
void orl_fill_room(const struct frame *frame, struct orl_tex *room);
// Spreads the blended colours over fill->level[0]. Painters that finish pixels have already written
// sums over 2x2 pixels of (colour, 1) there. In radiance, clipped pixels first take the light
// around them. Before a room only colours of surfaces count.
enum orl_result orl_fill_color(const struct frame *frame) ORL_CHECK_RESULT;
// Makes the mipmaps of fill->guesses. Painters that finish pixels have written the sums; for radiance they are
// made here.
enum orl_result orl_fill_guesses(const struct frame *frame) ORL_CHECK_RESULT;

// --- guess.c: guessed depth moves to where photographs do not see past it ---

struct guess {
    struct orl_buf *costs, *sums;         // per cell and plane: shaders/guess/planes.glsl
    struct orl_tex *estimated, *picked;   // per cell, R32F: inverse depth; share of it
};

// Allocates for pictures of this size. Does nothing if the frame tries no depths.
enum orl_result orl_guess_resize(const struct frame *frame, struct guess *guess);
void orl_guess_finish(struct orl_gpu *gpu, struct guess *guess);
// True if this frame tries depths: the method asks for it, and the costs fit into a storage buffer.
bool orl_guess_applies(const struct frame *frame);
// Moves the estimated background depth to where few photographs see past it and the others agree,
// from the estimate to infinity. `choice`: the dispatch of shaders/gather/choose.comp, with the
// parameters `block`, that has run. Its lists stay as they are.
void orl_guess_depth(const struct frame *frame, const struct orl_dispatch *choice,
                     const struct gather_block *block);

// --- edges.c: what single pixels show wrongly: specks, and depth edges that are not antialiased ---

struct edges {
    struct orl_buf *list;  // shaders/edges/edge_list.glsl
    struct orl_tex *painted; // RG8, of each pixel: how much its best photograph varies there; fourth root of light
};

// Makes room for the pixels of pictures of this size.
enum orl_result orl_edges_resize(struct orl_gpu *gpu, struct edges *edges, int width, int height) ORL_CHECK_RESULT;
void orl_edges_finish(struct orl_gpu *gpu, struct edges *edges);
// Whether the painter keeps `painted`, and specks go.
bool orl_edges_find_specks(const struct frame *frame);
// Gives specks the colour of what surrounds them.
enum orl_result orl_edges_remove_specks(const struct frame *frame) ORL_CHECK_RESULT;
// Averages the finished colours across depth discontinuities.
enum orl_result orl_edges_antialias(const struct frame *frame) ORL_CHECK_RESULT;

// --- soft_layer.c: the scene's soft splats (src/soft) in the frame's picture ---

// Where the surface is wrong, a picture blended from photographs has its structure in wrong places. The splats show how
// much: what they show in those photographs, blended in the same way, then differs from what they show in the view.

// Zero-initialised, it holds nothing: the splats are read with the first frame that shows them.
struct soft_layer {
    bool shows; // the frame's picture shows them
    struct orl_soft_raster raster;
    // Owned, of the view's size, R16F: the luma of splats in photographs, blended, < 0: none; mipmapped, how far that
    // in the view differs.
    struct orl_tex *gathered, *differs;
};

// Makes the layer of a frame whose photographs are chosen ready, with the splats as each of them shows them. In a
// progressive frame it is one photograph, and while others lack it, the frame no longer shows the splats.
// ORL_ERR_NOT_FOUND: the scene has none (oriel refine).
enum orl_result orl_soft_layer_ready(struct frame *frame) ORL_CHECK_RESULT;
// Corrects the frame's picture.
enum orl_result orl_soft_layer_mix(const struct frame *frame) ORL_CHECK_RESULT;
// Keeps what the splats show in a photograph in a layer of a GL_R8 texture at least as large, but for its mip levels.
enum orl_result orl_soft_layer_keep(struct orl_gpu *gpu, struct orl_soft_raster *raster, const struct orl_view *view,
                                    struct orl_tex *slots, int slot) ORL_CHECK_RESULT;
void orl_soft_layer_finish(struct orl_gpu *gpu, struct soft_layer *layer);

// --- paint.c ---

struct paint {
    struct gather gather;      // parameters of the photographs in use
    struct fill fill;
    struct soft_layer soft;
    struct edges edges;
    struct guess guess;
    struct orl_tex *trusted;   // RGBA32F, radiance: weight * confidence, weight, blur; else NULL
    struct orl_tex *states[2]; // RGBA32F, state of a combination between sweeps, and output of
                               // a filter; else NULL
};

enum orl_result orl_paint_init(struct orl_gpu *gpu, size_t photo_count, struct paint *paint) ORL_CHECK_RESULT;
void orl_paint_finish(struct orl_gpu *gpu, struct paint *paint);
// Makes the targets fit what this frame runs. Does nothing if all is there.
enum orl_result orl_paint_resize(const struct frame *frame) ORL_CHECK_RESULT;

#endif
