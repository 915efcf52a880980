// Running COLMAP.
#ifndef ORL_PREPROCESS_COLMAP_RUN_H
#define ORL_PREPROCESS_COLMAP_RUN_H

#include "preprocess/job/job.h"

enum { ORL_COLMAP_ARGS_MAX = 64 };
// A command line being put together. Text is copied.
struct orl_colmap_args {
    char *items[ORL_COLMAP_ARGS_MAX + 1];
    size_t count;
    bool failed; // no memory or no room
};
void orl_colmap_arg(struct orl_colmap_args *args, const char *name, const char *format,
                    ...) ORL_PRINTF(3, 4);
// Finds COLMAP, its version and whether it can use CUDA. ORL_ERR_EXTERNAL, with
// advice, when it cannot be run.
enum orl_result orl_job_find_colmap(struct orl_job *job) ORL_CHECK_RESULT;
// Runs `colmap COMMAND ...` and releases args. Progress is read from its output:
// `done` of `total` units are finished already, and it adds up to `share` of them.
struct orl_colmap_run {
    const char *command, *step;
    double done, share, total;
    const char *tolerated; // failing is fine when it prints this; NULL: never
};
enum orl_result orl_job_colmap(struct orl_job *job, const struct orl_colmap_run *run,
                               struct orl_colmap_args *args) ORL_CHECK_RESULT;
// Progress in [0, 1) that a line of COLMAP's output tells; negative: none. `total`
// is the number of photographs, for the mapper's lines.
double orl_colmap_line_progress(const char *line, double total);

#endif
