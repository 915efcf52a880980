// The point cloud of a site: large blocks (scene/point_blocks.h) that are called cells. The first parts
// of all cells form one file, which is loaded first: the coarse cloud.
#include <math.h>
#include <stdlib.h>

#include "core/file.h"
#include "core/memory.h"
#include "scene/point_blocks.h"
#include "scene/point_lod.h"
#include "walk/internal.h"

enum {
    CELL_POINTS = 4096, // a power of two
    CELLS_PER_FILE = 16,
    COARSE_BYTES = 420 << 10, // of points in the coarse cloud, about
};
static const uint32_t magic = 0x504c524f; // "ORLP"

// A cell as the coarse file has it, read by web/js/points.js like the points, struct point_code.
struct cell {
    struct point_frame frame;
    float size[3];         // of the bounds of its points, which begin at the frame's origin
    uint32_t count, coarse; // number of points; number of these in the coarse file
    uint32_t file, first;  // of the other points: number of the file, index of the first point in it
};
_Static_assert(sizeof(struct cell) == 11 * 4, "a cell is words");

struct writing {
    struct site *site;
    const struct orl_points *points;
    uint32_t *order; // owned; CELL_POINTS of each cell, see orl_point_order
    struct cell *cells; // owned
    size_t cell_count;
    double share, coarse; // fraction of a cell's points that are kept; fraction that is in the
                          // coarse file
    struct point_code *coarse_points; // owned
    size_t coarse_count;
};

// --- files ---

static json_t *box_json(const struct cell *cells, size_t count)
{
    struct point_range range = orl_point_range_none();
    for (size_t c = 0; c < count; c++) {
        const float *low = cells[c].frame.origin, *size = cells[c].size;
        orl_point_range_add(&range, low, 0);
        orl_point_range_add(&range, (float[3]){low[0] + size[0], low[1] + size[1], low[2] + size[2]}, 0);
    }
    const float *low = range.low, *high = range.high;
    return json_pack("[f,f,f,f,f,f]", (double)low[0], (double)low[1], (double)low[2], (double)high[0],
                     (double)high[1], (double)high[2]);
}

// Describes and encodes a cell. Points outside the coarse file are appended to `rest`.
static void encode_cell(struct writing *w, size_t index, struct point_code *rest, size_t *rest_count)
{
    const struct orl_points *points = w->points;
    const uint32_t *order = w->order + index * CELL_POINTS;
    struct cell *cell = &w->cells[index];
    struct point_range range = orl_point_range_none();
    size_t all = 0;
    while (all < CELL_POINTS && order[all] != UINT32_MAX)
        all++;
    size_t kept = (size_t)ceil((double)all * w->share), coarse = (size_t)ceil((double)all * w->coarse);
    float enlarged = sqrtf((float)all / (float)kept); // so that fewer points cover the same surface
    for (size_t i = 0; i < kept; i++)
        orl_point_range_add(&range, points->position[order[i]], points->radius[order[i]] * enlarged);
    *cell = (struct cell){.frame = orl_point_frame(&range), .count = (uint32_t)kept, .coarse = (uint32_t)coarse,
                          .file = (uint32_t)(index / CELLS_PER_FILE), .first = (uint32_t)*rest_count};
    for (int k = 0; k < 3; k++)
        cell->size[k] = range.high[k] - range.low[k];
    for (size_t i = 0; i < kept; i++) {
        size_t point = order[i];
        struct point_code *to = i < coarse ? &w->coarse_points[w->coarse_count++] : &rest[(*rest_count)++];
        *to = orl_point_encode(&cell->frame, points->position[point], points->normal[point],
                               points->color[point], points->radius[point] * enlarged);
    }
    w->site->report->points += kept;
}

static enum orl_result write_files(struct writing *w, json_t *files)
{
    struct point_code *rest = orl_array(w->site->log, CELLS_PER_FILE * CELL_POINTS, sizeof *rest);
    enum orl_result result = rest ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t first = 0; result == ORL_OK && first < w->cell_count; first += CELLS_PER_FILE) {
        size_t points = 0, c = first;
        for (; c < w->cell_count && c < first + CELLS_PER_FILE; c++)
            encode_cell(w, c, rest, &points);
        if (!(w->coarse < w->share)) // the coarse file has all points
            continue;
        const char *path = ORL_PATH("", "%spoints/%04zu.bin", w->site->folder, first / CELLS_PER_FILE);
        result = orl_site_write(w->site, path, rest, points * sizeof *rest);
        json_t *file = result == ORL_OK ? orl_site_file(w->site, path) : NULL;
        if (file)
            json_object_set_new(file, "box", box_json(w->cells + first, c - first));
        if (result == ORL_OK && json_array_append_new(files, file) != 0)
            result = ORL_ERR_MEMORY;
    }
    free(rest);
    return result;
}

// Writes the header, the cells and the coarse points.
static enum orl_result write_coarse(struct writing *w, json_t **file)
{
    const char *path = ORL_PATH(w->site->folder, "points/coarse.bin");
    const uint32_t header[4] = {magic, 3, (uint32_t)w->cell_count, sizeof *w->coarse_points};
    struct orl_bytes data = {0};
    enum orl_result result = orl_bytes_add(w->site->log, &data, header, sizeof header);
    ORL_THEN(result, orl_bytes_add(w->site->log, &data, w->cells, w->cell_count * sizeof *w->cells));
    ORL_THEN(result, orl_bytes_add(w->site->log, &data, w->coarse_points, w->coarse_count * sizeof *w->coarse_points));
    ORL_THEN(result, orl_site_write(w->site, path, data.data, data.size));
    *file = result == ORL_OK ? orl_site_file(w->site, path) : NULL;
    free(data.data);
    return result;
}

enum orl_result orl_site_points(struct site *site, const struct orl_points *points, size_t max_points,
                                json_t **out)
{
    struct writing w = {.site = site, .points = points};
    size_t before = site->report->points, entries = 0;
    json_t *files = json_array(), *coarse = NULL;
    enum orl_result result = points->count > UINT32_MAX
        ? orl_fail(site->log, ORL_ERR_UNSUPPORTED, "%zu points are too many", points->count)
        : orl_point_order(site->log, points, NULL, CELL_POINTS, &w.order, &entries);
    if (result == ORL_OK && entries == 0)
        result = orl_fail(site->log, ORL_ERR_DATA, "the scene has no points: nothing to publish");
    if (result != ORL_OK)
        goto end;
    double count = (double)points->count;
    w.cell_count = entries / CELL_POINTS;
    w.share = fmin(1, (double)max_points / count);
    w.coarse = fmin(w.share, (double)COARSE_BYTES / sizeof *w.coarse_points / count);
    w.cells = orl_array(site->log, w.cell_count, sizeof *w.cells);
    w.coarse_points = orl_array(site->log, (size_t)ceil(count * w.coarse) + w.cell_count, sizeof *w.coarse_points);
    result = w.cells && w.coarse_points ? write_files(&w, files) : ORL_ERR_MEMORY;
    ORL_THEN(result, write_coarse(&w, &coarse));
    if (result == ORL_OK) {
        *out = json_pack("{s:I, s:O, s:O}", "count", (json_int_t)(site->report->points - before), "coarse",
                         coarse, "files", files);
        result = *out ? ORL_OK : ORL_ERR_MEMORY;
    }
end:
    json_decref(files);
    json_decref(coarse);
    free(w.order);
    free(w.cells);
    free(w.coarse_points);
    return result;
}

enum orl_result orl_site_scene_points(struct site *site, json_t **out)
{
    struct orl_points level = {0}, walls = {0}; // of a cloud that is larger than memory; of a room
    const struct orl_lod *lod = site->scene->lod;
    size_t most = (size_t)site->params->max_points;
    enum orl_result result = lod ? orl_lod_sample(lod, most, &level) : ORL_OK;
    if (result == ORL_OK && site->carves)
        result = orl_site_room(site, &walls);
    ORL_THEN(result, orl_site_points(site, site->carves ? &walls : lod ? &level : &site->scene->points, most, out));
    orl_points_finish(&level);
    orl_points_finish(&walls);
    return result;
}
