// Writes a scene in the formats of other programs, from one table of kinds.
#ifndef ORL_EXCHANGE_EXPORT_H
#define ORL_EXCHANGE_EXPORT_H

#include "oriel/gpu.h"
#include "oriel/progress.h"
#include "oriel/scene.h"

struct orl_export_params {
    const char *out; // file or folder, as the kind has it
    int degree;      // of spherical harmonics, [0, 2]; -1: the kind's own choice
    bool thin;       // splats: write a third scale
    const char *at;  // hdri: the photograph whose place is meant; NULL: the middlemost
    int width;       // hdri: of the picture, pixels; 0: the kind's own choice
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
