#include "eval/commit.h"

#include "commit_id.h"

const char *orl_commit(void)
{
    return ORL_COMMIT;
}
