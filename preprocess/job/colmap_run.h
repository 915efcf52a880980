// Runs COLMAP.
#ifndef ORL_PREPROCESS_COLMAP_RUN_H
#define ORL_PREPROCESS_COLMAP_RUN_H

#include "preprocess/job/job.h"

enum { ORL_COLMAP_ARGS_MAX = 64 };
// A command line under construction. Text is copied.
struct orl_colmap_args {
    char *items[ORL_COLMAP_ARGS_MAX + 1];
    size_t count;
    bool failed; // out of memory, or too many arguments
};
void orl_colmap_arg(struct orl_colmap_args *args, const char *name, const char *format,
                    ...) ORL_PRINTF(3, 4);
// Finds COLMAP, its version and whether it can use CUDA. ORL_ERR_EXTERNAL, with advice: COLMAP
// cannot be run.
enum orl_result orl_job_find_colmap(struct orl_job *job) ORL_CHECK_RESULT;
// Runs `colmap COMMAND ...` and releases args. Progress is read from COLMAP's output: `done` of
// `total` units are finished before, and the command completes up to `share` more.
struct orl_colmap_run {
    const char *command, *step;
    double done, share, total;
    const char *tolerated[2]; // the command may fail when it prints one of these; NULL: none
};
enum orl_result orl_job_colmap(struct orl_job *job, const struct orl_colmap_run *run,
                               struct orl_colmap_args *args) ORL_CHECK_RESULT;
// Progress in [0, 1) from a line of COLMAP's output; negative: the line has none. `total` is the
// number of photographs, for the mapper's lines.
double orl_colmap_line_progress(const char *line, double total);

#endif
