#include "preprocess/plan.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/json.h"
#include "core/memory.h"
#include "core/arguments.h"
#include "preprocess/calibrate/parts.h"
#include "preprocess/cloud/clusters.h"
#include "preprocess/cloud/fuse.h"
#include "preprocess/cloud/fuse_memory.h"
#include "preprocess/densify_stage.h"

// Processor time and memory with llvmpipe on a core of an AMD EPYC (docs/how/scale.md has how they
// were measured).
static const double PASS_S_PER_MPX = 8, FUSE_S_PER_MPX = 1.5, FINISH_S_PER_MPX = 2.5;
static const double PART_BASE_BYTES = 140 << 20, PART_BYTES_PER_PX = 300;
// Of finish where clusters are fused: of a point when radii are found, and 63,000 points a megapixel.
static const double FINISH_BASE_BYTES = 100 << 20, RADII_BYTES_PER_PX = 160 * 0.063;
// Of calibrate: of a photograph of --quality standard, and of a pair.
static const double FEATURES_S = 2, PAIR_S = 0.2, MAP_S = 1, FEATURES_BYTES = 1 << 20;
static const double CALIBRATE_BYTES = 512 << 20;
enum {
    PARTNERS = 14,         // pairs that are matched, a photograph, at most about
    PART_PAIRS = 512,      // pairs of a job
    PASS_BYTES = 16,       // of a pixel in depth and normal maps
    CONFIDENCE_BYTES = 4,  // and in the last pass
    CLOUD_BYTES = 4,       // of points.ply, a pixel of the photographs
};

struct planner {
    const struct orl_log *log;
    char *dir;         // owned; the scene, absolute
    json_t *arguments; // of oriel prepare
    struct orl_prepare_params params; // parsed from them
    bool undistorted;  // else the calibration is planned,
    size_t given;      // of so many photographs
    struct orl_names photos;
    struct orl_colmap_model model;
    struct orl_densify_params densify;
    char masks[ORL_PATH_SIZE]; // the folder, where there is one
    int parts;
    double max_ram;    // bytes; INFINITY: no limit, since the machines of the jobs are not known
    struct orl_clusters clusters; // of fusion
    bool *reads;       // owned; [part * parts + other]: has part a source in the other?
    double *pixels;    // owned; of each photograph
    json_t *jobs;
};

// --- what the scene says ---

// Takes out options and values that earlier programs had.
static json_t *without_gone_options(const json_t *arguments)
{
    json_t *left = json_array();
    for (size_t i = 0; i < json_array_size(arguments); i++) {
        json_t *text = json_array_get(arguments, i);
        const char *word = json_is_string(text) ? json_string_value(text) : "";
        const char *value = json_string_value(json_array_get(arguments, i + 1));
        if (strcmp(word, "--adapt-budget") == 0 ||
            (strcmp(word, "--adapt") == 0 && value && strcmp(value, "none") != 0))
            i++;
        else
            json_array_append(left, text);
    }
    return left;
}

// Reads p->params, whose texts belong to p->arguments.
static enum orl_result parse_arguments(struct planner *p, const char *path)
{
    const struct orl_option_set sets[] = {{orl_prepare_options(), &p->params}, {0}};
    size_t count = json_array_size(p->arguments), inputs;
    const char **texts = orl_array(p->log, 2 * count, sizeof *texts);
    enum orl_result result = texts ? ORL_OK : ORL_ERR_MEMORY;
    p->params = (struct orl_prepare_params){ORL_PREPARE_DEFAULTS};
    for (size_t i = 0; result == ORL_OK && i < count; i++) {
        texts[i] = json_string_value(json_array_get(p->arguments, i));
        if (!texts[i])
            result = orl_fail(p->log, ORL_ERR_FORMAT, "%s: \"arguments\" are not texts", path);
    }
    ORL_THEN(result, orl_arguments_parse(p->log, path, sets, (int)count, texts, count, texts + count,
                                       &inputs));
    free(texts);
    return result;
}

static enum orl_result read_arguments(struct planner *p)
{
    json_t *stages = NULL, *begun = NULL; // begun: a calibration's photographs
    const char *path = ORL_PATH(p->dir, ".oriel/stages.json"), *parts = ORL_PATH(p->dir, ORL_PARTS_STATE);
    enum orl_result result = orl_path_is_file(path) ? orl_json_read(p->log, path, &stages) : ORL_OK;
    p->undistorted = json_object_get(json_object_get(stages, "done"), "undistort") != NULL;
    if (result == ORL_OK && !p->undistorted && orl_path_is_file(parts))
        result = orl_json_read(p->log, parts, &begun);
    p->given = json_array_size(json_object_get(begun, "photographs"));
    json_decref(begun);
    p->arguments = without_gone_options(json_object_get(stages, "arguments"));
    if (result == ORL_OK && ((!p->undistorted && !p->given) || !json_array_size(p->arguments)))
        result = orl_fail(p->log, ORL_ERR_DATA, "%s: nothing to plan yet: run oriel prepare PHOTOS "
                          "--out %s --until undistort (or collect) first", p->dir, p->dir);
    ORL_THEN(result, parse_arguments(p, path));
    json_decref(stages);
    return result;
}

static enum orl_result read_scene(struct planner *p, int photographs)
{
    ORL_TRY(orl_colmap_read(p->log, ORL_PATH(p->dir, "sparse"), &p->model));
    // The training photographs that the stereo was begun with; none for COLMAP's stereo, which has no parts.
    if (orl_path_is_file(ORL_PATH(p->dir, "stereo/densify.json")))
        ORL_TRY(orl_file_read_names(p->log, ORL_PATH(p->dir, "stereo/fusion.cfg"), &p->photos));
    size_t count = p->photos.count;
    p->parts = (int)((count + (size_t)photographs - 1) / (size_t)photographs);
    p->densify = orl_densify_settings(&p->params);
    p->densify.masks_dir = p->params.masks_dir ? orl_path_print(p->masks, p->dir, "masks") : NULL;
    p->pixels = orl_array(p->log, count + 1, sizeof *p->pixels);
    p->reads = orl_array(p->log, (size_t)p->parts * (size_t)p->parts + 1, sizeof *p->reads);
    ORL_TRY_MEMORY(p->pixels && p->reads);
    p->max_ram = p->params.max_ram_bytes ? (double)p->params.max_ram_bytes : (double)INFINITY;
    ORL_TRY(orl_fuse_clusters(p->log, &p->model, &p->photos, p->params.fuse_cluster, p->max_ram,
                              &p->clusters));
    for (size_t i = 0; i < count; i++) {
        const struct orl_colmap_image *image =
            orl_colmap_image_by_name(&p->model, p->photos.items[i]);
        if (!image)
            return orl_fail(p->log, ORL_ERR_DATA, "%s/stereo/fusion.cfg: %s is not in the model",
                            p->dir, p->photos.items[i]);
        const struct orl_camera *camera =
            &orl_colmap_camera_by_id(&p->model, image->camera_id)->pinhole;
        p->pixels[i] = (double)camera->width * camera->height;
    }
    return count ? orl_densify_part_sources(p->log, &p->model, &p->photos, p->densify.sources,
                                            p->parts, p->reads)
                 : ORL_OK;
}

// --- jobs ---

static size_t part_begin(const struct planner *p, int part)
{
    return p->photos.count * (size_t)part / (size_t)p->parts;
}

static json_t *job_name(const struct planner *p, int pass, int part)
{
    int digits = p->parts > 9999 ? 6 : 4;
    return json_sprintf("densify-%d-%0*d", pass, digits, part + 1);
}

static void add_text(json_t *list, const char *text)
{
    json_array_append_new(list, json_string(text));
}

static void add_option(json_t *list, const char *option, int value)
{
    add_text(list, option);
    json_array_append_new(list, json_sprintf("%d", value));
}

static void add_part(json_t *list, int part, int parts)
{
    add_text(list, "--part");
    json_array_append_new(list, json_sprintf("%d/%d", part + 1, parts));
}

static json_t *densify_command(const struct planner *p, int pass, int part)
{
    json_t *list = json_pack("[s, s, s, s, s+]", "oriel", "densify", p->dir, "--photos", p->dir,
                             "/stereo/fusion.cfg");
    orl_arguments_record(list, orl_densify_options(), &p->densify);
    add_option(list, "--pass", pass);
    add_part(list, part, p->parts);
    return list;
}

// The maps that a pass leaves, by the names that the stereo gives them.
static json_t *densify_outputs(const struct planner *p, int pass, int part)
{
    static const char *const kinds[] = {"depth", "normal", "confidence"};
    json_t *list = json_array();
    char kind[ORL_DENSIFY_KIND_SIZE];
    bool last = pass == p->densify.geometric_passes;
    orl_densify_pass_kind(pass, p->densify.geometric_passes, kind);
    for (size_t i = part_begin(p, part); i < part_begin(p, part + 1); i++)
        for (int k = 0; k < 2 + last; k++)
            json_array_append_new(list, json_sprintf("%s/stereo/%s_maps/%s.%s.bin", p->dir,
                                                     kinds[k], p->photos.items[i], kind));
    return list;
}

static json_t *densify_needs(const struct planner *p, int pass, int part)
{
    json_t *list = json_array();
    for (int other = 0; pass > 0 && other < p->parts; other++)
        if (other == part || p->reads[part * p->parts + other])
            json_array_append_new(list, job_name(p, pass - 1, other));
    return list;
}

static void plan_part(struct planner *p, int pass, int part)
{
    double pixels = 0, largest = 0;
    bool last = pass == p->densify.geometric_passes;
    for (size_t i = part_begin(p, part); i < part_begin(p, part + 1); i++) {
        pixels += p->pixels[i];
        largest = p->pixels[i] > largest ? p->pixels[i] : largest;
    }
    // A geometric pass reads its own maps of the pass before and the depths of its sources.
    double read = pass ? pixels * (PASS_BYTES + 4.0 * p->densify.sources) : 0;
    json_array_append_new(p->jobs, json_pack(
        "{s:o, s:s, s:o, s:o, s:[s+, s+, s+, s+], s:o, s:i, s:f, s:f, s:f, s:f}",
        "name", job_name(p, pass, part), "kind", "densify", "command",
        densify_command(p, pass, part), "needs", densify_needs(p, pass, part), "inputs", p->dir,
        "/images", p->dir, "/sparse", p->dir, "/stereo/fusion.cfg", p->dir,
        "/stereo/densify.json", "outputs", densify_outputs(p, pass, part), "threads", 2, "cpu_s",
        pixels * 1e-6 * PASS_S_PER_MPX, "memory_bytes",
        PART_BASE_BYTES + PART_BYTES_PER_PX * largest, "read_bytes", read, "written_bytes",
        pixels * (PASS_BYTES + (last ? CONFIDENCE_BYTES : 0))));
}

static json_t *part_name(const char *step, int part)
{
    return json_sprintf("%s-%06d", step, part + 1);
}

static json_t *fuse_command(const struct planner *p, int cluster)
{
    json_t *list = json_pack("[s, s, s, s]", "oriel", "job", "fuse", p->dir);
    add_option(list, "--photographs", (int)p->clusters.size);
    if (p->densify.masks_dir)
        add_text(list, "--masks");
    if (p->params.max_ram_bytes)
        add_option(list, "--max-ram", (int)(p->params.max_ram_bytes >> 20));
    add_part(list, cluster, (int)p->clusters.count);
    return list;
}

// A cluster needs the parts of the last pass that hold its photographs. *pixels: their sum.
static enum orl_result fuse_needs(const struct planner *p, int cluster, json_t *needs,
                                  double *pixels)
{
    struct orl_names names = {0};
    enum orl_result result = orl_clusters_photographs(p->log, &p->clusters, cluster, &names);
    *pixels = 0;
    for (int part = 0; result == ORL_OK && part < p->parts; part++) {
        bool needed = false;
        for (size_t i = part_begin(p, part); i < part_begin(p, part + 1); i++) {
            bool used = orl_names_contain(&names, p->photos.items[i]);
            *pixels += used ? p->pixels[i] : 0;
            needed = needed || used;
        }
        if (needed)
            json_array_append_new(needs, job_name(p, p->densify.geometric_passes, part));
    }
    orl_names_finish(&names);
    return result;
}

static enum orl_result plan_cluster(struct planner *p, int cluster)
{
    double pixels;
    json_t *needs = json_array();
    enum orl_result result = fuse_needs(p, cluster, needs, &pixels);
    if (result == ORL_OK)
        json_array_append_new(p->jobs, json_pack(
            "{s:o, s:s, s:o, s:O, s:[s+, s+, s+], s:[s], s:i, s:f, s:f, s:f, s:f}", "name",
            part_name("fuse", cluster), "kind", "fuse", "command", fuse_command(p, cluster), "needs",
            needs, "inputs", p->dir, "/stereo", p->dir, "/images", p->dir, "/sparse", "outputs",
            ORL_FUSE_CLUSTER_PATH(p->dir, p->clusters.size, cluster, ".ply"), "threads", 1, "cpu_s",
            pixels * 1e-6 * FUSE_S_PER_MPX, "memory_bytes",
            FINISH_BASE_BYTES + fmin(orl_fuse_bytes(pixels), p->max_ram), "read_bytes",
            pixels * 2 * PASS_BYTES, "written_bytes", pixels * CLOUD_BYTES));
    json_decref(needs);
    return result;
}

static json_t *prepare_command(const struct planner *p, const char *until)
{
    json_t *command = json_pack("[s, s]", "oriel", "prepare");
    json_array_extend(command, p->arguments);
    add_text(command, "--out");
    add_text(command, p->dir);
    add_text(command, "--resume");
    if (until) {
        add_text(command, "--until");
        add_text(command, until);
    }
    return command;
}

static void plan_finish(struct planner *p)
{
    json_t *needs = json_array();
    double pixels = 0;
    for (int part = 0; part < p->parts; part++)
        json_array_append_new(needs, job_name(p, p->densify.geometric_passes, part));
    for (int c = 0; p->clusters.count > 1 && c < (int)p->clusters.count; c++)
        json_array_append_new(needs, part_name("fuse", c));
    for (size_t i = 0; i < p->photos.count; i++)
        pixels += p->pixels[i];
    bool fuses = p->clusters.count < 2;
    json_t *command = prepare_command(p, NULL);
    // The clusters that are planned, whatever memory the machine of this job has.
    if (!p->params.max_ram_bytes && !p->params.fuse_cluster)
        add_option(command, "--fuse-cluster", p->clusters.size > 2 ? (int)p->clusters.size : 2);
    json_array_append_new(p->jobs, json_pack(
        "{s:s, s:s, s:o, s:o, s:[s+], s:[s+, s+], s:i, s:f, s:f, s:f, s:f}", "name", "finish",
        "kind", "finish", "command", command, "needs", needs, "inputs", p->dir, "/stereo",
        "outputs", p->dir, "/points.ply", p->dir, "/scene.json", "threads", 1, "cpu_s",
        pixels * 1e-6 * (FINISH_S_PER_MPX + (fuses ? FUSE_S_PER_MPX : 0)), "memory_bytes",
        FINISH_BASE_BYTES + fmin(fuses ? orl_fuse_bytes(pixels) : RADII_BYTES_PER_PX * pixels,
                                 p->max_ram),
        "read_bytes",
        pixels * 3 * PASS_BYTES, "written_bytes", pixels * CLOUD_BYTES));
}

static enum orl_result plan_jobs(struct planner *p)
{
    for (int pass = 0; pass <= p->densify.geometric_passes; pass++)
        for (int part = 0; part < p->parts; part++)
            plan_part(p, pass, part);
    enum orl_result result = ORL_OK;
    for (int c = 0; result == ORL_OK && p->clusters.count > 1 && c < (int)p->clusters.count; c++)
        result = plan_cluster(p, c);
    plan_finish(p);
    return result;
}

// --- calibration ---

// A job of the calibration: its inputs and outputs are below the scene.
static void plan_step(struct planner *p, enum orl_part_step step, int part, int parts,
                      json_t *needs, double cpu_s, double bytes)
{
    const char *name = orl_part_step_names[step];
    json_t *command = json_pack("[s, s, s, s, s, s]", "oriel", "job", "calibrate", p->dir, "--step", name);
    if (step != ORL_PART_PAIRS)
        add_part(command, part, parts);
    json_t *output = json_sprintf("%s/" ORL_CALIBRATE_WORK "/%s-%06d-of-%06d.db", p->dir, name,
                                  part + 1, parts);
    json_array_append_new(p->jobs, json_pack(
        "{s:o, s:s, s:o, s:o, s:[s+, s+], s:[o], s:i, s:f, s:f, s:f, s:f}", "name",
        part_name(name, part), "kind", name, "command", command, "needs", needs, "inputs", p->dir,
        "/.oriel/photos", p->dir, "/" ORL_PARTS_STATE, "outputs", output, "threads", 2, "cpu_s",
        cpu_s, "memory_bytes", CALIBRATE_BYTES, "read_bytes", bytes, "written_bytes", bytes));
}

// Features and matches in parts where pairs are chosen by retrieval; a few photographs, and those
// whose pairs COLMAP chooses, are one job.
static void plan_calibration(struct planner *p, int photographs)
{
    json_t *features = json_array(), *chosen = json_array(), *matches = json_array();
    double count = (double)p->given, pairs = count * PARTNERS;
    int parts = (int)((p->given + (size_t)photographs - 1) / (size_t)photographs);
    int chunks = (int)(pairs / PART_PAIRS) + 1;
    bool retrieves = orl_match_way(p->params.matching, p->given) == ORL_MATCHING_RETRIEVAL;
    for (int k = 0; retrieves && k < parts; k++) {
        double share = count / parts;
        plan_step(p, ORL_PART_FEATURES, k, parts, json_array(), share * FEATURES_S,
                  share * FEATURES_BYTES);
        json_array_append_new(features, part_name("features", k));
    }
    if (retrieves) {
        plan_step(p, ORL_PART_PAIRS, 0, 1, json_incref(features), count * 0.1,
                  count * FEATURES_BYTES);
        json_array_append_new(chosen, part_name("pairs", 0));
    }
    for (int k = 0; retrieves && k < chunks; k++) {
        plan_step(p, ORL_PART_MATCHES, k, chunks, json_incref(chosen), pairs / chunks * PAIR_S,
                  fmin(count, 2 * pairs / chunks) * FEATURES_BYTES);
        json_array_append_new(matches, part_name("matches", k));
    }
    json_array_append_new(p->jobs, json_pack(
        "{s:s, s:s, s:o, s:O, s:[s+], s:[s+, s+], s:i, s:f, s:f, s:f, s:f}", "name", "calibrate",
        "kind", "calibrate", "command", prepare_command(p, "undistort"), "needs", matches, "inputs",
        p->dir, "/" ORL_CALIBRATE_WORK, "outputs", p->dir, "/sparse", p->dir, "/images", "threads",
        2, "cpu_s", count * MAP_S + (retrieves ? 0 : count * FEATURES_S + pairs * PAIR_S),
        "memory_bytes", CALIBRATE_BYTES + count * FEATURES_BYTES, "read_bytes",
        count * FEATURES_BYTES, "written_bytes", count * FEATURES_BYTES));
    json_decref(features);
    json_decref(chosen);
    json_decref(matches);
}

static json_t *sum_jobs(const json_t *jobs)
{
    static const char *const keys[] = {"cpu_s", "read_bytes", "written_bytes"};
    json_t *sum = json_object(), *job;
    size_t i;
    for (size_t k = 0; k < ORL_COUNT(keys); k++) {
        double total = 0;
        json_array_foreach(jobs, i, job)
            total += json_number_value(json_object_get(job, keys[k]));
        json_object_set_new(sum, keys[k], json_real(total));
    }
    return sum;
}

enum orl_result orl_plan(const struct orl_log *log, const char *scene, int photographs,
                         json_t **plan)
{
    struct planner p = {.log = log, .dir = realpath(scene, NULL), .jobs = json_array()};
    *plan = NULL;
    enum orl_result result = p.dir ? ORL_OK
                                   : orl_fail(log, ORL_ERR_NOT_FOUND, "%s: no such folder", scene);
    if (result == ORL_OK && !p.jobs)
        result = ORL_ERR_MEMORY;
    if (result == ORL_OK && !orl_path_is_file(ORL_PATH(p.dir, "scene.json"))) {
        result = read_arguments(&p);
        if (result == ORL_OK && !p.undistorted)
            plan_calibration(&p, photographs);
        else if (result == ORL_OK)
            result = read_scene(&p, photographs);
        if (result == ORL_OK && p.undistorted)
            result = plan_jobs(&p);
    }
    if (result == ORL_OK)
        *plan = json_pack("{s:i, s:s, s:I, s:O, s:o}", "version", 1, "scene", p.dir,
                          "photographs", (json_int_t)(p.undistorted ? p.photos.count : p.given), "jobs", p.jobs, "sum",
                          sum_jobs(p.jobs));
    if (result == ORL_OK && !*plan)
        result = orl_fail(log, ORL_ERR_FORMAT, "%s: a name is not UTF-8", scene);
    json_decref(p.jobs);
    json_decref(p.arguments);
    orl_arguments_finish(orl_prepare_options(), &p.params);
    orl_names_finish(&p.photos);
    orl_clusters_finish(&p.clusters);
    orl_colmap_finish(&p.model);
    free(p.pixels);
    free(p.reads);
    free(p.dir);
    return result;
}
