// Private to the chart: its parts in chart_*.c.
#ifndef ORL_EVAL_CHART_INTERNAL_H
#define ORL_EVAL_CHART_INTERNAL_H

#include <jansson.h>

#include "eval/chart.h"
#include "eval/heldout.h"
#include "eval/metrics.h"

// --- chart_plan.c: what is measured ---

// One dot: a method with its settings and those of its renderer.
struct chart_config {
    const struct orl_method *method;
    char setting[64]; // "": the method as it is
    struct orl_render_params render;
    enum orl_textures textures;
    int photo_divide; // photographs at 1/n of their size
    int size_divide;  // pictures drawn at 1/n of their size and enlarged
};
struct chart_plan {
    struct chart_config *items; // owned
    size_t count, capacity;
};
// Methods with the scene's tuned values, and the settings of those that have some.
enum orl_result orl_chart_make_plan(struct orl_gpu *gpu, const struct orl_scene *scene,
                                    const struct orl_chart_params *params,
                                    struct chart_plan *plan);

// --- one scene ---

struct chart_scene {
    struct orl_gpu *gpu;
    const struct orl_chart_params *params;
    struct orl_scene *scene;    // owned
    const char *name;           // of its folder
    char checksum[32];
    struct orl_heldout *views;  // owned
    size_t view_count;
    json_t *json;               // owned: of chart.json's "scenes"
};

// --- chart_measure.c ---

enum { CHART_FIGURES = 7 };
extern const char *const orl_chart_figures[CHART_FIGURES]; // names: psnr_db, ...

// "views", "mean" and "sd" of a row, from pictures that `picture` hands out one by one, U8 x3 of
// the view's size, with coverage (F32 x1); pictures for the page are written below
// OUT/pictures/SCENE/ID.
struct chart_pictures {
    enum orl_result (*picture)(void *priv, size_t view, struct orl_image *rendered,
                               struct orl_image *coverage);
    void *priv;
};
enum orl_result orl_chart_compare(const struct chart_scene *scene, const char *id,
                                  const struct chart_pictures *pictures, json_t *row);
// A whole row, new.
enum orl_result orl_chart_measure(const struct chart_scene *scene,
                                  const struct chart_config *config, json_t **row);
// The photographs themselves, for the page; and their list in scene->json.
enum orl_result orl_chart_write_photographs(struct chart_scene *scene);

// --- chart_peer.c ---

// A whole row, new. NULL: the peer has no picture of this scene.
enum orl_result orl_chart_peer_row(const struct chart_scene *scene,
                                   const struct orl_chart_peer *peer, json_t **row);

// --- chart_rows.c: rows kept between runs ---

// "oriel.candidates-3": a file name.
void orl_chart_id(const char *method, const char *setting, char id[128]);
// What a row depends on; new. Rows are used again only while this stays the same.
json_t *orl_chart_provenance(const struct chart_scene *scene);
// The row of this id if it was measured by this program, on this device, of this scene, with
// its pictures; else NULL. New.
json_t *orl_chart_load_row(const struct chart_scene *scene, const char *id);
enum orl_result orl_chart_keep_row(const struct chart_scene *scene, const char *id,
                                   const json_t *row);
// Of all that a rendering of the scene depends on.
enum orl_result orl_chart_checksum(const struct orl_log *log, const struct orl_scene *scene,
                                   char text[32]);

// --- chart_report.c: fronts, means over scenes ---

// A row's text, "" where there is none; a row's number, NAN where there is none or null.
const char *orl_chart_text(const json_t *row, const char *key);
double orl_chart_number(const json_t *row, const char *key);

// Adds "on_front", "dominated_by" and "sentence" to each row, and "overall" to the root, which has
// "scenes" and "rows".
enum orl_result orl_chart_analyse(const struct orl_log *log, json_t *root);

// --- chart_write.c ---

enum orl_result orl_chart_write(const struct orl_log *log, const char *out, const json_t *root);
// chart.html with places for the data.
extern const char orl_chart_page[];

#endif
