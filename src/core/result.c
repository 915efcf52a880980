#include "oriel/result.h"

static const struct {
    const char *name, *message;
} results[] = {
#define ORL_RESULT_ROW(code, message) [code] = {#code, message},
    ORL_RESULTS(ORL_RESULT_ROW)
#undef ORL_RESULT_ROW
};

static bool in_table(enum orl_result result)
{
    return (unsigned)result < ORL_RESULT_COUNT;
}

const char *orl_result_name(enum orl_result result)
{
    return in_table(result) ? results[result].name : "unknown";
}

const char *orl_result_message(enum orl_result result)
{
    return in_table(result) ? results[result].message : "unknown";
}
