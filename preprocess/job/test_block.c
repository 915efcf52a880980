#include "preprocess/job/test_block.h"

enum orl_result orl_test_block_check(const struct orl_log *log, struct orl_test_block block,
                                     size_t count)
{
    ORL_REQUIRE(log, block.first >= 0 && (block.end == 0 || block.end > block.first));
    if ((size_t)block.end > count)
        return orl_fail(log, ORL_ERR_ARGUMENT, "--test-block %d:%d: there are %zu photographs, "
                        "numbered from 0", block.first, block.end, count);
    return ORL_OK;
}
