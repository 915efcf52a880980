#include "scene/ply.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"

static const struct {
    const char *name, *alias;
    size_t size;
} types[ORL_PLY_TYPE_COUNT] = {
    [ORL_PLY_INT8] = {"char", "int8", 1},        [ORL_PLY_UINT8] = {"uchar", "uint8", 1},
    [ORL_PLY_INT16] = {"short", "int16", 2},     [ORL_PLY_UINT16] = {"ushort", "uint16", 2},
    [ORL_PLY_INT32] = {"int", "int32", 4},       [ORL_PLY_UINT32] = {"uint", "uint32", 4},
    [ORL_PLY_FLOAT32] = {"float", "float32", 4}, [ORL_PLY_FLOAT64] = {"double", "float64", 8},
};

enum { HEADER_LINE_MAX = 1024 };

enum orl_result orl_ply_bad(const struct orl_ply *ply, const char *what)
{
    return orl_fail(ply->log, ORL_ERR_FORMAT, "%s: byte %zu: %s", ply->path, ply->at, what);
}

static enum orl_ply_type type_by_name(const char *name)
{
    int i = 0;
    while (i < ORL_PLY_TYPE_COUNT && strcmp(name, types[i].name) != 0 &&
           strcmp(name, types[i].alias) != 0)
        i++;
    return (enum orl_ply_type)i;
}

// --- the header ---

// Copies the next header line; ply->at stays at the start of the line. False when the line has no
// end.
static bool header_line(const struct orl_ply *ply, char line[HEADER_LINE_MAX], size_t *length)
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

static enum orl_result add_property(struct orl_ply *ply, const char *line)
{
    if (!ply->element_count)
        return orl_ply_bad(ply, "a property ahead of the elements");
    struct orl_ply_element *element = &ply->elements[ply->element_count - 1];
    struct orl_ply_property property = {0};
    char type[32], count_type[32];
    property.list = sscanf(line, "property list %31s %31s %63s", count_type, type,
                           property.name) == 3;
    if (!property.list && sscanf(line, "property %31s %63s", type, property.name) != 2)
        return orl_ply_bad(ply, "a property needs a type and a name");
    property.type = type_by_name(type);
    property.count_type = property.list ? type_by_name(count_type) : ORL_PLY_UINT8;
    if (property.type == ORL_PLY_TYPE_COUNT || property.count_type >= ORL_PLY_FLOAT32)
        return orl_ply_bad(ply, "unknown type of a property");
    if (orl_ply_property_index(element, property.name) >= 0)
        return orl_ply_bad(ply, "a property is given twice");
    if (element->property_count == ORL_PLY_PROPERTIES_MAX)
        return orl_ply_bad(ply, "too many properties");
    size_t capacity = (size_t)element->property_count;
    ORL_TRY(ORL_GROW(ply->log, element->properties, capacity, element->property_count));
    element->properties[element->property_count++] = property;
    element->lists = element->lists || property.list;
    // In an ascii file a value takes at least a digit and a space.
    element->least += ply->ascii ? 2 : types[property.list ? property.count_type
                                                           : property.type].size;
    return ORL_OK;
}

static enum orl_result add_element(struct orl_ply *ply, const char *line)
{
    char name[64];
    unsigned long long count;
    if (strchr(line, '-') || sscanf(line, "element %63s %llu", name, &count) != 2)
        return orl_ply_bad(ply, "an element needs a name and a count");
    if (ply->element_count == ORL_PLY_ELEMENTS_MAX)
        return orl_ply_bad(ply, "too many elements");
    struct orl_ply_element *element = &ply->elements[ply->element_count++];
    *element = (struct orl_ply_element){.count = count};
    memcpy(element->name, name, sizeof name);
    return ORL_OK;
}

static enum orl_result parse_format(struct orl_ply *ply, const char *line)
{
    if (strcmp(line, "format ascii 1.0") == 0)
        ply->ascii = true;
    else if (strcmp(line, "format binary_little_endian 1.0") != 0)
        return orl_ply_bad(ply, "the format is neither ascii 1.0 nor binary_little_endian 1.0");
    return ORL_OK;
}

static enum orl_result parse_header(struct orl_ply *ply)
{
    char line[HEADER_LINE_MAX];
    size_t length;
    enum orl_result result = ORL_OK;
    if (ply->size < 4 || memcmp(ply->data, "ply", 3) != 0)
        return orl_ply_bad(ply, "not a PLY file");
    bool have_format = false, ended = false;
    for (int number = 0; result == ORL_OK && !ended; number++, ply->at += length) {
        if (!header_line(ply, line, &length))
            return orl_ply_bad(ply, "the header does not end");
        if (strncmp(line, "format ", 7) == 0) {
            result = parse_format(ply, line);
            have_format = true;
        } else if (strncmp(line, "element ", 8) == 0) {
            result = have_format ? add_element(ply, line)
                                 : orl_ply_bad(ply, "an element ahead of the format");
        } else if (strncmp(line, "property ", 9) == 0) {
            result = add_property(ply, line);
        } else if (strcmp(line, "end_header") == 0) {
            ended = true;
        } else if (number > 0 && strncmp(line, "comment", 7) != 0 &&
                   strncmp(line, "obj_info", 8) != 0) {
            result = orl_ply_bad(ply, "unknown line in the header");
        }
    }
    return result;
}

enum orl_result orl_ply_open(const struct orl_log *log, const char *path, struct orl_ply *ply)
{
    *ply = (struct orl_ply){.log = log, .path = path};
    enum orl_result result = orl_file_read(log, path, SIZE_MAX / 2, &ply->data, &ply->size);
    ORL_THEN(result, parse_header(ply));
    if (result != ORL_OK)
        orl_ply_close(ply);
    return result;
}

enum orl_result orl_ply_open_header(const struct orl_log *log, const char *path,
                                    struct orl_ply *ply, FILE **stream)
{
    enum { HEADER_MAX = 1 << 16 };
    *ply = (struct orl_ply){.log = log, .path = path, .data = orl_array(log, HEADER_MAX + 1, 1)};
    enum orl_result result = ply->data ? orl_file_open(log, path, stream) : ORL_ERR_MEMORY;
    if (result == ORL_OK) {
        ply->size = fread(ply->data, 1, HEADER_MAX, *stream);
        result = parse_header(ply);
    }
    if (result == ORL_OK)
        return ORL_OK;
    orl_ply_close(ply);
    if (*stream)
        fclose(*stream);
    *stream = NULL;
    return result;
}

void orl_ply_close(struct orl_ply *ply)
{
    for (int i = 0; i < ply->element_count; i++)
        free(ply->elements[i].properties);
    free(ply->data);
    memset(ply, 0, sizeof *ply);
}

int orl_ply_property_index(const struct orl_ply_element *element, const char *name)
{
    for (int i = 0; i < element->property_count; i++)
        if (strcmp(element->properties[i].name, name) == 0)
            return i;
    return -1;
}

// --- records ---

static double binary_value(const uint8_t *at, enum orl_ply_type type)
{
    union {
        int8_t i8; uint8_t u8; int16_t i16; uint16_t u16;
        int32_t i32; uint32_t u32; float f32; double f64;
    } v;
    memcpy(&v, at, types[type].size);
    switch (type) {
    case ORL_PLY_INT8: return v.i8;
    case ORL_PLY_UINT8: return v.u8;
    case ORL_PLY_INT16: return v.i16;
    case ORL_PLY_UINT16: return v.u16;
    case ORL_PLY_INT32: return v.i32;
    case ORL_PLY_UINT32: return v.u32;
    case ORL_PLY_FLOAT32: return (double)v.f32;
    default: return v.f64;
    }
}

static enum orl_result take(struct orl_ply *ply, enum orl_ply_type type, double *value)
{
    if (!ply->ascii) {
        if (types[type].size > ply->size - ply->at)
            return orl_ply_bad(ply, "the file ends inside a record");
        *value = binary_value(ply->data + ply->at, type);
        ply->at += types[type].size;
        return ORL_OK;
    }
    const char *text = (const char *)ply->data + ply->at;
    char *end;
    *value = strtod(text, &end); // stops at the zero byte after the data
    if (end == text)
        return orl_ply_bad(ply, "a value is missing or not a number");
    ply->at += (size_t)(end - text);
    return ORL_OK;
}

static enum orl_result take_list(struct orl_ply *ply, const struct orl_ply_property *property,
                                 double length, struct orl_ply_list *items)
{
    size_t least = ply->ascii ? 1 : types[property->type].size;
    if (!(length >= 0) || length > (double)((ply->size - ply->at) / least))
        return orl_ply_bad(ply, "a list is larger than the file");
    size_t count = (size_t)length;
    enum orl_result result = ORL_OK;
    if (items) {
        result = orl_grow(ply->log, (void **)&items->items, &items->capacity, count,
                          sizeof *items->items);
        items->count = count;
    }
    for (size_t i = 0; result == ORL_OK && i < count; i++) {
        double unused;
        result = take(ply, property->type, items ? &items->items[i] : &unused);
    }
    return result;
}

enum orl_result orl_ply_record(struct orl_ply *ply, const struct orl_ply_element *element,
                               double *values, int list, struct orl_ply_list *items)
{
    for (int i = 0; i < element->property_count; i++) {
        const struct orl_ply_property *property = &element->properties[i];
        ORL_TRY(take(ply, property->list ? property->count_type : property->type, &values[i]));
        if (property->list)
            ORL_TRY(take_list(ply, property, values[i], i == list ? items : NULL));
    }
    return ORL_OK;
}

// --- finding an element ---

static enum orl_result skip(struct orl_ply *ply, const struct orl_ply_element *element)
{
    double values[ORL_PLY_PROPERTIES_MAX];
    size_t left = ply->size - ply->at, unit = ply->ascii ? 1 : element->least;
    if (unit && element->count > left / unit)
        return orl_ply_bad(ply, "an element is larger than the file");
    if (!ply->ascii && !element->lists) {
        ply->at += unit * (size_t)element->count;
        return ORL_OK;
    }
    for (uint64_t i = 0; i < element->count; i++)
        ORL_TRY(orl_ply_record(ply, element, values, -1, NULL));
    return ORL_OK;
}

enum orl_result orl_ply_seek(struct orl_ply *ply, const char *name, const char *missing,
                             const struct orl_ply_element **found)
{
    *found = NULL;
    int i = ply->next;
    while (i < ply->element_count && strcmp(ply->elements[i].name, name) != 0)
        i++;
    if (i == ply->element_count)
        return orl_ply_bad(ply, missing);
    for (; ply->next < i; ply->next++)
        ORL_TRY(skip(ply, &ply->elements[ply->next]));
    const struct orl_ply_element *element = &ply->elements[ply->next++];
    size_t left = ply->size - ply->at;
    // + ply->ascii: the last line of an ascii file may lack its newline.
    if (element->count && (!element->least ||
                           element->count > (left + ply->ascii) / element->least))
        return orl_fail(ply->log, ORL_ERR_FORMAT,
                        "%s: byte %zu: the header claims %llu records of %s, %zu bytes or more "
                        "each, but only %zu bytes follow", ply->path, ply->at,
                        (unsigned long long)element->count, name, element->least, left);
    *found = element;
    return ORL_OK;
}
