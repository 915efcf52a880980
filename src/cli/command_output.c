#include "cli/command_output.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/json.h"

const char *output_tone_name(size_t index)
{
    return index < ORL_TONE_COUNT ? orl_tones[index].name : NULL;
}

static enum orl_result choose_layers(const struct orl_log *log, const struct orl_names *names,
                                     bool confidence, struct orl_frame_layers *layers)
{
    static const char *const known[] = {"depth", "normal", "coverage", "confidence"};
    bool *const chosen[] = {&layers->depth, &layers->normal, &layers->coverage, &layers->confidence};
    const size_t count = ORL_COUNT(known) - !confidence;
    for (size_t i = 0; i < names->count; i++) {
        size_t k = 0;
        while (k < count && strcmp(names->items[i], known[k]) != 0)
            k++;
        if (k == count)
            return orl_fail(log, ORL_ERR_ARGUMENT, "--layers %s: must be of depth, normal, coverage%s",
                            names->items[i], confidence ? ", confidence" : "");
        *chosen[k] = true;
    }
    return ORL_OK;
}

enum orl_result output_choose(const struct orl_log *log, struct output_options options,
                              bool confidence, struct orl_frame_output *output)
{
    output->float_color = options.float_color;
    output->tone.curve = (enum orl_tone_curve)options.tone;
    output->tone.exposure_ev = options.exposure_ev;
    output->tone.white = options.white;
    output->compression = options.compression;
    return choose_layers(log, &options.layers, confidence, &output->layers);
}

bool radiance_chosen(const struct orl_log *log, const struct orl_scene *scene,
                     enum radiance_wish wish)
{
    bool found = wish == RADIANCE_AUTO && orl_scene_is_bracketed(scene);
    if (found)
        orl_logf(log, ORL_LOG_INFO, "%s: photographs of several exposures are merged into radiance; "
                 "--radiance off shows them as they are", scene->dir);
    return found || wish == RADIANCE_ON;
}

bool report_on_stdout(const char *path)
{
    return path && strcmp(path, "-") == 0;
}

static enum orl_result print_report(const struct orl_log *log, const json_t *report)
{
    char *text = json_dumps(report, JSON_INDENT(1) | JSON_ENSURE_ASCII | JSON_REAL_PRECISION(ORL_JSON_DIGITS));
    if (!text)
        return orl_fail(log, ORL_ERR_MEMORY, "no memory for the report");
    puts(text); // main says what does not arrive
    free(text);
    return ORL_OK;
}

enum orl_result report_write(const struct orl_log *log, const char *path, json_t *report)
{
    enum orl_result result = report_on_stdout(path) ? print_report(log, report) : orl_json_write(log, path, report);
    json_decref(report);
    return result;
}
