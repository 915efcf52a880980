// The point cloud of a site: cells of neighbouring points, with positions quantised within each
// cell. Each cell is ordered so that any first part of it covers the cell evenly. The first parts
// of all cells form one file, which is loaded first: the coarse cloud.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "scene/point_blocks.h"
#include "scene/point_lod.h"
#include "walk/internal.h"

enum {
    CELL_POINTS = 4096, // a power of two, for the bit-reversed order within a cell
    CELLS_PER_FILE = 16,
    POINT_BYTES = 12,   // read by web/js/points.js
    CELL_WORDS = 12,
    COARSE_BYTES = 420 << 10, // of points in the coarse cloud, about
};
static const uint32_t magic = 0x504c524f; // "ORLP"

// The record of a cell in the coarse file, in 4-byte words.
struct cell_words {
    float low[3], size[3];           // bounds of its points
    float radius_low, radius_octaves; // radius = low * 2^(octaves * byte / 255)
    uint32_t count, coarse;          // number of points; number of these in the coarse file
    uint32_t file, first;            // of the other points: number of the file, index of the first
                                     // point in it
};
_Static_assert(sizeof(struct cell_words) == 4 * CELL_WORDS, "cell_words is words");

// The points in the order in which they are written.
struct order {
    const struct orl_points *points;
    uint32_t *index;
    size_t count;
    size_t cells;
};

// --- order ---

// Leaves out points without a radius, which show nothing.
static size_t drop_flat(const struct orl_points *points, uint32_t *index, size_t count)
{
    size_t left = 0;
    for (size_t i = 0; i < count; i++)
        if (points->radius[index[i]] > 0)
            index[left++] = index[i];
    return left;
}

static enum orl_result make_order(const struct orl_log *log, const struct orl_points *points,
                                  struct order *order)
{
    struct point_cube cube;
    uint32_t *curve = NULL;
    *order = (struct order){.points = points};
    if (points->count > UINT32_MAX)
        return orl_fail(log, ORL_ERR_UNSUPPORTED, "%zu points are too many", points->count);
    enum orl_result result = orl_point_cube_find(log, points, &cube);
    ORL_THEN(result, orl_point_curve(log, points, &cube, &curve, &order->count));
    order->index = result == ORL_OK ? orl_array(log, order->count, sizeof *order->index) : NULL;
    if (order->index) {
        order->count = drop_flat(points, curve, order->count);
        order->cells = (order->count + CELL_POINTS - 1) / CELL_POINTS;
        for (size_t first = 0; first < order->count; first += CELL_POINTS) {
            size_t left = order->count - first;
            orl_point_shuffle(curve + first, left < CELL_POINTS ? left : CELL_POINTS, CELL_POINTS,
                              order->index + first);
        }
    } else if (result == ORL_OK) {
        result = ORL_ERR_MEMORY;
    }
    free(curve);
    return result;
}

// --- a cell ---

struct cell {
    const struct orl_points *points;
    const uint32_t *index;
    float enlarged; // factor on radii, so that fewer points cover the same surface
    struct cell_words words;
};

static void describe_cell(struct cell *cell, size_t count)
{
    const struct orl_points *points = cell->points;
    struct cell_words *w = &cell->words;
    float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    float least = INFINITY, most = 0;
    for (size_t i = 0; i < count; i++) {
        size_t point = cell->index[i];
        for (int k = 0; k < 3; k++) {
            low[k] = fminf(low[k], points->position[point][k]);
            high[k] = fmaxf(high[k], points->position[point][k]);
        }
        least = fminf(least, points->radius[point]);
        most = fmaxf(most, points->radius[point]);
    }
    for (int k = 0; k < 3; k++) {
        w->low[k] = low[k];
        w->size[k] = fmaxf(high[k] - low[k], 1e-12f);
    }
    w->radius_low = least * cell->enlarged;
    w->radius_octaves = log2f(most / least);
    w->count = (uint32_t)count;
}

// Position 3 x 16 bits, normal 2 x 8, sRGB colour 3 x 8, radius 8, and 16 bits of padding.
static void encode_point(const struct cell *cell, size_t i, uint8_t out[POINT_BYTES])
{
    const struct cell_words *w = &cell->words;
    size_t point = cell->index[i];
    memset(out, 0, POINT_BYTES);
    for (int k = 0; k < 3; k++) {
        float part = (cell->points->position[point][k] - w->low[k]) / w->size[k];
        unsigned value = (unsigned)lrintf(fminf(1, fmaxf(0, part)) * 65535);
        out[2 * k] = (uint8_t)value;
        out[2 * k + 1] = (uint8_t)(value >> 8);
    }
    uint16_t normal = orl_octahedron_bytes(cell->points->normal[point]);
    out[6] = (uint8_t)normal;
    out[7] = (uint8_t)(normal >> 8);
    memcpy(out + 8, cell->points->color[point], 3);
    float radius = cell->points->radius[point] * cell->enlarged;
    float octaves = w->radius_octaves > 0 ? log2f(radius / w->radius_low) / w->radius_octaves : 0;
    out[11] = (uint8_t)lrintf(fminf(1, fmaxf(0, octaves)) * 255);
}

// --- files ---

static json_t *box_json(const struct cell_words *words, size_t count)
{
    float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (size_t c = 0; c < count; c++)
        for (int k = 0; k < 3; k++) {
            low[k] = fminf(low[k], words[c].low[k]);
            high[k] = fmaxf(high[k], words[c].low[k] + words[c].size[k]);
        }
    return json_pack("[f,f,f,f,f,f]", (double)low[0], (double)low[1], (double)low[2],
                     (double)high[0], (double)high[1], (double)high[2]);
}

struct writing {
    struct site *site;
    struct order order;
    struct cell_words *words; // of all cells
    double share, coarse;     // fraction of a cell's points that are kept; fraction that is in the
                              // coarse file
    uint8_t *coarse_data;     // owned
    size_t coarse_size;
};

// Describes and encodes cells [first, first + count). Points outside the coarse file are appended
// to `rest`.
static void encode_cells(struct writing *w, size_t first, size_t count, uint8_t *rest,
                         size_t *rest_points)
{
    for (size_t c = first; c < first + count; c++) {
        size_t at = c * CELL_POINTS, left = w->order.count - at;
        size_t all = left < CELL_POINTS ? left : CELL_POINTS;
        size_t kept = (size_t)ceil((double)all * w->share);
        size_t coarse = (size_t)ceil((double)all * w->coarse);
        coarse = coarse < kept ? coarse : kept;
        struct cell cell = {.points = w->order.points, .index = w->order.index + at,
                            .enlarged = sqrtf((float)all / (float)kept)};
        describe_cell(&cell, kept);
        cell.words.coarse = (uint32_t)coarse;
        cell.words.file = (uint32_t)(c / CELLS_PER_FILE);
        cell.words.first = (uint32_t)*rest_points;
        for (size_t i = 0; i < coarse; i++, w->coarse_size += POINT_BYTES)
            encode_point(&cell, i, w->coarse_data + w->coarse_size);
        for (size_t i = coarse; i < kept; i++, ++*rest_points)
            encode_point(&cell, i, rest + *rest_points * POINT_BYTES);
        w->words[c] = cell.words;
        w->site->report->points += kept;
    }
}

static enum orl_result write_files(struct writing *w, json_t *files)
{
    uint8_t *rest = orl_array(w->site->log, CELLS_PER_FILE * CELL_POINTS, POINT_BYTES);
    enum orl_result result = rest ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t c = 0; result == ORL_OK && c < w->order.cells; c += CELLS_PER_FILE) {
        size_t left = w->order.cells - c, points = 0;
        size_t count = left < CELLS_PER_FILE ? left : CELLS_PER_FILE;
        encode_cells(w, c, count, rest, &points);
        if (!(w->coarse < w->share)) // the coarse file has all points
            continue;
        const char *path = ORL_PATH("", "%spoints/%04zu.bin", w->site->folder, c / CELLS_PER_FILE);
        result = orl_site_write(w->site, path, rest, points * POINT_BYTES);
        json_t *file = result == ORL_OK ? orl_site_file(w->site, path) : NULL;
        if (file)
            json_object_set_new(file, "box", box_json(w->words + c, count));
        if (result == ORL_OK && json_array_append_new(files, file) != 0)
            result = ORL_ERR_MEMORY;
    }
    free(rest);
    return result;
}

// Writes the header, the cells' records and the coarse points.
static enum orl_result write_coarse(struct writing *w, json_t **file)
{
    const char *path = ORL_PATH(w->site->folder, "points/coarse.bin");
    const uint32_t header[4] = {magic, 2, (uint32_t)w->order.cells, POINT_BYTES};
    size_t cells = w->order.cells * sizeof *w->words;
    size_t size = sizeof header + cells + w->coarse_size;
    uint8_t *data = orl_array(w->site->log, size, 1);
    ORL_TRY_MEMORY(data);
    memcpy(data, header, sizeof header);
    memcpy(data + sizeof header, w->words, cells);
    memcpy(data + sizeof header + cells, w->coarse_data, w->coarse_size);
    enum orl_result result = orl_site_write(w->site, path, data, size);
    *file = result == ORL_OK ? orl_site_file(w->site, path) : NULL;
    free(data);
    return result;
}

enum orl_result orl_site_points(struct site *site, const struct orl_points *points, size_t max_points,
                                json_t **out)
{
    struct writing w = {.site = site};
    size_t before = site->report->points;
    json_t *files = json_array(), *coarse = NULL;
    enum orl_result result = make_order(site->log, points, &w.order);
    if (result == ORL_OK && w.order.count == 0)
        result = orl_fail(site->log, ORL_ERR_DATA, "the scene has no points: nothing to publish");
    if (result != ORL_OK)
        goto end;
    double count = (double)w.order.count;
    w.share = fmin(1, (double)max_points / count);
    w.coarse = fmin(w.share, (double)COARSE_BYTES / POINT_BYTES / count);
    w.words = orl_array(site->log, w.order.cells, sizeof *w.words);
    w.coarse_data = orl_array(site->log, (size_t)ceil(count * w.coarse) + w.order.cells,
                              POINT_BYTES);
    result = w.words && w.coarse_data ? write_files(&w, files) : ORL_ERR_MEMORY;
    ORL_THEN(result, write_coarse(&w, &coarse));
    if (result == ORL_OK) {
        *out = json_pack("{s:I, s:O, s:O}", "count", (json_int_t)(site->report->points - before), "coarse",
                         coarse, "files", files);
        result = *out ? ORL_OK : ORL_ERR_MEMORY;
    }
end:
    json_decref(files);
    json_decref(coarse);
    free(w.order.index);
    free(w.words);
    free(w.coarse_data);
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
