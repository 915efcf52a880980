// Overflow-checked allocation.
#ifndef ORL_CORE_MEMORY_H
#define ORL_CORE_MEMORY_H

#include <stdarg.h>

#include "oriel/log.h"

// Zeroed array of count * size bytes, released with free(). NULL, logged, when
// the product overflows or memory runs out. count 0 gives a valid pointer.
void *orl_array(const struct orl_log *log, size_t count, size_t size);

// Grows *array (may be NULL) to hold at least `needed` elements, doubling;
// *capacity is updated. New elements are not initialised.
enum orl_result orl_grow(const struct orl_log *log, void **array, size_t *capacity,
                         size_t needed, size_t size) ORL_CHECK_RESULT;

// Bytes that this process may still ask for without swapping: what the system, its control group
// and its address space limit leave. UINT64_MAX: nothing is known.
uint64_t orl_memory_available(void);

// Copies, released with free(); NULL, logged, when memory runs out.
char *orl_strdup(const struct orl_log *log, const char *text);
char *orl_format(const struct orl_log *log, const char *format, ...) ORL_PRINTF(2, 3);
char *orl_vformat(const struct orl_log *log, const char *format, va_list args) ORL_PRINTF(2, 0);

#endif
