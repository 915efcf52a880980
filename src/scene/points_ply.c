// Reading PLY (Turk 1994): ascii or binary little endian, one point per vertex.
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "scene/points.h"

enum scalar { INT8, UINT8, INT16, UINT16, INT32, UINT32, FLOAT32, FLOAT64, SCALAR_COUNT };
static const struct {
    const char *name, *alias;
    size_t size;
} scalars[SCALAR_COUNT] = {
    [INT8] = {"char", "int8", 1},       [UINT8] = {"uchar", "uint8", 1},
    [INT16] = {"short", "int16", 2},    [UINT16] = {"ushort", "uint16", 2},
    [INT32] = {"int", "int32", 4},      [UINT32] = {"uint", "uint32", 4},
    [FLOAT32] = {"float", "float32", 4}, [FLOAT64] = {"double", "float64", 8},
};

// What a property is to us.
enum role {
    X, Y, Z, NX, NY, NZ, RED, GREEN, BLUE, RADIUS, PHOTOGRAPHS, ROLE_COUNT, OTHER = ROLE_COUNT
};
static const char *const roles[ROLE_COUNT] = {"x", "y", "z", "nx", "ny", "nz",
                                              "red", "green", "blue", "radius", "photographs"};

enum { PROPERTIES_MAX = 256, HEADER_LINE_MAX = 1024 };

struct ply {
    const struct orl_log *log;
    const char *path;
    const uint8_t *data;
    size_t size, at; // at: next byte to read
    bool ascii;
    uint64_t count;
    size_t before;   // bytes (binary) or lines (ascii) of elements ahead of the vertices
    int property_count;
    struct {
        enum scalar type;
        enum role role;
        size_t offset; // in a binary record
    } properties[PROPERTIES_MAX];
    bool has[ROLE_COUNT];
    size_t stride;
};

static enum orl_result bad(const struct ply *ply, const char *what)
{
    return orl_fail(ply->log, ORL_ERR_FORMAT, "%s: byte %zu: %s", ply->path, ply->at, what);
}

static enum scalar scalar_by_name(const char *name)
{
    int i = 0;
    while (i < SCALAR_COUNT && strcmp(name, scalars[i].name) != 0 &&
           strcmp(name, scalars[i].alias) != 0)
        i++;
    return (enum scalar)i;
}

static enum role role_by_name(const char *name)
{
    if (strncmp(name, "diffuse_", 8) == 0)
        name += 8;
    int i = 0;
    while (i < ROLE_COUNT && strcmp(name, roles[i]) != 0)
        i++;
    return (enum role)i;
}

// Copies the next header line; ply->at stays at its start. False when it does not end.
static bool header_line(const struct ply *ply, char line[HEADER_LINE_MAX], size_t *length)
{
    size_t room = ply->size - ply->at;
    const uint8_t *end = memchr(ply->data + ply->at, '\n', room < HEADER_LINE_MAX
                                                               ? room : HEADER_LINE_MAX - 1);
    if (!end)
        return false;
    *length = (size_t)(end - (ply->data + ply->at)) + 1;
    size_t used = *length - 1;
    memcpy(line, ply->data + ply->at, used);
    while (used && (line[used - 1] == '\r' || line[used - 1] == ' '))
        used--;
    line[used] = '\0';
    return true;
}

static enum orl_result add_property(struct ply *ply, const char *line)
{
    char type[32], name[64];
    if (sscanf(line, "property %31s %63s", type, name) != 2)
        return bad(ply, "a property needs a type and a name");
    enum scalar scalar = scalar_by_name(type);
    if (scalar == SCALAR_COUNT)
        return bad(ply, strcmp(type, "list") == 0 ? "vertices with lists are not supported"
                                                  : "unknown type of a property");
    if (ply->property_count == PROPERTIES_MAX)
        return bad(ply, "too many properties");
    enum role role = role_by_name(name);
    if (role != OTHER && ply->has[role])
        return bad(ply, "a property is given twice");
    if (role != OTHER)
        ply->has[role] = true;
    ply->properties[ply->property_count].type = scalar;
    ply->properties[ply->property_count].role = role;
    ply->properties[ply->property_count++].offset = ply->stride;
    ply->stride += scalars[scalar].size;
    return ORL_OK;
}

// An element ahead of the vertices is skipped, so its size must be known.
struct skipped {
    uint64_t count;
    size_t stride;
};

static enum orl_result end_skipped(struct ply *ply, struct skipped *skipped)
{
    size_t unit = ply->ascii ? 1 : skipped->stride;
    if (unit && skipped->count > (ply->size - ply->before) / unit)
        return bad(ply, "an element is larger than the file");
    ply->before += unit * (size_t)skipped->count;
    *skipped = (struct skipped){0};
    return ORL_OK;
}

static enum orl_result skip_property(struct ply *ply, const char *line, struct skipped *skipped)
{
    char type[32];
    enum scalar scalar =
        sscanf(line, "property %31s", type) == 1 ? scalar_by_name(type) : SCALAR_COUNT;
    if (scalar == SCALAR_COUNT && !ply->ascii)
        return bad(ply, "lists ahead of the vertices are not supported");
    skipped->stride += scalar == SCALAR_COUNT ? 0 : scalars[scalar].size;
    return ORL_OK;
}

static enum orl_result parse_format(struct ply *ply, const char *line)
{
    if (strcmp(line, "format ascii 1.0") == 0)
        ply->ascii = true;
    else if (strcmp(line, "format binary_little_endian 1.0") != 0)
        return bad(ply, "the format is neither ascii 1.0 nor binary_little_endian 1.0");
    return ORL_OK;
}

// Where the header stands: ahead of the vertices, in them, or past them.
enum part { BEFORE, VERTEX, AFTER };

static enum orl_result parse_element(struct ply *ply, const char *line, enum part *part,
                                     struct skipped *skipped)
{
    char name[64];
    unsigned long long count;
    if (strchr(line, '-') || sscanf(line, "element %63s %llu", name, &count) != 2)
        return bad(ply, "an element needs a name and a count");
    enum orl_result result = *part == BEFORE ? end_skipped(ply, skipped) : ORL_OK;
    if (strcmp(name, "vertex") == 0 && *part == BEFORE) {
        *part = VERTEX;
        ply->count = count;
    } else if (*part == BEFORE) {
        skipped->count = count;
    } else {
        *part = AFTER;
    }
    return result;
}

static enum orl_result parse_header(struct ply *ply)
{
    char line[HEADER_LINE_MAX];
    size_t length;
    enum part part = BEFORE;
    struct skipped skipped = {0};
    enum orl_result result = ORL_OK;
    if (ply->size < 4 || memcmp(ply->data, "ply", 3) != 0)
        return bad(ply, "not a PLY file");
    bool have_format = false, ended = false;
    for (int number = 0; result == ORL_OK && !ended; number++, ply->at += length) {
        if (!header_line(ply, line, &length))
            return bad(ply, "the header does not end");
        if (strncmp(line, "format ", 7) == 0) {
            result = parse_format(ply, line);
            have_format = true;
        } else if (strncmp(line, "element ", 8) == 0) {
            result = have_format ? parse_element(ply, line, &part, &skipped)
                                 : bad(ply, "an element ahead of the format");
        } else if (strncmp(line, "property ", 9) == 0) {
            result = part == VERTEX  ? add_property(ply, line)
                     : part == BEFORE ? skip_property(ply, line, &skipped)
                                      : ORL_OK;
        } else if (strcmp(line, "end_header") == 0) {
            ended = true;
        } else if (number > 0 && strncmp(line, "comment", 7) != 0 &&
                   strncmp(line, "obj_info", 8) != 0) {
            result = bad(ply, "unknown line in the header");
        }
        if (result != ORL_OK)
            return result;
    }
    if (part == BEFORE)
        return bad(ply, "no vertices");
    if (!ply->has[X] || !ply->has[Y] || !ply->has[Z])
        return bad(ply, "the vertices lack x, y or z");
    return ORL_OK;
}

// The header's claims against the file's size, before anything is allocated.
static enum orl_result check_size(struct ply *ply)
{
    size_t left = ply->size - ply->at;
    size_t record = ply->ascii ? 2 * (size_t)ply->property_count : ply->stride;
    size_t before = ply->ascii ? 0 : ply->before;
    // The last line of an ascii file may lack its newline.
    if (before > left || ply->count > (left - before + ply->ascii) / record)
        return orl_fail(ply->log, ORL_ERR_FORMAT,
                        "%s: byte %zu: the header claims %llu points of %zu bytes or more, "
                        "but only %zu bytes follow", ply->path, ply->at,
                        (unsigned long long)ply->count, record, left);
    ply->at += before;
    return ORL_OK;
}

static double binary_value(const uint8_t *at, enum scalar type)
{
    union {
        int8_t i8; uint8_t u8; int16_t i16; uint16_t u16;
        int32_t i32; uint32_t u32; float f32; double f64;
    } v;
    memcpy(&v, at, scalars[type].size);
    switch (type) {
    case INT8: return v.i8;
    case UINT8: return v.u8;
    case INT16: return v.i16;
    case UINT16: return v.u16;
    case INT32: return v.i32;
    case UINT32: return v.u32;
    case FLOAT32: return v.f32;
    default: return v.f64;
    }
}

// Fills values[role]; `OTHER` goes to the last slot.
static enum orl_result read_record(struct ply *ply, double values[ROLE_COUNT + 1])
{
    for (int i = 0; i < ply->property_count; i++) {
        enum scalar type = ply->properties[i].type;
        enum role role = ply->properties[i].role;
        if (ply->ascii) {
            const char *text = (const char *)ply->data + ply->at;
            char *end;
            values[role] = strtod(text, &end); // the data end with a zero byte
            if (end == text)
                return bad(ply, "a value of a vertex is missing or not a number");
            ply->at += (size_t)(end - text);
        } else {
            values[role] = binary_value(ply->data + ply->at + ply->properties[i].offset, type);
        }
        // Float colours run from 0 to 1.
        if (role >= RED && role <= BLUE && type >= FLOAT32)
            values[role] *= 255;
    }
    if (!ply->ascii)
        ply->at += ply->stride;
    return ORL_OK;
}

static void set_normal(const double values[3], float normal[3])
{
    double length = sqrt(values[0] * values[0] + values[1] * values[1] + values[2] * values[2]);
    for (int i = 0; i < 3; i++)
        normal[i] = length > 1e-12 && isfinite(length) ? (float)(values[i] / length) : 0;
}

// Stores a point at index i. False when it must be dropped.
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

static enum orl_result skip_ascii_lines(struct ply *ply)
{
    for (size_t i = 0; i < ply->before; i++) {
        const uint8_t *end = memchr(ply->data + ply->at, '\n', ply->size - ply->at);
        if (!end)
            return bad(ply, "the file ends ahead of the vertices");
        ply->at = (size_t)(end - ply->data) + 1;
    }
    return ORL_OK;
}

static enum orl_result read_points(struct ply *ply, struct orl_points *points)
{
    size_t kept = 0, bad_radii = 0;
    // Without colours a point is mid-grey.
    double values[ROLE_COUNT + 1] = {[RED] = 128, [GREEN] = 128, [BLUE] = 128};
    enum orl_result result = ply->ascii ? skip_ascii_lines(ply) : ORL_OK;
    for (uint64_t i = 0; i < ply->count && result == ORL_OK; i++) {
        result = read_record(ply, values);
        if (result == ORL_OK && set_point(points, kept, values, &bad_radii))
            kept++;
    }
    if (result != ORL_OK)
        return result;
    if (kept < ply->count)
        orl_logf(ply->log, ORL_LOG_WARNING, "%s: %zu of %zu points are not finite or absurdly far: "
                 "dropped", ply->path, (size_t)ply->count - kept, (size_t)ply->count);
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
    uint8_t *data = NULL;
    struct ply *ply = orl_array(log, 1, sizeof *ply);
    if (!ply)
        return ORL_ERR_MEMORY;
    *ply = (struct ply){.log = log, .path = path};
    enum orl_result result = orl_file_read(log, path, SIZE_MAX / 2, &data, &ply->size);
    if (result != ORL_OK)
        goto end;
    ply->data = data;
    if ((result = parse_header(ply)) != ORL_OK || (result = check_size(ply)) != ORL_OK ||
        (result = orl_points_init(log, points, (size_t)ply->count)) != ORL_OK)
        goto end;
    result = read_points(ply, points);
    if (result != ORL_OK)
        orl_points_finish(points);
end:
    free(data);
    free(ply);
    return result;
}
