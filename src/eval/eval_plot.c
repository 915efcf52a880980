// Accuracy against time, as a picture.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "eval/eval.h"
#include "io/svg_plot.h"

struct dots {
    struct orl_plot_series *series; // one per method
    double *x, *y;                  // of all evaluations
    const char **labels;
    size_t series_count;
};

static enum orl_result make_dots(const struct orl_log *log, const struct orl_eval *evals,
                                 size_t count, struct dots *dots)
{
    dots->series = orl_array(log, count, sizeof *dots->series);
    dots->x = orl_array(log, count, sizeof *dots->x);
    dots->y = orl_array(log, count, sizeof *dots->y);
    dots->labels = orl_array(log, count, sizeof *dots->labels);
    if (!dots->series || !dots->x || !dots->y || !dots->labels)
        return ORL_ERR_MEMORY;
    for (size_t i = 0; i < count; i++) {
        dots->x[i] = evals[i].mean.render_ms;
        dots->y[i] = evals[i].mean.metrics.psnr_db;
        const char *value = strchr(evals[i].setting, '=');
        dots->labels[i] = value ? value + 1 : "";
        if (i == 0 || strcmp(evals[i].method, evals[i - 1].method) != 0)
            dots->series[dots->series_count++] = (struct orl_plot_series){
                .name = evals[i].method, .x = dots->x + i, .y = dots->y + i,
                .labels = dots->labels + i, .line = true};
        dots->series[dots->series_count - 1].count++;
    }
    return ORL_OK;
}

enum orl_result orl_eval_plot(const struct orl_log *log, const struct orl_eval *evals,
                              size_t count, const char *path)
{
    const struct orl_eval *first = &evals[0];
    const char *equals = strchr(first->setting, '=');
    char subtitle[320], title[128];
    struct dots dots = {0};
    snprintf(title, sizeof title, "Accuracy against time%s%.*s", equals ? ", by " : "",
             equals ? (int)(equals - first->setting) : 0, first->setting);
    snprintf(subtitle, sizeof subtitle, "%s: %zu photographs held out, the first of %dx%d; %s",
             orl_path_name(first->scene->dir), first->view_count, first->views[0].width,
             first->views[0].height, first->device);
    char *svg = NULL;
    enum orl_result result = make_dots(log, evals, count, &dots);
    if (result == ORL_OK) {
        svg = orl_plot_svg(log, &(struct orl_plot){
            .title = title, .subtitle = subtitle, .x_label = "milliseconds a view",
            .y_label = "PSNR of whole pictures, dB", .x_log = true, .y_fit = true,
            .series = dots.series, .series_count = dots.series_count});
        result = svg ? orl_file_write(log, path, svg, strlen(svg)) : ORL_ERR_MEMORY;
    }
    free(svg);
    free(dots.series);
    free(dots.x);
    free(dots.y);
    free(dots.labels);
    return result;
}
