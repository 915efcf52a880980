// Runs COLMAP.
#ifndef ORL_PREPROCESS_COLMAP_RUN_H
#define ORL_PREPROCESS_COLMAP_RUN_H

#include "preprocess/job/job.h"

// Finds COLMAP, its version and whether it can use CUDA. ORL_ERR_EXTERNAL, with advice: COLMAP
// cannot be run.
enum orl_result orl_job_find_colmap(struct orl_job *job) ORL_CHECK_RESULT;
enum { ORL_COLMAP_ARGS_MAX = 64, ORL_COLMAP_TEXT = 1 << 15 };
// A run of `colmap COMMAND ...`, which is not copied. Progress is read from COLMAP's output: `done` of
// `total` units are finished before, and the command completes up to `share` more; total 0: all.
struct orl_colmap_run {
    const char *command, *step;
    double done, share, total;
    const char *tolerated[2]; // the command may fail when it prints one of these; NULL: none
    // Set by orl_colmap_arg:
    const char *args[ORL_COLMAP_ARGS_MAX]; // in `text`, but for names
    size_t arg_count, used;                // bytes of text
    char text[ORL_COLMAP_TEXT];
    bool failed;                           // too many arguments, or too long
};
// Adds an option, whose name is static, and its value, which is copied.
void orl_colmap_arg(struct orl_colmap_run *run, const char *name, const char *format,
                    ...) ORL_PRINTF(3, 4);
enum orl_result orl_job_colmap(struct orl_job *job, struct orl_colmap_run *run) ORL_CHECK_RESULT;
// Progress in [0, 1) from a line of COLMAP's output; negative: the line has none. `total` is the
// number of photographs, for the mapper's lines.
double orl_colmap_line_progress(const char *line, double total);

#endif
