#include "oriel/progress.h"

void orl_progress_report(const struct orl_progress *progress, const char *step,
                         double done, double total, const char *detail)
{
    if (progress && progress->report)
        progress->report(progress->priv, step, done, total, detail);
}

bool orl_progress_cancelled(const struct orl_progress *progress)
{
    return progress && progress->cancelled && progress->cancelled(progress->priv);
}
