// A moving figure in a room, seen by fixed cameras: photographs, silhouettes, backgrounds, depth
// and meshes that are known exactly. World: metres, y up, the floor at y = 0.
#ifndef ORL_DATASETS_FIGURES_H
#define ORL_DATASETS_FIGURES_H

#include "oriel/image.h"
#include "oriel/option_row.h"
#include "oriel/progress.h"
#include "oriel/camera.h"
#include "oriel/scene.h"
#include "scene/mesh.h"

enum {
    ORL_FIGURES_CAMERAS_MAX = 99,
    ORL_FIGURES_FRAMES_MAX = 99999,
    ORL_FIGURES_SIDE_MIN = 32,
    ORL_FIGURES_SIDE_MAX = 4096,
};

// On a ring around the figure; 25 time steps to a second.
#define ORL_FIGURES_OPTIONS(ROW) \
    ROW(cameras, "cameras", INT(8, 2, ORL_FIGURES_CAMERAS_MAX, "N"), "figures: cameras around", \
        "figures") \
    ROW(frames, "frames", INT(1, 1, ORL_FIGURES_FRAMES_MAX, "N"), \
        "figures: time steps, 25 to a second", "figures")
struct orl_figures_params {
    ORL_FIGURES_OPTIONS(ORL_OPTION_MEMBER)
    int width, height; // pixels, [ORL_FIGURES_SIDE_MIN, ORL_FIGURES_SIDE_MAX]
};

// ORL_ERR_ARGUMENT, logged, for a size out of range. The rows above say what the other values may be.
enum orl_result orl_figures_check(const struct orl_log *log,
                                  const struct orl_figures_params *params) ORL_CHECK_RESULT;
// params->cameras views.
void orl_figures_views(const struct orl_figures_params *params, struct orl_view *views);

extern const struct orl_room orl_figures_room;

// --- one time step ---

// A part of the body: all points within `radius` of the segment from a to b.
struct orl_figure_part {
    double a[3], b[3], radius;
    double color[2][3]; // linear light reflected, of its two kinds of stripes
};
enum { ORL_FIGURE_PARTS = 14 };
struct orl_figure {
    struct orl_figure_part parts[ORL_FIGURE_PARTS];
};
// The figure at a time step: it walks on a small circle.
void orl_figure_pose(int frame, struct orl_figure *figure);
// Distance to its surface, negative inside. *part takes the nearest one; may be NULL.
double orl_figure_distance(const struct orl_figure *figure, const double at[3], int *part);
// Its surface, vertices on it to within 1e-5 m, with normals and colours; `spacing` of the grid
// that it is found on, metres.
enum orl_result orl_figure_mesh(const struct orl_log *log, const struct orl_figure *figure,
                                double spacing, struct orl_mesh *mesh) ORL_CHECK_RESULT;

// From the part's segment to a point, the shortest way.
void orl_figure_part_offset(const struct orl_figure_part *part, const double at[3], double off[3]);
// What the part reflects at a point of its surface, linear.
void orl_figure_part_color(const struct orl_figure_part *part, const double at[3], double color[3]);

struct orl_figures_picture {
    struct orl_image photo; // U8 x3, sRGB: mean of 4 x 4 rays a pixel
    struct orl_image mask;  // U8 x1: 255 where the ray through the pixel's centre meets the figure
    struct orl_image depth; // F32 x1: z in camera space at the pixel's centre
};
// What a camera sees. figure NULL: the empty room, which has no mask.
enum orl_result orl_figures_draw(const struct orl_log *log, const struct orl_figure *figure,
                                 const struct orl_view *view,
                                 struct orl_figures_picture *picture) ORL_CHECK_RESULT;
void orl_figures_picture_finish(struct orl_figures_picture *picture);

// --- all of them, as files ---

// Fills OUT, a new or empty folder, which appears only when whole (docs/reference/synthetic.md).
enum orl_result orl_figures_run(const struct orl_log *log, const struct orl_progress *progress,
                                const struct orl_figures_params *params,
                                const char *out) ORL_CHECK_RESULT;
// Plays the pictures of such a folder into DIR/camNN/NNNNN.png, 25 a second, as live cameras would.
enum orl_result orl_figures_play(const struct orl_log *log, const struct orl_progress *progress,
                                 const struct orl_figures_params *params, const char *out,
                                 const char *dir) ORL_CHECK_RESULT;

#endif
