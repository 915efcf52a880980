// Collect: lists the photographs given and finds those that can be used.
#ifndef ORL_PREPROCESS_COLLECT_H
#define ORL_PREPROCESS_COLLECT_H

#include "preprocess/job/job.h"

// Lists and checks the photographs, and links them into .oriel/photos.
enum orl_result orl_stage_collect(struct orl_job *job) ORL_CHECK_RESULT;

#endif
