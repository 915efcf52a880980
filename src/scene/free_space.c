#include "scene/free_space.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "scene/depth_buffer.h"

enum {
    CHUNK = 1 << 18,    // points between two checks for cancellation
    VIEWS_MAX = 24,     // that vote; more hardly change the result
    PER_CELL = 4,       // points of a cell on average, which sets its size
    VISITED_MAX = 64,   // of a cell: where more crowd, each visited one stands for several
    SIDES = 4,          // quadrants around a point in the picture
    FAR_MIN = 2,        // points behind in each of them, without which nothing is looked through
    THROUGH_MIN = 2,    // photographs that must look through a point to drop it
    CONFIRM_SHARE = 3,  // ... and so many times as many as those that confirm it
};
static const double cell_min_px = 2;
static const double same_depth = 0.02;  // fraction of depth, at least
static const double same_cells = 4;     // sizes of a cell: surfaces at up to some 70 degrees
static const double through_share = 0.1, confirm_share = 0.3; // nearby points, of those behind

// A point as one photograph sees it.
struct seen {
    float at[3]; // pixel and depth
    int32_t cell; // -1: outside of the picture
    uint32_t point;
};
// The points that one photograph sees, sorted into cells of its picture.
struct cells {
    int columns, rows;
    double side_px;
    uint32_t *start;     // of each cell in `sorted`, and the end of the last one
    struct seen *points; // all
    struct seen *sorted; // those in the picture, by their cells
};

static enum orl_result cells_init(const struct orl_log *log, size_t points, size_t cells,
                                  struct cells *c)
{
    c->start = orl_array(log, cells + 2, sizeof *c->start);
    c->points = orl_array(log, points, sizeof *c->points);
    c->sorted = orl_array(log, points, sizeof *c->sorted);
    return c->start && c->points && c->sorted ? ORL_OK : ORL_ERR_MEMORY;
}

static void cells_finish(struct cells *c)
{
    free(c->start);
    free(c->points);
    free(c->sorted);
}

// Finds the cell of every point. The cells are as large as the density of the points asks for.
static void project(const struct orl_points *points, const struct orl_view *view, struct cells *c)
{
    const struct orl_camera *camera = &view->camera;
    size_t inside_count = 0;
    for (size_t i = 0; i < points->count; i++) {
        double pixel[2] = {0, 0}, z = 0;
        bool inside = orl_point_project(view, points->position[i], pixel, &z);
        c->points[i] = (struct seen){.at = {(float)pixel[0], (float)pixel[1], (float)z}, .point = (uint32_t)i,
                                     .cell = inside ? 0 : -1}; // until the size of a cell is known
        inside_count += inside;
    }
    double pixels = (double)camera->width * camera->height;
    c->side_px = fmax(cell_min_px, sqrt(PER_CELL * pixels / (double)(inside_count ? inside_count : 1)));
    c->columns = (int)(camera->width / c->side_px) + 1;
    c->rows = (int)(camera->height / c->side_px) + 1;
    for (size_t i = 0; i < points->count; i++) {
        struct seen *seen = &c->points[i];
        if (seen->cell >= 0)
            seen->cell = (int)((double)seen->at[1] / c->side_px) * c->columns +
                         (int)((double)seen->at[0] / c->side_px);
    }
}

// Sorts the points by cell (counting sort).
static void sort(size_t points, struct cells *c)
{
    size_t count = (size_t)c->columns * (size_t)c->rows;
    memset(c->start, 0, (count + 2) * sizeof *c->start);
    for (size_t i = 0; i < points; i++)
        if (c->points[i].cell >= 0)
            c->start[c->points[i].cell + 2]++;
    for (size_t k = 2; k < count + 2; k++)
        c->start[k] += c->start[k - 1];
    for (size_t i = 0; i < points; i++)
        if (c->points[i].cell >= 0)
            c->sorted[c->start[c->points[i].cell + 1]++] = c->points[i];
}

// Counts the points around a point in the picture that are as near as it is, without itself, and
// those behind it on each side.
static void count_around(const struct cells *c, const struct seen *seen, double tolerance, size_t *near,
                         size_t far[SIDES])
{
    int column = seen->cell % c->columns, row = seen->cell / c->columns;
    const float *at = seen->at;
    float low = at[2] * (float)(1 - tolerance), high = at[2] * (float)(1 + tolerance);
    *near = 0;
    memset(far, 0, SIDES * sizeof *far);
    for (int y = row > 0 ? row - 1 : 0; y <= row + 1 && y < c->rows; y++) {
        for (int x = column > 0 ? column - 1 : 0; x <= column + 1 && x < c->columns; x++) {
            const uint32_t *cell = &c->start[y * c->columns + x];
            const uint32_t step = (cell[1] - cell[0]) / VISITED_MAX + 1;
            for (uint32_t k = cell[0]; k < cell[1]; k += step) {
                const float *other = c->sorted[k].at;
                far[2 * (other[1] > at[1]) + (other[0] > at[0])] += other[2] > high ? step : 0;
                *near += other[2] >= low && other[2] <= high ? step - (c->sorted[k].point == seen->point) : 0;
            }
        }
    }
}

static enum orl_result vote(const struct orl_progress *progress, const struct cells *c,
                            size_t points, double focal_px, uint8_t *through, uint8_t *confirm)
{
    double tolerance = fmax(same_depth, same_cells * c->side_px / focal_px);
    for (size_t i = 0; i < points; i++) {
        if (i % CHUNK == 0 && orl_progress_cancelled(progress))
            return ORL_ERR_CANCELLED;
        size_t near, far[SIDES], all = 0;
        bool around = true;
        if (c->points[i].cell < 0)
            continue;
        count_around(c, &c->points[i], tolerance, &near, far);
        for (int k = 0; k < SIDES; k++) {
            all += far[k];
            around = around && far[k] >= FAR_MIN;
        }
        through[i] += around && (double)near <= through_share * (double)all;
        confirm[i] += near > 0 && (double)near >= confirm_share * (double)all;
    }
    return ORL_OK;
}

enum orl_result orl_points_drop_in_free_space(const struct orl_log *log,
                                              const struct orl_progress *progress,
                                              const struct orl_view *views, size_t view_count,
                                              struct orl_points *points)
{
    size_t voters = view_count < VIEWS_MAX ? view_count : VIEWS_MAX, cells = 0, kept = 0;
    if (!points->count || voters < THROUGH_MIN)
        return ORL_OK;
    if (points->count > UINT32_MAX)
        return orl_fail(log, ORL_ERR_UNSUPPORTED, "%zu points are too many", points->count);
    for (size_t v = 0; v < view_count; v++) {
        size_t most = ((size_t)(views[v].camera.width / cell_min_px) + 1) *
                      ((size_t)(views[v].camera.height / cell_min_px) + 1);
        cells = most > cells ? most : cells;
    }
    struct cells c = {0};
    uint8_t *through = orl_array(log, points->count, 1);
    uint8_t *confirm = orl_array(log, points->count, 1);
    enum orl_result result = cells_init(log, points->count, cells, &c);
    if (!through || !confirm)
        result = ORL_ERR_MEMORY;
    for (size_t v = 0; result == ORL_OK && v < voters; v++) {
        const struct orl_view *view = &views[v * view_count / voters];
        project(points, view, &c);
        sort(points->count, &c);
        result = vote(progress, &c, points->count, view->camera.fx, through, confirm);
    }
    for (size_t i = 0; result == ORL_OK && i < points->count; i++)
        if (through[i] < THROUGH_MIN || through[i] < CONFIRM_SHARE * confirm[i] ||
            points->photographs[i])
            orl_points_copy(points, i, points, kept++);
    if (result == ORL_OK && kept < points->count)
        orl_logf(log, ORL_LOG_INFO, "%zu of %zu points are in mid-air: dropped",
                 points->count - kept, points->count);
    if (result == ORL_OK)
        points->count = kept;
    cells_finish(&c);
    free(through);
    free(confirm);
    return result;
}
