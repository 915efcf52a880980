// General rules, stated once for every header of Oriel:
//
// - A function that touches files, memory or GL returns enum orl_result. The function
//   that detects an error logs it once; its callers pass the code on.
// - struct orl_log * and struct orl_progress * may be NULL: nothing is reported then.
// - create/destroy allocate; init/finish do not. Every destroy takes a pointer
//   to the handle, accepts NULL and half-built objects, and sets it to NULL.
// - Parameter structs need to live only until the call returns.
// - On failure an out parameter is left NULL or zeroed, and owns nothing.
// - Strings are UTF-8. Angles are radians. Images are row-major, top row first.
// - Objects are not thread-safe; different objects may be used by different
//   threads, except those of one orl_gpu, which belong to its creating thread.
#ifndef ORIEL_COMMON_H
#define ORIEL_COMMON_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define ORL_PRINTF(fmt, args) __attribute__((format(printf, fmt, args)))
#define ORL_CHECK_RESULT __attribute__((warn_unused_result))
#else
#define ORL_PRINTF(fmt, args)
#define ORL_CHECK_RESULT
#endif

#define ORL_COUNT(array) (sizeof(array) / sizeof((array)[0]))

// A path by value, for `f(orl_scene_mesh_path(scene).text)`. One that is longer than the system takes is cut,
// but remains too long, so that nothing opens it.
enum { ORL_PATH_SIZE = 4097 };
struct orl_file_path {
    char text[ORL_PATH_SIZE];
};

#endif
