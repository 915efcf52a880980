// Progress and cancellation, passed down into every long job.
#ifndef ORIEL_PROGRESS_H
#define ORIEL_PROGRESS_H

#include "oriel/common.h"

struct orl_progress {
    // step: a short name ("densify"). done, total: units of work. detail: the current item, may
    // be NULL. Called often, so it must be cheap.
    void (*report)(void *priv, const char *step, double done, double total,
                   const char *detail);
    // Returns true once the job should stop; the job then returns ORL_ERR_CANCELLED.
    bool (*cancelled)(void *priv);
    void *priv;
};

void orl_progress_report(const struct orl_progress *progress, const char *step,
                         double done, double total, const char *detail);
bool orl_progress_cancelled(const struct orl_progress *progress);

#endif
