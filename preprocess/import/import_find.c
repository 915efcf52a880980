// Finds the files that belong to each camera.
#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "core/memory.h"
#include "io/picture.h"
#include "io/video.h"
#include "preprocess/import/import_internal.h"
#include "preprocess/job/test_block.h"

static bool is_picture(const char *name)
{
    return orl_path_has_extension(name, "jpg jpeg png pbm pgm pnm") || orl_picture_needs_copy(name);
}

// Length of the name without the extension of a picture or clip. Other dots belong to the name.
static size_t stem_length(const char *name)
{
    const char *dot = strrchr(name, '.');
    return dot && (is_picture(name) || orl_video_is(name)) ? (size_t)(dot - name) : strlen(name);
}

static bool same_text(const char *a, size_t a_length, const char *b, size_t b_length)
{
    return a_length == b_length && strncasecmp(a, b, a_length) == 0;
}

// True for names such as "0001.png" and "0001.jpg.png", which belong to a camera "0001.jpg" or
// "0001". Capitals do not count: other systems change them.
static bool belongs(const char *file, const char *name)
{
    size_t stem = stem_length(file);
    return same_text(file, stem, name, strlen(name)) ||
           same_text(file, stem, name, stem_length(name));
}

// True when the name of one is the beginning of the other's, capitals too.
static bool belongs_exactly(const char *file, const char *name)
{
    size_t stem = stem_length(file);
    return belongs(file, name) && strncmp(file, name, stem) == 0;
}

// True when the file's name contains the camera's name between separators.
static bool contains(const char *file, const char *name)
{
    size_t length = stem_length(name), stem = stem_length(file);
    for (size_t i = 0; i + length <= stem; i++)
        if (strncmp(file + i, name, length) == 0 &&
            (i == 0 || !isalnum((unsigned char)file[i - 1])) &&
            (i + length == stem || !isalnum((unsigned char)file[i + length])))
            return true;
    return false;
}

void orl_import_found_finish(struct import_found *found)
{
    free(found->path);
    *found = (struct import_found){0};
}

static enum orl_result set(const struct orl_log *log, const char *path, enum import_kind kind,
                           struct import_found *found)
{
    orl_import_found_finish(found);
    found->path = orl_strdup(log, path);
    found->kind = found->path ? kind : IMPORT_NOTHING;
    return found->path ? ORL_OK : ORL_ERR_MEMORY;
}

enum orl_result orl_import_list_pictures(const struct orl_log *log, const char *dir,
                                         struct orl_names *names)
{
    struct orl_names all = {0};
    memset(names, 0, sizeof *names);
    enum orl_result result = orl_dir_list(log, dir, &all);
    for (size_t i = 0; result == ORL_OK && i < all.count; i++)
        if (is_picture(all.items[i]))
            result = orl_names_add(log, names, all.items[i]);
    orl_names_finish(&all);
    if (result != ORL_OK)
        orl_names_finish(names);
    return result;
}

// Looks into a camera's own folder: for a clip named after the role, else pictures, else one clip.
static enum orl_result look_inside(const struct orl_log *log, const char *dir, const char *role,
                                   struct import_found *found)
{
    struct orl_names names = {0};
    size_t pictures = 0, clips = 0;
    const char *clip = NULL;
    bool named = false;
    enum orl_result result = orl_dir_list(log, dir, &names);
    for (size_t i = 0; result == ORL_OK && i < names.count; i++) {
        const char *name = names.items[i];
        pictures += is_picture(name);
        if (!orl_video_is(name))
            continue;
        bool this_one = same_text(name, stem_length(name), role, strlen(role));
        if (!named)
            clip = name;
        named = named || this_one;
        clips++;
    }
    if (result == ORL_OK && clip && (named || !pictures)) {
        if (!named && clips > 1)
            result = orl_fail(log, ORL_ERR_DATA, "%s: several clips, none of them named %s", dir,
                              role);
        else
            result = set(log, ORL_PATH(dir, "%s", clip), IMPORT_CLIP, found);
    } else if (result == ORL_OK && pictures) {
        result = set(log, dir, IMPORT_FOLDER, found);
    }
    orl_names_finish(&names);
    return result;
}

static enum orl_result look_loosely(const struct orl_log *log, const char *dir, const char *name,
                                    const struct orl_names *names, struct import_found *found)
{
    const char *only = NULL;
    for (size_t i = 0; i < names->count; i++) {
        if (!is_picture(names->items[i]) || !contains(names->items[i], name))
            continue;
        if (only)
            return orl_fail(log, ORL_ERR_DATA, "%s: both %s and %s may belong to %s", dir, only,
                            names->items[i], name);
        only = names->items[i];
    }
    return only ? set(log, ORL_PATH(dir, "%s", only), IMPORT_PICTURE, found) : ORL_OK;
}

// Looks in `dir` for the files of the camera `name`: a picture of this name with any extension; a
// folder of this name with pictures or a clip (the clip named `role` where there are several); or a
// clip of this name. `loosely`: also a picture whose name contains the camera's. Sets found->kind.
static enum orl_result find_files(const struct orl_log *log, const char *dir, const char *name,
                                  const char *role, bool loosely, struct import_found *found)
{
    struct orl_names names = {0};
    const char *named = ORL_PATH(dir, "%s", name);
    orl_import_found_finish(found);
    if (orl_path_is_file(named) && is_picture(name))
        return set(log, named, IMPORT_PICTURE, found);
    enum orl_result result = orl_dir_list(log, dir, &names);
    for (size_t i = 0; result == ORL_OK && found->kind == IMPORT_NOTHING && i < 2 * names.count; i++) {
        const char *file = names.items[i % names.count];
        if (i < names.count ? !belongs_exactly(file, name) : !belongs(file, name))
            continue;
        const char *path = ORL_PATH(dir, "%s", file);
        if (orl_path_is_dir(path))
            result = look_inside(log, path, role, found);
        else if (orl_path_is_file(path) && (is_picture(file) || orl_video_is(file))) // no link to nowhere
            result = set(log, path, orl_video_is(file) ? IMPORT_CLIP : IMPORT_PICTURE, found);
    }
    if (result == ORL_OK && loosely && found->kind == IMPORT_NOTHING)
        result = look_loosely(log, dir, name, &names, found);
    orl_names_finish(&names);
    if (result != ORL_OK)
        orl_import_found_finish(found);
    return result;
}

// --- all cameras ---

// Looks for the last part of a path in the folder that leads to it. A folder that is not there has
// nothing.
static enum orl_result find_below(const struct import_job *job, const char *dir, const char *path,
                                  struct import_found *found)
{
    const char *base = orl_path_name(path);
    const char *folder = ORL_PATH(*path == '/' ? "" : dir, "%.*s", (int)(base - path), path);
    return orl_path_is_dir(folder) ? find_files(job->log, folder, base, "video", false, found) : ORL_OK;
}

// Sets `dir` to the first folder beside the cameras that has the first camera's picture, else to the cameras' folder.
static enum orl_result look_for_folder(const struct import_job *job, char dir[ORL_PATH_SIZE])
{
    const struct orl_log *log = job->log;
    const char *folder = job->known.folder, *name = job->known.model.images[0].name;
    struct orl_names names = {0};
    struct import_found found = {0};
    enum orl_result result = find_below(job, folder, name, &found);
    bool here = found.kind != IMPORT_NOTHING;
    if (result == ORL_OK && !here)
        result = orl_dir_list(log, folder, &names);
    for (size_t i = 0; result == ORL_OK && found.kind == IMPORT_NOTHING && i < names.count; i++)
        if (orl_path_is_dir(orl_path_print(dir, folder, "%s", names.items[i])))
            result = find_below(job, dir, name, &found);
    if (here || found.kind == IMPORT_NOTHING)
        orl_path_print(dir, "", "%s", folder);
    orl_import_found_finish(&found);
    orl_names_finish(&names);
    return result;
}

// Chooses the folder of pictures: the given one, else images/ beside the cameras, or beside sparse/ where
// a model in it was named, else another one beside the cameras, else the cameras' folder.
static enum orl_result choose_folder(const struct import_job *job, char dir[ORL_PATH_SIZE])
{
    static const char *const places[] = {"images", "../images", "../../images"};
    const char *told = job->params->images_dir;
    size_t tries = job->known.pictures ? 1 : ORL_COUNT(places); // COLMAP's models name no paths
    bool chosen = told != NULL;
    if (told)
        orl_path_print(dir, "", "%s", told);
    for (size_t i = 0; !chosen && i < tries; i++)
        chosen = orl_path_is_dir(orl_path_print(dir, job->known.folder, "%s", places[i]));
    if (!chosen)
        ORL_TRY(look_for_folder(job, dir));
    return orl_path_is_dir(dir) ? ORL_OK
                                : orl_fail(job->log, ORL_ERR_NOT_FOUND, "--images %s: no such folder", dir);
}

// True when no other camera's name has the same last part.
static bool is_only_name(const struct import_job *job, const char *base)
{
    const struct orl_colmap_model *model = &job->known.model;
    size_t count = 0;
    for (size_t i = 0; i < model->image_count && count < 2; i++)
        count += strcmp(orl_path_name(model->images[i].name), base) == 0;
    return count == 1;
}

// Finds a camera's picture by the camera's name, else by the path in the file of cameras, unless the
// user named the folder: that file may be a stranger's. Else the last part of the name will do.
static enum orl_result find_picture(const struct import_job *job, const char *dir,
                                    const struct orl_colmap_image *image,
                                    struct import_found *found)
{
    const struct orl_known_cameras *known = &job->known;
    const char *told = known->pictures ? known->pictures[image->id - 1].path : image->name;
    const char *base = orl_path_name(image->name);
    ORL_TRY(find_below(job, dir, image->name, found));
    if (found->kind == IMPORT_NOTHING && strchr(told, '/') && !job->params->images_dir)
        ORL_TRY(find_below(job, known->folder, told, found));
    if (found->kind == IMPORT_NOTHING && base != image->name && is_only_name(job, base))
        ORL_TRY(find_files(job->log, dir, base, "video", false, found));
    return ORL_OK;
}

// True when the file of cameras puts a photograph there. What the user says of held-out photographs
// replaces what the file says.
static bool goes_to(const struct import_job *job, const struct orl_colmap_image *image,
                    enum orl_known_split split)
{
    const struct orl_names *list = job->params->test_list;
    const struct orl_test_block *block = &job->params->test_block;
    return job->known.splits && !job->params->test_every && !(list && list->count) &&
           block->first == block->end && job->known.pictures[image->id - 1].split == split;
}

// A file that is empty or no picture is warned of, like one that is missing.
static bool is_broken(const struct import_job *job, const struct import_found *found)
{
    struct orl_picture_info info;
    if (found->kind != IMPORT_PICTURE || orl_picture_inspect(NULL, found->path, &info) != ORL_ERR_FORMAT)
        return false;
    orl_logf(job->log, ORL_LOG_WARNING, "%s: not a picture that can be read: left out", found->path);
    return true;
}

static enum orl_result find_pictures(struct import_job *job, const char *dir)
{
    const struct orl_colmap_model *model = &job->known.model;
    enum orl_result result = ORL_OK;
    size_t missing = 0, unused = 0;
    const char *missed = NULL;
    job->views = orl_array(job->log, model->image_count, sizeof *job->views);
    job->why_not = orl_array(job->log, model->image_count, sizeof *job->why_not);
    ORL_TRY_MEMORY(job->views && job->why_not);
    for (size_t i = 0; result == ORL_OK && i < model->image_count; i++) {
        struct import_view *view = &job->views[job->view_count];
        const struct orl_colmap_image *image = &model->images[i];
        if (goes_to(job, image, ORL_KNOWN_UNUSED)) {
            job->why_not[i] = "neither for training nor for testing";
            unused++;
            continue;
        }
        view->image = image;
        view->camera = (size_t)(orl_colmap_camera_by_id(model, image->camera_id) - model->cameras);
        result = find_picture(job, dir, image, &view->picture);
        if (view->picture.kind == IMPORT_NOTHING) {
            missed = image->name;
            job->why_not[i] = "no picture";
            missing++;
        } else if (is_broken(job, &view->picture)) {
            orl_import_found_finish(&view->picture);
            job->why_not[i] = "its picture cannot be read";
        } else {
            job->view_count++;
        }
    }
    if (result == ORL_OK && job->view_count < 2)
        result = orl_fail(job->log, ORL_ERR_NOT_FOUND, "%s: pictures of %zu of %zu cameras can be "
                          "used%s%s; two are needed; --images names their folder", dir, job->view_count,
                          model->image_count, missed ? "; missing: " : "", missed ? missed : "");
    else if (result == ORL_OK && missing)
        orl_logf(job->log, ORL_LOG_WARNING, "%s: no picture for %zu of %zu cameras, as %s: left "
                 "out", dir, missing, model->image_count, missed);
    if (result == ORL_OK && unused)
        orl_logf(job->log, ORL_LOG_INFO, "%zu of %zu photographs are neither for training nor for "
                 "testing, as the cameras' file says: left out", unused, model->image_count);
    return result;
}

// A JPEG or PNG keeps its name, since every COLMAP tool reads these formats.
static enum orl_result name_view(const struct import_job *job, struct import_view *view)
{
    const char *name = view->image->name;
    const char *file = orl_path_name(view->picture.path);
    const char *base = orl_path_name(name);
    bool keep = view->picture.kind == IMPORT_PICTURE && orl_path_has_extension(file, "jpg jpeg png");
    // The view keeps the folders in the camera's name and takes the extension of the file.
    view->name = keep ? orl_format(job->log, "%.*s%s", (int)(base - name), name, file)
                      : orl_format(job->log, "%.*s%.*s.jpg", (int)(base - name), name,
                                   (int)stem_length(base), base);
    return view->name ? ORL_OK : ORL_ERR_MEMORY;
}

static int compare_views(const void *a, const void *b)
{
    return strcmp(((const struct import_view *)a)->name, ((const struct import_view *)b)->name);
}

static enum orl_result name_views(struct import_job *job)
{
    job->sequence = job->views[0].picture.kind != IMPORT_PICTURE;
    for (size_t i = 0; i < job->view_count; i++) {
        struct import_view *view = &job->views[i];
        if ((view->picture.kind != IMPORT_PICTURE) != job->sequence)
            return orl_fail(job->log, ORL_ERR_DATA, "%s is %s, but %s is %s", view->picture.path,
                            job->sequence ? "one picture" : "a sequence",
                            job->views[0].picture.path, job->sequence ? "a sequence" : "one");
        ORL_TRY(name_view(job, view));
    }
    qsort(job->views, job->view_count, sizeof *job->views, compare_views);
    for (size_t i = 1; i < job->view_count; i++)
        if (strcmp(job->views[i].name, job->views[i - 1].name) == 0)
            return orl_fail(job->log, ORL_ERR_DATA, "two cameras have the picture %s",
                            job->views[i].name);
    return ORL_OK;
}

static enum orl_result hold_out(struct import_job *job)
{
    const struct orl_import_params *params = job->params;
    size_t test = 0;
    ORL_TRY(orl_test_block_check(job->log, params->test_block, job->view_count));
    for (size_t i = 0; i < job->view_count; i++)
        job->views[i].test = goes_to(job, job->views[i].image, ORL_KNOWN_TEST);
    for (int i = params->test_block.first; i < params->test_block.end; i++)
        job->views[i].test = true;
    for (size_t i = 0; params->test_every && i < job->view_count; i += (size_t)params->test_every)
        job->views[i].test = true;
    for (size_t n = 0; params->test_list && n < params->test_list->count; n++) {
        const char *given = params->test_list->items[n];
        bool found = false;
        for (size_t i = 0; i < job->view_count; i++)
            if (strcmp(job->views[i].name, given) == 0 || belongs(job->views[i].name, given))
                found = job->views[i].test = true;
        if (!found)
            return orl_fail(job->log, ORL_ERR_ARGUMENT, "--test-list %s: no photograph of this "
                            "name", given);
    }
    for (size_t i = 0; i < job->view_count; i++)
        test += job->views[i].test;
    return job->view_count - test >= 2
               ? ORL_OK
               : orl_fail(job->log, ORL_ERR_ARGUMENT, "%zu of %zu photographs held out: at least "
                          "two must remain", test, job->view_count);
}

// Looks for the companion of the camera "front/0001.jpg" in front/, else for "front_0001", else, where
// no other camera has this name, for "0001".
static enum orl_result find_companion(const struct import_job *job, const char *dir,
                                      const char *role, const char *name,
                                      struct import_found *found)
{
    const char *base = orl_path_name(name);
    const char *inside = ORL_PATH(dir, "%.*s", (int)(base - name), name);
    char flat[ORL_PATH_SIZE];
    orl_path_print(flat, "", "%s", name);
    for (char *c = flat; *c; c++)
        if (*c == '/')
            *c = '_';
    if (base != name && orl_path_is_dir(inside))
        ORL_TRY(find_files(job->log, inside, base, role, true, found));
    if (base != name && found->kind == IMPORT_NOTHING)
        ORL_TRY(find_files(job->log, dir, flat, role, true, found));
    if (found->kind == IMPORT_NOTHING && is_only_name(job, base))
        ORL_TRY(find_files(job->log, dir, base, role, true, found));
    return ORL_OK;
}

// Finds masks or backgrounds, of which every camera must have one.
static enum orl_result find_companions(struct import_job *job, const char *option, const char *dir)
{
    if (!orl_path_is_dir(dir))
        return orl_fail(job->log, ORL_ERR_NOT_FOUND, "--%s %s: no such folder", option, dir);
    bool masks = strcmp(option, "masks") == 0;
    for (size_t i = 0; i < job->view_count; i++) {
        struct import_view *view = &job->views[i];
        struct import_found *found = masks ? &view->mask : &view->background;
        ORL_TRY(find_companion(job, dir, option, view->image->name, found));
        if (found->kind == IMPORT_NOTHING)
            return orl_fail(job->log, ORL_ERR_NOT_FOUND, "--%s %s: nothing here for the camera "
                            "%s", option, dir, view->image->name);
        if (masks && job->sequence == (found->kind == IMPORT_PICTURE))
            return orl_fail(job->log, ORL_ERR_DATA, "%s: a sequence needs a sequence of masks, "
                            "and a picture one", found->path);
    }
    return ORL_OK;
}

// Finds the masks that the file of cameras names. A picture without one is whole.
static enum orl_result find_stated_masks(struct import_job *job)
{
    const struct orl_known_cameras *known = &job->known;
    size_t missing = 0;
    for (size_t i = 0; known->pictures && i < job->view_count; i++) {
        struct import_view *view = &job->views[i];
        const char *told = known->pictures[view->image->id - 1].mask;
        char path[ORL_PATH_SIZE];
        if (told && orl_known_find(known->folder, told, path))
            ORL_TRY(set(job->log, path, IMPORT_PICTURE, &view->mask));
        else
            missing += told != NULL;
    }
    if (missing)
        orl_logf(job->log, ORL_LOG_WARNING, "%s: masks of %zu of %zu cameras, which their file names, are not "
                 "here", known->folder, missing, job->view_count);
    return ORL_OK;
}

enum orl_result orl_import_find_all(struct import_job *job)
{
    char dir[ORL_PATH_SIZE];
    ORL_TRY(choose_folder(job, dir));
    ORL_TRY(find_pictures(job, dir));
    ORL_TRY(name_views(job));
    ORL_TRY(hold_out(job));
    if (job->params->silhouettes == ORL_SILHOUETTES_STATED && !job->sequence)
        ORL_TRY(find_stated_masks(job));
    if (job->params->masks_dir)
        ORL_TRY(find_companions(job, "masks", job->params->masks_dir));
    if (job->params->background)
        ORL_TRY(find_companions(job, "background", job->params->background));
    return ORL_OK;
}
