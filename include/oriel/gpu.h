// The GL device: headless EGL context, buffers, textures, compute programs and pass timers. This is
// the only module that creates or deletes GL objects.
//
// Thread safety: everything made from an orl_gpu belongs to the thread that created it. All objects
// must be destroyed before their orl_gpu.
#ifndef ORIEL_GPU_H
#define ORIEL_GPU_H

#include <epoxy/gl.h>

#include "oriel/log.h"

struct orl_gpu;

struct orl_gpu_params {
    const char *shader_dir; // folder to read shaders from; NULL: use the embedded shaders
    bool debug;             // log GL debug output; errors become sticky failures;
                            // programs are always compiled, so that all warnings show
    // Folder of the cache of linked programs; NULL: oriel in $XDG_CACHE_HOME or ~/.cache; "": no
    // cache, as with ORIEL_CACHE=off in the environment.
    const char *cache_dir;
};

struct orl_gpu_caps {
    char vendor[128], renderer[128], version[128]; // as GL reports
    bool software;               // a CPU renderer such as llvmpipe
    size_t max_storage_block;    // bytes of one shader storage binding
    int max_texture_size;        // pixels
    int max_buffer_texels;       // texels of one buffer bound as an image
    int max_texture_layers;
};

// Opens a device without a display: tries the EGL device platform, then Mesa's surfaceless one.
// Without OpenGL 4.5 core returns ORL_ERR_GPU; the log then says what was found and how to get
// Mesa's software renderer.
enum orl_result orl_gpu_create(const struct orl_log *log, const struct orl_gpu_params *params,
                               struct orl_gpu **out) ORL_CHECK_RESULT;
void orl_gpu_destroy(struct orl_gpu **gpu);
const struct orl_gpu_caps *orl_gpu_caps(const struct orl_gpu *gpu);
const struct orl_log *orl_gpu_log(const struct orl_gpu *gpu);
// Waits for the device. ORL_ERR_GPU if any GL error occurred since the last call, and always once the
// device has been reset: what was read from it before this call must not be used then.
enum orl_result orl_gpu_finish(struct orl_gpu *gpu) ORL_CHECK_RESULT;
// What a buffer or texture holds, for accounts of device memory.
enum orl_owner {
    ORL_OWNER_FRAME, // targets, lists and all else that a frame needs
    ORL_OWNER_POINTS,
    ORL_OWNER_PHOTOGRAPHS,
    ORL_OWNER_COUNT
};
// By enum orl_owner: "frame", "points", "photographs".
extern const char *const orl_owner_names[ORL_OWNER_COUNT];
// Bytes in live buffers and textures.
size_t orl_gpu_bytes(const struct orl_gpu *gpu);
// The same of one owner.
size_t orl_gpu_owner_bytes(const struct orl_gpu *gpu, enum orl_owner owner);
// The same by owner and tag: fills up to `capacity` rows in order of first use and returns how many
// there are.
struct orl_gpu_memory {
    enum orl_owner owner;
    const char *tag;
    size_t bytes;
    unsigned objects;
};
size_t orl_gpu_memory(const struct orl_gpu *gpu, struct orl_gpu_memory *rows, size_t capacity);

// --- buffers and textures ---

struct orl_tex_params {
    int width, height;
    int layers;      // 0: a 2D texture, otherwise a 2D array
    int levels;      // mip levels; 0 counts as 1
    GLenum format;   // sized internal format, such as GL_RGBA32F
    bool linear;     // linear filtering (and between levels); false: nearest
    enum orl_owner owner;
    const char *tag; // string literal
};
struct orl_tex {
    GLuint id;
    struct orl_tex_params params;
    size_t bytes;
};
struct orl_buf {
    GLuint id;
    size_t size;
    enum orl_owner owner;
    const char *tag; // string literal, for GL labels and messages
    struct orl_tex texels; // the buffer as a texture or image; id 0: none was asked for
};
// data may be NULL: zeroed. format: of texels as which programs read the buffer, such as GL_RGBA32F, at most
// caps->max_buffer_texels; 0: none. Reads of texels give the same as storage reads, but are several times cheaper on
// software renderers.
enum orl_result orl_buf_create(struct orl_gpu *gpu, enum orl_owner owner, const char *tag, size_t size,
                               const void *data, GLenum format, struct orl_buf **out) ORL_CHECK_RESULT;
// Keeps *buf, which may be NULL, if it has room for `size` bytes; else a new one takes its place, which has more room
// than that if the old one was too small.
enum orl_result orl_buf_fit(struct orl_gpu *gpu, enum orl_owner owner, const char *tag, size_t size, GLenum format,
                            struct orl_buf **buf) ORL_CHECK_RESULT;
void orl_buf_destroy(struct orl_gpu *gpu, struct orl_buf **buf);
void orl_buf_write(struct orl_buf *buf, size_t offset, size_t size, const void *data);
// Reads the first `size` bytes. Waits for the device.
void orl_buf_read(const struct orl_buf *buf, size_t size, void *data);
// Sets every 32-bit word to `word`.
void orl_buf_fill(struct orl_buf *buf, uint32_t word);

// Creates a texture, filled with zeros unless it is compressed. Texture coordinates clamp to the edge.
enum orl_result orl_tex_create(struct orl_gpu *gpu, const struct orl_tex_params *params,
                               struct orl_tex **out) ORL_CHECK_RESULT;
// One of several textures of the same size.
struct orl_tex_row {
    const char *tag;
    GLenum format;
    struct orl_tex **tex;
};
enum orl_result orl_tex_create_rows(struct orl_gpu *gpu, int width, int height, const struct orl_tex_row *rows,
                                    size_t count) ORL_CHECK_RESULT;
// Keeps *tex, which may be NULL, if it has this size, as many levels and this format; else a new texture
// takes its place.
enum orl_result orl_tex_fit(struct orl_gpu *gpu, const struct orl_tex_params *params,
                            struct orl_tex **tex) ORL_CHECK_RESULT;
void orl_tex_destroy(struct orl_gpu *gpu, struct orl_tex **tex);
// True if the device can sample textures of this compressed format.
bool orl_gpu_has_compressed(const struct orl_gpu *gpu, GLenum format);
// The number of mip levels down to one texel.
int orl_mip_levels(int width, int height);
// Bytes of one layer with all its levels.
size_t orl_tex_layer_bytes(const struct orl_tex_params *params);
// Writes level 0 of a texture without layers: tightly packed pixels of a client format and type, such as GL_RGB,
// GL_UNSIGNED_BYTE.
void orl_tex_write(struct orl_tex *tex, GLenum format, GLenum type, const void *pixels);
// Writes the top left width x height part of level 0 of a layer (0 without layers) in the same way.
void orl_tex_write_layer(struct orl_tex *tex, int layer, int width, int height, GLenum format, GLenum type,
                         const void *pixels);
// Reads a level and waits for the device. `size`: room in `pixels`, bytes.
void orl_tex_read(const struct orl_tex *tex, int level, GLenum format, GLenum type, size_t size,
                  void *pixels);
// Copies the top left width x height part of a level of `from` to level 0 of a layer of `to`.
void orl_tex_copy_layer(const struct orl_tex *from, int level, int width, int height,
                        struct orl_tex *to, int layer);
// Compresses all levels of `to` from `from`, 8 bits per channel, into a layer of the array `to`,
// which must have the same size. RGTC1 gets the luma; RGTC2 the chroma, and has half the size,
// rounded up. Oriel encodes them (gpu/compress.h). Alpha is lost. Waits for the device.
enum orl_result orl_tex_compress_layer(struct orl_gpu *gpu, const struct orl_tex *from,
                                       struct orl_tex *to, int layer) ORL_CHECK_RESULT;
// Sets level 0 of a layer (0 without layers) to 0; not of compressed formats.
void orl_tex_clear(struct orl_tex *tex, int layer);
// Sets every texel of level 0 of a GL_R32UI texture to `word`.
void orl_tex_fill(struct orl_tex *tex, uint32_t word);
// Fills the coarser levels of one layer (0 without layers) from its level 0, which shaders may have
// written. GL_RGBA8 counts as sRGB, whose means are those of light. Samplers see all levels from then on.
void orl_tex_make_mipmaps(struct orl_tex *tex, int layer);
// Whether samples between two levels mix both, as a linear texture does when it is made. Without, they
// read the nearer one: software renderers pay for the choice even where levels are whole.
void orl_tex_mix_levels(struct orl_tex *tex, bool mix);

// --- programs and dispatch ---

struct orl_prog;
// An exchangeable part of a program: #include <name> in its files includes the shader file `file`.
struct orl_slot {
    const char *name, *file;
};
// Returns the compute program of the shader `file` (relative to shaders/). Its source is expanded:
// #include "..." and <...> are resolved, and #version 450 core and `defines` are prepended. The
// lines "A 1\nB 2\n" of `defines` become #define lines; NULL: none. slots: terminated by a NULL
// name; NULL: none. The program is made on first request, cached and owned by the gpu. If it does
// not compile, the cause is logged, and every dispatch of it is a sticky failure.
struct orl_prog *orl_prog_get(struct orl_gpu *gpu, const char *file, const struct orl_slot *slots,
                              const char *defines);
// The same for the graphics pipeline (raster.h).
struct orl_prog *orl_prog_get_raster(struct orl_gpu *gpu, const char *vertex_file,
                                     const char *fragment_file, const char *defines);
// True if the compiled program reads or writes the image or buffer of this name.
bool orl_prog_reads(const struct orl_prog *prog, const char *name);
// The `index`-th shader file below `folder`, in order of names; NULL past the end. The string is
// static.
const char *orl_shader_file(const char *folder, size_t index);

enum { ORL_BINDINGS_MAX = 8 };
// One compute dispatch; array index = binding point of its kind, NULL: not bound.
struct orl_dispatch {
    struct orl_prog *prog;
    const void *params;        // contents of the std140 block at uniform binding 0
    size_t params_size;        // its bytes, at least the size of the program's block
    const struct orl_buf *bufs[ORL_BINDINGS_MAX];
    const struct orl_tex *textures[ORL_BINDINGS_MAX];
    const struct orl_tex *images[ORL_BINDINGS_MAX]; // level 0; the shader says what it reads and what it writes
    int layer;                 // of the arrays among the images
    int size[2];               // invocations, rounded up to whole work groups; 0 counts as 1
    const struct orl_buf *indirect; // NULL, or a buffer whose first three words are the work groups
};
#define ORL_PARAMS(block) .params = &(block), .params_size = sizeof(block)
// Later dispatches, draws and the functions above see what the program has written.
void orl_gpu_dispatch(struct orl_gpu *gpu, const struct orl_dispatch *dispatch);
static inline unsigned orl_groups(size_t items, unsigned group_size)
{
    return (unsigned)((items + group_size - 1) / group_size);
}

// --- pass timers ---

struct orl_pass_time {
    const char *name; // as given to orl_pass_begin
    double ms;        // sum of all passes of this name since the last reset
    unsigned count;
};
// Passes must not nest. `name` is a string literal. Timing is off by default and costs nothing
// then. On software renderers an enabled timer drains the pipeline, since GL's own timestamps do
// not bound compute work there.
void orl_gpu_time_passes(struct orl_gpu *gpu, bool enabled);
void orl_pass_begin(struct orl_gpu *gpu, const char *name);
void orl_pass_end(struct orl_gpu *gpu);
// A dispatch that is a pass.
void orl_gpu_pass(struct orl_gpu *gpu, const char *name, const struct orl_dispatch *dispatch);
// Waits for pending timers, fills up to `capacity` rows in order of first use, resets the sums, and
// returns the number of passes.
size_t orl_gpu_take_times(struct orl_gpu *gpu, struct orl_pass_time *times, size_t capacity);

// One execution of a pass: when the CPU issued it and when the device ran it, in seconds of
// orl_time_s. On a software renderer the device's end is the time at which the pipeline was
// drained.
struct orl_pass_span {
    const char *name;
    double cpu_start_s, cpu_end_s, gpu_start_s, gpu_end_s;
};
struct orl_pass_trace {
    struct orl_pass_span *spans; // owned by the caller
    size_t capacity, count;
    size_t dropped;              // spans that did not fit
};
// Records every timed pass in `trace`, which must outlive the recording. NULL ends it and waits
// for pending passes. Requires orl_gpu_time_passes.
void orl_gpu_trace_passes(struct orl_gpu *gpu, struct orl_pass_trace *trace);

#endif
