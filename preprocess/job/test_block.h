// Photographs held out by their place in the order of names.
#ifndef ORL_PREPROCESS_JOB_TEST_BLOCK_H
#define ORL_PREPROCESS_JOB_TEST_BLOCK_H

#include "oriel/log.h"
#include "oriel/prepare_params.h"

// ORL_ERR_ARGUMENT, logged: the block reaches past the last of `count` photographs.
enum orl_result orl_test_block_check(const struct orl_log *log, struct orl_test_block block,
                                     size_t count) ORL_CHECK_RESULT;

#endif
