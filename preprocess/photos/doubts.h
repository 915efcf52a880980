// Photographs that do more harm than good: blurred ones, several of one picture or one view.
#ifndef ORL_PREPROCESS_DOUBTS_H
#define ORL_PREPROCESS_DOUBTS_H

#include "preprocess/job/job.h"
#include "preprocess/photos/look.h"

// Keeps what `luma`, the picture of a photograph, looks like for the functions below. What could not be
// kept is only found again.
void orl_doubts_keep_look(const struct orl_job *job, const struct orl_source *source,
                          const struct orl_image *luma);
bool orl_doubts_has_look(const struct orl_job *job, const struct orl_source *source);

struct orl_doubt {
    bool blurred;
    int same; // the earlier photograph, not blurred, that shows the same picture; -1: none
};
// Judges all sources of the job; `doubts` has an entry for each.
enum orl_result orl_doubts_find(const struct orl_job *job,
                                struct orl_doubt *doubts) ORL_CHECK_RESULT;
// Counts the views that the photographs show, up to `enough`. Photographs of a camera that stood
// still count as one view, at any exposure and with moving people.
enum orl_result orl_count_views(const struct orl_job *job, size_t enough,
                                size_t *views) ORL_CHECK_RESULT;

#endif
