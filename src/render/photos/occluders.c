#include "io/picture.h"
#include "render/photos/photos.h"
#include "shared/render_blocks.h"

// Depth of all occluders, as a share of the usual distance to what photographs see: before all that
// a view can show.
static const float OCCLUDER_DISTANCE = 0.01f;

enum orl_result orl_occluders_read(const struct orl_log *log, const struct orl_scene *scene,
                                   size_t photo, struct orl_image *mask)
{
    *mask = (struct orl_image){0};
    bool time_step = scene->frame_count > 0 && scene->frame >= 0;
    if (!(scene->photos[photo].occluded > 0) || time_step)
        return ORL_OK;
    return orl_picture_read(log, orl_scene_file(scene, photo, ORL_FILE_OCCLUDERS).text, 1, mask);
}

static void put(const struct frame *frame, size_t photo, const int kept[2], struct orl_tex *mask)
{
    const struct photos *photos = frame->photos;
    struct depth_map_block block = {
        .kept_size = {kept[0], kept[1]},
        .occluder_depth = OCCLUDER_DISTANCE * (float)photos->scene->photo_distance};
    orl_gpu_dispatch(frame->gpu, &(struct orl_dispatch){
        .prog = orl_prog_get(frame->gpu, "proxy/photo_occluders.comp", NULL, NULL), ORL_PARAMS(block),
        .textures = {mask}, .images = {photos->depth}, .layer = photos->states[photo].slot,
        .size = {kept[0], kept[1]}});
}

enum orl_result orl_occluders_put(const struct frame *frame, size_t photo, const int kept[2])
{
    struct orl_image image;
    struct orl_tex *mask = NULL;
    enum orl_result result = orl_occluders_read(orl_gpu_log(frame->gpu), frame->photos->scene,
                                                photo, &image);
    if (result != ORL_OK || image.width == 0)
        return result;
    const struct orl_tex_params params = {.width = image.width, .height = image.height,
                                          .format = GL_R8, .tag = "occluders"};
    result = orl_tex_create(frame->gpu, &params, &mask);
    if (result == ORL_OK) {
        orl_tex_write(mask, GL_RED, GL_UNSIGNED_BYTE, image.u8);
        put(frame, photo, kept, mask);
    }
    orl_tex_destroy(frame->gpu, &mask);
    orl_image_finish(&image);
    return result;
}
