// A scene as a web site of static files, which a visitor's browser renders
// (docs/reference/site.md).
#ifndef ORL_WALK_PUBLISH_H
#define ORL_WALK_PUBLISH_H

#include "oriel/progress.h"
#include "oriel/render.h"

struct orl_publish_params {
    const char *out;   // the folder of the site; with single_file, its HTML file
    const char *title; // of the page; NULL: the name of the scene's folder
    bool single_file;  // everything in one HTML file, which a browser can also open from disk
    bool radiance;     // photographs are published as merged radiance
    int photo_side;    // greatest longer side of the site's photographs, pixels
    int jpeg_quality;  // of photographs, [1, 100]
    size_t max_points; // greatest number of points; a larger cloud is thinned evenly; of
                       // points.lod the finest level that has no more
    const struct orl_progress *progress; // may be NULL
};
#define ORL_PUBLISH_DEFAULTS .photo_side = 1024, .jpeg_quality = 88, .max_points = 3000000

struct orl_publish_report {
    size_t photos, points;
    size_t first_bytes; // loaded before the page shows the scene: page, poster and coarse points
    size_t bytes;       // of all files
};

// Writes the site completely or not at all, without held-out photographs. An earlier site of Oriel
// at `out` is replaced. ORL_ERR_ARGUMENT: `out` is another folder.
enum orl_result orl_publish(struct orl_gpu *gpu, const struct orl_scene *scene,
                            const struct orl_publish_params *params,
                            struct orl_publish_report *report) ORL_CHECK_RESULT;

#endif
