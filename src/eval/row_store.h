// Rows of a report that are kept between runs, as OUT/rows/GROUP/ID.json, and reused while the
// program, the device and the scene are the same.
#ifndef ORL_EVAL_ROW_STORE_H
#define ORL_EVAL_ROW_STORE_H

#include <jansson.h>

#include "oriel/gpu.h"
#include "oriel/option_row.h"
#include "oriel/scene.h"

enum { ORL_ROW_ID_MAX = 128, ORL_ROW_CHECKSUM_SIZE = 32 };

// The rows that a run measures: of each `count` one after the other the one at `index`. A
// run of a part keeps its rows for a later run of all and writes no report. count 0: all rows.
bool orl_row_part_has(const struct orl_part *part, size_t row);

struct orl_row_store {
    const struct orl_log *log;
    const char *out, *group; // folder of the report; folder of the rows in it
};

// Makes a file name such as "oriel.candidates-3".
void orl_row_id(const char *method, const char *setting, char id[ORL_ROW_ID_MAX]);
// A row's text, "" when missing; a row's number, NAN when missing or null.
const char *orl_row_text(const json_t *row, const char *key);
double orl_row_number(const json_t *row, const char *key);
// A number, or null unless it is finite. A new reference.
json_t *orl_number_json(double value);

// What every row depends on: commit, device, driver and the scene's checksum, to which a report
// adds its own settings. A new reference.
json_t *orl_row_provenance(struct orl_gpu *gpu, const char *checksum);
// The kept row if its "provenance" equals this one, else NULL. A new reference.
json_t *orl_row_load(const struct orl_row_store *store, const char *id, const json_t *provenance);
// Writes the row, and replaces it by what is read back, whose numbers have fewer digits: a report of
// rows just measured is that of rows used again.
enum orl_result orl_row_keep(const struct orl_row_store *store, const char *id,
                             json_t **row) ORL_CHECK_RESULT;
// Checksum of everything that a rendering of the scene depends on.
enum orl_result orl_row_checksum(const struct orl_log *log, const struct orl_scene *scene,
                                 char text[ORL_ROW_CHECKSUM_SIZE]) ORL_CHECK_RESULT;

#endif
