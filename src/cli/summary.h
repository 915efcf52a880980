// A readable summary of a scene's manifest.
#ifndef ORL_CLI_SUMMARY_H
#define ORL_CLI_SUMMARY_H

#include "oriel/log.h"

// Prints counts, the stages with time and memory, and left-out photographs of DIR/scene.json to
// stdout.
enum orl_result summary_print(const struct orl_log *log, const char *dir) ORL_CHECK_RESULT;

#endif
