#include "cli/walk.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "eval/stability.h"

static bool json_to_stdout(const struct walk_options *options)
{
    return options->json && strcmp(options->json, "-") == 0;
}

static void print_header(const struct orl_stability *s)
{
    printf("walk of %zu frames of %dx%d, %s; differences of one frame, warped, to the next, in "
           "8-bit values\n", s->step_count + 1, s->width, s->height, s->device);
    printf("%-14s %8s %7s %7s %7s  %7s %22s  %15s %9s\n", "method", "seen%", "mean", "floor",
           "p99", "blocks", "worst block", "worst jump", "ms");
}

static void print_row(const struct orl_stability *s)
{
    const struct orl_stability_step *all = &s->all;
    char block[64], jump[64];
    snprintf(block, sizeof block, "%.2f %zu:%d,%d", all->block_worst, s->worst_block_step + 1,
             all->block_x, all->block_y);
    snprintf(jump, sizeof jump, "%.2f %zu", all->jump, s->worst_jump_step + 1);
    printf("%-14s %8.1f %7.3f %7.3f %7.2f  %7.3f %22s  %15s %9.1f\n", s->method,
           100 * all->compared, all->mean, all->floor, all->p99, all->block_mean, block, jump,
           s->render_ms);
    fflush(stdout);
}

static enum orl_result measure(struct orl_gpu *gpu, struct orl_renderer *renderer,
                               const struct orl_scene *scene, const struct orl_method *method,
                               const struct walk_options *options, const struct orl_path *path,
                               const struct orl_progress *progress, struct orl_stability *out)
{
    const struct orl_log *log = orl_gpu_log(gpu);
    struct orl_render_params render;
    enum orl_result result = orl_render_params_tuned(log, method, scene, &render);
    for (size_t i = 0; result == ORL_OK && i < options->settings->count; i++)
        result = orl_render_params_set(log, &render, options->settings->items[i]);
    if (result != ORL_OK)
        return result;
    const struct orl_stability_params params = {
        .method = method->name, .render = &render, .views = path->views,
        .view_count = path->count, .image_dir = options->images, .progress = progress};
    return orl_stability_run(gpu, renderer, &params, out);
}

static enum orl_result write_json(const struct orl_log *log, const struct orl_scene *scene,
                                  const struct orl_stability *all, size_t count, bool array,
                                  const struct walk_options *options)
{
    char *text = orl_stability_to_json(log, scene, all, count, array);
    if (!text)
        return ORL_ERR_MEMORY;
    enum orl_result result = ORL_OK;
    if (!json_to_stdout(options))
        result = orl_file_write(log, options->json, text, strlen(text));
    else if (puts(text) < 0 || fflush(stdout) != 0)
        result = orl_fail(log, ORL_ERR_IO, "standard output: cannot write");
    free(text);
    return result;
}

enum orl_result walk_run(struct orl_gpu *gpu, struct orl_renderer *renderer,
                         const struct orl_scene *scene, const struct orl_method *methods,
                         size_t count, bool array, const struct walk_options *options,
                         const struct orl_progress *progress)
{
    const struct orl_log *log = orl_gpu_log(gpu);
    struct orl_path path = {0};
    size_t done = 0;
    struct orl_stability *all = orl_array(log, count, sizeof *all);
    enum orl_result result = all ? ORL_OK : ORL_ERR_MEMORY;
    if (result == ORL_OK)
        result = orl_stability_walk(log, scene, (size_t)options->frames, options->divide, &path);
    for (; result == ORL_OK && done < count; done++) {
        result = measure(gpu, renderer, scene, &methods[done], options, &path, progress,
                         &all[done]);
        if (result != ORL_OK)
            break;
        if (!json_to_stdout(options) && done == 0)
            print_header(&all[0]);
        if (!json_to_stdout(options))
            print_row(&all[done]);
    }
    if (result == ORL_OK && options->json)
        result = write_json(log, scene, all, count, array, options);
    for (size_t i = 0; i < done; i++)
        orl_stability_finish(&all[i]);
    free(all);
    orl_path_finish(&path);
    return result;
}
