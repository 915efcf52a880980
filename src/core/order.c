#include "core/order.h"

#include <stdint.h>
#include <string.h>

#define ORDER(function, type) \
    int function(const void *a, const void *b) \
    { \
        type x = *(const type *)a, y = *(const type *)b; \
        return (x > y) - (x < y); \
    }

ORDER(orl_order_floats, float)
ORDER(orl_order_doubles, double)
ORDER(orl_order_ints, int)
ORDER(orl_order_sizes, size_t)

int orl_order_texts(const void *a, const void *b)
{
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

int orl_order_pairs(const void *a, const void *b)
{
    const uint32_t *x = a, *y = b;
    int first = (x[0] > y[0]) - (x[0] < y[0]);
    return first ? first : (x[1] > y[1]) - (x[1] < y[1]);
}

int orl_order_ranked(const void *a, const void *b)
{
    const struct orl_ranked *x = a, *y = b;
    if (x->key != y->key)
        return x->key < y->key ? -1 : 1;
    return (x->index > y->index) - (x->index < y->index);
}
