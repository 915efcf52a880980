// Private to the chart: its parts in chart_*.c.
#ifndef ORL_EVAL_CHART_INTERNAL_H
#define ORL_EVAL_CHART_INTERNAL_H

#include <jansson.h>

#include "eval/chart.h"
#include "eval/heldout.h"
#include "eval/metrics.h"
#include "eval/row_store.h"

// --- chart_plan.c: what is measured ---

// One dot: a method with its settings and the renderer's.
struct chart_config {
    const struct orl_method *method;
    char setting[64]; // "": the method's own values
    struct orl_render_params render;
    enum orl_textures textures;
    int photo_divide; // photographs at 1/n of their size
    int size_divide;  // pictures drawn at 1/n of their size and enlarged
};
struct chart_plan {
    struct chart_config *items; // owned
    size_t count, capacity;
};
// Plans the methods with the scene's tuned values, and the settings of the methods that have some.
enum orl_result orl_chart_make_plan(struct orl_gpu *gpu, const struct orl_scene *scene,
                                    const struct orl_chart_params *params,
                                    struct chart_plan *plan);

// --- one scene ---

struct chart_scene {
    struct orl_gpu *gpu;
    const struct orl_chart_params *params;
    struct orl_scene *scene;    // owned
    const char *name;           // of its folder
    char checksum[ORL_ROW_CHECKSUM_SIZE];
    struct orl_heldout *views;  // owned
    size_t view_count;
    json_t *json;               // owned: this scene's entry in chart.json's "scenes"
};

// --- chart_measure.c ---

enum { CHART_FIGURES = 8 };
extern const char *const orl_chart_figures[CHART_FIGURES]; // names: psnr_db, ...

// Sets "views", "mean" and "sd" of a row from pictures that `picture` returns one by one: U8 x3 of
// the view's size, with coverage (F32 x1). Writes pictures for the page below
// OUT/pictures/SCENE/ID.
struct chart_pictures {
    enum orl_result (*picture)(void *priv, size_t view, struct orl_image *rendered,
                               struct orl_image *coverage);
    void *priv;
};
enum orl_result orl_chart_compare(const struct chart_scene *scene, const char *id,
                                  const struct chart_pictures *pictures, json_t *row);
// Measures a complete row, which is a new reference.
enum orl_result orl_chart_measure(const struct chart_scene *scene,
                                  const struct chart_config *config, json_t **row);
// Writes the photographs for the page, and their list into scene->json.
enum orl_result orl_chart_write_photographs(struct chart_scene *scene);

// --- chart_peer.c ---

// A complete row, which is a new reference. NULL: the peer has no picture of this scene.
enum orl_result orl_chart_peer_row(const struct chart_scene *scene,
                                   const struct orl_chart_peer *peer, json_t **row);

// --- chart_rows.c: rows kept between runs ---

// What a row depends on, as a new reference. Rows are reused only while this stays the same.
json_t *orl_chart_provenance(const struct chart_scene *scene);
// The row of this id if this program measured it on this device and scene and its pictures exist,
// else NULL. A new reference.
json_t *orl_chart_load_row(const struct chart_scene *scene, const char *id);
enum orl_result orl_chart_keep_row(const struct chart_scene *scene, const char *id,
                                   json_t **row);

// --- chart_report.c: Pareto fronts, means over scenes ---

// Adds "on_front", "dominated_by" and "sentence" to each row, and "overall" to the root, which
// holds "scenes" and "rows".
enum orl_result orl_chart_analyse(const struct orl_log *log, json_t *root);

// --- chart_write.c ---

enum orl_result orl_chart_write(const struct orl_log *log, const char *out, const json_t *root);
// chart.html with marks where the data belongs.
extern const char orl_chart_page[];

#endif
