// An environment map, as Blender and game engines light scenes with: all directions from one
// photograph's place, in radiance.
#include <math.h>

#include "core/vec3.h"
#include "exchange/kinds.h"
#include "oriel/hdr.h"
#include "render/output/output.h"

enum { WIDTH = 2048 };

// The training photograph nearest to the middle of all.
static const char *middlemost(const struct orl_scene *scene)
{
    double sum[3] = {0}, least = INFINITY;
    size_t count = 0;
    const char *name = NULL;
    for (size_t i = 0; i < scene->photo_count; i++) {
        double eye[3];
        orl_pose_centre(&scene->photos[i].view.cam_from_world, eye);
        count += !scene->photos[i].test;
        for (int k = 0; k < 3 && !scene->photos[i].test; k++)
            sum[k] += eye[k];
    }
    for (size_t i = 0; i < scene->photo_count; i++) {
        double off[3];
        orl_pose_centre(&scene->photos[i].view.cam_from_world, off);
        for (int k = 0; k < 3; k++)
            off[k] -= sum[k] / (double)count;
        if (!scene->photos[i].test && orl_dot3(off, off) < least) {
            least = orl_dot3(off, off);
            name = scene->photos[i].name;
        }
    }
    return name;
}

static enum orl_result draw(struct orl_gpu *gpu, const struct orl_scene *scene,
                            const struct orl_panorama *panorama, struct orl_frame *frame)
{
    const struct orl_log *log = orl_gpu_log(gpu);
    const struct orl_method *method = orl_method_find(log, orl_method_default(scene));
    struct orl_hdr_params params = {ORL_HDR_DEFAULTS};
    struct orl_hdr *hdr = NULL;
    if (!method)
        return ORL_ERR_ARGUMENT;
    orl_render_params_tuned(log, method, scene, &params.render);
    params.render.sample = ORL_SAMPLE_RADIANCE;
    enum orl_result result = orl_hdr_create(gpu, scene, &params, &hdr);
    ORL_THEN(result, orl_hdr_draw_panorama(hdr, panorama, NULL, frame));
    orl_hdr_destroy(&hdr);
    return result;
}

ORL_EXPORT_WRITER(orl_export_hdri)
{
    const char *at = params->at ? params->at : middlemost(scene);
    int width = params->width ? params->width : WIDTH;
    struct orl_panorama panorama = {.width = width, .height = width / 2};
    struct orl_frame_output output = {ORL_FRAME_OUTPUT_DEFAULTS};
    struct orl_gpu *gpu = NULL;
    struct orl_frame frame = {0};
    struct orl_view view;
    (void)progress;
    if (!orl_frame_can_write(params->out))
        return orl_fail(log, ORL_ERR_ARGUMENT, "--out %s: must end in .exr or .png", params->out);
    enum orl_result result = orl_panorama_place(log, scene, at, &panorama);
    ORL_THEN(result, orl_gpu_create(log, &(struct orl_gpu_params){.shader_dir = params->shader_dir}, &gpu));
    ORL_THEN(result, draw(gpu, scene, &panorama, &frame));
    if (result == ORL_OK) {
        output.attributes.latlong = orl_panorama_view(&panorama, &view);
        result = orl_frame_write(log, params->out, &view, &frame, &output);
    }
    orl_frame_finish(&frame);
    orl_gpu_destroy(&gpu);
    return result;
}
