#include "scene/sky.h"

#include <math.h>
#include <string.h>

#include "core/vec3.h"
#include "scene/meter.h"

// --- upwards ---

enum { ROUNDS = 4 };
// Added to the mean square of a horizontal axis: photographs may roll by so much, the tangent's square,
// and photographs that all look in one direction do not tell how they are tilted.
static const double ROLL2 = 0.01;

// Solves m x = b for a positive definite matrix, b becoming x. Changes m.
static void solve(double m[3][3], double b[3])
{
    for (int i = 0; i < 3; i++)
        for (int j = i + 1; j < 3; j++) {
            double factor = m[j][i] / m[i][i];
            for (int k = i; k < 3; k++)
                m[j][k] -= factor * m[i][k];
            b[j] -= factor * b[i];
        }
    for (int i = 2; i >= 0; i--) {
        for (int k = i + 1; k < 3; k++)
            b[i] -= m[i][k] * b[k];
        b[i] /= m[i][i];
    }
}

// Turns `up` towards the direction that is the most perpendicular to the horizontal axes (inverse
// iteration for the least eigenvector).
static void turn_up(const struct orl_scene *scene, double up[3])
{
    double m[3][3] = {{ROLL2, 0, 0}, {0, ROLL2, 0}, {0, 0, ROLL2}};
    for (size_t i = 0; i < scene->photo_count; i++) {
        const struct orl_pose *pose = &scene->photos[i].view.cam_from_world;
        bool upright = fabs(orl_dot3(pose->r[0], up)) < fabs(orl_dot3(pose->r[1], up));
        const double *axis = pose->r[upright ? 0 : 1];
        for (int k = 0; k < 9; k++)
            m[k / 3][k % 3] += axis[k / 3] * axis[k % 3] / (double)scene->photo_count;
    }
    solve(m, up);
    orl_normalize3(up);
}

struct orl_view orl_photo_upright(const struct orl_photo *photo)
{
    // Quarters, clockwise, that turn a picture of each EXIF orientation upright, mirrored ones too.
    static const int quarters[9] = {0, 0, 0, 2, 2, 1, 1, 3, 3};
    struct orl_view view = photo->view;
    bool known = photo->orientation >= 1 && photo->orientation <= 8;
    for (int i = known ? quarters[photo->orientation] : 0; i > 0; i--) {
        struct orl_view was = view;
        struct orl_camera *c = &view.camera;
        struct orl_pose *pose = &view.cam_from_world;
        for (int k = 0; k < 3; k++) { // upwards is to the right then, the right downwards
            pose->r[0][k] = -was.cam_from_world.r[1][k];
            pose->r[1][k] = was.cam_from_world.r[0][k];
        }
        pose->t[0] = -was.cam_from_world.t[1];
        pose->t[1] = was.cam_from_world.t[0];
        *c = (struct orl_camera){.width = was.camera.height, .height = was.camera.width,
                                 .fx = was.camera.fy, .fy = was.camera.fx,
                                 .cx = was.camera.height - was.camera.cy, .cy = was.camera.cx};
    }
    return view;
}

bool orl_scene_mean_up(const struct orl_scene *scene, double up[3])
{
    memset(up, 0, 3 * sizeof *up);
    for (size_t i = 0; i < scene->photo_count; i++) {
        struct orl_view view = orl_photo_upright(&scene->photos[i]);
        for (int k = 0; k < 3; k++)
            up[k] -= view.cam_from_world.r[1][k];
    }
    if (orl_normalize3(up) > 0)
        return true;
    up[0] = up[2] = 0;
    up[1] = -1;
    return false;
}

void orl_scene_upwards(const struct orl_scene *scene, double up[3])
{
    if (scene->ground.height > 0) {
        memcpy(up, scene->ground.plane, 3 * sizeof *up);
        return;
    }
    orl_scene_mean_up(scene, up);
    for (int round = 0; round < ROUNDS; round++)
        turn_up(scene, up);
}

// --- colours ---

// Root mean square, square roots of light. Skies of one day differ by up to 0.08, those of an Internet
// collection by 0.15 (docs/measured/guess.md).
static const double DIFFERENT = 0.1;
enum { SKIES_LEAST = 3 }; // fewer do not tell how days differ

void orl_sky_of_photo(const struct orl_photo *photo, const float gain[3], float root[3])
{
    for (int c = 0; c < 3; c++)
        root[c] = sqrtf(orl_light_aligned(gain[c], photo->sky[c]));
}

size_t orl_skies_mean(const struct orl_scene *scene, const bool *skip, bool aligned, float root[3])
{
    static const float one[3] = {1, 1, 1};
    size_t count = 0;
    memset(root, 0, 3 * sizeof *root);
    for (size_t i = 0; i < scene->photo_count; i++) {
        const struct orl_photo *photo = &scene->photos[i];
        float own[3];
        if (!photo->has_sky || (skip && skip[i]))
            continue;
        orl_sky_of_photo(photo, aligned ? photo->gain : one, own);
        for (int c = 0; c < 3; c++)
            root[c] += own[c];
        count++;
    }
    for (int c = 0; c < 3 && count; c++)
        root[c] /= (float)count;
    return count;
}

bool orl_skies_differ(const struct orl_scene *scene)
{
    float mean[3], own[3];
    double square = 0;
    size_t count = orl_skies_mean(scene, NULL, true, mean);
    for (size_t i = 0; i < scene->photo_count; i++) {
        if (!scene->photos[i].has_sky)
            continue;
        orl_sky_of_photo(&scene->photos[i], scene->photos[i].gain, own);
        for (int c = 0; c < 3; c++)
            square += pow((double)(own[c] - mean[c]), 2) / 3;
    }
    return count >= SKIES_LEAST && sqrt(square / (double)count) >= DIFFERENT;
}
