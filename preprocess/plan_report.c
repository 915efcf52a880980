// Rows of a report as jobs: parts that keep their rows, and a run of all that joins them.
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "core/json.h"
#include "core/memory.h"
#include "preprocess/plan.h"

// Processor time of all methods' rows with llvmpipe on photographs of 0.4 megapixels, whole and
// quick, and memory (docs/how/scale.md#costs). A picture of the report and its row take some 30 kB.
static const double CHART_S[] = {600, 15}, STRESS_S[] = {400, 90};
static const double ROWS_BYTES = 512 << 20, REPORT_BYTES = 30000 * 100.0;

// The folder's absolute path; it need not be there yet.
static char *absolute(const struct orl_log *log, const char *path)
{
    char *there = realpath(path, NULL), *here = NULL, *whole = NULL;
    if (there || path[0] == '/')
        return there ? there : orl_strdup(log, path);
    here = getcwd(NULL, 0);
    if (here)
        whole = orl_format(log, "%s/%s", here, path);
    else
        (void)orl_fail(log, ORL_ERR_IO, "%s: %s", path, strerror(errno));
    free(here);
    return whole;
}

// The command of a part, from 0 on; -1: of the whole report.
static json_t *command_of(const struct orl_plan_report *report, const char *scene, const char *out,
                          int part)
{
    json_t *list = json_pack("[s, s, s, s, s]", "oriel", report->kind, scene, "--out", out);
    for (size_t i = 0; i < json_array_size(report->options); i++)
        json_array_append(list, json_array_get(report->options, i));
    if (part >= 0) {
        json_array_append_new(list, json_string("--part"));
        json_array_append_new(list, json_sprintf("%d/%d", part + 1, report->parts));
    }
    return list;
}

static enum orl_result add_job(const struct orl_log *log, json_t *plan, json_t *name,
                               const char *kind, json_t *command, const json_t *needs,
                               const char *output, double cpu_s)
{
    const char *scene = orl_json_text(plan, "scene");
    json_t *sum = json_object_get(plan, "sum");
    json_t *job = json_pack(
        "{s:o, s:s, s:o, s:O, s:[s+, s+, s+], s:[s], s:i, s:f, s:f, s:f, s:f}", "name", name,
        "kind", kind, "command", command, "needs", needs, "inputs", scene, "/scene.json", scene,
        "/images", scene, "/sparse", "outputs", output, "threads", 2, "cpu_s", cpu_s,
        "memory_bytes", ROWS_BYTES, "read_bytes", REPORT_BYTES, "written_bytes", REPORT_BYTES);
    if (!job)
        return orl_fail(log, ORL_ERR_FORMAT, "%s: a name is not UTF-8", output);
    static const char *const keys[] = {"cpu_s", "read_bytes", "written_bytes"};
    for (size_t k = 0; k < ORL_COUNT(keys); k++)
        json_object_set_new(sum, keys[k],
                            json_real(json_number_value(json_object_get(sum, keys[k])) +
                                      json_number_value(json_object_get(job, keys[k]))));
    json_array_append_new(json_object_get(plan, "jobs"), job);
    return ORL_OK;
}

static bool has_job(const json_t *plan, const char *name)
{
    size_t i;
    const json_t *job;
    json_array_foreach(json_object_get(plan, "jobs"), i, job)
        if (strcmp(orl_json_text(job, "name"), name) == 0)
            return true;
    return false;
}

enum orl_result orl_plan_add_report(const struct orl_log *log, json_t *plan,
                                    const struct orl_plan_report *report)
{
    const char *scene = orl_json_text(plan, "scene");
    // A scene whose jobs end with its calibration cannot be drawn after them.
    if (has_job(plan, "calibrate"))
        return orl_fail(log, ORL_ERR_DATA, "%s: the rows of a report are planned once the scene is "
                        "calibrated", scene);
    json_t *whole = has_job(plan, "finish") ? json_pack("[s]", "finish") : json_array();
    json_t *parts = json_array();
    char *out = absolute(log, report->out), *rows = out ? orl_format(log, "%s/rows", out) : NULL;
    enum orl_result result = rows ? ORL_OK : ORL_ERR_MEMORY;
    double cpu_s = (strcmp(report->kind, "chart") == 0 ? CHART_S : STRESS_S)[report->quick];
    for (int part = 0; result == ORL_OK && part < report->parts; part++) {
        json_t *name = json_sprintf("%s-%04d", report->kind, part + 1);
        json_array_append(parts, name);
        result = add_job(log, plan, name, report->kind, command_of(report, scene, out, part),
                         whole, rows, cpu_s / report->parts);
    }
    if (result == ORL_OK)
        result = add_job(log, plan, json_string(report->kind), report->kind,
                         command_of(report, scene, out, -1), parts, out, 0);
    json_decref(whole);
    json_decref(parts);
    free(rows);
    free(out);
    return result;
}
