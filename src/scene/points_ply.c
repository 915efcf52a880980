// Reading points from PLY: one point per vertex. Files of 3D and 2D Gaussian splatting (Kerbl et al.
// 2023, "3D Gaussian splatting for real-time radiance field rendering"; Huang et al. 2024) are read
// as opaque discs.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "oriel/points.h"
#include "scene/ply.h"
#include "scene/point_stream.h"

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
        static const char *const other[][3] = {{"diffuse_red", "diffuse_green", "diffuse_blue"}, {"r", "g", "b"}};
        for (size_t i = 0; i < ORL_COUNT(other) && property[role] < 0 && role >= RED && role <= BLUE; i++)
            property[role] = orl_ply_property_index(vertex, other[i][role - RED]);
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
    for (int role = DC_RED; role <= SCALE_Y; role++) // discs have no third scale
        if (property[role] < 0)
            return false;
    return property[RED] < 0;
}

// Takes a Gaussian as a disc: the colour that the zeroth spherical harmonic gives, and the standard
// deviation of its two longer axes as the radius, unless the file has a radius (oriel export). False:
// it is more transparent than opaque.
static bool take_gaussian(double values[ROLE_COUNT], bool has_radius)
{
    double shortest = fmin(values[SCALE_X], fmin(values[SCALE_Y], values[SCALE_Z]));
    for (int k = 0; k < 3; k++)
        values[RED + k] = 255 * (0.5 + ORL_HARMONIC_0 * values[DC_RED + k]);
    // Scales are logarithms, and the opacity is a logit.
    if (!has_radius)
        values[RADIUS] = exp((values[SCALE_X] + values[SCALE_Y] + values[SCALE_Z] - shortest) / 2);
    return values[OPACITY] >= 0;
}

// Stores a point at index i. False when the point must be dropped.
static bool set_point(struct orl_points *points, size_t i, const double values[ROLE_COUNT],
                      const double origin[3], size_t *bad_radii)
{
    for (int k = 0; k < 3; k++) {
        points->position[i][k] = (float)(values[X + k] - origin[k]);
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

// Programs that convert from LAS store 16 bits, or 8 bits in properties of 16, and others floats of either
// range, so the file's greatest value decides what white is, unless there is no doubt.
static bool is_white_known(const struct orl_ply_element *vertex, const int property[ROLE_COUNT])
{
    return property[RED] < 0 || vertex->properties[property[RED]].type == ORL_PLY_UINT8;
}

// Raises *greatest to the greatest colour of the next records.
static enum orl_result find_greatest(struct orl_ply *ply, const struct orl_ply_element *vertex,
                                     const int property[ROLE_COUNT], double *greatest)
{
    double record[ORL_PLY_PROPERTIES_MAX];
    for (uint64_t i = 0; i < vertex->count; i++) {
        ORL_TRY(orl_ply_record(ply, vertex, record, -1, NULL));
        for (int role = RED; role <= BLUE; role++)
            if (property[role] >= 0 && isfinite(record[property[role]]))
                *greatest = fmax(*greatest, record[property[role]]);
    }
    return ORL_OK;
}

// The factor that brings colours to 255 at white.
static double scale_of(const struct orl_ply_element *vertex, const int property[ROLE_COUNT], double greatest)
{
    // Floats may exceed white.
    bool unit = orl_ply_is_float(vertex, property[RED]) && greatest < 16;
    return unit ? 255 : greatest > 255 ? 255.0 / 65535 : 1;
}

// Leaves the reader where it was.
static enum orl_result find_color_scale(struct orl_ply *ply, const struct orl_ply_element *vertex,
                                        const int property[ROLE_COUNT], double *scale)
{
    double greatest = 0;
    const size_t start = ply->at;
    *scale = 1;
    if (is_white_known(vertex, property))
        return ORL_OK;
    ORL_TRY(find_greatest(ply, vertex, property, &greatest));
    ply->at = start;
    *scale = scale_of(vertex, property, greatest);
    return ORL_OK;
}

// color_scale: see scale_of.
static enum orl_result read_points(struct orl_ply *ply, const struct orl_ply_element *vertex,
                                   const int property[ROLE_COUNT], const double origin[3],
                                   double color_scale, struct orl_points *points)
{
    size_t kept = 0, bad_radii = 0, transparent = 0;
    bool gaussian = is_gaussian(property);
    double record[ORL_PLY_PROPERTIES_MAX];
    // Points without colours are mid-grey, and discs are thin: their third scale is a logarithm.
    double values[ROLE_COUNT] = {[RED] = 128, [GREEN] = 128, [BLUE] = 128, [SCALE_Z] = -1000};
    enum orl_result result = ORL_OK;
    for (uint64_t i = 0; i < vertex->count && result == ORL_OK; i++) {
        result = orl_ply_record(ply, vertex, record, -1, NULL);
        for (int role = 0; result == ORL_OK && role < ROLE_COUNT; role++) {
            if (property[role] < 0)
                continue;
            bool color = role >= RED && role <= BLUE;
            values[role] = record[property[role]] * (color ? color_scale : 1);
        }
        if (result == ORL_OK && gaussian && !take_gaussian(values, property[RADIUS] >= 0))
            transparent++;
        else if (result == ORL_OK && set_point(points, kept, values, origin, &bad_radii))
            kept++;
    }
    ORL_TRY(result);
    if (kept && !gaussian && property[RED] < 0)
        orl_logf(ply->log, ORL_LOG_INFO, "%s: no colours (red, green, blue): its points are grey", ply->path);
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

// Finds the property of each role.
static enum orl_result find_vertices(struct orl_ply *ply, const struct orl_ply_element *vertex,
                                     int property[ROLE_COUNT])
{
    find_roles(vertex, property);
    for (int role = 0; role < ROLE_COUNT; role++)
        if (property[role] >= 0 && vertex->properties[property[role]].list)
            return orl_ply_bad(ply, "lists are not supported where a point needs a number");
    if (property[X] < 0 || property[Y] < 0 || property[Z] < 0)
        return orl_ply_bad(ply, "the vertices lack x, y or z");
    return ORL_OK;
}

static const double nowhere[3]; // the origin that files have unless told otherwise

enum orl_result orl_points_read(const struct orl_log *log, const char *path, const double *origin,
                                struct orl_points *points)
{
    origin = origin ? origin : nowhere;
    memset(points, 0, sizeof *points);
    struct orl_ply ply;
    const struct orl_ply_element *vertex = NULL;
    int property[ROLE_COUNT];
    ORL_TRY(orl_ply_open(log, path, &ply));
    enum orl_result result = orl_ply_seek(&ply, "vertex", "no vertices", &vertex);
    ORL_THEN(result, find_vertices(&ply, vertex, property));
    if (result == ORL_OK && memcmp(origin, nowhere, sizeof nowhere) != 0 &&
        vertex->properties[property[X]].type == ORL_PLY_FLOAT32)
        orl_logf(log, ORL_LOG_WARNING, "%s: its coordinates are 32-bit floats, which are too coarse so far "
                 "from 0: write doubles", path);
    ORL_THEN(result, orl_points_init(log, points, (size_t)vertex->count));
    double color_scale;
    ORL_THEN(result, find_color_scale(&ply, vertex, property, &color_scale));
    ORL_THEN(result, read_points(&ply, vertex, property, origin, color_scale, points));
    if (result != ORL_OK)
        orl_points_finish(points);
    orl_ply_close(&ply);
    return result;
}

// --- a part at a time ---

struct orl_point_stream {
    struct orl_ply ply; // its data: the records of one part
    FILE *file;
    size_t records_at;  // offset of the first record
    size_t capacity;    // of ply.data, in bytes
    uint64_t next;      // record
    int property[ROLE_COUNT];
    double color_scale; // see scale_of
};

// The file must hold all the records that its header claims.
static enum orl_result check_length(struct orl_point_stream *s)
{
    const struct orl_ply_element *vertex = &s->ply.elements[0];
    off_t end = fseeko(s->file, 0, SEEK_END) == 0 ? ftello(s->file) : -1;
    if (end < 0)
        return orl_file_failed(s->ply.log, s->ply.path);
    if (vertex->count > ((uint64_t)end - s->records_at) / vertex->least)
        return orl_ply_bad(&s->ply, "the file ends ahead of the last vertex");
    return orl_point_stream_seek(s, 0);
}

// Loads the next `most` records, or as many as are left. *part: the vertices, with their number as the count.
static enum orl_result load_part(struct orl_point_stream *s, size_t most, struct orl_ply_element *part)
{
    *part = s->ply.elements[0];
    uint64_t left = s->next < part->count ? part->count - s->next : 0;
    part->count = left < most ? left : most;
    size_t bytes = (size_t)part->count * part->least;
    ORL_TRY(orl_grow(s->ply.log, (void **)&s->ply.data, &s->capacity, bytes, 1));
    if (fread(s->ply.data, 1, bytes, s->file) != bytes)
        return orl_fail(s->ply.log, ORL_ERR_IO, "%s: cannot read record %llu", s->ply.path,
                        (unsigned long long)s->next);
    s->ply.size = bytes;
    s->ply.at = 0;
    s->next += part->count;
    return ORL_OK;
}

// Takes a pass over the whole file where the type of the colours leaves open what white is.
static enum orl_result find_stream_scale(struct orl_point_stream *s)
{
    enum { AT_ONCE = 1 << 16 };
    struct orl_ply_element part = s->ply.elements[0];
    double greatest = 0;
    s->color_scale = 1;
    if (is_white_known(&part, s->property))
        return ORL_OK;
    do {
        ORL_TRY(load_part(s, AT_ONCE, &part));
        ORL_TRY(find_greatest(&s->ply, &part, s->property, &greatest));
    } while (part.count);
    s->color_scale = scale_of(&part, s->property, greatest);
    return orl_point_stream_seek(s, 0);
}

enum orl_result orl_point_stream_open(const struct orl_log *log, const char *path,
                                      struct orl_point_stream **out, uint64_t *total)
{
    struct orl_point_stream *s = *out = orl_array(log, 1, sizeof *s);
    ORL_TRY_MEMORY(s);
    enum orl_result result = orl_ply_open_header(log, path, &s->ply, &s->file);
    if (result == ORL_OK && (s->ply.ascii || !s->ply.element_count || s->ply.elements[0].lists ||
                             strcmp(s->ply.elements[0].name, "vertex") != 0))
        result = orl_fail(log, ORL_ERR_UNSUPPORTED, "%s: only a binary PLY whose vertices come "
                          "first and have no lists can be read a part at a time", path);
    ORL_THEN(result, find_vertices(&s->ply, &s->ply.elements[0], s->property));
    if (result == ORL_OK) {
        s->records_at = s->ply.at;
        *total = s->ply.elements[0].count;
        result = check_length(s);
    }
    ORL_THEN(result, find_stream_scale(s));
    if (result != ORL_OK)
        orl_point_stream_close(out);
    return result;
}

void orl_point_stream_close(struct orl_point_stream **stream)
{
    struct orl_point_stream *s = *stream;
    if (s && s->file)
        fclose(s->file);
    if (s)
        orl_ply_close(&s->ply);
    free(s);
    *stream = NULL;
}

enum orl_result orl_point_stream_seek(struct orl_point_stream *s, uint64_t record)
{
    off_t at = (off_t)(s->records_at + record * s->ply.elements[0].least);
    s->next = record;
    return fseeko(s->file, at, SEEK_SET) == 0 ? ORL_OK : orl_file_failed(s->ply.log, s->ply.path);
}

enum orl_result orl_point_stream_next(struct orl_point_stream *s, size_t most,
                                      struct orl_points *points, size_t *read)
{
    struct orl_ply_element part;
    *read = 0;
    ORL_TRY(load_part(s, most, &part));
    *read = (size_t)part.count;
    return read_points(&s->ply, &part, s->property, nowhere, s->color_scale, points);
}
