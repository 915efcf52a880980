#include "hdr/replace.h"

#include <jansson.h>
#include <stdlib.h>

#include "core/file.h"
#include "core/json.h"
#include "core/memory.h"
#include "core/new_dir.h"
#include "hdr/internal.h"
#include "io/picture.h"
#include "io/exr.h"
#include "scene/subset.h"

enum { JPEG_QUALITY = 97 };

struct replacement {
    struct orl_hdr *hdr;
    const struct orl_replace_params *params;
    const struct orl_progress *progress;
    struct orl_new_dir new_dir;
    struct orl_subset subset; // in the folder of new_dir
    bool *keep;               // of the subset
    size_t count;             // photographs to be replaced
};

static bool is_replaced(const struct replacement *r, size_t photo)
{
    const struct orl_photo *p = &r->subset.scene->photos[photo];
    return !p->test && p->series == r->params->series;
}

// --- pictures ---

static enum orl_result write_picture(const struct replacement *r, const char *name,
                                     const struct orl_image *light)
{
    const struct orl_log *log = r->subset.log;
    struct orl_image picture = {0};
    const char *path = ORL_PATH(r->subset.dir, "images/%s", name);
    ORL_TRY(orl_file_make_folder(log, path));
    enum orl_result result = orl_tone_apply(log, light, &r->params->tone, &picture);
    ORL_THEN(result, orl_path_has_extension(name, "jpg jpeg")
                         ? orl_jpeg_write(log, path, &picture, JPEG_QUALITY, NULL)
                         : orl_png_write(log, path, &picture));
    ORL_THEN(result, orl_subset_add_checksum(&r->subset, ORL_PATH("images", "%s", name)));
    orl_image_finish(&picture);
    return result;
}

static enum orl_result write_light(const struct replacement *r, const char *name,
                                   const struct orl_image *light)
{
    const char *path = ORL_PATH(r->subset.dir, "images_linear/%s.exr", name);
    ORL_TRY(orl_file_make_folder(r->subset.log, path));
    ORL_TRY(orl_linear_write(r->subset.log, path, light));
    return orl_subset_add_checksum(&r->subset, ORL_PATH("images_linear", "%s.exr", name));
}

static enum orl_result replace_photo(const struct replacement *r, size_t photo)
{
    const struct orl_photo *p = &r->subset.scene->photos[photo];
    struct orl_frame frame = {0};
    enum orl_result result = orl_hdr_draw(r->hdr, &p->view, r->params->skip, &frame);
    ORL_THEN(result, write_picture(r, p->name, &frame.color));
    ORL_THEN(result, write_light(r, p->name, &frame.color));
    ORL_THEN(result, orl_subset_copy_photo(&r->subset, photo));
    orl_frame_finish(&frame);
    return result;
}

static enum orl_result write_photos(const struct replacement *r)
{
    enum orl_result result = ORL_OK;
    size_t done = 0;
    for (size_t i = 0; result == ORL_OK && i < r->subset.scene->photo_count; i++) {
        if (orl_progress_cancelled(r->progress))
            return ORL_ERR_CANCELLED;
        if (is_replaced(r, i)) {
            result = replace_photo(r, i);
            orl_progress_report(r->progress, "hdr", (double)++done, (double)r->count,
                                r->subset.scene->photos[i].name);
        } else if (r->keep[i]) {
            result = orl_subset_copy_photo(&r->subset, i);
        }
    }
    return result;
}

// --- the manifest ---

static void describe_photo(json_t *entry)
{
    json_object_set_new(entry, "exposure_ev", json_real(0));
    json_object_set_new(entry, "gain", json_pack("[i, i, i]", 1, 1, 1));
    json_object_set_new(entry, "radiance", json_true());
    json_object_del(entry, "vignette");
    json_object_del(entry, "response");
}

static enum orl_result write_manifest(const struct replacement *r)
{
    json_t *list = json_object_get(r->subset.manifest, "photographs"), *entry;
    size_t i;
    json_object_del(r->subset.manifest, "tuned"); // other photographs want other settings
    json_array_foreach(list, i, entry)
        if (is_replaced(r, (size_t)orl_scene_find_photo(r->subset.scene, orl_json_text(entry, "name"))))
            describe_photo(entry);
    json_object_set_new(r->subset.manifest, "replaced",
                        json_pack("{s:i, s:I, s:s, s:s}", "series", r->params->series,
                                  "photographs", (json_int_t)r->count, "merge",
                                  orl_hdr_merge_names[r->hdr->params.merge], "method",
                                  r->params->method));
    return orl_json_write(r->subset.log, ORL_PATH(r->subset.dir, "scene.json"), r->subset.manifest);
}

static enum orl_result choose(struct replacement *r)
{
    const struct orl_log *log = r->subset.log;
    const struct orl_scene *scene = r->subset.scene;
    if (scene->frame_count)
        return orl_fail(log, ORL_ERR_DATA, "%s: is a sequence", scene->dir);
    if (!orl_path_is_file(ORL_PATH(scene->dir, "scene.json")))
        return orl_fail(log, ORL_ERR_DATA, "%s: a plain workspace; prepare or import it first", scene->dir);
    r->subset.keep = r->keep = orl_array(log, scene->photo_count, sizeof *r->keep);
    ORL_TRY_MEMORY(r->keep);
    for (size_t i = 0; i < scene->photo_count; i++) {
        r->count += is_replaced(r, i);
        r->keep[i] = is_replaced(r, i) || scene->photos[i].test;
    }
    return r->count ? ORL_OK
                    : orl_fail(log, ORL_ERR_NOT_FOUND, "%s has no series %d; see oriel info",
                               scene->dir, r->params->series);
}

enum orl_result orl_hdr_replace_series(struct orl_hdr *hdr,
                                       const struct orl_replace_params *params,
                                       const struct orl_progress *progress)
{
    const struct orl_log *log = orl_gpu_log(hdr->gpu);
    struct replacement r = {.hdr = hdr, .params = params, .progress = progress,
                            .subset = {.log = log, .scene = hdr->scene}};
    enum orl_result result = choose(&r);
    ORL_THEN(result, orl_new_dir_begin(log, params->out, false, &r.new_dir));
    r.subset.dir = r.new_dir.path;
    ORL_THEN(result, orl_subset_begin(&r.subset));
    ORL_THEN(result, write_photos(&r));
    ORL_THEN(result, write_manifest(&r));
    ORL_THEN(result, orl_new_dir_finish(log, &r.new_dir));
    orl_new_dir_abort(log, &r.new_dir);
    json_decref(r.subset.manifest);
    free(r.keep);
    return result;
}
