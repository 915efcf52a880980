#include "scene/subset.h"

#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/json.h"
#include "core/memory.h"
#include "scene/colmap.h"
#include "scene/manifest.h"

// --- files ---

enum orl_result orl_subset_add_checksum(const struct orl_subset *subset, const char *name)
{
    char sum[ORL_CHECKSUM_SIZE];
    const char *path = ORL_PATH(subset->dir, "%s", name);
    ORL_TRY(orl_file_checksum(subset->log, path, sum));
    if (json_object_set_new(json_object_get(subset->manifest, "checksums"), name, json_string(sum)) != 0)
        return orl_fail(subset->log, ORL_ERR_MEMORY, "%s: no memory for its checksum", path);
    return ORL_OK;
}

// Copies a file of the scene to the same place in the new folder, if the file exists and was not written there yet.
// `path` begins with the scene's folder.
static enum orl_result copy_if_there(const struct orl_subset *subset, const char *path)
{
    const char *name = path + strlen(subset->scene->dir);
    name += strspn(name, "/");
    if (!orl_path_is_file(path) || json_object_get(json_object_get(subset->manifest, "checksums"), name))
        return ORL_OK;
    ORL_TRY(orl_file_copy(subset->log, path, ORL_PATH(subset->dir, "%s", name)));
    return orl_subset_add_checksum(subset, name);
}

enum orl_result orl_subset_copy_photo(const struct orl_subset *subset, size_t photo)
{
    struct orl_scene at = *subset->scene;
    for (at.frame = -1; at.frame < (int)at.frame_count; at.frame++)
        for (enum orl_photo_file kind = ORL_FILE_PHOTO; kind <= ORL_FILE_LINEAR; kind++)
            ORL_TRY(copy_if_there(subset, orl_scene_file(&at, photo, kind).text));
    return ORL_OK;
}

static enum orl_result copy_meshes(const struct orl_subset *subset)
{
    struct orl_scene at = *subset->scene;
    for (at.frame = -1; at.frame < (int)at.frame_count; at.frame++)
        ORL_TRY(copy_if_there(subset, orl_scene_mesh_path(&at).text));
    return ORL_OK;
}

static enum orl_result write_points(const struct orl_subset *subset)
{
    if (!subset->points)
        return copy_if_there(subset, ORL_PATH(subset->scene->dir, "points.ply"));
    ORL_TRY(orl_points_write(subset->log, ORL_PATH(subset->dir, "points.ply"), subset->points, true, NULL));
    return orl_subset_add_checksum(subset, "points.ply");
}

// --- the sparse model ---

static enum orl_result write_model(const struct orl_subset *subset)
{
    static const char *const files[] = {"sparse/cameras.bin", "sparse/images.bin", "sparse/points3D.bin"};
    struct orl_colmap_model all = {0};
    const char *sparse = ORL_PATH(subset->dir, "sparse");
    enum orl_result result = orl_dir_make(subset->log, sparse);
    ORL_THEN(result, orl_scene_read_model(subset->log, subset->scene, &all));
    // Photographs and the images of the model have equal indices.
    if (result == ORL_OK && all.image_count != subset->scene->photo_count)
        result = orl_fail(subset->log, ORL_ERR_DATA, "%s: its sparse model has changed", subset->scene->dir);
    ORL_THEN(result, orl_colmap_write(subset->log, sparse, &all, subset->keep));
    for (size_t i = 0; result == ORL_OK && i < ORL_COUNT(files); i++)
        result = orl_subset_add_checksum(subset, files[i]);
    orl_colmap_finish(&all);
    return result;
}

// --- the manifest ---

static enum orl_result read_manifest(const struct orl_subset *subset, json_t **root)
{
    const struct orl_scene *scene = subset->scene;
    const char *path = ORL_PATH(scene->dir, "scene.json");
    if (orl_path_is_file(path))
        return orl_json_read(subset->log, path, root);
    json_t *photos = json_array();
    for (size_t i = 0; i < scene->photo_count; i++)
        json_array_append_new(photos, json_pack("{s:s, s:s}", "name", scene->photos[i].name,
                                                "split", "train"));
    *root = json_pack("{s:s, s:i, s:s, s:o}", "format", "oriel scene", "version",
                      ORL_MANIFEST_VERSION, "made_by", "oriel " ORL_VERSION, "photographs",
                      photos);
    return *root ? ORL_OK : orl_fail(subset->log, ORL_ERR_MEMORY, "no memory for the manifest");
}

// Removes all other photographs from the manifest, and sets the counts of photographs.
static void keep_photographs(const struct orl_subset *subset)
{
    json_t *list = json_object_get(subset->manifest, "photographs");
    json_t *counts = json_object_get(subset->manifest, "counts");
    json_int_t test = 0;
    for (size_t i = json_array_size(list); i-- > 0;) {
        const char *name = orl_json_text(json_array_get(list, i), "name");
        int photo = name ? orl_scene_find_photo(subset->scene, name) : -1;
        if (photo >= 0 && subset->keep[photo])
            test += subset->scene->photos[photo].test;
        else
            json_array_remove(list, i);
    }
    if (!json_is_object(counts)) {
        counts = json_object();
        json_object_set_new(subset->manifest, "counts", counts);
    }
    json_int_t count = (json_int_t)json_array_size(list);
    json_object_set_new(counts, "registered", json_integer(count));
    json_object_set_new(counts, "test", json_integer(test));
    json_object_set_new(counts, "train", json_integer(count - test));
}

enum orl_result orl_subset_begin(struct orl_subset *subset)
{
    ORL_TRY(read_manifest(subset, &subset->manifest));
    keep_photographs(subset);
    json_object_set_new(subset->manifest, "checksums", json_object());
    ORL_TRY(write_points(subset));
    ORL_TRY(copy_meshes(subset));
    return write_model(subset);
}
