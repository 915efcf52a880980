// Private to src/render: the shaders' parameters of photographs, and the painters that need only
// the generic gather.
#ifndef ORL_RENDER_GATHER_H
#define ORL_RENDER_GATHER_H

#include "render/frame/frame.h"
#include "render/frame/method.h"
#include "shared/render_blocks.h"

enum { PHOTO_ROWS = 7 };  // image binding of shaders/gather/photo.glsl

struct gather {
    struct photo_data *list;    // parameters of the photographs of one dispatch
    struct orl_buf *photos;     // the same on the device
    struct orl_tex *photo_rows; // view of `photos` as RGBA32F texels
    struct orl_buf *tile_lists; // listed photographs of each tile
    struct orl_buf *unfinished; // marks of the last tiled painter: gather/unfinished.glsl
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
// The program of the shader `file` with the declaration of the options and `defines` (NULL: none).
struct orl_prog *orl_gather_prog(const struct frame *frame, const char *file,
                                 const struct orl_slot *slots, const char *defines);
// The files of the method's slots for orl_prog_get.
enum { GATHER_SLOTS = 5 };
struct gather_slots {
    char files[GATHER_SLOTS][64];
    struct orl_slot slots[GATHER_SLOTS];
};
void orl_gather_slots(const struct frame *frame, struct gather_slots *out);
// Puts another file into a slot.
void orl_gather_set_slot(struct gather_slots *slots, const char *slot, const char *file);
// Empties the picture and what belongs to it.
void orl_gather_clear(const struct frame *frame);
// Ensures room for `bytes` in *buf, whose contents may be lost.
enum orl_result orl_make_room(struct orl_gpu *gpu, const char *tag, size_t bytes,
                              struct orl_buf **buf);

// For a progressive frame: gives pixels that no photograph has painted the colours of the proxy, if
// photographs are absent. Does nothing in the first frame of which that is so: without normals, the proxy has
// no colours.
enum orl_result orl_gather_underpaint(const struct frame *frame) ORL_CHECK_RESULT;

extern const struct orl_combine orl_combine_mean;
// gather: runs shaders/gather/gather.comp with the method's slots, in batches of as many
// photographs as are resident together. points: shows the proxy's own colours, of splats or of a mesh's vertices.
extern const struct orl_painter orl_paint_gather, orl_paint_points;

#endif
