// Overflow-checked allocation.
#ifndef ORL_CORE_MEMORY_H
#define ORL_CORE_MEMORY_H

#include "oriel/log.h"

// Allocates a zeroed array of count * size bytes, released with free(). NULL, logged, when
// the product overflows or memory runs out. count 0 gives a valid pointer.
void *orl_array(const struct orl_log *log, size_t count, size_t size);
// As ORL_TRY, for what was allocated: returns ORL_ERR_MEMORY when it is NULL.
#define ORL_TRY_MEMORY(there)                                                            \
    do {                                                                                 \
        if (!(there))                                                                    \
            return ORL_ERR_MEMORY;                                                       \
    } while (0)

// Grows *array (may be NULL) by doubling until it holds at least `needed` elements
// and updates *capacity. New elements are not initialised.
enum orl_result orl_grow(const struct orl_log *log, void **array, size_t *capacity,
                         size_t needed, size_t size) ORL_CHECK_RESULT;
// The same for one more element behind `count`. All but log and count are set in place.
#define ORL_GROW(log, items, capacity, count)                                            \
    orl_grow(log, (void **)&(items), &(capacity), (size_t)(count) + 1, sizeof *(items))

// Bytes or text that grow. `data` is owned, and ends with a zero byte that `size` does not count; NULL:
// nothing has been added.
struct orl_bytes {
    char *data;
    size_t size, capacity;
};
enum orl_result orl_bytes_add(const struct orl_log *log, struct orl_bytes *bytes, const void *data,
                              size_t size) ORL_CHECK_RESULT;

// Bytes that this process can still allocate without swapping, by the limits of the system, of its
// control group and of its address space. UINT64_MAX: unknown.
uint64_t orl_memory_available(void);

// Bytes of address space that the limit of this process (ulimit -v) leaves. UINT64_MAX: no limit.
uint64_t orl_address_space_left(void);

// These return new strings, released with free(); NULL, logged, when memory runs out.
char *orl_strdup(const struct orl_log *log, const char *text);
char *orl_format(const struct orl_log *log, const char *format, ...) ORL_PRINTF(2, 3);

#endif
