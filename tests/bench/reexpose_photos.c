// reexpose FROM TO NOISE NAME=EV..: photographs as if taken at other exposures. Values are
// made linear (sRGB), multiplied by 2^EV, given sensor noise (docs/reference/synthetic.md), clipped,
// encoded and rounded again, with EXIF saying the exposure; others are copied.
// FROM is a folder of photographs, or a scene: then TO becomes one, its scene.json saying
// exposure, series and gain. Held-out photographs of a scene are copied, whatever is asked.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <jansson.h>

#include "core/color.h"
#include "core/file.h"
#include "core/memory.h"
#include "datasets/synth.h"
#include "io/picture.h"

struct job {
    struct orl_log log;
    char **exposures; // NAME=EV
    int count;
    double noise;
};

// False when the photograph keeps its exposure.
static bool exposure_of(const struct job *job, const char *name, double *ev)
{
    size_t length = strlen(name);
    for (int i = 0; i < job->count; i++) {
        if (strncmp(job->exposures[i], name, length) == 0 && job->exposures[i][length] == '=') {
            *ev = atof(job->exposures[i] + length + 1);
            return true;
        }
    }
    return false;
}

static enum orl_result expose(const struct job *job, const char *from, const char *to, double ev,
                              uint32_t key)
{
    struct orl_image image = {0}, light = {0}, photo = {0};
    struct orl_synth_sensor sensor = {.exposure_ev = ev, .noise = job->noise, .key = key};
    struct orl_picture_info info = {0};
    enum orl_result result = orl_picture_read(&job->log, from, 3, &image);
    if (result == ORL_OK)
        result = orl_picture_inspect(&job->log, from, &info);
    if (result == ORL_OK)
        result = orl_image_init(&job->log, &light, image.width, image.height, 3, ORL_PIXEL_F32);
    size_t values = 3 * (size_t)image.width * (size_t)image.height;
    for (size_t i = 0; result == ORL_OK && i < values; i++)
        light.f32[i] = orl_srgb_decode((float)image.u8[i] / 255);
    if (result == ORL_OK)
        result = orl_synth_expose(&job->log, &light, &sensor, &photo);
    info.exif.exposure_s = exp2(ev) / 250;
    info.exif.aperture = 8;
    info.exif.iso = 100;
    info.exif.bias_ev = ev;
    if (result == ORL_OK)
        result = orl_jpeg_write(&job->log, to, &photo, 97, &info.exif);
    orl_image_finish(&image);
    orl_image_finish(&light);
    orl_image_finish(&photo);
    return result;
}

static enum orl_result expose_folder(const struct job *job, const char *from, const char *to)
{
    struct orl_names names = {0};
    enum orl_result result = orl_dir_make(&job->log, to);
    if (result == ORL_OK)
        result = orl_dir_list(&job->log, from, &names);
    for (size_t i = 0; result == ORL_OK && i < names.count; i++) {
        char *source = orl_path_join(&job->log, from, names.items[i]);
        char *target = orl_path_join(&job->log, to, names.items[i]);
        double ev;
        if (exposure_of(job, names.items[i], &ev))
            result = expose(job, source, target, ev, (uint32_t)i * 7919u + 1);
        else if (orl_path_is_file(source))
            result = orl_file_copy(&job->log, source, target);
        free(source);
        free(target);
    }
    orl_names_finish(&names);
    return result;
}

// Series count exposures from the darkest, as prepare does.
static int series_of(const struct job *job, double ev)
{
    int darker = 0;
    for (int i = 0; i < job->count; i++) {
        double other = atof(strchr(job->exposures[i], '=') + 1);
        bool first = other < ev;
        for (int j = 0; j < i; j++)
            first = first && atof(strchr(job->exposures[j], '=') + 1) != other;
        darker += first;
    }
    return darker;
}

static enum orl_result write_manifest(const struct job *job, const char *from, const char *to)
{
    json_error_t error;
    json_t *root = json_load_file(from, 0, &error), *photo;
    size_t i;
    json_array_foreach(json_object_get(root, "photographs"), i, photo) {
        const char *name = json_string_value(json_object_get(photo, "name"));
        bool test = strcmp(json_string_value(json_object_get(photo, "split")), "test") == 0;
        double ev = 0;
        if (!test)
            exposure_of(job, name, &ev);
        json_object_set_new(photo, "exposure_ev", json_real(ev));
        json_object_set_new(photo, "series", json_integer(series_of(job, ev)));
        // What the photographs differed by before still holds.
        json_t *gain = json_array(), *own = json_object_get(photo, "gain");
        for (size_t c = 0; c < 3; c++) {
            double before = own ? json_number_value(json_array_get(own, c)) : 1.0;
            json_array_append_new(gain, json_real(exp2(-ev) * before));
        }
        json_object_set_new(photo, "gain", gain);
    }
    int status = root ? json_dump_file(root, to, JSON_INDENT(1)) : -1;
    json_decref(root);
    return status == 0 ? ORL_OK
                       : orl_fail(&job->log, ORL_ERR_IO, "%s: cannot be read or written", from);
}

// Takes exposures of held-out photographs off the list.
static void spare_held_out(struct job *job, const char *manifest)
{
    json_error_t error;
    json_t *root = json_load_file(manifest, 0, &error), *photo;
    size_t i;
    json_array_foreach(json_object_get(root, "photographs"), i, photo) {
        const char *name = json_string_value(json_object_get(photo, "name"));
        bool test = strcmp(json_string_value(json_object_get(photo, "split")), "test") == 0;
        for (int k = 0; test && k < job->count; k++)
            if (strncmp(job->exposures[k], name, strlen(name)) == 0)
                job->exposures[k--] = job->exposures[--job->count];
    }
    json_decref(root);
}

static enum orl_result expose_scene(struct job *job, const char *from, const char *to)
{
    static const char *const parts[] = {"images", "sparse"};
    char *manifest = orl_path_join(&job->log, from, "scene.json");
    char *out = orl_path_join(&job->log, to, "scene.json");
    spare_held_out(job, manifest);
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < ORL_COUNT(parts); i++) {
        char *source = orl_path_join(&job->log, from, parts[i]);
        char *target = orl_path_join(&job->log, to, parts[i]);
        result = expose_folder(job, source, target);
        free(source);
        free(target);
    }
    char *points = orl_path_join(&job->log, from, "points.ply");
    char *copied = orl_path_join(&job->log, to, "points.ply");
    if (result == ORL_OK)
        result = orl_file_copy(&job->log, points, copied);
    if (result == ORL_OK)
        result = write_manifest(job, manifest, out);
    free(points);
    free(copied);
    free(manifest);
    free(out);
    return result;
}

int main(int argc, char **argv)
{
    if (argc < 5) {
        fprintf(stderr, "usage: reexpose FROM TO NOISE NAME=EV...\n");
        return 2;
    }
    struct job job = {.log = orl_log_stderr(ORL_LOG_INFO), .exposures = argv + 4,
                      .count = argc - 4, .noise = atof(argv[3])};
    char *manifest = orl_path_join(&job.log, argv[1], "scene.json");
    enum orl_result result = manifest && orl_path_is_file(manifest)
                                 ? expose_scene(&job, argv[1], argv[2])
                                 : expose_folder(&job, argv[1], argv[2]);
    free(manifest);
    return result == ORL_OK ? 0 : 1;
}
