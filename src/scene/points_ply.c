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

struct orl_point_stream {
    struct orl_ply ply; // its data: the whole file, or the records of one part
    FILE *file;         // that parts are read from; NULL: the whole file has been read
    const struct orl_ply_element *vertex;
    size_t records_at;  // offset of the first record
    size_t capacity;    // of ply.data, in bytes
    uint64_t next;      // record
    int property[ROLE_COUNT];
    double color_scale; // brings colours to 255 at white
};

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

// Finds the next `most` records, or as many as are left, and reads them from the file. *part: the vertices, with their
// number as the count.
static enum orl_result take_part(struct orl_point_stream *s, size_t most, struct orl_ply_element *part)
{
    *part = *s->vertex;
    uint64_t left = s->next < part->count ? part->count - s->next : 0;
    part->count = left < most ? left : most;
    size_t bytes = s->file ? (size_t)part->count * part->least : 0;
    if (s->file) {
        ORL_TRY(orl_grow(s->ply.log, (void **)&s->ply.data, &s->capacity, bytes, 1));
        s->ply.size = fread(s->ply.data, 1, bytes, s->file);
        s->ply.at = 0;
        if (s->ply.size != bytes)
            return orl_fail(s->ply.log, ORL_ERR_IO, "%s: cannot read record %llu", s->ply.path,
                            (unsigned long long)s->next);
    }
    s->next += part->count;
    return ORL_OK;
}

enum orl_result orl_point_stream_seek(struct orl_point_stream *s, uint64_t record)
{
    size_t at = s->records_at + (size_t)record * s->vertex->least;
    s->next = record;
    if (!s->file)
        s->ply.at = at;
    return !s->file || fseeko(s->file, (off_t)at, SEEK_SET) == 0 ? ORL_OK : orl_file_failed(s->ply.log, s->ply.path);
}

// Finds the factor that brings colours to 255 at white. Programs that convert from LAS store 16 bits, or 8 bits in
// properties of 16, and others floats of either range, so the file's greatest value decides what white is, unless there
// is no doubt: that takes a pass over all records.
static enum orl_result find_color_scale(struct orl_point_stream *s)
{
    enum { AT_ONCE = 1 << 16 };
    struct orl_ply_element part;
    double greatest = 0, record[ORL_PLY_PROPERTIES_MAX];
    s->color_scale = 1;
    if (s->property[RED] < 0 || s->vertex->properties[s->property[RED]].type == ORL_PLY_UINT8)
        return ORL_OK;
    do {
        ORL_TRY(take_part(s, AT_ONCE, &part));
        for (uint64_t i = 0; i < part.count; i++) {
            ORL_TRY(orl_ply_record(&s->ply, &part, record, -1, NULL));
            for (int role = RED; role <= BLUE; role++)
                if (s->property[role] >= 0 && isfinite(record[s->property[role]]))
                    greatest = fmax(greatest, record[s->property[role]]);
        }
    } while (part.count);
    // Floats may exceed white.
    bool unit = s->vertex->properties[s->property[RED]].type >= ORL_PLY_FLOAT32 && greatest < 16;
    s->color_scale = unit ? 255 : greatest > 255 ? 255.0 / 65535 : 1;
    return orl_point_stream_seek(s, 0);
}

// Reads the next `most` records, or as many as are left; *read: how many.
static enum orl_result read_points(struct orl_point_stream *s, size_t most, const double origin[3],
                                   struct orl_points *points, size_t *read)
{
    size_t kept = 0, bad_radii = 0, transparent = 0;
    const int *property = s->property;
    const struct orl_ply *ply = &s->ply;
    struct orl_ply_element part;
    bool gaussian = is_gaussian(property);
    double record[ORL_PLY_PROPERTIES_MAX];
    // Points without colours are mid-grey, and discs are thin: their third scale is a logarithm.
    double values[ROLE_COUNT] = {[RED] = 128, [GREEN] = 128, [BLUE] = 128, [SCALE_Z] = -1000};
    ORL_TRY(take_part(s, most, &part));
    *read = (size_t)part.count;
    for (size_t i = 0; i < *read; i++) {
        ORL_TRY(orl_ply_record(&s->ply, &part, record, -1, NULL));
        for (int role = 0; role < ROLE_COUNT; role++) {
            bool color = role >= RED && role <= BLUE;
            if (property[role] >= 0)
                values[role] = record[property[role]] * (color ? s->color_scale : 1);
        }
        if (gaussian && !take_gaussian(values, property[RADIUS] >= 0))
            transparent++;
        else
            kept += set_point(points, kept, values, origin, &bad_radii);
    }
    if (kept && !gaussian && property[RED] < 0)
        orl_logf(ply->log, ORL_LOG_INFO, "%s: no colours (red, green, blue): its points are grey", ply->path);
    if (transparent)
        orl_logf(ply->log, ORL_LOG_INFO, "%s: %zu of %zu Gaussians are transparent: dropped",
                 ply->path, transparent, *read);
    if (kept + transparent < *read)
        orl_logf(ply->log, ORL_LOG_WARNING, "%s: %zu of %zu points are not finite or absurdly far: "
                 "dropped", ply->path, *read - transparent - kept, *read);
    if (bad_radii)
        orl_logf(ply->log, ORL_LOG_WARNING,
                 "%s: %zu radii are negative or not finite: taken as unknown", ply->path,
                 bad_radii);
    points->count = kept;
    return ORL_OK;
}

// Begins with the vertices, at whose first record the reader is: finds the property of each role.
static enum orl_result begin(struct orl_point_stream *s)
{
    s->records_at = s->ply.at;
    find_roles(s->vertex, s->property);
    for (int role = 0; role < ROLE_COUNT; role++)
        if (s->property[role] >= 0 && s->vertex->properties[s->property[role]].list)
            return orl_ply_bad(&s->ply, "lists are not supported where a point needs a number");
    if (s->property[X] < 0 || s->property[Y] < 0 || s->property[Z] < 0)
        return orl_ply_bad(&s->ply, "the vertices lack x, y or z");
    return ORL_OK;
}

static const double nowhere[3]; // the origin that files have unless told otherwise

enum orl_result orl_points_read(const struct orl_log *log, const char *path, const double *origin,
                                struct orl_points *points)
{
    origin = origin ? origin : nowhere;
    memset(points, 0, sizeof *points);
    struct orl_point_stream s = {0};
    size_t read;
    ORL_TRY(orl_ply_open(log, path, &s.ply));
    enum orl_result result = orl_ply_seek(&s.ply, "vertex", "no vertices", &s.vertex);
    ORL_THEN(result, begin(&s));
    if (result == ORL_OK && memcmp(origin, nowhere, sizeof nowhere) != 0 &&
        s.vertex->properties[s.property[X]].type == ORL_PLY_FLOAT32)
        orl_logf(log, ORL_LOG_WARNING, "%s: its coordinates are 32-bit floats, which are too coarse so far "
                 "from 0: write doubles", path);
    ORL_THEN(result, orl_points_init(log, points, (size_t)s.vertex->count));
    ORL_THEN(result, find_color_scale(&s));
    ORL_THEN(result, read_points(&s, SIZE_MAX, origin, points, &read));
    if (result != ORL_OK)
        orl_points_finish(points);
    orl_ply_close(&s.ply);
    return result;
}

// --- a part at a time ---

// The file must hold all the records that its header claims.
static enum orl_result check_length(struct orl_point_stream *s)
{
    off_t end = fseeko(s->file, 0, SEEK_END) == 0 ? ftello(s->file) : -1;
    if (end < 0)
        return orl_file_failed(s->ply.log, s->ply.path);
    if (s->vertex->count > ((uint64_t)end - s->records_at) / s->vertex->least)
        return orl_ply_bad(&s->ply, "the file ends ahead of the last vertex");
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
    s->vertex = &s->ply.elements[0];
    *total = s->vertex->count;
    ORL_THEN(result, begin(s));
    ORL_THEN(result, check_length(s));
    ORL_THEN(result, find_color_scale(s));
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

enum orl_result orl_point_stream_next(struct orl_point_stream *s, size_t most,
                                      struct orl_points *points, size_t *read)
{
    return read_points(s, most, nowhere, points, read);
}
