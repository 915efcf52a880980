// Device memory by owner: the bytes of the live buffers and textures of each tag.
#include <string.h>

#include "gpu/internal.h"

// When all rows are in use, the last row collects all further tags.
static struct orl_gpu_memory *find_row(struct orl_gpu *gpu, const char *tag)
{
    for (size_t i = 0; i < gpu->memory_count; i++)
        if (strcmp(gpu->memory[i].tag, tag) == 0)
            return &gpu->memory[i];
    if (gpu->memory_count == ORL_MEMORY_ROWS_MAX)
        return &gpu->memory[ORL_MEMORY_ROWS_MAX - 1];
    struct orl_gpu_memory *row = &gpu->memory[gpu->memory_count++];
    *row = (struct orl_gpu_memory){
        .tag = gpu->memory_count == ORL_MEMORY_ROWS_MAX ? "others" : tag};
    return row;
}

void orl_gpu_count_bytes(struct orl_gpu *gpu, const char *tag, size_t bytes)
{
    struct orl_gpu_memory *row = find_row(gpu, tag);
    row->bytes += bytes;
    row->objects++;
    gpu->live_bytes += bytes;
}

void orl_gpu_uncount_bytes(struct orl_gpu *gpu, const char *tag, size_t bytes)
{
    struct orl_gpu_memory *row = find_row(gpu, tag);
    row->bytes -= bytes;
    row->objects--;
    gpu->live_bytes -= bytes;
}

size_t orl_gpu_memory(const struct orl_gpu *gpu, struct orl_gpu_memory *rows, size_t capacity)
{
    size_t count = 0;
    for (size_t i = 0; i < gpu->memory_count; i++) {
        if (!gpu->memory[i].objects)
            continue;
        if (count < capacity)
            rows[count] = gpu->memory[i];
        count++;
    }
    return count;
}
