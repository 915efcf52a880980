// Reading points from PLY: one point per vertex. Files of 3D Gaussian splatting (Kerbl et al. 2023,
// "3D Gaussian splatting for real-time radiance field rendering") are read as opaque discs.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "scene/ply.h"
#include "oriel/points.h"

// The meaning of a property.
enum role {
    X, Y, Z, NX, NY, NZ, RED, GREEN, BLUE, RADIUS, PHOTOGRAPHS,
    DC_RED, DC_GREEN, DC_BLUE, OPACITY, SCALE_X, SCALE_Y, SCALE_Z, ROLE_COUNT
};
static const char *const roles[ROLE_COUNT] = {"x", "y", "z", "nx", "ny", "nz",
                                              "red", "green", "blue", "radius", "photographs",
                                              "f_dc_0", "f_dc_1", "f_dc_2", "opacity",
                                              "scale_0", "scale_1", "scale_2"};

// Sets the index of the property of each role; -1: none.
static void find_roles(const struct orl_ply_element *vertex, int property[ROLE_COUNT])
{
    for (int role = 0; role < ROLE_COUNT; role++) {
        property[role] = orl_ply_property_index(vertex, roles[role]);
        if (property[role] < 0 && role >= RED && role <= BLUE) {
            static const char *const other[] = {"diffuse_red", "diffuse_green", "diffuse_blue"};
            property[role] = orl_ply_property_index(vertex, other[role - RED]);
        }
    }
}

static void set_normal(const double values[3], float normal[3])
{
    double length = sqrt(values[0] * values[0] + values[1] * values[1] + values[2] * values[2]);
    for (int i = 0; i < 3; i++)
        normal[i] = length > 1e-12 && isfinite(length) ? (float)(values[i] / length) : 0;
}

static bool is_gaussian(const int property[ROLE_COUNT])
{
    for (int role = DC_RED; role <= SCALE_Z; role++)
        if (property[role] < 0)
            return false;
    return property[RED] < 0 && property[RADIUS] < 0;
}

// Takes a Gaussian as a disc: the colour that the zeroth spherical harmonic gives, and the standard
// deviation of its two longer axes as the radius. False: it is more transparent than opaque.
static bool take_gaussian(double values[ROLE_COUNT])
{
    static const double harmonic = 0.28209479177387814; // 1 / (2 sqrt(pi))
    double shortest = fmin(values[SCALE_X], fmin(values[SCALE_Y], values[SCALE_Z]));
    for (int k = 0; k < 3; k++)
        values[RED + k] = 255 * (0.5 + harmonic * values[DC_RED + k]);
    // Scales are logarithms, and the opacity is a logit.
    values[RADIUS] = exp((values[SCALE_X] + values[SCALE_Y] + values[SCALE_Z] - shortest) / 2);
    return values[OPACITY] >= 0;
}

// Stores a point at index i. False when the point must be dropped.
static bool set_point(struct orl_points *points, size_t i, const double values[ROLE_COUNT],
                      size_t *bad_radii)
{
    for (int k = 0; k < 3; k++) {
        points->position[i][k] = (float)values[X + k];
        double c = values[RED + k];
        points->color[i][k] = (uint8_t)(c >= 255 ? 255 : c > 0 ? c + 0.5 : 0);
    }
    if (!orl_point_usable(points->position[i]))
        return false;
    set_normal(&values[NX], points->normal[i]);
    float radius = (float)values[RADIUS];
    bool usable = isfinite(radius) && radius >= 0;
    points->radius[i] = usable ? radius : 0;
    *bad_radii += !usable;
    double seen = values[PHOTOGRAPHS];
    points->photographs[i] = (uint8_t)(seen >= 255 ? 255 : seen > 0 ? seen : 0);
    return true;
}

static enum orl_result read_points(struct orl_ply *ply, const struct orl_ply_element *vertex,
                                   const int property[ROLE_COUNT], struct orl_points *points)
{
    size_t kept = 0, bad_radii = 0, transparent = 0;
    bool gaussian = is_gaussian(property);
    double record[ORL_PLY_PROPERTIES_MAX];
    // Points without colours are mid-grey.
    double values[ROLE_COUNT] = {[RED] = 128, [GREEN] = 128, [BLUE] = 128};
    enum orl_result result = ORL_OK;
    for (uint64_t i = 0; i < vertex->count && result == ORL_OK; i++) {
        result = orl_ply_record(ply, vertex, record, -1, NULL);
        for (int role = 0; result == ORL_OK && role < ROLE_COUNT; role++) {
            if (property[role] < 0)
                continue;
            bool unit = role >= RED && role <= BLUE && orl_ply_is_float(vertex, property[role]);
            values[role] = record[property[role]] * (unit ? 255 : 1);
        }
        if (result == ORL_OK && gaussian && !take_gaussian(values))
            transparent++;
        else if (result == ORL_OK && set_point(points, kept, values, &bad_radii))
            kept++;
    }
    if (result != ORL_OK)
        return result;
    if (transparent)
        orl_logf(ply->log, ORL_LOG_INFO, "%s: %zu of %zu Gaussians are transparent: dropped",
                 ply->path, transparent, (size_t)vertex->count);
    if (kept + transparent < vertex->count)
        orl_logf(ply->log, ORL_LOG_WARNING, "%s: %zu of %zu points are not finite or absurdly far: "
                 "dropped", ply->path, (size_t)vertex->count - transparent - kept,
                 (size_t)vertex->count);
    if (bad_radii)
        orl_logf(ply->log, ORL_LOG_WARNING,
                 "%s: %zu radii are negative or not finite: taken as unknown", ply->path,
                 bad_radii);
    points->count = kept;
    return ORL_OK;
}

enum orl_result orl_points_read(const struct orl_log *log, const char *path,
                                struct orl_points *points)
{
    memset(points, 0, sizeof *points);
    struct orl_ply ply;
    const struct orl_ply_element *vertex = NULL;
    int property[ROLE_COUNT];
    enum orl_result result = orl_ply_open(log, path, &ply);
    if (result != ORL_OK)
        return result;
    result = orl_ply_seek(&ply, "vertex", "no vertices", &vertex);
    if (result == ORL_OK && vertex->lists)
        result = orl_ply_bad(&ply, "vertices with lists are not supported");
    if (result != ORL_OK)
        goto end;
    find_roles(vertex, property);
    if (property[X] < 0 || property[Y] < 0 || property[Z] < 0)
        result = orl_ply_bad(&ply, "the vertices lack x, y or z");
    if (result == ORL_OK)
        result = orl_points_init(log, points, (size_t)vertex->count);
    if (result == ORL_OK)
        result = read_points(&ply, vertex, property, points);
    if (result != ORL_OK)
        orl_points_finish(points);
end:
    orl_ply_close(&ply);
    return result;
}
