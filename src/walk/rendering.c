#include "walk/rendering.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "core/file.h"
#include "core/json.h"
#include "core/memory.h"
#include "oriel/path.h"
#include "render/output/sequence.h"
#include "walk/internal.h"

enum { WIDTH = 1280, HEIGHT = 720, FPS = 24, FRAMES_MAX = 100000, NUMBER_MAX = 999 };

bool orl_walk_rendering_asked(const json_t *message)
{
    static const char *const formats[] = {"mp4", "png", "exr"};
    struct orl_tone_params tone;
    const char *format = orl_json_text(message, "format");
    if (!orl_walk_tone_read(message, &tone))
        return false;
    for (size_t i = 0; format && i < ORL_COUNT(formats); i++)
        if (strcmp(format, formats[i]) == 0)
            return json_is_object(json_object_get(message, "render"));
    return false;
}

// One rendering while it runs.
struct run {
    const struct walk_rendering *rendering;
    struct orl_path path;
    size_t done;
    char *stem, *keys, *file; // owned: SCENE/renders/NNN, its keyframes, what is written
};

static enum orl_result draw(void *priv, const struct orl_view *view, struct orl_frame *frame)
{
    struct run *run = priv;
    const struct walk_rendering *r = run->rendering;
    r->report(r->priv, run->done++, run->path.count, run->file);
    return orl_renderer_draw(r->renderer, view, r->render, NULL, frame);
}

// Takes the next number that no file has.
static enum orl_result name_files(struct run *run, const char *format)
{
    const struct orl_log *log = run->rendering->log;
    char *folder = orl_path_join(log, run->rendering->scene->dir, "renders");
    enum orl_result result = folder ? orl_dir_make(log, folder) : ORL_ERR_MEMORY;
    bool is_free = false;
    for (int number = 1; result == ORL_OK && !is_free && number <= NUMBER_MAX; number++) {
        free(run->stem);
        free(run->keys);
        run->stem = orl_format(log, "%s/%03d", folder, number);
        run->keys = run->stem ? orl_format(log, "%s.path.json", run->stem) : NULL;
        is_free = run->keys && access(run->keys, F_OK) != 0;
        result = run->keys ? ORL_OK : ORL_ERR_MEMORY;
    }
    if (result == ORL_OK && !is_free)
        result = orl_fail(log, ORL_ERR_IO, "%s: has no free number", folder);
    if (result == ORL_OK) {
        run->file = strcmp(format, "mp4") == 0 ? orl_format(log, "%s.mp4", run->stem)
                                               : orl_strdup(log, run->stem);
        result = run->file ? ORL_OK : ORL_ERR_MEMORY;
    }
    free(folder);
    return result;
}

static enum orl_result read_path(struct run *run, const json_t *keyframes)
{
    const struct walk_rendering *r = run->rendering;
    enum orl_result result = orl_json_write(r->log, run->keys, keyframes);
    ORL_THEN(result, orl_path_read(r->log, r->scene, run->keys, &run->path));
    if (result == ORL_OK && run->path.count > FRAMES_MAX)
        result = orl_fail(r->log, ORL_ERR_FORMAT, "%s: %zu frames", run->keys, run->path.count);
    for (size_t i = 0; result == ORL_OK && i < run->path.count; i++) {
        struct orl_camera *c = &run->path.views[i].camera;
        *c = orl_camera_reframed(c, WIDTH, HEIGHT);
    }
    if (result != ORL_OK)
        (void)unlink(run->keys);
    return result;
}

static enum orl_result write_frames(struct run *run, const char *format,
                                    const struct orl_tone_params *tone)
{
    const struct walk_rendering *r = run->rendering;
    struct orl_frame_output output = {ORL_FRAME_OUTPUT_DEFAULTS};
    output.tone = *tone;
    const struct orl_sequence sequence = {
        .views = run->path.views, .count = run->path.count, .draw = draw, .priv = run,
        .output = &output, .step = "render", .progress = r->progress};
    return strcmp(format, "mp4") == 0
               ? orl_sequence_write_video(r->log, &sequence, run->file, FPS)
               : orl_sequence_write_dir(r->log, &sequence, run->file, format);
}

enum orl_result orl_walk_rendering_run(const struct walk_rendering *rendering, const json_t *message)
{
    struct run run = {.rendering = rendering};
    struct orl_tone_params tone;
    const char *format = orl_json_text(message, "format");
    enum orl_result result = orl_walk_tone_read(message, &tone) ? name_files(&run, format)
                                                                : ORL_ERR_FORMAT;
    ORL_THEN(result, read_path(&run, json_object_get(message, "render")));
    ORL_THEN(result, write_frames(&run, format, &tone));
    if (result == ORL_OK)
        rendering->report(rendering->priv, run.path.count, run.path.count, run.file);
    orl_path_finish(&run.path);
    free(run.stem);
    free(run.keys);
    free(run.file);
    return result;
}
