// What the owner of a site has put beside Oriel's files stays when the site is published again.
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/file.h"
#include "core/json.h"
#include "core/memory.h"
#include "core/order.h"
#include "walk/internal.h"

static const char list_name[] = "files.json";

enum orl_result orl_site_list(const struct site *site)
{
    struct orl_names paths = {0};
    enum orl_result result = orl_site_files(site->log, site->dir, false, &paths);
    json_t *list = json_array();
    for (size_t i = 0; i < paths.count; i++)
        json_array_append_new(list, orl_json_string(paths.items[i]));
    json_array_append_new(list, orl_json_string(list_name));
    json_t *root = json_pack("{s:o}", "files", list);
    ORL_THEN(result, orl_json_write(site->log, ORL_PATH(site->dir, "%s", list_name), root));
    json_decref(root);
    orl_names_finish(&paths);
    return result;
}

struct keeping {
    const struct orl_log *log;
    const char *old, *new;   // the sites
    struct orl_names listed; // sorted
    bool knows;              // the old site says which files are its own
};

static bool is_listed(const struct keeping *k, const char *path)
{
    return k->listed.count && bsearch(&path, k->listed.items, k->listed.count,
                                      sizeof *k->listed.items, orl_order_texts);
}

static enum orl_result read_list(struct keeping *k)
{
    json_t *root = NULL, *item;
    size_t i;
    const char *file = ORL_PATH(k->old, "%s", list_name);
    k->knows = orl_path_is_file(file);
    enum orl_result result = k->knows ? orl_json_read(k->log, file, &root) : ORL_OK;
    json_array_foreach(json_object_get(root, "files"), i, item)
        if (result == ORL_OK && json_is_string(item))
            result = orl_names_add(k->log, &k->listed, json_string_value(item));
    orl_names_sort(&k->listed);
    json_decref(root);
    return result;
}

static enum orl_result copy_link(const struct orl_log *log, const char *from, const char *to)
{
    char target[PATH_MAX];
    ssize_t length = readlink(from, target, sizeof target - 1);
    if (length >= 0)
        target[length] = '\0';
    return length >= 0 && symlink(target, to) == 0
               ? ORL_OK
               : orl_fail(log, ORL_ERR_IO, "%s: cannot be kept: %s", from, strerror(errno));
}

// As a second name of the same file, so that both sites are whole; drives without that get a copy.
static enum orl_result keep_file(const struct keeping *k, const char *from, const char *to,
                                 const struct stat *st)
{
    if (linkat(AT_FDCWD, from, AT_FDCWD, to, 0) == 0)
        return ORL_OK;
    if (S_ISLNK(st->st_mode))
        return copy_link(k->log, from, to);
    enum orl_result result = orl_file_copy(k->log, from, to);
    if (result == ORL_OK)
        (void)!chmod(to, st->st_mode & 07777);
    return result;
}

static enum orl_result keep(const struct keeping *k, const char *path);

static enum orl_result keep_folder(const struct keeping *k, const char *path, const char *from,
                                   const char *to, const struct stat *st)
{
    struct orl_names names = {0};
    enum orl_result result = orl_dir_list(k->log, from, &names);
    if (result == ORL_OK && names.count == 0)
        result = orl_dir_make(k->log, to);
    for (size_t i = 0; result == ORL_OK && i < names.count; i++) {
        char *child = orl_format(k->log, "%s%s%s", path, *path ? "/" : "", names.items[i]);
        result = child ? keep(k, child) : ORL_ERR_MEMORY;
        free(child);
    }
    if (result == ORL_OK && *path && orl_path_is_dir(to))
        (void)!chmod(to, st->st_mode & 07777);
    orl_names_finish(&names);
    return result;
}

static enum orl_result keep(const struct keeping *k, const char *path)
{
    struct stat st, there;
    char *from = orl_path_join(k->log, k->old, path), *to = orl_path_join(k->log, k->new, path);
    enum orl_result result = from && to ? ORL_OK : ORL_ERR_MEMORY;
    if (result == ORL_OK && lstat(from, &st) != 0)
        result = orl_fail(k->log, ORL_ERR_IO, "%s: %s", from, strerror(errno));
    if (result != ORL_OK || is_listed(k, path))
        goto end;
    bool taken = lstat(to, &there) == 0;
    if (S_ISDIR(st.st_mode) && (!taken || S_ISDIR(there.st_mode)))
        result = keep_folder(k, path, from, to, &st);
    else if (taken && k->knows)
        result = orl_fail(k->log, ORL_ERR_ARGUMENT, "%s: was not written by Oriel, and the new site "
                          "has something of this name: move it elsewhere", from);
    else if (!taken && (result = orl_file_make_folder(k->log, to)) == ORL_OK)
        result = keep_file(k, from, to, &st);
end:
    free(from);
    free(to);
    return result;
}

enum orl_result orl_site_keep(const struct site *site, const char *old)
{
    struct keeping k = {.log = site->log, .old = old, .new = site->dir};
    if (!orl_path_is_dir(old))
        return ORL_OK;
    enum orl_result result = read_list(&k);
    ORL_THEN(result, keep(&k, ""));
    orl_names_finish(&k.listed);
    return result;
}
