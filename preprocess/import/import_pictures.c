// Undistorted photographs, silhouettes and backgrounds of a single picture or a sequence.
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "io/mask.h"
#include "io/picture.h"
#include "io/exr.h"
#include "scene/colmap.h"
#include "preprocess/import/import_internal.h"
#include "scene/silhouette.h"

enum { JPEG_QUALITY = 97 };

static const struct orl_colmap_camera *camera_of(const struct import_job *job,
                                                 const struct import_view *view)
{
    return &job->known.model.cameras[view->camera];
}

// Path "images/NAME", or "frames/NNNNN/images/NAME" for frame >= 0. Makes its folder.
static enum orl_result output_path(const struct import_job *job, const char *folder, int frame,
                                   const char *name, const char *ending, char path[ORL_PATH_SIZE])
{
    const char *dir = frame < 0 ? job->dir : ORL_PATH(job->dir, "frames/%05d", frame);
    return orl_file_make_folder(job->log, orl_path_print(path, dir, "%s/%s%s", folder, name, ending));
}

// --- writing ---

static enum orl_result undistort(const struct import_job *job, const struct import_view *view,
                                 const char *path, const struct orl_image *image,
                                 struct orl_image *out)
{
    const struct orl_colmap_camera *from = camera_of(job, view);
    if (image->width != from->pinhole.width || image->height != from->pinhole.height)
        return orl_fail(job->log, ORL_ERR_DATA, "%s: %dx%d pixels, but its camera has %dx%d", path,
                        image->width, image->height, from->pinhole.width, from->pinhole.height);
    return orl_undistort(job->log, from, &job->targets[view->camera], image, out);
}

// A picture that needs no change is copied byte for byte, without loss. COLMAP, which may read it from
// the scene, takes PNG of 8 bits alone, and colours as sRGB.
static bool may_copy(const struct import_job *job, const struct import_view *view)
{
    struct orl_picture_info info;
    return view->picture.kind == IMPORT_PICTURE && !view->composed &&
           strcmp(orl_path_name(view->picture.path), orl_path_name(view->name)) == 0 &&
           orl_import_is_same(camera_of(job, view), &job->targets[view->camera]) &&
           orl_picture_inspect(NULL, view->picture.path, &info) == ORL_OK && info.bits <= 8 &&
           !info.profiled;
}

static enum orl_result write_photo(const struct import_job *job, const struct import_view *view,
                                   int frame, const char *path, const struct orl_image *picture)
{
    struct orl_image image = {0};
    char out[ORL_PATH_SIZE];
    ORL_TRY(output_path(job, "images", frame, view->name, "", out));
    if (may_copy(job, view))
        return orl_file_copy(job->log, path, out);
    enum orl_result result = undistort(job, view, path, picture, &image);
    ORL_THEN(result, orl_picture_is_png(view->name) ? orl_png_write(job->log, out, &image)
                                                    : orl_jpeg_write(job->log, out, &image, JPEG_QUALITY, NULL));
    orl_image_finish(&image);
    return result;
}

// Writes the linear light of a photograph with more than 8 bits a sample, beside its 8-bit copy.
static enum orl_result write_linear(const struct import_job *job, const struct import_view *view)
{
    struct orl_picture_info info;
    struct orl_image light = {0}, image = {0};
    char out[ORL_PATH_SIZE];
    const char *path = view->picture.path;
    ORL_TRY(orl_picture_inspect(job->log, path, &info));
    if (info.bits <= 8 || view->composed)
        return ORL_OK;
    ORL_TRY(output_path(job, "images_linear", -1, view->name, ".exr", out));
    enum orl_result result = orl_picture_read_linear(job->log, path, &light);
    ORL_THEN(result, undistort(job, view, path, &light, &image));
    ORL_THEN(result, orl_linear_write(job->log, out, &image));
    orl_image_finish(&light);
    orl_image_finish(&image);
    return result;
}

// Writes the mask of a picture as given (0 or not), undistorted.
static enum orl_result write_mask(const struct import_job *job, const struct import_view *view,
                                  int frame, const char *path, const struct orl_image *mask)
{
    struct orl_image image = {0};
    char out[ORL_PATH_SIZE];
    ORL_TRY(output_path(job, "masks", frame, view->name, ".png", out));
    enum orl_result result = undistort(job, view, path, mask, &image);
    size_t count = result == ORL_OK ? orl_image_bytes(&image) : 0;
    for (size_t i = 0; i < count; i++) // resampling makes intermediate values
        image.u8[i] = image.u8[i] >= 128;
    if (result == ORL_OK) {
        orl_silhouette_mark_edges(&image);
        result = orl_png_write(job->log, out, &image);
    }
    orl_image_finish(&image);
    return result;
}

// --- backgrounds ---

static enum orl_result add_background(const struct import_job *job, const char *path,
                                      struct orl_background *background)
{
    struct orl_image picture;
    enum orl_result result = orl_picture_read(job->log, path, 3, &picture);
    ORL_THEN(result, orl_background_add(job->log, background, &picture));
    orl_image_finish(&picture);
    return result;
}

static enum orl_result learn_background(const struct import_job *job,
                                        const struct import_view *view,
                                        struct orl_background *background)
{
    // All frames of the background count, whatever range of the sequence is wanted.
    const struct orl_frame_range all = {0, 0, 1};
    struct import_frames frames;
    if (view->background.kind == IMPORT_PICTURE)
        return add_background(job, view->background.path, background);
    enum orl_result result = orl_import_frames_open(job, &view->background, &all, &frames);
    for (size_t i = 0; result == ORL_OK && i < frames.count; i++) {
        result = add_background(job, IMPORT_FRAME_PATH(&frames, i), background);
        if (orl_progress_cancelled(job->progress))
            result = ORL_ERR_CANCELLED;
    }
    orl_import_frames_close(job, &frames);
    return result;
}

static enum orl_result write_background(const struct import_job *job,
                                        const struct import_view *view,
                                        const struct orl_background *background)
{
    struct orl_image mean = {0}, image = {0};
    char out[ORL_PATH_SIZE];
    const struct orl_image *from = &background->mean;
    ORL_TRY(output_path(job, "background", -1, view->name, ".png", out));
    enum orl_result result = orl_image_init(job->log, &mean, from->width, from->height, 3, ORL_PIXEL_U8);
    size_t count = result == ORL_OK ? orl_image_bytes(&mean) : 0;
    for (size_t i = 0; i < count; i++)
        mean.u8[i] = (uint8_t)(from->f32[i] + 0.5f);
    ORL_THEN(result, undistort(job, view, view->background.path, &mean, &image));
    ORL_THEN(result, orl_png_write(job->log, out, &image));
    orl_image_finish(&mean);
    orl_image_finish(&image);
    return result;
}

// --- alpha ---

// Lays a picture on white where it has alpha, as programs that render such sets do: the colours under
// its transparent pixels mean nothing. The alpha is its silhouette.
static enum orl_result take_alpha(const struct import_job *job, struct import_view *view,
                                  const char *path, struct orl_image *picture,
                                  struct orl_image *mask)
{
    struct orl_image rgba = {0};
    enum orl_result result = orl_mask_read(job->log, path, true, mask);
    if (result != ORL_OK || !mask->u8)
        return result;
    result = orl_picture_read(job->log, path, 4, &rgba);
    size_t count = result == ORL_OK ? (size_t)rgba.width * (size_t)rgba.height : 0;
    for (size_t i = 0; i < 3 * count; i++) {
        int alpha = rgba.u8[4 * (i / 3) + 3];
        picture->u8[i] = (uint8_t)((picture->u8[i] * alpha + 255 * (255 - alpha) + 127) / 255);
    }
    view->composed = result == ORL_OK;
    orl_image_finish(&rgba);
    return result;
}

// --- one picture ---

static enum orl_result make_mask(const struct import_job *job, const char *path,
                                 const char *mask_path, const struct orl_background *background,
                                 const struct orl_image *picture, struct orl_image *mask)
{
    const struct orl_difference_params difference = {ORL_DIFFERENCE_DEFAULTS};
    int threshold;
    enum orl_result result;
    switch (job->params->silhouettes) {
    case ORL_SILHOUETTES_GIVEN:
        return orl_mask_read(job->log, mask_path, false, mask);
    case ORL_SILHOUETTES_DARK:
        result = orl_silhouette_dark(job->log, picture, job->params->dark_threshold, &threshold,
                                     mask);
        if (result == ORL_OK && job->params->dark_threshold < 0)
            orl_logf(job->log, ORL_LOG_DEBUG, "%s: the subject is above %d", path, threshold);
        return result;
    default:
        return orl_silhouette_difference(job->log, background, &difference, picture, mask);
    }
}

static enum orl_result count_mask(struct import_job *job, const char *path,
                                  const struct orl_image *mask)
{
    job->mask_count++;
    if (orl_mask_count(mask))
        return ORL_OK;
    if (!job->empty_masks++)
        job->first_empty = orl_strdup(job->log, path);
    return job->first_empty ? ORL_OK : ORL_ERR_MEMORY;
}

// A subject may be absent from some pictures.
static enum orl_result judge_masks(const struct import_job *job)
{
    if (!job->empty_masks)
        return ORL_OK;
    if (job->empty_masks == job->mask_count)
        return orl_fail(job->log, ORL_ERR_DATA, "%s: no silhouette has any pixel of the subject, as "
                        "this one%s", job->first_empty,
                        job->params->masks_dir ? ": masks are black where the subject is not" : "");
    orl_logf(job->log, ORL_LOG_WARNING, "%s: %zu of %zu silhouettes are empty, as this one",
             job->first_empty, job->empty_masks, job->mask_count);
    return ORL_OK;
}

static enum orl_result import_picture(struct import_job *job, struct import_view *view,
                                      int frame, const char *path, const char *mask_path,
                                      const struct orl_background *background)
{
    struct orl_image picture = {0}, mask = {0};
    bool stated = job->params->silhouettes == ORL_SILHOUETTES_STATED && !job->sequence;
    enum orl_result result = orl_picture_read(job->log, path, 3, &picture);
    if (result == ORL_OK && stated && orl_picture_is_png(path))
        result = take_alpha(job, view, path, &picture, &mask);
    if (result == ORL_OK && stated && mask_path) {
        orl_image_finish(&mask);
        result = orl_mask_read(job->log, mask_path, false, &mask);
    }
    ORL_THEN(result, write_photo(job, view, frame, path, &picture));
    // The scene's own pictures, shown before a frame is chosen, are those of the first frame.
    if (result == ORL_OK && frame == 0)
        result = write_photo(job, view, -1, path, &picture);
    bool found = job->params->silhouettes > ORL_SILHOUETTES_STATED;
    if (result == ORL_OK && (found || mask.u8)) {
        if (found)
            result = make_mask(job, path, mask_path, background, &picture, &mask);
        view->masked = true;
        ORL_THEN(result, count_mask(job, mask_path ? mask_path : path, &mask));
        ORL_THEN(result, write_mask(job, view, frame, mask_path ? mask_path : path, &mask));
        if (result == ORL_OK && frame == 0)
            result = write_mask(job, view, -1, mask_path ? mask_path : path, &mask);
    }
    orl_image_finish(&picture);
    orl_image_finish(&mask);
    return result;
}

// --- one camera ---

// Refuses what is no picture of a lens: a panorama, or a camera whose undistorted pictures would hold
// next to nothing.
static enum orl_result check_lens(const struct import_job *job, const struct import_view *view,
                                  const char *path)
{
    const double least = 0.05, focal_min = 0.1, corner = 0.45, kept_min = 0.8; // of the side
    const struct orl_camera *from = &camera_of(job, view)->pinhole;
    struct orl_camera to = orl_import_target(camera_of(job, view), 0);
    int larger = from->width > from->height ? from->width : from->height;
    if (from->fx < focal_min * larger)
        return orl_fail(job->log, ORL_ERR_DATA, "%s: a focal length of %.4g pixels for a picture of "
                        "%dx%d, which no lens has: panoramas must be cut into flat views", path,
                        from->fx, from->width, from->height);
    if (to.width < least * from->width || to.height < least * from->height)
        return orl_fail(job->log, ORL_ERR_DATA, "%s: its lens distortion leaves %dx%d of %dx%d "
                        "pixels, which no lens does: its terms (k1, ...) are wrong", path, to.width,
                        to.height, from->width, from->height);
    // Cameras of one file are alike: the first tells.
    if (view != job->views)
        return ORL_OK;
    const double ends[2][2] = {{-to.cx / to.fx, 0}, {(to.width - to.cx) / to.fx, 0}};
    double left[2], right[2];
    orl_colmap_camera_project(camera_of(job, view), ends[0], left);
    orl_colmap_camera_project(camera_of(job, view), ends[1], right);
    double kept = (right[0] - left[0]) / from->width;
    if (kept < kept_min)
        orl_logf(job->log, ORL_LOG_WARNING, "%s: its flat picture keeps %.0f %% of its width: the rest is "
                 "too far from the axis of so wide a lens", path, 100 * kept);
    if (fabs(from->cx / from->width - 0.5) > corner &&
        fabs(from->cy / from->height - 0.5) > corner)
        orl_logf(job->log, ORL_LOG_WARNING, "%s: the principal point of its camera, %.4g, %.4g, is at a "
                 "corner: Oriel takes it in pixels from the upper left corner", path, from->cx, from->cy);
    return ORL_OK;
}

static enum orl_result settle_camera(struct import_job *job, struct import_view *view,
                                     const char *path)
{
    struct orl_picture_info info;
    struct orl_camera *target = &job->targets[view->camera];
    ORL_TRY(orl_picture_inspect(job->log, path, &info));
    if (info.panorama)
        return orl_fail(job->log, ORL_ERR_UNSUPPORTED, "%s: " ORL_PANORAMA_ADVICE, path);
    view->gain_map = info.gain_map;
    if (!job->sequence) // the pixels stay as they are stored; what is upright is known to the scene alone
        view->orientation = info.exif.orientation;
    if (target->width) // known from an earlier picture of the same camera
        return ORL_OK;
    ORL_TRY(orl_known_camera_settle(job->log, &job->known, view->camera, path, info.width, info.height));
    ORL_TRY(check_lens(job, view, path));
    *target = orl_import_target(camera_of(job, view), job->params->max_size);
    return ORL_OK;
}

static enum orl_result import_time_steps(struct import_job *job, struct import_view *view,
                                         const struct import_frames *frames,
                                         const struct import_frames *masks,
                                         const struct orl_background *background)
{
    for (size_t i = 0; i < frames->count; i++) {
        orl_progress_report(job->progress, "import",
                            (double)(view - job->views) + (double)i / (double)frames->count,
                            (double)job->view_count, view->name);
        const char *path = IMPORT_FRAME_PATH(frames, i);
        const char *mask = masks->count > i ? IMPORT_FRAME_PATH(masks, i) : NULL;
        if (orl_progress_cancelled(job->progress))
            return ORL_ERR_CANCELLED;
        if (i == 0)
            ORL_TRY(settle_camera(job, view, path));
        ORL_TRY(import_picture(job, view, (int)i, path, mask, background));
    }
    return ORL_OK;
}

static enum orl_result import_sequence(struct import_job *job, struct import_view *view,
                                       const struct orl_background *background)
{
    struct import_frames frames = {0}, masks = {0};
    const struct orl_frame_range *range = &job->params->frames;
    // Masks of a clip would be decoded into the same folder as the pictures.
    if (view->mask.kind == IMPORT_CLIP)
        return orl_fail(job->log, ORL_ERR_UNSUPPORTED, "%s: masks of a sequence must be folders of "
                        "pictures, as a clip's coding blurs them", view->mask.path);
    enum orl_result result = orl_import_frames_open(job, &view->picture, range, &frames);
    if (result == ORL_OK && view->mask.kind == IMPORT_FOLDER)
        result = orl_import_frames_open(job, &view->mask, range, &masks);
    if (result == ORL_OK && masks.count && masks.count != frames.count)
        result = orl_fail(job->log, ORL_ERR_DATA, "%s: %zu masks, but %zu pictures",
                          view->mask.path, masks.count, frames.count);
    ORL_THEN(result, import_time_steps(job, view, &frames, &masks, background));
    if (result == ORL_OK && job->frame_count && frames.count != job->frame_count)
        orl_logf(job->log, ORL_LOG_WARNING, "%s: %zu pictures, but other cameras have %zu: what "
                 "not all have is left out", view->picture.path, frames.count, job->frame_count);
    if (!job->frame_count || frames.count < job->frame_count)
        job->frame_count = frames.count;
    orl_import_frames_close(job, &masks);
    orl_import_frames_close(job, &frames);
    return result;
}

static enum orl_result import_view(struct import_job *job, struct import_view *view)
{
    struct orl_background background = {0};
    enum orl_result result = ORL_OK;
    if (view->background.kind != IMPORT_NOTHING)
        result = learn_background(job, view, &background);
    if (result == ORL_OK && job->sequence)
        result = import_sequence(job, view, &background);
    else if (result == ORL_OK) {
        result = settle_camera(job, view, view->picture.path);
        ORL_THEN(result, import_picture(job, view, -1, view->picture.path, view->mask.path, &background));
        ORL_THEN(result, write_linear(job, view));
    }
    if (result == ORL_OK && background.count)
        result = write_background(job, view, &background);
    orl_background_finish(&background);
    return result;
}

// Removes frames that some cameras lack.
static enum orl_result drop_surplus(const struct import_job *job)
{
    for (size_t i = job->frame_count;; i++) {
        const char *path = ORL_PATH(job->dir, "frames/%05zu", i);
        if (!orl_path_is_dir(path))
            return ORL_OK;
        ORL_TRY(orl_dir_remove(job->log, path));
    }
}

static void say_unusual(const struct import_job *job)
{
    size_t count = 0, gain_maps = 0, masked = 0;
    for (size_t i = 0; i < job->view_count; i++) {
        count += job->views[i].composed;
        gain_maps += job->views[i].gain_map;
        masked += job->views[i].masked;
    }
    const char *masks = ORL_PATH(job->known.folder, "masks");
    if (!masked && orl_path_is_dir(masks))
        orl_logf(job->log, ORL_LOG_INFO, "%s is not used: --masks names a folder of masks", masks);
    if (gain_maps)
        orl_logf(job->log, ORL_LOG_INFO, ORL_GAIN_MAP_NEWS, gain_maps, job->view_count);
    if (count)
        orl_logf(job->log, ORL_LOG_INFO, "%zu of %zu photographs have alpha: they are laid on white, and alpha "
                 "is their silhouette", count, job->view_count);
}

enum orl_result orl_import_pictures(struct import_job *job)
{
    job->targets = orl_array(job->log, job->known.model.camera_count, sizeof *job->targets);
    ORL_TRY_MEMORY(job->targets);
    for (size_t i = 0; i < job->view_count; i++) {
        if (orl_progress_cancelled(job->progress))
            return ORL_ERR_CANCELLED;
        orl_progress_report(job->progress, "import", (double)i, (double)job->view_count,
                            job->views[i].name);
        ORL_TRY(import_view(job, &job->views[i]));
    }
    if (job->sequence)
        ORL_TRY(drop_surplus(job));
    ORL_TRY(judge_masks(job));
    say_unusual(job);
    orl_progress_report(job->progress, "import", 1, 1, NULL);
    return ORL_OK;
}
