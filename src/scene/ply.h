// PLY files (Turk 1994), ascii or binary little endian: the header, and records of any element.
#ifndef ORL_SCENE_PLY_H
#define ORL_SCENE_PLY_H

#include <stdio.h>

#include "oriel/log.h"

enum orl_ply_type {
    ORL_PLY_INT8, ORL_PLY_UINT8, ORL_PLY_INT16, ORL_PLY_UINT16, ORL_PLY_INT32, ORL_PLY_UINT32,
    ORL_PLY_FLOAT32, ORL_PLY_FLOAT64, ORL_PLY_TYPE_COUNT
};

struct orl_ply_property {
    char name[64];
    enum orl_ply_type type;       // of the value; for a list, of its items
    enum orl_ply_type count_type; // of a list's length
    bool list;
};

enum { ORL_PLY_ELEMENTS_MAX = 16, ORL_PLY_PROPERTIES_MAX = 256 };
struct orl_ply_element {
    char name[64];
    uint64_t count;
    size_t least; // smallest size of a record in bytes, with its lists empty
    bool lists;
    int property_count;
    struct orl_ply_property *properties; // owned
};

struct orl_ply {
    const struct orl_log *log;
    const char *path; // not owned
    uint8_t *data;    // owned; a zero byte follows
    size_t size, at;  // at: offset of the next byte to read
    bool ascii;
    int element_count, next; // next: the element whose records come next
    struct orl_ply_element elements[ORL_PLY_ELEMENTS_MAX];
};

// The constant spherical harmonic, 1 / (2 sqrt(pi)). In files of Gaussian splatting a colour is
// this times f_dc, and a half.
#define ORL_HARMONIC_0 0.28209479177387814

// Reads the file and its header. The path must outlive the reader.
enum orl_result orl_ply_open(const struct orl_log *log, const char *path,
                             struct orl_ply *ply) ORL_CHECK_RESULT;
// Reads the header alone. ply->at is the offset of the first record in the file, whose bytes are not
// there: *stream, which the caller closes, has them.
enum orl_result orl_ply_open_header(const struct orl_log *log, const char *path,
                                    struct orl_ply *ply, FILE **stream) ORL_CHECK_RESULT;
void orl_ply_close(struct orl_ply *ply);
// Logs the reader's position in bytes and `what` is wrong there; returns ORL_ERR_FORMAT.
enum orl_result orl_ply_bad(const struct orl_ply *ply, const char *what);

// Moves the reader to the records of the element of this name, past the elements before it, and
// checks that the file is long enough for these records. When there is no such element the error
// says `missing`.
enum orl_result orl_ply_seek(struct orl_ply *ply, const char *name, const char *missing,
                             const struct orl_ply_element **element) ORL_CHECK_RESULT;
// Items of one list.
struct orl_ply_list {
    double *items; // owned
    size_t count, capacity;
};
// Reads one record. values[i] is the value of property i, or the length of a list. The items of
// property `list` (-1: none) go to *items.
enum orl_result orl_ply_record(struct orl_ply *ply, const struct orl_ply_element *element,
                               double *values, int list,
                               struct orl_ply_list *items) ORL_CHECK_RESULT;
// Index of the property of this name; -1 when there is none.
int orl_ply_property_index(const struct orl_ply_element *element, const char *name);

#endif
