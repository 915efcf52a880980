// A row for pictures that another program rendered at the held-out cameras.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bridge/bridge.h"
#include "core/memory.h"
#include "eval/chart_internal.h"
#include "eval/internal.h"
#include "io/picture.h"

struct job {
    const struct chart_scene *scene;
    char *dir; // owned
};

// Path of the picture, NULL when there is none.
static char *find_picture(const struct job *job, size_t view)
{
    static const char *const extensions[] = {"png", "jpg", "jpeg", "JPG"};
    const struct chart_scene *scene = job->scene;
    char *found = NULL;
    char *stem = orl_eval_file_stem(NULL, scene->scene, scene->views[view].photo);
    for (size_t i = 0; stem && !found && i < ORL_COUNT(extensions); i++) {
        char *path = orl_format(NULL, "%s/%s.%s", job->dir, stem, extensions[i]);
        if (path && orl_path_is_file(path))
            found = path;
        else
            free(path);
    }
    free(stem);
    return found;
}

static enum orl_result read_picture(void *priv, size_t view, struct orl_image *rendered,
                                    struct orl_image *coverage)
{
    const struct job *job = priv;
    const struct orl_log *log = orl_gpu_log(job->scene->gpu);
    const struct orl_heldout *heldout = &job->scene->views[view];
    int width = heldout->picture.width, height = heldout->picture.height;
    struct orl_image other = {0};
    char *path = find_picture(job, view);
    if (!path)
        return orl_fail(log, ORL_ERR_NOT_FOUND, "%s: no picture of %s", job->dir,
                        job->scene->scene->photos[heldout->photo].name);
    enum orl_result result = orl_picture_read(log, path, 3, &other);
    // The size may differ, but the shape must agree within a pixel or two.
    double skew = fabs((double)other.width * height - (double)other.height * width);
    if (result == ORL_OK && skew > 2 * fmax(other.width, other.height))
        result = orl_fail(log, ORL_ERR_DATA, "%s has %dx%d pixels, the photograph %dx%d", path,
                          other.width, other.height, width, height);
    int n = heldout->divide;
    bool as_photograph = other.width / n == width && other.height / n == height;
    if (result == ORL_OK)
        result = as_photograph ? orl_heldout_shrink(log, &other, n, rendered)
                               : orl_bridge_resize(log, &other, width, height, rendered);
    if (result == ORL_OK)
        result = orl_image_init(log, coverage, width, height, 1, ORL_PIXEL_F32);
    for (int i = 0; result == ORL_OK && i < width * height; i++)
        coverage->f32[i] = 1; // the program's coverage is unknown, so the whole picture counts
    orl_image_finish(&other);
    free(path);
    return result;
}

static char *choose_dir(const struct chart_scene *scene, const struct orl_chart_peer *peer)
{
    const struct orl_log *log = orl_gpu_log(scene->gpu);
    char *own = orl_path_join(log, peer->dir, scene->name);
    if (!own || orl_path_is_dir(own))
        return own;
    free(own);
    return orl_strdup(log, peer->dir);
}

enum orl_result orl_chart_peer_row(const struct chart_scene *scene,
                                   const struct orl_chart_peer *peer, json_t **out)
{
    struct job job = {scene, choose_dir(scene, peer)};
    const struct chart_pictures pictures = {read_picture, &job};
    char id[ORL_ROW_ID_MAX];
    size_t there = 0;
    *out = NULL;
    if (!job.dir)
        return ORL_ERR_MEMORY;
    for (size_t i = 0; i < scene->view_count; i++) {
        char *path = find_picture(&job, i);
        there += path != NULL;
        free(path);
    }
    if (!there) {
        free(job.dir);
        return ORL_OK;
    }
    json_t *row = json_pack("{s:s, s:s, s:s, s:b, s:o, s:o}", "scene", scene->name, "method",
                            peer->name, "setting", "", "peer", true, "frame_ms",
                            peer->ms > 0 ? json_real(peer->ms) : json_null(), "device_bytes",
                            peer->mib > 0 ? json_integer((json_int_t)(peer->mib * (1 << 20)))
                                          : json_null());
    orl_row_id(peer->name, "", id);
    enum orl_result result = row ? orl_chart_compare(scene, id, &pictures, row) : ORL_ERR_MEMORY;
    if (result == ORL_OK) {
        *out = row;
    } else {
        json_decref(row);
    }
    free(job.dir);
    return result;
}
