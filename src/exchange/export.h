// Writes a scene in the formats of other programs, from one table of kinds.
#ifndef ORL_EXCHANGE_EXPORT_H
#define ORL_EXCHANGE_EXPORT_H

#include "oriel/gpu.h"
#include "oriel/option_row.h"
#include "oriel/progress.h"
#include "oriel/scene.h"

#define ORL_EXPORT_OPTIONS(ROW) \
    ROW(out, "out", TEXT("FILE|DIR"), "where; nerfstudio and blender make a folder") \
    ROW(degree, "sh", INT(-1, 0, 2, "N"), \
        "of splats and glb: degree of spherical harmonics; default 1") \
    ROW(thin, "thin", FLAG, "of splats: a third scale, for programs that know no discs") \
    ROW(at, "at", TEXT("PHOTO"), \
        "of hdri: the photograph whose place it is; default: the middlemost") \
    ROW(width, "width", INT(0, 16, 32768, "PX"), "of hdri; default 2048")
struct orl_export_params {
    ORL_EXPORT_OPTIONS(ORL_OPTION_MEMBER)
    const char *shader_dir;
};

// What a kind reads of the parameters.
enum { ORL_EXPORT_DEGREE = 1, ORL_EXPORT_THIN = 2, ORL_EXPORT_PLACE = 4 };

struct orl_export_kind {
    const char *name, *what;
    int reads; // of ORL_EXPORT_*
    bool points; // writes the points
    bool placed; // in the coordinates that were imported, as doubles; others in those of the scene
    // NULL: a scene is of this kind already.
    enum orl_result (*write)(const struct orl_log *log, const struct orl_progress *progress,
                             const struct orl_scene *scene,
                             const struct orl_export_params *params);
};
// Ended by a NULL name.
extern const struct orl_export_kind orl_export_kinds[];

#endif
