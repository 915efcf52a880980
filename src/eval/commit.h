// Which program measured.
#ifndef ORL_EVAL_COMMIT_H
#define ORL_EVAL_COMMIT_H

// The commit that this program was built from, with a checksum of changes to it ("+..."); "" when
// it was built outside of a repository.
const char *orl_commit(void);

#endif
