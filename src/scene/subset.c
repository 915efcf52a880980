#include "scene/subset.h"

#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/json.h"
#include "core/memory.h"
#include "scene/colmap.h"

// Copies a file of the scene to the same place in `dir`, if the file exists. `path` begins with the
// scene's folder.
static enum orl_result copy_if_there(const struct orl_log *log, const struct orl_scene *scene,
                                     const char *path, const char *dir)
{
    const char *inside = path + strlen(scene->dir);
    return orl_path_is_file(path) ? orl_file_copy(log, path, ORL_PATH(dir, "%s", inside + strspn(inside, "/")))
                                  : ORL_OK;
}

enum orl_result orl_subset_copy_masks(const struct orl_log *log, const struct orl_scene *scene,
                                      size_t photo, const char *dir)
{
    ORL_TRY(copy_if_there(log, scene, orl_scene_file(scene, photo, ORL_FILE_MASK).text, dir));
    ORL_TRY(copy_if_there(log, scene, orl_scene_file(scene, photo, ORL_FILE_BACKGROUND).text, dir));
    return copy_if_there(log, scene, orl_scene_file(scene, photo, ORL_FILE_OCCLUDERS).text, dir);
}

enum orl_result orl_subset_copy_photo(const struct orl_log *log, const struct orl_scene *scene,
                                      size_t photo, const char *dir)
{
    ORL_TRY(copy_if_there(log, scene, orl_scene_file(scene, photo, ORL_FILE_PHOTO).text, dir));
    ORL_TRY(copy_if_there(log, scene, orl_scene_file(scene, photo, ORL_FILE_LINEAR).text, dir));
    return orl_subset_copy_masks(log, scene, photo, dir);
}

// --- the sparse model ---

// Writes the images of `all` that stay. They are listed in an array of their own, since `all` owns
// the names of every image.
static enum orl_result write_kept(const struct orl_log *log, const struct orl_colmap_model *all,
                                  const bool *keep, const char *sparse)
{
    struct orl_colmap_model kept = *all;
    kept.image_count = 0;
    kept.images = orl_array(log, all->image_count, sizeof *kept.images);
    ORL_TRY_MEMORY(kept.images);
    for (size_t i = 0; i < all->image_count; i++)
        if (keep[i])
            kept.images[kept.image_count++] = all->images[i];
    enum orl_result result = orl_colmap_write(log, sparse, &kept);
    free(kept.images);
    return result;
}

enum orl_result orl_subset_write_model(const struct orl_log *log, const struct orl_scene *scene,
                                       const bool *keep, const char *dir)
{
    struct orl_colmap_model all = {0};
    const char *sparse = ORL_PATH(dir, "sparse");
    enum orl_result result = orl_dir_make(log, sparse);
    ORL_THEN(result, orl_scene_read_model(log, scene, &all));
    // Photographs and the images of the model have equal indices.
    if (result == ORL_OK && all.image_count != scene->photo_count)
        result = orl_fail(log, ORL_ERR_DATA, "%s: its sparse model has changed", scene->dir);
    ORL_THEN(result, write_kept(log, &all, keep, sparse));
    orl_colmap_finish(&all);
    return result;
}

// --- the manifest ---

void orl_subset_keep_photographs(const struct orl_scene *scene, const bool *keep, json_t *root)
{
    json_t *list = json_object_get(root, "photographs"), *counts = json_object_get(root, "counts");
    json_int_t test = 0;
    for (size_t i = json_array_size(list); i-- > 0;) {
        const char *name = orl_json_text(json_array_get(list, i), "name");
        int photo = name ? orl_scene_find_photo(scene, name) : -1;
        if (photo >= 0 && keep[photo])
            test += scene->photos[photo].test;
        else
            json_array_remove(list, i);
    }
    if (!json_is_object(counts)) {
        counts = json_object();
        json_object_set_new(root, "counts", counts);
    }
    json_int_t count = (json_int_t)json_array_size(list);
    json_object_set_new(counts, "registered", json_integer(count));
    json_object_set_new(counts, "test", json_integer(test));
    json_object_set_new(counts, "train", json_integer(count - test));
}

enum orl_result orl_subset_add_checksum(const struct orl_log *log, const char *dir,
                                        const char *name, json_t *sums)
{
    char sum[ORL_CHECKSUM_SIZE];
    const char *path = ORL_PATH(dir, "%s", name);
    ORL_TRY(orl_file_checksum(log, path, sum));
    if (json_object_set_new(sums, name, json_string(sum)) != 0)
        return orl_fail(log, ORL_ERR_MEMORY, "%s: no memory for its checksum", path);
    return ORL_OK;
}

enum orl_result orl_subset_add_checksums(const struct orl_log *log, const char *dir, json_t *sums)
{
    static const char *const files[] = {"points.ply", "sparse/cameras.bin", "sparse/images.bin",
                                        "sparse/points3D.bin"};
    for (size_t i = 0; i < ORL_COUNT(files); i++)
        ORL_TRY(orl_subset_add_checksum(log, dir, files[i], sums));
    return ORL_OK;
}

enum orl_result orl_subset_begin(const struct orl_log *log, const struct orl_scene *scene,
                                 const bool *keep, const char *dir, json_t **manifest)
{
    const char *path = ORL_PATH(scene->dir, "scene.json");
    *manifest = NULL;
    if (scene->frame_count)
        return orl_fail(log, ORL_ERR_DATA, "%s: is a sequence", scene->dir);
    if (!orl_path_is_file(path))
        return orl_fail(log, ORL_ERR_DATA, "%s: a plain workspace; prepare or import it first",
                        scene->dir);
    enum orl_result result = orl_json_read(log, path, manifest);
    ORL_THEN(result, copy_if_there(log, scene, ORL_PATH(scene->dir, "points.ply"), dir));
    ORL_THEN(result, copy_if_there(log, scene, orl_scene_mesh_path(scene).text, dir));
    ORL_THEN(result, orl_subset_write_model(log, scene, keep, dir));
    if (result == ORL_OK) {
        orl_subset_keep_photographs(scene, keep, *manifest);
        json_object_del(*manifest, "tuned"); // other photographs want other settings
        json_t *sums = json_object();
        json_object_set_new(*manifest, "checksums", sums);
        result = orl_subset_add_checksums(log, dir, sums);
    }
    if (result != ORL_OK) {
        json_decref(*manifest);
        *manifest = NULL;
    }
    return result;
}
