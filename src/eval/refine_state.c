#include "eval/refine_state.h"

#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"

static const size_t BYTES_MAX = (size_t)1 << 36, ROW = ORL_SOFT_VALUES * sizeof(float);

enum orl_result orl_refine_state_write(const struct orl_log *log, const char *path, struct orl_refine_state *state,
                                       const struct orl_soft_model *model)
{
    struct orl_atomic_file file;
    state->splats = model->count;
    ORL_TRY(orl_atomic_open(log, path, &file));
    fwrite(state, sizeof *state, 1, file.stream);
    fwrite(model->splats, ROW, model->count, file.stream);
    if (state->at.steps)
        fwrite(model->moments, ROW, 2 * model->count, file.stream);
    return orl_atomic_commit(log, &file);
}

static enum orl_result take(const struct orl_log *log, const uint8_t *data, const struct orl_refine_state *head,
                            struct orl_soft_model *model)
{
    const size_t count = head->splats;
    struct orl_soft_model read = {.splats = orl_array(log, count, ROW), .count = count, .capacity = count};
    if (head->at.steps)
        read.moments = orl_array(log, 2 * count, ROW);
    orl_soft_finish(model);
    *model = read;
    if (!read.splats || (head->at.steps && !read.moments))
        return ORL_ERR_MEMORY;
    memcpy(read.splats, data, count * ROW);
    if (read.moments)
        memcpy(read.moments, data + count * ROW, 2 * count * ROW);
    return ORL_OK;
}

enum orl_result orl_refine_state_read(const struct orl_log *log, const char *path, struct orl_refine_state *state,
                                      struct orl_soft_model *model)
{
    struct orl_refine_state head = {0};
    uint8_t *data = NULL;
    size_t size = 0;
    if (!orl_path_is_file(path))
        return ORL_OK;
    enum orl_result result = orl_file_read(log, path, BYTES_MAX, &data, &size);
    if (result == ORL_OK && size >= sizeof head)
        memcpy(&head, data, sizeof head);
    const size_t rows = head.at.steps ? 3 : 1;
    bool fits = head.key == state->key && head.splats > 0 && head.splats < BYTES_MAX / ROW &&
                size == sizeof head + rows * head.splats * ROW;
    if (result == ORL_OK && !fits)
        orl_logf(log, ORL_LOG_WARNING, "%s: of another scene or other settings, or damaged; refine begins anew", path);
    else if (result == ORL_OK && (result = take(log, data + sizeof head, &head, model)) == ORL_OK)
        *state = head;
    free(data);
    return result;
}
