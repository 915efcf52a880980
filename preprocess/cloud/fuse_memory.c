#include "preprocess/cloud/fuse_memory.h"

#include <math.h>
#include <stdlib.h>

#include "core/memory.h"
#include "core/order.h"
#include "preprocess/cloud/clusters.h"

// Bytes for each pixel: its depth, the pixels that are found, and the points, which are about a third
// of the pixels.
enum { PIXEL_BYTES = 4 + 5 + 11 };
// Bytes for each pixel of a photograph while its normals are read, as they are in the file and in order. The points
// are fewer than a third of the pixels, which leaves these bytes for a quarter of the photographs.
enum { READ_BYTES = 24, RESERVED = 4 };
static const double PROGRAM_BYTES = 32 << 20; // the program, and the photographs that are read
// Clusters smaller than these lose too many points: photographs at the border of a cluster have fewer
// neighbours to agree with.
enum { LEAST = 8 };

static double pixels_of(const struct orl_colmap_model *model, const struct orl_colmap_image *image)
{
    const struct orl_camera *camera = &orl_colmap_camera_by_id(model, image->camera_id)->pinhole;
    return (double)camera->width * camera->height;
}

double orl_fuse_pixels(const struct orl_colmap_model *model, const struct orl_names *names)
{
    double pixels = 0;
    for (size_t i = 0; i < model->image_count; i++)
        if (orl_names_contain(names, model->images[i].name))
            pixels += pixels_of(model, &model->images[i]);
    return pixels;
}

double orl_fuse_budget(size_t max_ram_bytes)
{
    static const double unknown = 2.0 * (1 << 30);
    uint64_t available = orl_memory_available();
    if (max_ram_bytes)
        return (double)max_ram_bytes;
    return available == UINT64_MAX ? unknown : 0.5 * (double)available;
}

double orl_fuse_bytes(double pixels)
{
    return PROGRAM_BYTES + PIXEL_BYTES * pixels;
}

size_t orl_fuse_at_once(double pixels, size_t count, double budget)
{
    double each = READ_BYTES * fmax(pixels / (double)count, 1), room = fmax(budget - orl_fuse_bytes(pixels), 0);
    return 1 + count / RESERVED + (size_t)fmin(room / each, (double)count);
}

// Bytes of a fusion of `fused` of `count` photographs at most, when they are the largest.
static double max_bytes(const double *rising, size_t count, size_t fused)
{
    double pixels = 0;
    for (size_t i = count - fused; i < count; i++)
        pixels += rising[i];
    return orl_fuse_bytes(pixels);
}

enum orl_result orl_fuse_plan_size(const struct orl_log *log, const struct orl_colmap_model *model,
                                   const struct orl_names *names, size_t most, double budget,
                                   size_t *size)
{
    size_t count = 0;
    double *rising = orl_array(log, model->image_count + 1, sizeof *rising);
    ORL_TRY_MEMORY(rising);
    for (size_t i = 0; i < model->image_count; i++)
        if (orl_names_contain(names, model->images[i].name))
            rising[count++] = pixels_of(model, &model->images[i]);
    qsort(rising, count, sizeof *rising, orl_order_doubles);
    size_t members = count < most ? count : most;
    for (size_t clusters = 2; members > LEAST; clusters++) {
        size_t fused = members < count ? members + orl_clusters_helpers(members) : count;
        if (max_bytes(rising, count, fused < count ? fused : count) <= budget)
            break;
        size_t fewer = (count + clusters - 1) / clusters;
        members = fewer < members ? fewer : members;
    }
    *size = members ? members : most;
    free(rising);
    return ORL_OK;
}
