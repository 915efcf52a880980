#include "preprocess/cloud/fuse_memory.h"

#include <stdlib.h>

#include "core/memory.h"
#include "preprocess/cloud/clusters.h"

// Bytes of a pixel in COLMAP's maps: depth, normal and colour, as its program stores them. Beside
// the maps: COLMAP's marks of fused pixels, and the points with the lists of their photographs.
enum { MAP_BYTES = 24, OTHER_BYTES = 10 };
static const double PROGRAM_BYTES = 32 << 20; // COLMAP without photographs
// COLMAP follows each pixel of a photograph into the 50 that overlap it most
// (StereoFusion.check_num_images). With the maps of fewer in its cache it reads them again and again:
// a fusion of seconds takes minutes (docs/measured/matching.md).
enum { WORKING_SET = 51 };
// Clusters smaller than these lose too many points: a surface needs three photographs to agree, and
// those at the border of a cluster have fewer neighbours.
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
    return orl_fuse_bytes_beside_maps(pixels) + MAP_BYTES * pixels;
}

double orl_fuse_bytes_beside_maps(double pixels)
{
    return PROGRAM_BYTES + OTHER_BYTES * pixels;
}

static int compare_falling(const void *left, const void *right)
{
    double a = *(const double *)left, b = *(const double *)right;
    return a > b ? -1 : a < b;
}

// Bytes of a fusion of `count` photographs at most, when they are the largest.
static double least_bytes(const double *falling, size_t count)
{
    double pixels = 0, maps = 0;
    for (size_t i = 0; i < count; i++) {
        pixels += falling[i];
        maps += i < WORKING_SET ? falling[i] : 0;
    }
    return orl_fuse_bytes_beside_maps(pixels) + MAP_BYTES * maps;
}

enum orl_result orl_fuse_plan_size(const struct orl_log *log, const struct orl_colmap_model *model,
                                   const struct orl_names *names, size_t most, double budget,
                                   size_t *size)
{
    size_t count = 0;
    double *falling = orl_array(log, model->image_count + 1, sizeof *falling);
    if (!falling)
        return ORL_ERR_MEMORY;
    for (size_t i = 0; i < model->image_count; i++)
        if (orl_names_contain(names, model->images[i].name))
            falling[count++] = pixels_of(model, &model->images[i]);
    qsort(falling, count, sizeof *falling, compare_falling);
    size_t members = count < most ? count : most;
    for (size_t clusters = 2; members > LEAST; clusters++) {
        size_t fused = members < count ? members + orl_clusters_helpers(members) : count;
        if (least_bytes(falling, fused < count ? fused : count) <= budget)
            break;
        size_t fewer = (count + clusters - 1) / clusters;
        members = fewer < members ? fewer : members;
    }
    *size = members ? members : most;
    free(falling);
    return ORL_OK;
}
