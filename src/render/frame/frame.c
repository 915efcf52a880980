#include "render/frame/frame.h"

#include <math.h>
#include <string.h>

#include "scene/ground_plane.h"
#include "shared/constants.h"

enum orl_result orl_frame_target(const struct frame *frame, const char *tag, bool wanted, GLenum format,
                                 struct orl_tex **tex)
{
    const struct orl_camera *camera = &frame->view->camera;
    const struct orl_tex_params params = {.width = camera->width, .height = camera->height, .format = format,
                                          .tag = tag};
    if (wanted)
        return orl_tex_fit(frame->gpu, &params, tex);
    orl_tex_destroy(frame->gpu, tex);
    return ORL_OK;
}

void orl_frame_finish(struct orl_frame *frame)
{
    orl_image_finish(&frame->color);
    orl_image_finish(&frame->depth);
    orl_image_finish(&frame->normal);
    orl_image_finish(&frame->coverage);
    orl_image_finish(&frame->confidence);
}

bool orl_params_guess(const struct orl_render_params *params)
{
    return params->fill == ORL_FILL_DEPTH || params->fill == ORL_FILL_GROUND;
}

double orl_frame_footprint(const struct frame *frame)
{
    const struct orl_scene *scene = frame->scene;
    double sum = 0, count = 0;
    for (size_t i = 0; i < scene->photo_count; i++) {
        sum += scene->photos[i].test ? 0 : scene->photos[i].view.camera.fx;
        count += !scene->photos[i].test;
    }
    return count > 0 ? fmax(sum / count / frame->view->camera.fx, 1) : 1;
}

void orl_frame_ground(const struct frame *frame, float out[4])
{
    const struct orl_ground *ground = &frame->scene->ground;
    double inverse[3];
    memset(out, 0, 4 * sizeof *out);
    if (frame->params->fill != ORL_FILL_GROUND ||
        !orl_ground_along_rays(ground, frame->view, inverse))
        return;
    for (int k = 0; k < 3; k++)
        out[k] = (float)inverse[k];
    out[3] = (float)(1 / (ORL_GROUND_REACH * ground->height));
}

void orl_set_pose(const struct orl_pose *pose, float rotation[3][4], float eye[4])
{
    double centre[3];
    orl_pose_centre(pose, centre);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            rotation[i][j] = (float)pose->r[i][j];
        eye[i] = (float)centre[i];
    }
}

void orl_set_focal(const struct orl_camera *camera, float focal[4])
{
    focal[0] = (float)camera->fx;
    focal[1] = (float)camera->fy;
    focal[2] = (float)camera->cx;
    focal[3] = (float)camera->cy;
}
