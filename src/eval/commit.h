// Identifies the program in reports.
#ifndef ORL_EVAL_COMMIT_H
#define ORL_EVAL_COMMIT_H

// The commit that this program was built from, with a checksum of local changes ("+..."); "" when
// it was built outside a repository.
const char *orl_commit(void);

#endif
