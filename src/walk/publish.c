// Writes a site part by part. The site takes its name only when it is complete.
#include "walk/publish.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "core/file.h"
#include "core/json.h"
#include "core/new_dir.h"
#include "core/text.h"
#include "scene/info.h"
#include "walk/internal.h"

enum orl_result orl_site_write(struct site *site, const char *path, const void *data, size_t size)
{
    return orl_file_write(site->log, ORL_PATH(site->dir, "%s", path), data, size);
}

// 0: the file is missing.
static size_t bytes_of(const struct site *site, const char *path)
{
    struct stat status;
    return stat(ORL_PATH(site->dir, "%s", path), &status) == 0 ? (size_t)status.st_size : 0;
}

json_t *orl_site_file(const struct site *site, const char *path)
{
    if (!orl_path_is_file(ORL_PATH(site->dir, "%s", path))) {
        orl_logf(site->log, ORL_LOG_ERROR, "%s is missing in the site", path);
        return NULL;
    }
    return json_pack("{s:s, s:I}", "file", path, "bytes", (json_int_t)bytes_of(site, path));
}

// --- the output ---

// Accepts a path that does not exist, or a site that Oriel wrote.
static enum orl_result check_out(const struct orl_log *log, const char *out, bool single_file)
{
    if (single_file)
        return orl_path_is_dir(out) ? orl_fail(log, ORL_ERR_ARGUMENT, "--out %s: is a folder, but "
                                               "--single-file writes an HTML file", out)
                                    : ORL_OK;
    if (orl_path_is_file(out))
        return orl_fail(log, ORL_ERR_ARGUMENT, "--out %s: is a file, and a site is a folder; "
                        "--single-file writes an HTML file", out);
    if (!orl_path_is_dir(out))
        return ORL_OK;
    const char *path = ORL_PATH(out, "manifest.json");
    json_t *manifest = NULL;
    const struct orl_log quiet = {.level = ORL_LOG_ERROR};
    bool ours = orl_path_is_file(path) && orl_json_read(&quiet, path, &manifest) == ORL_OK;
    const char *format = orl_json_text(manifest, "format");
    ours = ours && format && strcmp(format, "oriel site") == 0;
    json_decref(manifest);
    return ours ? ORL_OK : orl_fail(log, ORL_ERR_ARGUMENT, "--out %s: is a folder that is no site "
                                    "of Oriel, and stays as it is", out);
}

static enum orl_result make_folders(struct site *site)
{
    static const char *const folders[] = {"js", "points", "photos", "depth", "thumbs"};
    for (size_t i = 0; i < ORL_COUNT(folders); i++)
        ORL_TRY(orl_dir_make(site->log, ORL_PATH(site->dir, "%s", folders[i])));
    return ORL_OK;
}

// --- the parts of the site ---

static void count_bytes(const struct site *site)
{
    static const char *const first[] = {"shaders.json", "manifest.json", "poster.jpg", "points/coarse.bin", NULL};
    struct orl_names paths = {0};
    if (orl_site_files(site->log, site->dir, false, &paths) == ORL_OK)
        for (size_t i = 0; i < paths.count; i++) {
            size_t bytes = bytes_of(site, paths.items[i]);
            site->report->bytes += bytes;
            if (orl_walk_page_file(paths.items[i]) || orl_text_is_one_of(paths.items[i], first))
                site->report->first_bytes += bytes;
        }
    orl_names_finish(&paths);
}

static enum orl_result write_site(struct site *site)
{
    json_t *points = NULL, *photos = NULL, *steps = NULL, *soft = NULL;
    enum orl_result result = orl_walk_start(site->log, site->scene, &site->start);
    ORL_THEN(result, make_folders(site));
    ORL_THEN(result, orl_site_page(site));
    ORL_THEN(result, orl_site_scene_points(site, &points));
    ORL_THEN(result, orl_site_soft(site, &soft));
    ORL_THEN(result, orl_site_photos(site, &photos));
    ORL_THEN(result, orl_site_poster(site));
    if (result == ORL_OK && site->carves)
        result = orl_site_steps(site, &steps);
    ORL_THEN(result, orl_site_manifest(site, points, photos, steps, soft));
    json_decref(points);
    json_decref(photos);
    json_decref(steps);
    json_decref(soft);
    return result;
}

// The page paints by the first method (web/shaders), whichever method the scene's default is. The
// poster must look like the page. Where silhouettes alone say where the subject is, or it moves, li has
// its depth.
static enum orl_result make_renderer(struct site *site)
{
    site->subject = orl_method_find(site->log, "li")->params;
    site->carves = orl_scene_silhouettes(site->scene) && !site->params->radiance &&
                   (site->scene->frame_count || !orl_scene_point_count(site->scene));
    orl_render_params_tuned(site->log, &orl_methods[0], site->scene, &site->render);
    const struct orl_renderer_params limits = {.radiance = site->params->radiance};
    if (limits.radiance) {
        site->render.sample = ORL_SAMPLE_RADIANCE;
        site->range = orl_site_range(site->scene);
    }
    return orl_renderer_create(site->gpu, site->scene, &limits, &site->renderer);
}

static enum orl_result replace_site(const struct site *site, struct orl_new_dir *dir)
{
    ORL_TRY(orl_site_list(site));
    ORL_TRY(orl_site_keep(site, dir->out));
    return orl_new_dir_finish(site->log, dir);
}

enum orl_result orl_publish(struct orl_gpu *gpu, struct orl_scene *scene,
                            const struct orl_publish_params *asked,
                            struct orl_publish_report *report)
{
    const struct orl_log *log = orl_gpu_log(gpu);
    struct orl_publish_params params = *asked;
    char *title = NULL;
    *report = (struct orl_publish_report){0};
    struct orl_new_dir dir;
    struct site site = {.log = log, .scene = scene, .params = &params, .gpu = gpu,
                        .report = report, .dir = dir.path, .folder = ""};
    enum orl_result result = orl_new_dir_begin(log, params.out, true, &dir);
    ORL_THEN(result, check_out(log, params.out, params.single_file));
    ORL_THEN(result, orl_walk_settings_read(log, scene, &site.settings));
    if (result == ORL_OK)
        params.title = title = orl_walk_title(log, scene, asked->title, site.settings);
    ORL_THEN(result, title ? make_renderer(&site) : ORL_ERR_MEMORY);
    ORL_THEN(result, write_site(&site));
    if (result == ORL_OK)
        count_bytes(&site);
    if (result == ORL_OK)
        result = params.single_file ? orl_site_pack(&site, params.out)
                                    : replace_site(&site, &dir);
    orl_new_dir_abort(log, &dir);
    orl_renderer_destroy(&site.renderer);
    orl_soft_raster_finish(gpu, &site.soft);
    json_decref(site.settings);
    free(title);
    return result;
}
