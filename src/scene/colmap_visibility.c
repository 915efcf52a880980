// COLMAP's fused.ply.vis (src/mvs/fusion.cc): a u64 count, then for each point a u32 n and n u32
// indices of the photographs that the point was fused from.
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "scene/colmap.h"

enum orl_result orl_colmap_visibility_read(const struct orl_log *log, const char *path,
                                           size_t count, uint8_t *photographs)
{
    uint8_t *data = NULL;
    size_t size, at = sizeof(uint64_t);
    uint64_t listed = 0;
    enum orl_result result = orl_file_read(log, path, SIZE_MAX / 2, &data, &size);
    if (result != ORL_OK)
        return result;
    if (size >= at)
        memcpy(&listed, data, sizeof listed);
    if (size < at || listed != count)
        result = orl_fail(log, ORL_ERR_FORMAT, "%s: byte 0: lists %llu points instead of %zu", path,
                          (unsigned long long)listed, count);
    for (size_t i = 0; result == ORL_OK && i < count; i++) {
        uint32_t n = 0;
        if (size - at >= sizeof n)
            memcpy(&n, data + at, sizeof n);
        if (size - at < sizeof n || (size - at - sizeof n) / sizeof(uint32_t) < n) {
            result = orl_fail(log, ORL_ERR_FORMAT, "%s: byte %zu: the list of a point is cut", path,
                              at);
            break;
        }
        photographs[i] = n < UINT8_MAX ? (uint8_t)n : UINT8_MAX;
        at += (1 + (size_t)n) * sizeof(uint32_t);
    }
    free(data);
    return result;
}
