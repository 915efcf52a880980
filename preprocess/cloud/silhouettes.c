#include "preprocess/cloud/silhouettes.h"

#include <math.h>
#include <stdlib.h>

#include "core/file.h"
#include "core/memory.h"
#include "core/order.h"
#include "core/vec3.h"
#include "io/picture.h"
#include "scene/silhouette.h"

enum {
    LEAST = 5,     // photographs
    BORDER = 50,   // of the picture's side: the width of its border
    DARKEST = 100, // thresholds above are not those of a dark backdrop; 8 bits
};
// Share of the pixels at the border that may be the subject's, on average and in any photograph. A
// subject that leaves the pictures is not one that they go around, and masks may leave the room in.
static const double BORDER_MAX = 0.1, BORDER_MOST_ONE = 0.5;
// Length of the mean of the directions to the photographs: 0 all around, 1 from one side.
static const double ONE_SIDED = 0.8;

void orl_silhouettes_finish(struct orl_silhouettes *found)
{
    for (size_t i = 0; found->items && i < found->count; i++)
        orl_image_finish(&found->items[i].mask);
    free(found->items);
    free(found->image);
    *found = (struct orl_silhouettes){0};
}

// --- whether there may be any ---

static enum orl_result list_photographs(struct orl_job *job, const struct orl_colmap_model *model,
                                        const struct orl_names *train,
                                        struct orl_silhouettes *found)
{
    found->items = orl_array(job->log, train->count, sizeof *found->items);
    found->image = orl_array(job->log, train->count, sizeof *found->image);
    ORL_TRY_MEMORY(found->items && found->image);
    for (size_t i = 0; i < model->image_count; i++)
        if (orl_names_contain(train, model->images[i].name)) {
            found->items[found->count].view = orl_colmap_image_view(model, &model->images[i]);
            found->image[found->count++] = &model->images[i];
        }
    return ORL_OK;
}

static bool is_one_sided(const struct orl_silhouettes *found, const struct orl_points *points)
{
    double middle[3] = {0}, mean[3] = {0};
    for (size_t i = 0; i < points->count; i++)
        for (int k = 0; k < 3; k++)
            middle[k] += (double)points->position[i][k] / (double)points->count;
    for (size_t i = 0; i < found->count; i++) {
        double towards[3], length;
        orl_pose_centre(&found->items[i].view.cam_from_world, towards);
        for (int k = 0; k < 3; k++)
            towards[k] -= middle[k];
        length = sqrt(orl_dot3(towards, towards));
        for (int k = 0; k < 3 && length > 0; k++)
            mean[k] += towards[k] / length / (double)found->count;
    }
    return sqrt(orl_dot3(mean, mean)) > ONE_SIDED;
}

// --- the border of the pictures ---

// The share of the pixels at the picture's border that are marked.
static double border_share(const struct orl_image *mask)
{
    int wide = mask->width / BORDER + 1, high = mask->height / BORDER + 1;
    size_t marked = 0, count = 0;
    for (int y = 0; y < mask->height; y++)
        for (int x = 0; x < mask->width; x++)
            if (x < wide || y < high || x >= mask->width - wide || y >= mask->height - high) {
                marked += mask->u8[(size_t)y * (size_t)mask->width + (size_t)x] != 0;
                count++;
            }
    return (double)marked / (double)count;
}

// Adds a photograph's share to the mean over `count`. False if it is too large by then.
static bool add_border(const struct orl_image *mask, size_t count, double *mean)
{
    double share = border_share(mask);
    *mean += share / (double)count;
    return share <= BORDER_MOST_ONE && *mean <= BORDER_MAX;
}

// --- masks of the scene ---

static enum orl_result read_masks(struct orl_job *job, struct orl_silhouettes *found, bool *all)
{
    double border = 0;
    enum orl_result result = ORL_OK;
    *all = true;
    for (size_t i = 0; result == ORL_OK && *all && i < found->count; i++) {
        struct orl_silhouette *s = &found->items[i];
        const char *path = ORL_PATH(job->dir, "masks/%s.png", found->image[i]->name);
        *all = orl_path_is_file(path);
        if (*all)
            result = orl_picture_read(job->log, path, 1, &s->mask);
        *all = *all && result == ORL_OK && s->mask.width == s->view.camera.width &&
               s->mask.height == s->view.camera.height &&
               add_border(&s->mask, found->count, &border);
    }
    return result;
}

// --- a dark backdrop ---

static enum orl_result read_dark(struct orl_job *job, const struct orl_silhouettes *found, size_t i,
                                 int threshold, int *used, struct orl_image *mask)
{
    struct orl_image picture = {0};
    const char *path = ORL_PATH(job->dir, "images/%s", found->image[i]->name);
    enum orl_result result = orl_picture_read(job->log, path, 3, &picture);
    ORL_THEN(result, orl_silhouette_dark(job->log, &picture, threshold, used, mask));
    orl_image_finish(&picture);
    return result;
}

// The threshold for all photographs is the lower quartile of those of each: shadows of the subject
// should not be cut out of it, and a hull that is too large by what the backdrop reflects in one
// photograph is carved by others. Negative: the backdrop is not dark.
static enum orl_result find_threshold(struct orl_job *job, const struct orl_silhouettes *found,
                                      int *threshold)
{
    int *used = orl_array(job->log, found->count, sizeof *used);
    double border = 0;
    bool dark = true;
    enum orl_result result = used ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && dark && i < found->count; i++) {
        struct orl_image mask = {0};
        result = read_dark(job, found, i, -1, &used[i], &mask);
        dark = result == ORL_OK && add_border(&mask, found->count, &border);
        orl_image_finish(&mask);
    }
    *threshold = -1;
    if (result == ORL_OK && dark) {
        qsort(used, found->count, sizeof *used, orl_order_ints);
        if (used[found->count / 4] <= DARKEST)
            *threshold = used[found->count / 4];
    }
    free(used);
    return result;
}

static enum orl_result cut_out(struct orl_job *job, struct orl_silhouettes *found, bool *all)
{
    int threshold, used;
    enum orl_result result = find_threshold(job, found, &threshold);
    *all = result == ORL_OK && threshold >= 0;
    for (size_t i = 0; result == ORL_OK && *all && i < found->count; i++) {
        struct orl_silhouette *s = &found->items[i];
        result = read_dark(job, found, i, threshold, &used, &s->mask);
        *all = s->mask.width == s->view.camera.width && s->mask.height == s->view.camera.height;
    }
    return result;
}

enum orl_result orl_silhouettes_find(struct orl_job *job, const struct orl_colmap_model *model,
                                     const struct orl_names *train, const struct orl_points *points,
                                     struct orl_silhouettes *found)
{
    bool all = false;
    *found = (struct orl_silhouettes){0};
    enum orl_result result = list_photographs(job, model, train, found);
    bool possible = result == ORL_OK && found->count >= LEAST && !is_one_sided(found, points);
    found->given = possible && job->params->masks_dir;
    if (possible && found->given)
        result = read_masks(job, found, &all);
    else if (possible)
        result = cut_out(job, found, &all);
    if (!all || result != ORL_OK)
        orl_silhouettes_finish(found);
    return result;
}
