// ORIEL_GPU_CHECK=1: every index into an array, buffer or texture is compared with its size while
// shaders run, and every target that they wrote is searched for values that are not finite. What is
// found is logged with shader, line and name, and is a sticky failure of the device.
#ifndef ORL_GPU_CHECK_H
#define ORL_GPU_CHECK_H

#include "gpu/internal.h"
#include "gpu/raster.h"

// Where an index is written: in a file of a program (shader_source.files), at the bracket or
// function name that begins it. Counted from 0, 1 and 0.
struct orl_check_site {
    unsigned file, line, column;
};
uint32_t orl_check_site_pack(const struct orl_check_site *site);
struct orl_check_site orl_check_site_unpack(uint32_t word);

// Text of a shader file with its indexes checked by the functions of shaders/check/index.glsl.
// Lines keep their numbers; comments become spaces. Owned by the caller; NULL, logged: no memory.
char *orl_check_source(const struct orl_log *log, const char *text, unsigned file);
// The expression at a line and column of the original text: its start and length. NULL: there is
// none.
const char *orl_check_expression(const char *text, const struct orl_check_site *site,
                                 size_t *length);

// Device state of the checks. NULL stands for checks that are off, for all of these.
struct orl_check;
enum orl_result orl_check_create(const struct orl_log *log,
                                 struct orl_check **out) ORL_CHECK_RESULT;
// Logs what was checked. The context must be current.
void orl_check_destroy(const struct orl_log *log, struct orl_check **check);
// Before a dispatch: clears the record of wrong indexes and binds it.
void orl_check_begin(struct orl_check *check);
// After it, and after a draw.
void orl_check_dispatch(struct orl_gpu *gpu, const struct orl_dispatch *dispatch);
void orl_check_raster(struct orl_gpu *gpu, const struct orl_raster *raster);

#endif
