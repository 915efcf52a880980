// A cloud of any size that looks like a scene's: each point becomes many smaller ones, spread over
// its disc. To measure what grows with the points.
// usage: bench_large_cloud SCENE TIMES OUT.ply     TIMES the scene's points
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "oriel/points.h"

struct record {
    float position[3], normal[3];
    uint8_t color[3];
    float radius;
} __attribute__((packed));

static double random_value(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 40) / (1 << 24);
}

// Two directions in the plane of the disc.
static void find_tangents(const float n[3], double u[3], double v[3])
{
    int least = fabsf(n[0]) < fabsf(n[1]) ? 0 : 1;
    least = fabsf(n[2]) < fabsf(n[least]) ? 2 : least;
    double e[3] = {0}, length = 0;
    e[least] = 1;
    for (int k = 0; k < 3; k++)
        u[k] = (double)n[(k + 1) % 3] * e[(k + 2) % 3] - (double)n[(k + 2) % 3] * e[(k + 1) % 3];
    for (int k = 0; k < 3; k++)
        length += u[k] * u[k];
    for (int k = 0; k < 3; k++)
        u[k] /= sqrt(length) + 1e-30;
    for (int k = 0; k < 3; k++)
        v[k] = (double)n[(k + 1) % 3] * u[(k + 2) % 3] - (double)n[(k + 2) % 3] * u[(k + 1) % 3];
}

static struct record spread(const struct orl_points *p, size_t i, double times, uint64_t *state)
{
    struct record r = {.radius = p->radius[i] / (float)sqrt(times)};
    double u[3], v[3], angle = 2 * 3.14159265358979 * random_value(state);
    double reach = (double)p->radius[i] * sqrt(random_value(state));
    find_tangents(p->normal[i], u, v);
    for (int k = 0; k < 3; k++)
        r.position[k] = (float)((double)p->position[i][k] +
                                reach * (cos(angle) * u[k] + sin(angle) * v[k]));
    memcpy(r.normal, p->normal[i], sizeof r.normal);
    memcpy(r.color, p->color[i], sizeof r.color);
    return r;
}

static bool write_cloud(const struct orl_points *points, size_t times, FILE *file)
{
    uint64_t state = 1;
    fprintf(file, "ply\nformat binary_little_endian 1.0\nelement vertex %zu\nproperty float x\n"
            "property float y\nproperty float z\nproperty float nx\nproperty float ny\n"
            "property float nz\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
            "property float radius\nend_header\n", points->count * times);
    for (size_t k = 0; k < times; k++)
        for (size_t i = 0; i < points->count; i++) {
            struct record r = spread(points, i, (double)times, &state);
            if (fwrite(&r, sizeof r, 1, file) != 1)
                return false;
        }
    return fflush(file) == 0;
}

int main(int argc, char **argv)
{
    const struct orl_log log = orl_log_stderr(ORL_LOG_WARNING);
    struct orl_points points = {0};
    size_t times = argc == 4 ? (size_t)strtoul(argv[2], NULL, 10) : 0;
    if (!times) {
        fprintf(stderr, "usage: bench_large_cloud SCENE TIMES OUT.ply\n");
        return 2;
    }
    char *ply = orl_path_join(&log, argv[1], "points.ply");
    FILE *out = NULL;
    int status = 1;
    if (ply && orl_points_read(&log, ply, NULL, &points) == ORL_OK && (out = fopen(argv[3], "wb")))
        status = write_cloud(&points, times, out) ? 0 : 1;
    if (status)
        perror(argv[3]);
    if (out)
        fclose(out);
    orl_points_finish(&points);
    free(ply);
    return status;
}
