// A readable summary of a scene's manifest.
#include <jansson.h>
#include <math.h>
#include <stdio.h>

#include "cli/command_output.h"
#include "core/file.h"
#include "core/json.h"
#include "core/text.h"

static void print_counts(const json_t *root)
{
    const json_t *counts = json_object_get(root, "counts");
    printf("photographs  %.0f given, %.0f used, %.0f registered (%.0f train, %.0f held out)\n",
           orl_json_value(counts, "given"), orl_json_value(counts, "used"),
           orl_json_value(counts, "registered"), orl_json_value(counts, "train"),
           orl_json_value(counts, "test"));
    printf("points       %.0f\n", orl_json_value(counts, "points"));
}

static void print_stages(const json_t *stages)
{
    double wall = 0, cpu = 0, peak = 0;
    const char *name;
    const json_t *record;
    json_object_foreach((json_t *)(uintptr_t)stages, name, record) {
        double own = orl_json_value(record, "peak_rss_mib");
        double child = orl_json_value(record, "child_peak_rss_mib");
        const char *tool = orl_json_text(record, "tool");
        double stage_peak = fmax(own, child);
        printf("%-12s %7.1f s wall %8.1f s CPU %7.0f MiB  %s\n", name, orl_json_value(record, "wall_s"),
               orl_json_value(record, "cpu_s"), stage_peak, tool ? tool : "");
        wall += orl_json_value(record, "wall_s");
        cpu += orl_json_value(record, "cpu_s");
        peak = fmax(peak, stage_peak);
    }
    if (json_object_size(stages) > 0)
        printf("%-12s %7.1f s wall %8.1f s CPU %7.0f MiB  at most\n", "all", wall, cpu, peak);
}

enum { LEFT_OUT_SHOWN = 20 };

static void print_left_out(const json_t *list)
{
    size_t i;
    const json_t *entry;
    json_array_foreach((json_t *)(uintptr_t)list, i, entry) {
        const char *name = orl_json_text(entry, "name");
        const char *why = orl_json_text(entry, "why");
        char shown[ORL_TEXT_SHOWN];
        orl_text_escape(name ? name : "?", shown, sizeof shown);
        if (i == LEFT_OUT_SHOWN) {
            printf("left out     and %zu more, which scene.json names\n", json_array_size(list) - i);
            break;
        }
        printf("left out     %s: %s\n", shown, why ? why : "?");
    }
}

enum orl_result summary_print(const struct orl_log *log, const char *dir)
{
    json_t *root = NULL;
    ORL_TRY(orl_json_read(log, ORL_PATH(dir, "scene.json"), &root));
    char shown[ORL_TEXT_SHOWN];
    orl_text_escape(dir, shown, sizeof shown);
    printf("scene        %s\n", shown);
    print_counts(root);
    print_left_out(json_object_get(root, "left_out"));
    print_stages(json_object_get(root, "stages"));
    json_decref(root);
    return ORL_OK;
}
