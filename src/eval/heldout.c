#include "eval/heldout.h"

#include <string.h>

#include "core/color.h"
#include "core/memory.h"
#include "render/output/reexpose.h"
#include "render/photos/photo_loader.h"

enum { METRIC_SIDE = 11 }; // side of SSIM's window, pixels

// --- the photograph ---

enum orl_result orl_heldout_shrink(const struct orl_log *log, const struct orl_image *from, int n,
                                   struct orl_image *to)
{
    float linear[256];
    ORL_TRY(orl_image_init(log, to, from->width / n, from->height / n, 3, ORL_PIXEL_U8));
    for (int i = 0; i < 256; i++)
        linear[i] = orl_srgb_decode((float)i / 255);
    for (int y = 0; y < to->height; y++)
        for (int x = 0; x < to->width; x++)
            for (int c = 0; c < 3; c++) {
                float sum = 0;
                for (int k = 0; k < n * n; k++) {
                    size_t row = (size_t)(y * n + k / n), column = (size_t)(x * n + k % n);
                    sum += linear[from->u8[3 * (row * (size_t)from->width + column) + (size_t)c]];
                }
                to->u8[3 * ((size_t)y * (size_t)to->width + (size_t)x) + (size_t)c] =
                    (uint8_t)(255 * orl_srgb_encode(sum / (float)(n * n)) + 0.5f);
            }
    return ORL_OK;
}

// The camera of the picture from orl_heldout_shrink. Cut-off pixels do not shift the others.
static struct orl_camera shrunk_camera(const struct orl_camera *c, int n)
{
    return (struct orl_camera){.width = c->width / n, .height = c->height / n, .fx = c->fx / n,
                               .fy = c->fy / n, .cx = c->cx / n, .cy = c->cy / n};
}

enum orl_result orl_heldout_load(const struct orl_log *log, const struct orl_scene *scene,
                                 size_t photo, int divide, struct orl_heldout *heldout)
{
    memset(heldout, 0, sizeof *heldout);
    const struct orl_view *view = &scene->photos[photo].view;
    struct orl_image full = {0};
    int n = divide;
    while (n > 1 && (view->camera.width / n < METRIC_SIDE || view->camera.height / n < METRIC_SIDE))
        n--;
    enum orl_result result = orl_photo_read(log, scene, photo, false, &full);
    if (result == ORL_OK && n == 1) {
        heldout->picture = full;
        memset(&full, 0, sizeof full);
    } else if (result == ORL_OK) {
        result = orl_heldout_shrink(log, &full, n, &heldout->picture);
    }
    orl_image_finish(&full);
    heldout->photo = photo;
    heldout->divide = n;
    heldout->view = (struct orl_view){shrunk_camera(&view->camera, n), view->cam_from_world};
    return result;
}

void orl_heldout_finish(struct orl_heldout *heldout)
{
    orl_image_finish(&heldout->picture);
    memset(heldout, 0, sizeof *heldout);
}

size_t orl_heldout_count(const struct orl_scene *scene)
{
    size_t count = 0;
    for (size_t i = 0; i < scene->photo_count; i++)
        count += scene->photos[i].test;
    return count;
}

bool orl_heldout_chosen(const struct orl_scene *scene, bool test, size_t most, size_t photo)
{
    size_t count = 0, at = 0;
    for (size_t i = 0; i < scene->photo_count; i++) {
        bool counts = scene->photos[i].test == test;
        count += counts;
        at += counts && i < photo;
    }
    size_t wanted = most && most < count ? most : count;
    return scene->photos[photo].test == test && (at + 1) * wanted / count > at * wanted / count;
}

// --- the rendering ---

// True when the rendering is at the scene's reference exposure. It then has to be brought to what
// this photograph's camera would show, with a gain estimated without the photograph's pixels
// (expose.h) and the vignetting of its lens.
static bool is_aligned(const struct orl_render_params *render, const struct orl_photo *photo)
{
    bool changed = photo->metering != 0;
    for (int c = 0; c < 3; c++)
        changed = changed || photo->gain[c] != 1 || photo->vignette[c] != 0;
    return changed && render->alignment == ORL_ALIGNMENT_ON &&
           orl_render_option_read(orl_render_option_find("alignment"), render);
}

enum orl_result orl_heldout_expose(const struct orl_log *log, const struct orl_scene *scene,
                                   size_t photo, const struct orl_render_params *render,
                                   struct orl_image *color, struct orl_image *picture)
{
    if (!render)
        return orl_photo_expose(log, scene, photo, color, picture);
    if (is_aligned(render, &scene->photos[photo]))
        orl_photo_unalign(&scene->photos[photo], color);
    return orl_tone_srgb(log, color, picture);
}

enum orl_result orl_heldout_draw(const struct orl_log *log, struct orl_renderer *renderer,
                                 const struct orl_scene *scene, const struct orl_heldout *heldout,
                                 const struct orl_render_params *render, const bool *skip,
                                 struct orl_image *picture, struct orl_image *coverage)
{
    struct orl_frame frame = {0};
    struct orl_render_params params = *render;
    params.leave_out |= coverage ? ORL_LAYER_NORMAL | ORL_LAYER_DEPTH : ~0u;
    *picture = (struct orl_image){0};
    if (coverage)
        *coverage = (struct orl_image){0};
    enum orl_result result = orl_renderer_draw(renderer, &heldout->view, &params, skip, &frame);
    ORL_THEN(result, orl_heldout_expose(log, scene, heldout->photo, render, &frame.color, picture));
    if (result == ORL_OK && coverage) {
        *coverage = frame.coverage;
        frame.coverage = (struct orl_image){0};
    }
    orl_frame_finish(&frame);
    return result;
}
