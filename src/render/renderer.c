// Renders a frame: surface, painter, post passes, read-back.
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "render/frame/method.h"
#include "render/hull/prefetch.h"
#include "render/internal.h"
#include "render/paint/paint.h"
#include "render/papers/room.h"
#include "render/photos/photos.h"
#include "render/proxy/proxy.h"
#include "render/proxy/splats.h"

enum { PROXIES_MAX = 4 };

// The state that outlives a frame.
struct orl_renderer {
    struct orl_gpu *gpu;
    const struct orl_scene *scene;
    struct proxy proxies[PROXIES_MAX]; // of the kinds used so far; the first is the points
    size_t proxy_count;
    struct photos photos;
    struct paint paint;
    struct orl_tex *picture;  // of struct frame
    struct orl_tex *room;     // papers/room.h; NULL: it is not shown
    struct orl_tex *mean;     // reconstructions.c; NULL: a frame is one picture
    size_t *chosen;           // memory of struct frame's list
    float (*selected)[4];
    struct orl_image staging; // for read_back.c
    size_t point_bytes;       // of device memory for points that come as they are needed; 0: any
    int expected;             // time step after the next frame's; -1: none is expected
    struct prefetch *prefetch;      // what is prepared for it; NULL: nothing
};

// Device memory of everything but photographs: points, and targets of common sizes.
static size_t fixed_bytes(const struct orl_scene *scene, const struct cloud *cloud)
{
    int width = 1, height = 1;
    for (size_t i = 0; i < scene->photo_count; i++) {
        const struct orl_camera *c = &scene->photos[i].view.camera;
        width = c->width > width ? c->width : width;
        height = c->height > height ? c->height : height;
    }
    return orl_cloud_bytes(cloud) + 2 * orl_splats_target_bytes(cloud, width, height) +
           (size_t)width * (size_t)height * (16 + 38 + 20);
}

static size_t photo_budget(const struct orl_renderer *r, size_t max_vram_bytes)
{
    size_t fixed = fixed_bytes(r->scene, r->proxies[0].state);
    size_t budget = max_vram_bytes > fixed ? max_vram_bytes - fixed : 1;
    orl_logf(orl_gpu_log(r->gpu), ORL_LOG_INFO,
             "device memory: %zu MiB allowed, %zu MiB for points and targets, %zu MiB for "
             "photographs", max_vram_bytes >> 20, fixed >> 20, budget >> 20);
    return budget;
}

// The proxy of this kind, made when it is first asked for.
static enum orl_result find_proxy(struct orl_renderer *r, const struct orl_proxy_kind *kind,
                                  struct proxy **proxy)
{
    for (size_t i = 0; i < r->proxy_count; i++) {
        *proxy = &r->proxies[i];
        if ((*proxy)->kind == kind)
            return ORL_OK;
    }
    ORL_REQUIRE(orl_gpu_log(r->gpu), r->proxy_count < PROXIES_MAX);
    *proxy = &r->proxies[r->proxy_count];
    ORL_TRY(orl_proxy_create(r->gpu, r->scene, kind, r->point_bytes, *proxy));
    r->proxy_count++;
    return ORL_OK;
}

enum orl_result orl_renderer_create(struct orl_gpu *gpu, const struct orl_scene *scene,
                                    const struct orl_renderer_params *params,
                                    struct orl_renderer **out)
{
    static const struct orl_renderer_params defaults = {0};
    const struct orl_log *log = orl_gpu_log(gpu);
    *out = NULL;
    params = params ? params : &defaults;
    struct orl_renderer *r = orl_array(log, 1, sizeof *r);
    ORL_TRY_MEMORY(r);
    r->gpu = gpu;
    r->scene = scene;
    r->expected = -1;
    r->chosen = orl_array(log, scene->photo_count, sizeof *r->chosen);
    r->selected = orl_array(log, scene->photo_count, sizeof *r->selected);
    // Photographs take more than points do where both come as they are needed.
    r->point_bytes = scene->lod ? params->max_vram_bytes / 3 : 0;
    struct proxy *splats;
    enum orl_result result = r->chosen && r->selected ? ORL_OK : ORL_ERR_MEMORY;
    ORL_THEN(result, find_proxy(r, &orl_proxy_splats, &splats));
    if (result == ORL_OK)
        result = orl_photos_init(gpu, scene, params,
                                 params->max_vram_bytes ? photo_budget(r, params->max_vram_bytes)
                                                        : 0, &r->photos);
    ORL_THEN(result, orl_paint_init(gpu, scene->photo_count, &r->paint));
    if (result != ORL_OK)
        orl_renderer_destroy(&r);
    *out = r;
    return result;
}

void orl_renderer_destroy(struct orl_renderer **renderer)
{
    struct orl_renderer *r = *renderer;
    if (!r)
        return;
    for (size_t i = 0; i < r->proxy_count; i++)
        orl_proxy_finish(r->gpu, &r->proxies[i]);
    orl_prefetch_destroy(r->gpu, &r->prefetch);
    orl_photos_finish(r->gpu, &r->photos);
    orl_paint_finish(r->gpu, &r->paint);
    orl_tex_destroy(r->gpu, &r->room);
    orl_image_finish(&r->staging);
    orl_tex_destroy(r->gpu, &r->picture);
    orl_tex_destroy(r->gpu, &r->mean);
    free(r->chosen);
    free(r->selected);
    free(r);
    *renderer = NULL;
}

void orl_renderer_expect(struct orl_renderer *renderer, int time_step)
{
    renderer->expected = time_step;
}

size_t orl_renderer_uploaded(const struct orl_renderer *renderer)
{
    return renderer->photos.uploaded;
}

static enum orl_result resize(struct orl_renderer *r, const struct frame *frame)
{
    ORL_TRY(orl_paint_resize(frame));
    ORL_TRY(orl_frame_target(frame, "accumulated colour", true,
                             frame->finishes ? GL_RGBA16F : GL_RGBA32F, &r->picture));
    ORL_TRY(orl_frame_target(frame, "room", frame->params->fill == ORL_FILL_ROOM, GL_RGBA32F, &r->room));
    return orl_frame_target(frame, "mean of pictures", orl_reconstruction_count(frame) > 1,
                            GL_RGBA32F, &r->mean);
}

// Draws the surface that the view sees. `params`: the frame's, or those of one reconstruction.
static enum orl_result draw_surface(struct frame *frame, const struct orl_render_params *params)
{
    return orl_proxy_draw(frame->gpu, frame->proxy, frame->view, params, frame->normals,
                          &frame->proxy->view_target, &frame->surface);
}

static enum orl_result draw_picture(struct orl_renderer *r, struct frame *frame,
                                    const struct orl_render_params *params)
{
    const struct orl_painter *painter = frame->params->paint;
    size_t absent = 0;
    ORL_TRY(draw_surface(frame, params));
    if (orl_params_guess(frame->params) && painter != &orl_paint_points)
        orl_fill_depth(frame);
    if (r->room)
        ORL_TRY(orl_room_paint(frame, r->room, &absent));
    ORL_TRY(painter->paint(frame));
    if (frame->progressive) // those that came with this frame are in the next one's room
        frame->progressive->missing += absent;
    if (r->room)
        orl_room_show(frame, r->room);
    return orl_compose(frame);
}

static enum orl_result draw(struct orl_renderer *r, struct frame *frame, bool normals)
{
    const struct orl_painter *painter = frame->params->paint;
    int count = orl_reconstruction_count(frame), done = 0;
    enum orl_result result = ORL_OK;
    const struct orl_view *whole = frame->view;
    frame->normals = normals || orl_params_guess(frame->params) || orl_progressive_underpaints(frame) ||
                     (painter->reads_normals && painter->reads_normals(frame));
    for (; result == ORL_OK && done < count; done++) {
        struct orl_render_params params = *frame->params;
        struct orl_view view = *whole;
        orl_reconstruction_vary(done, count, &params, &view.camera);
        frame->view = &view;
        result = draw_picture(r, frame, &params);
        frame->view = whole;
        // A frame that lacks photographs is soon drawn again.
        if (frame->progressive && frame->progressive->missing > 0)
            break;
        if (result == ORL_OK && count > 1)
            orl_reconstruction_add(frame, r->mean, done, count);
    }
    if (result == ORL_OK && done > 1) // what is read back beside the picture is the scene's own
        result = draw_surface(frame, frame->params);
    return result;
}

static struct frame start_frame(struct orl_renderer *r, struct proxy *proxy,
                                const struct orl_view *view,
                                const struct orl_render_params *params, const bool *skip)
{
    return (struct frame){
        .gpu = r->gpu, .scene = r->scene, .view = view, .params = params, .skip = skip,
        .radiance = r->photos.radiance, .reads_chroma = r->photos.chroma != NULL,
        .finishes = params->paint->finishes && !r->photos.radiance,
        .proxy = proxy, .photos = &r->photos,
        .paint = &r->paint, .chosen = r->chosen, .selected = r->selected};
}

// Draws and reads back the frame, whose proxy is up to date. With `next`, prepares that time step
// meanwhile: its hull is carved before the read-back waits for the device.
static enum orl_result finish_frame(struct orl_renderer *r, struct frame *frame, bool normals,
                                    struct prefetch *next, struct orl_frame *out)
{
    enum orl_result result = draw(r, frame, normals);
    if (result == ORL_OK && next) {
        orl_prefetch_want(next, frame->chosen, frame->chosen_count);
        orl_pass_begin(r->gpu, "next hull");
        result = orl_prefetch_carve(r->gpu, next);
        orl_pass_end(r->gpu);
    }
    if (result == ORL_OK && out)
        result = orl_read_back(frame, &r->staging, out);
    ORL_THEN(result, orl_gpu_finish(r->gpu));
    if (result == ORL_OK && next)
        result = orl_prefetch_collect(r->gpu, next);
    return result;
}

// Brings everything that the frame needs besides photographs up to date.
static enum orl_result ready_frame(struct orl_renderer *r, struct frame *frame)
{
    orl_photos_follow_time_step(&r->photos);
    if (r->prefetch && orl_prefetch_time_step(r->prefetch) == r->scene->frame)
        frame->prefetch = r->prefetch;
    orl_prefetch_show(frame->prefetch, &r->photos);
    enum orl_result result = orl_proxy_update(frame);
    r->photos.depth_key = orl_photos_depth_key(frame);
    ORL_THEN(result, resize(r, frame));
    frame->picture = r->picture;
    return result;
}

static enum orl_result render(struct orl_renderer *r, const struct orl_view *view,
                              const struct orl_render_params *params, const bool *skip,
                              struct orl_progressive *progressive, struct orl_frame *out)
{
    const struct orl_log *log = orl_gpu_log(r->gpu);
    if (out)
        memset(out, 0, sizeof *out);
    if (!orl_camera_valid(&view->camera))
        return orl_fail(log, ORL_ERR_ARGUMENT, "this camera cannot be rendered: %dx%d, focal %g %g",
                        view->camera.width, view->camera.height, view->camera.fx, view->camera.fy);
    ORL_TRY(orl_render_params_check(log, params));
    struct proxy *proxy;
    struct prefetch *next = NULL;
    ORL_TRY(find_proxy(r, params->proxy, &proxy));
    struct frame frame = start_frame(r, proxy, view, params, skip);
    frame.progressive = progressive;
    r->paint.soft.shows = params->soft > 0 && frame.finishes;
    enum orl_result result = ready_frame(r, &frame);
    if (result == ORL_OK && r->expected >= 0 && r->expected != r->scene->frame)
        result = orl_prefetch_create(&frame, r->expected, &next);
    ORL_THEN(result, finish_frame(r, &frame, out && !(params->leave_out & ORL_LAYER_NORMAL), next, out));
    // Where small maps are kept to save memory, they are picked from ones that take more than all.
    if (r->scene->defaults.depth_divide > 1)
        orl_proxy_free_photo_target(r->gpu, proxy);
    r->expected = -1;
    orl_prefetch_destroy(r->gpu, &r->prefetch);
    r->prefetch = next;
    if (result != ORL_OK && out)
        orl_frame_finish(out);
    return result;
}

enum orl_result orl_renderer_draw(struct orl_renderer *r, const struct orl_view *view,
                                  const struct orl_render_params *params, const bool *skip,
                                  struct orl_frame *out)
{
    return render(r, view, params, skip, NULL, out);
}

enum orl_result orl_renderer_draw_progressive(struct orl_renderer *r, const struct orl_view *view,
                                              const struct orl_render_params *params,
                                              struct orl_progressive *progress,
                                              struct orl_frame *out)
{
    progress->missing = 0; // methods without photographs miss none
    progress->spent = 0;
    return render(r, view, params, NULL, progress, out);
}
