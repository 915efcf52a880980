// Shared by the writers of synthetic sets.
#ifndef ORL_DATASETS_SYNTH_FILES_H
#define ORL_DATASETS_SYNTH_FILES_H

#include "oriel/log.h"

// ORL_ERR_ARGUMENT unless `path` is new or an empty folder.
enum orl_result orl_synth_check_free(const struct orl_log *log, const char *path) ORL_CHECK_RESULT;
enum orl_result orl_synth_move_folder(const struct orl_log *log, const char *from,
                                      const char *to) ORL_CHECK_RESULT;

#endif
