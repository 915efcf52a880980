// What oriel prepare was asked to do, as the arguments of a command.
#ifndef ORL_PREPROCESS_ARGUMENTS_H
#define ORL_PREPROCESS_ARGUMENTS_H

#include <jansson.h>

#include "oriel/log.h"
#include "oriel/prepare_params.h"

// Texts that follow "oriel prepare" so that it does the same again in any folder: paths are
// absolute. Without --out, --resume and --until. NULL: out of memory. The caller releases it with
// json_decref.
json_t *orl_prepare_arguments(const struct orl_log *log, const struct orl_prepare_params *params);

#endif
