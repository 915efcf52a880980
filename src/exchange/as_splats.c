// The PLY of 2D Gaussian splatting: scales are logarithms, the opacity is a logit, and harmonics
// above the constant are ordered by channel. Normals are the true ones, where trainers write 0, and
// radii are there for Oriel's own reader.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/file.h"
#include "exchange/gaussians.h"
#include "exchange/kinds.h"

// Position, normal, harmonics, opacity, scales, rotation, radius.
enum { FLOATS_MAX = 3 + 3 + 3 * ORL_HARMONICS_MAX + 1 + 3 + 4 + 1 };

static void write_header(FILE *stream, const struct orl_gaussians *g, bool thin)
{
    fprintf(stream, "ply\nformat binary_little_endian 1.0\nelement vertex %zu\n"
                    "property float x\nproperty float y\nproperty float z\n"
                    "property float nx\nproperty float ny\nproperty float nz\n"
                    "property float f_dc_0\nproperty float f_dc_1\nproperty float f_dc_2\n",
            g->points->count);
    for (int k = 0; k < 3 * (g->terms - 1); k++)
        fprintf(stream, "property float f_rest_%d\n", k);
    fprintf(stream, "property float opacity\n"
                    "property float scale_0\nproperty float scale_1\n%s"
                    "property float rot_0\nproperty float rot_1\n"
                    "property float rot_2\nproperty float rot_3\n"
                    "property float radius\nend_header\n",
            thin ? "property float scale_2\n" : "");
}

// Returns how many floats the record has.
static size_t pack(const struct orl_gaussians *g, size_t i, bool thin, float record[FLOATS_MAX])
{
    struct orl_gaussian shape;
    const float *harmonics = g->harmonics + i * (size_t)g->terms * 3;
    size_t at = 9;
    orl_gaussian_shape(g, i, &shape);
    memcpy(record, g->points->position[i], 12);
    memcpy(record + 3, g->points->normal[i], 12);
    memcpy(record + 6, harmonics, 12);
    for (int c = 0; c < 3; c++)
        for (int k = 1; k < g->terms; k++)
            record[at++] = harmonics[k * 3 + c];
    record[at++] = logf(shape.opacity / (1 - shape.opacity));
    for (int k = 0; k < (thin ? 3 : 2); k++)
        record[at++] = logf(shape.scale[k]);
    memcpy(record + at, shape.rotation_wxyz, 16);
    record[at + 4] = g->points->radius[i];
    return at + 5;
}

static void write_all(FILE *stream, const struct orl_gaussians *g, bool thin)
{
    float record[FLOATS_MAX] = {0};
    write_header(stream, g, thin);
    for (size_t i = 0; i < g->points->count; i++)
        fwrite(record, sizeof *record, pack(g, i, thin, record), stream);
}

ORL_EXPORT_WRITER(orl_export_splats)
{
    struct orl_gaussians g = {0};
    struct orl_atomic_file file = {0};
    enum orl_result result =
        orl_gaussians_fit(log, progress, scene, params->degree < 0 ? 1 : params->degree, &g);
    ORL_THEN(result, orl_atomic_open(log, params->out, &file));
    if (result == ORL_OK) {
        write_all(file.stream, &g, params->thin);
        result = orl_atomic_commit(log, &file);
    }
    orl_gaussians_finish(&g);
    return result;
}
