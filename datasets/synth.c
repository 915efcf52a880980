// Names, ranges and cameras of synthetic monuments.
#include "datasets/synth.h"

#include <math.h>
#include <string.h>

enum orl_result orl_synth_check(const struct orl_log *log, const struct orl_synth_params *p)
{
    if (strcmp(p->name, "monument") != 0)
        return orl_fail(log, ORL_ERR_ARGUMENT, "there is no synthetic %s; there is: monument", p->name);
    if (p->width < ORL_SYNTH_SIDE_MIN || p->width > ORL_SYNTH_SIDE_MAX ||
        p->height < ORL_SYNTH_SIDE_MIN || p->height > ORL_SYNTH_SIDE_MAX)
        return orl_fail(log, ORL_ERR_ARGUMENT, "size %dx%d: each side must be from %d to %d",
                        p->width, p->height, ORL_SYNTH_SIDE_MIN, ORL_SYNTH_SIDE_MAX);
    for (int i = 0; i < p->exposure_count; i++)
        if (!(fabs(p->exposures_ev[i]) <= 12))
            return orl_fail(log, ORL_ERR_ARGUMENT, "exposure %g EV: must be from -12 to 12",
                            p->exposures_ev[i]);
    return ORL_OK;
}

// SplitMix64 (Steele, Lea and Flood 2014), scaled to [-1, 1).
static double next_random(uint64_t *state)
{
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    z ^= z >> 31;
    return (double)(z >> 11) * 0x1p-52 - 1;
}

void orl_synth_views(const struct orl_synth_params *p, struct orl_view *views)
{
    static const double arc_rad = 0.87; // half of the arc
    uint64_t state = p->seed;
    double side = p->width > p->height ? p->width : p->height;
    double focal = ORL_SYNTH_FOCAL_35MM / 35.0 * side;
    for (int i = 0; i < p->count; i++) {
        double jitter[7];
        for (size_t j = 0; j < ORL_COUNT(jitter); j++)
            jitter[j] = next_random(&state);
        double step = 2 * arc_rad / (p->count - 1);
        double angle = -arc_rad + step * i + 0.2 * step * jitter[0];
        // The path approaches the monument twice and recedes twice along the arc.
        double distance = 12.8 - 1.9 * sin(4 * M_PI * i / (p->count - 1)) + 0.3 * jitter[1];
        const double eye[3] = {distance * sin(angle), 1.65 + 0.15 * jitter[2],
                               distance * cos(angle) - 0.6};
        const double target[3] = {0.3 * jitter[3] + 0.12 * eye[0], 3.8 + 0.25 * jitter[4], -0.8};
        const double up[3] = {0.02 * jitter[5], 1, 0.01 * jitter[6]};
        views[i] = (struct orl_view){
            .camera = {.width = p->width, .height = p->height, .fx = focal, .fy = focal,
                       .cx = 0.5 * p->width, .cy = 0.5 * p->height},
            .cam_from_world = orl_pose_look_at(eye, target, up)};
    }
}
