// A scene as a web site of static files, which a visitor's browser renders
// (docs/reference/site.md).
#ifndef ORL_WALK_PUBLISH_H
#define ORL_WALK_PUBLISH_H

#include "oriel/progress.h"
#include "oriel/render.h"

// A larger cloud is thinned evenly; of points.lod the finest level is taken that has no more points.
#define ORL_PUBLISH_OPTIONS(ROW) \
    ROW(out, "out", NEEDED("SITE"), "folder to write; an earlier site is replaced") \
    ROW(title, "title", TEXT("TEXT"), \
        "of the page; default: that of walk.json, else the scene's name") \
    ROW(single_file, "single-file", FLAG, \
        "everything in one HTML file SITE, which also opens from disk") \
    ROW(photo_side, "max-size", INT(1024, 64, 8192, "PX"), \
        "longer side of photographs at most") \
    ROW(jpeg_quality, "quality", INT(95, 1, 100, "N"), "of JPEG") \
    ROW(max_points, "max-points", INT(3000000, 1, 100000000, "N"), \
        "the cloud is thinned to so many")
struct orl_publish_params {
    ORL_PUBLISH_OPTIONS(ORL_OPTION_MEMBER)
    bool radiance; // photographs are published as merged radiance
    const struct orl_progress *progress; // may be NULL
};
#define ORL_PUBLISH_DEFAULTS ORL_PUBLISH_OPTIONS(ORL_OPTION_PRESET) .progress = NULL

struct orl_publish_report {
    size_t photos, points;
    size_t first_bytes; // loaded before the page shows the scene: page, poster and coarse points
    size_t bytes;       // of all files
};

// Writes the site completely or not at all, without held-out photographs, of a sequence with silhouettes
// all time steps. The scene shows afterwards what it showed before. An earlier site of Oriel
// at `out` is replaced. ORL_ERR_ARGUMENT: `out` is another folder.
enum orl_result orl_publish(struct orl_gpu *gpu, struct orl_scene *scene,
                            const struct orl_publish_params *params,
                            struct orl_publish_report *report) ORL_CHECK_RESULT;

#endif
