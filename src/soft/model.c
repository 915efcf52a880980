#include "soft/model.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "core/vec3.h"
#include "scene/ply.h"

// Standard deviation of a disc's splat, in radii of the disc, and of its third axis as a part of the others.
static const double SIGMA = 0.5, THIN = 0.25;
static const float DISC_LOGIT = 1; // opacity 0.73

double orl_soft_random(uint64_t *state)
{
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    return (double)(*state >> 11) / 9007199254740992.0;
}

static float logarithm(double value)
{
    return (float)log(value);
}

static float logit(float opacity)
{
    return logf(opacity / (1 - opacity));
}

enum orl_result orl_soft_add(const struct orl_log *log, struct orl_soft_model *model, const double place[3],
                             double sigma, float opacity, const float rgb[3])
{
    ORL_TRY(ORL_GROW(log, model->splats, model->capacity, model->count));
    float *s = model->splats[model->count++];
    memset(s, 0, sizeof *model->splats);
    s[ORL_SOFT_TURN] = 1;
    s[ORL_SOFT_OPACITY] = logit(opacity);
    for (int k = 0; k < 3; k++) {
        s[ORL_SOFT_PLACE + k] = (float)place[k];
        s[ORL_SOFT_SIGMA + k] = logarithm(sigma);
        s[ORL_SOFT_COLOR + k] = (float)(((double)rgb[k] - 0.5) / ORL_HARMONIC_0);
    }
    return ORL_OK;
}

// The shortest rotation from the third axis to the normal.
static void turn_to(const float n[3], float q[4])
{
    float sign = n[2] < 0 ? -1.0f : 1.0f; // of a disc either side will do
    q[0] = 1 + sign * n[2];
    q[1] = -sign * n[1];
    q[2] = sign * n[0];
}

// Adds a flat splat.
static enum orl_result add_disc(const struct orl_log *log, struct orl_soft_model *model, const double place[3],
                                const float normal[3], double sigma, const float rgb[3])
{
    ORL_TRY(orl_soft_add(log, model, place, sigma, 0.5f, rgb));
    float *s = model->splats[model->count - 1];
    s[ORL_SOFT_OPACITY] = DISC_LOGIT;
    s[ORL_SOFT_SIGMA + 2] = logarithm(THIN * sigma);
    turn_to(normal, s + ORL_SOFT_TURN);
    return ORL_OK;
}

static uint64_t random_state(uint64_t seed)
{
    return 0x9e3779b97f4a7c15u ^ (seed + 1) * 0xbf58476d1ce4e5b9u;
}

enum orl_result orl_soft_from_points(const struct orl_log *log, const struct orl_points *points, double every,
                                     uint64_t seed, struct orl_soft_model *model)
{
    ORL_REQUIRE(log, every >= 1);
    uint64_t state = random_state(seed);
    for (size_t i = 0; i < points->count; i++) {
        if (orl_soft_random(&state) * every >= 1 || !(points->radius[i] > 0))
            continue;
        float rgb[3];
        double place[3];
        for (int k = 0; k < 3; k++) {
            rgb[k] = (float)points->color[i][k] / 255;
            place[k] = (double)points->position[i][k];
        }
        ORL_TRY(add_disc(log, model, place, points->normal[i],
                         SIGMA * sqrt(every) * (double)points->radius[i], rgb));
    }
    return ORL_OK;
}

// Of a triangle: its normal's direction, and its area.
static double triangle_area(const struct orl_mesh *mesh, size_t i, float normal[3])
{
    const float *a = mesh->position[mesh->triangle[i][0]], *b = mesh->position[mesh->triangle[i][1]];
    const float *c = mesh->position[mesh->triangle[i][2]];
    double ab[3], ac[3], n[3];
    for (int k = 0; k < 3; k++) {
        ab[k] = (double)b[k] - (double)a[k];
        ac[k] = (double)c[k] - (double)a[k];
    }
    orl_cross3(ab, ac, n);
    double length = orl_normalize3(n);
    for (int k = 0; k < 3; k++)
        normal[k] = (float)n[k];
    return length / 2;
}

enum orl_result orl_soft_from_mesh(const struct orl_log *log, const struct orl_mesh *mesh, double count, uint64_t seed,
                                   struct orl_soft_model *model)
{
    static const float grey[3] = {0.5f, 0.5f, 0.5f};
    uint64_t state = random_state(seed);
    float normal[3];
    double whole = 0;
    for (size_t i = 0; i < mesh->triangle_count; i++)
        whole += triangle_area(mesh, i, normal);
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        const double own = whole > 0 ? triangle_area(mesh, i, normal) / whole * count : 0;
        for (double n = floor(own + orl_soft_random(&state)); n >= 1; n--) {
            double u = sqrt(orl_soft_random(&state)), v = orl_soft_random(&state); // uniform over the triangle
            const double weights[3] = {1 - u, u * (1 - v), u * v};
            double place[3] = {0};
            for (int k = 0; k < 3; k++)
                for (int j = 0; j < 3; j++)
                    place[k] += weights[j] * (double)mesh->position[mesh->triangle[i][j]][k];
            ORL_TRY(add_disc(log, model, place, normal, SIGMA * sqrt(whole / count), grey));
        }
    }
    return ORL_OK;
}

static bool is_kept(const float *s, float logit)
{
    bool finite = true;
    for (int k = 0; k < ORL_SOFT_VALUES; k++)
        finite = finite && isfinite(s[k]);
    return finite && s[ORL_SOFT_OPACITY] >= logit;
}

void orl_soft_drop(struct orl_soft_model *model, float opacity)
{
    const float least = logit(opacity);
    size_t kept = 0;
    for (size_t i = 0; i < model->count; i++)
        if (is_kept(model->splats[i], least))
            memmove(model->splats[kept++], model->splats[i], sizeof *model->splats);
    model->count = kept;
    free(model->moments);
    model->moments = NULL;
}

void orl_soft_finish(struct orl_soft_model *model)
{
    free(model->splats);
    free(model->moments);
    memset(model, 0, sizeof *model);
}
