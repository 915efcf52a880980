// Private to src/gpu.
#ifndef ORL_GPU_INTERNAL_H
#define ORL_GPU_INTERNAL_H

#include <epoxy/egl.h>

#include "core/memory.h"
#include "oriel/gpu.h"

enum { ORL_PASSES_MAX = 64, ORL_QUERIES_MAX = 256, ORL_MEMORY_ROWS_MAX = 64,
       ORL_SHADER_FILES_MAX = 48 };

struct pass_query {
    GLuint ids[2]; // of its begin and end; 0: not created yet
    int pass;
    struct orl_pass_span *span; // in the trace; NULL: not traced
};

struct orl_gpu {
    const struct orl_log *log;
    EGLDisplay display;
    EGLContext context;
    struct orl_gpu_caps caps;
    char *shader_dir; // owned; NULL: embedded shaders
    char program_cache[ORL_PATH_SIZE]; // folder; "": no cache
    bool failed;      // sticky: a GL error or a high-severity message
    bool lost;        // for good: the device was reset
    bool current;     // the context could be made current
    struct orl_prog **progs; // programs made so far, owned
    size_t prog_count, prog_capacity;
    GLuint vertex_array, framebuffer; // of raster.c
    size_t live_bytes;
    struct orl_gpu_memory memory[ORL_MEMORY_ROWS_MAX];
    size_t memory_count;

    bool timing;
    int pass; // index of the open pass; -1: none
    double pass_start_s;
    struct orl_pass_time passes[ORL_PASSES_MAX];
    size_t pass_count;
    struct pass_query queries[ORL_QUERIES_MAX];
    size_t query_count; // pending queries
    struct orl_pass_trace *trace;               // NULL: no recording
    double clock_offset_s; // added to the device's clock to get orl_time_s
};

// Expanded source of shaders/`file`: version, defines, includes, #line. Owned by the caller
// even after an error (orl_shader_source_finish). files: file names by source number of #line, for messages.
struct shader_source {
    struct orl_bytes text;
    const char *files[ORL_SHADER_FILES_MAX]; // static strings
    size_t file_count;
};
enum orl_result orl_shader_source_load(struct orl_gpu *gpu, const char *file,
                                       const struct orl_slot *slots, const char *defines,
                                       struct shader_source *source);
void orl_shader_source_finish(struct shader_source *source);

// Mesa maps its cache of programs into memory and ends by SIGBUS when the disk is full. Oriel's own
// cache does not spare it: it lacks the machine code of the software renderer. So this turns it off,
// in the environment, where the disk has little room. Before the display is opened.
void orl_mesa_cache_guard(const struct orl_log *log);
// Cache of linked programs (program_cache.c). dir: cache_dir of struct orl_gpu_params.
void orl_program_cache_open(struct orl_gpu *gpu, const char *dir);
// True if `program` was found and is linked.
bool orl_program_cache_load(struct orl_gpu *gpu, const struct shader_source *source,
                            GLuint program);
void orl_program_cache_store(struct orl_gpu *gpu, const struct shader_source *source,
                             GLuint program);

// program.c: makes the program current with these parameters. False, a sticky failure, on error.
bool orl_prog_use(struct orl_gpu *gpu, struct orl_prog *prog, const void *params, size_t size);
// Binds textures and images, ORL_BINDINGS_MAX of each, as orl_dispatch has them.
void orl_gpu_bind(const struct orl_tex *const *textures, const struct orl_tex *const *images, int layer);
// Makes what a program has written visible to the programs that follow. Reads and writes by the host have barriers
// of their own.
void orl_gpu_barrier(void);
void orl_gpu_free_programs(struct orl_gpu *gpu);

// Logs every pending GL error as caused by `where`. True if there was none.
bool orl_gpu_check_errors(struct orl_gpu *gpu, const char *where);
void orl_gpu_free_queries(struct orl_gpu *gpu);
// Adds objects and their bytes to those of their owner and tag; negative ones are taken away.
void orl_gpu_count(struct orl_gpu *gpu, enum orl_owner owner, const char *tag, ptrdiff_t bytes, int objects);

#endif
