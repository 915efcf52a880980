// Device memory: what live buffers and textures take, by owner and tag.
#include <string.h>

#include "gpu/internal.h"

const char *const orl_owner_names[ORL_OWNER_COUNT] = {"frame", "points", "photographs"};

// The last row takes all tags that there is no row left for, as the frame's.
static struct orl_gpu_memory *find_row(struct orl_gpu *gpu, enum orl_owner owner,
                                       const char *tag)
{
    for (size_t i = 0; i < gpu->memory_count; i++)
        if (gpu->memory[i].owner == owner && strcmp(gpu->memory[i].tag, tag) == 0)
            return &gpu->memory[i];
    if (gpu->memory_count == ORL_MEMORY_ROWS_MAX)
        return &gpu->memory[ORL_MEMORY_ROWS_MAX - 1];
    struct orl_gpu_memory *row = &gpu->memory[gpu->memory_count++];
    bool last = gpu->memory_count == ORL_MEMORY_ROWS_MAX;
    *row = (struct orl_gpu_memory){.owner = last ? ORL_OWNER_FRAME : owner,
                                   .tag = last ? "others" : tag};
    return row;
}

void orl_gpu_count(struct orl_gpu *gpu, enum orl_owner owner, const char *tag, ptrdiff_t bytes, int objects)
{
    struct orl_gpu_memory *row = find_row(gpu, owner, tag);
    row->bytes += (size_t)bytes;
    row->objects += (unsigned)objects;
    gpu->live_bytes += (size_t)bytes;
}

size_t orl_gpu_owner_bytes(const struct orl_gpu *gpu, enum orl_owner owner)
{
    size_t bytes = 0;
    for (size_t i = 0; i < gpu->memory_count; i++)
        if (gpu->memory[i].owner == owner)
            bytes += gpu->memory[i].bytes;
    return bytes;
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
