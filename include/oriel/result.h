// Result codes: one table gives the enum, the name and the default message.
#ifndef ORIEL_RESULT_H
#define ORIEL_RESULT_H

#include "oriel/common.h"

#define ORL_RESULTS(X)                                                    \
    X(ORL_OK, "success")                                                  \
    X(ORL_ERR_ARGUMENT, "invalid argument")                               \
    X(ORL_ERR_MEMORY, "out of memory")                                    \
    X(ORL_ERR_IO, "cannot read or write a file")                          \
    X(ORL_ERR_FORMAT, "damaged or unsupported file")                      \
    X(ORL_ERR_NOT_FOUND, "not found")                                     \
    X(ORL_ERR_DATA, "the input cannot be used")                           \
    X(ORL_ERR_EXTERNAL, "another program failed")                         \
    X(ORL_ERR_GPU, "OpenGL error")                                        \
    X(ORL_ERR_UNSUPPORTED, "not supported here")                          \
    X(ORL_ERR_CANCELLED, "interrupted")

enum orl_result {
#define ORL_RESULT_ENUM(code, message) code,
    ORL_RESULTS(ORL_RESULT_ENUM)
#undef ORL_RESULT_ENUM
    ORL_RESULT_COUNT
};

// Passes an error on: returns the code of `call` unless it is ORL_OK.
#define ORL_TRY(call)                                                     \
    do {                                                                  \
        const enum orl_result result_of_call = (call);                    \
        if (result_of_call != ORL_OK)                                     \
            return result_of_call;                                        \
    } while (0)
// The next step of a function that cleans up at its end: done unless a step before it has failed.
#define ORL_THEN(result, call)                                            \
    do {                                                                  \
        if ((result) == ORL_OK)                                           \
            (result) = (call);                                            \
    } while (0)

// The code's name, such as "ORL_ERR_IO"; "unknown" outside the table.
const char *orl_result_name(enum orl_result result);
// The code's default message, such as "cannot read or write a file"; "unknown" outside the table.
const char *orl_result_message(enum orl_result result);

#endif
