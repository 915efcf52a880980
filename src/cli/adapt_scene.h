// What prepare and tune share with --adapt.
#ifndef ORL_CLI_ADAPT_SCENE_H
#define ORL_CLI_ADAPT_SCENE_H

#include "cli/args.h"
#include "cli/terminal.h"
#include "eval/adapt.h"

enum {
    ADAPT_VIEWS = 6,
    // Photographs at half their size are sharper for their pixels than those that will be drawn,
    // and prefer other methods and values.
    ADAPT_DIVIDE = 1,
    ADAPT_BUDGET_S = 120,
};

// Finds out how the scene in the folder `dir` is drawn best, stores it, and prints what the methods
// reach.
enum orl_result adapt_scene(const struct terminal *terminal, const struct arg_common *common,
                            const char *dir, size_t views, int size_divide,
                            double budget_s) ORL_CHECK_RESULT;

#endif
