// Ascending orders for qsort and bsearch.
#ifndef ORL_CORE_ORDER_H
#define ORL_CORE_ORDER_H

#include <stddef.h>

int orl_order_floats(const void *a, const void *b);
int orl_order_doubles(const void *a, const void *b);
int orl_order_ints(const void *a, const void *b);
int orl_order_sizes(const void *a, const void *b); // size_t
int orl_order_texts(const void *a, const void *b); // const char *, bytewise

// Items that begin with two uint32_t: by the first, then by the second.
int orl_order_pairs(const void *a, const void *b);

// An index and what it is sorted by.
struct orl_ranked {
    double key;
    size_t index;
};
int orl_order_ranked(const void *a, const void *b); // by key, then by index

#endif
