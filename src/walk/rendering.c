#include "walk/rendering.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "core/file.h"
#include "core/json.h"
#include "core/text.h"
#include "oriel/path.h"
#include "render/output/sequence.h"
#include "walk/internal.h"

enum { WIDTH = 1280, HEIGHT = 720, FPS = 24, FRAMES_MAX = 100000, NUMBER_MAX = 999 };

bool orl_walk_rendering_asked(const json_t *message)
{
    static const char *const formats[] = {"mp4", "png", "exr", NULL};
    struct orl_tone_params tone;
    const char *format = orl_json_text(message, "format");
    return format && orl_text_is_one_of(format, formats) && orl_walk_tone_read(message, &tone) &&
           json_is_object(json_object_get(message, "render"));
}

// One rendering while it runs.
struct run {
    const struct walk_rendering *rendering;
    struct orl_path path;
    size_t done;
    char keys[ORL_PATH_SIZE], file[ORL_PATH_SIZE]; // in SCENE/renders: the keyframes, what is written
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
    const char *folder = ORL_PATH(run->rendering->scene->dir, "renders");
    ORL_TRY(orl_walk_check_inside(log, run->rendering->scene, folder));
    ORL_TRY(orl_dir_make(log, folder));
    for (int number = 1; number <= NUMBER_MAX; number++) {
        orl_path_print(run->keys, folder, "%03d.path.json", number);
        orl_path_print(run->file, folder, "%03d%s", number, strcmp(format, "mp4") == 0 ? ".mp4" : "");
        if (access(run->keys, F_OK) != 0)
            return ORL_OK;
    }
    return orl_fail(log, ORL_ERR_IO, "%s: has no free number", folder);
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
    return orl_sequence_write(r->log, &sequence, run->file, format, FPS);
}

enum orl_result orl_walk_rendering_run(const struct walk_rendering *rendering, const json_t *message)
{
    struct run run = {.rendering = rendering};
    struct orl_tone_params tone;
    const char *format = orl_json_text(message, "format");
    (void)orl_walk_tone_read(message, &tone); // which the message has been checked for
    enum orl_result result = name_files(&run, format);
    ORL_THEN(result, orl_sequence_check_out(rendering->log, run.file, true, false));
    ORL_THEN(result, read_path(&run, json_object_get(message, "render")));
    ORL_THEN(result, write_frames(&run, format, &tone));
    if (result == ORL_OK)
        rendering->report(rendering->priv, run.path.count, run.path.count, run.file);
    orl_path_finish(&run.path);
    return result;
}
