// What the owner of a site has put beside Oriel's files stays when the site is published again.
#include <errno.h>
#include <fcntl.h>
#include <fts.h>
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

static enum orl_result keep(const struct keeping *k, FTS *tree, FTSENT *entry)
{
    const char *path = entry->fts_path + strlen(k->old);
    path += *path == '/';
    const char *to = ORL_PATH(k->new, "%s", path);
    struct stat there;
    bool taken = lstat(to, &there) == 0, is_folder = taken && S_ISDIR(there.st_mode);
    if (entry->fts_errno)
        return orl_fail(k->log, ORL_ERR_IO, "%s: %s", entry->fts_path, strerror(entry->fts_errno));
    if (entry->fts_info == FTS_DP) { // what is in a folder has been kept
        if (is_folder && *path)
            (void)!chmod(to, entry->fts_statp->st_mode & 07777);
        return ORL_OK;
    }
    bool listed = is_listed(k, path);
    if (!listed && entry->fts_info == FTS_D && taken == is_folder)
        return fts_children(tree, FTS_NAMEONLY) ? ORL_OK : orl_dir_make(k->log, to);
    (void)fts_set(tree, entry, FTS_SKIP);
    if (!listed && taken && k->knows)
        return orl_fail(k->log, ORL_ERR_ARGUMENT, "%s: was not written by Oriel, and the new site "
                        "has something of this name: move it elsewhere", entry->fts_path);
    if (listed || taken)
        return ORL_OK;
    ORL_TRY(orl_file_make_folder(k->log, to));
    return keep_file(k, entry->fts_path, to, entry->fts_statp);
}

enum orl_result orl_site_keep(const struct site *site, const char *old)
{
    struct keeping k = {.log = site->log, .old = old, .new = site->dir};
    char *roots[] = {(char *)old, NULL};
    if (!orl_path_is_dir(old))
        return ORL_OK;
    FTS *tree = fts_open(roots, FTS_PHYSICAL | FTS_COMFOLLOW | FTS_NOCHDIR, NULL);
    enum orl_result result = tree ? read_list(&k) : ORL_ERR_MEMORY;
    for (FTSENT *entry; result == ORL_OK && (entry = fts_read(tree));)
        result = keep(&k, tree, entry);
    if (result == ORL_OK && errno != 0) // of fts_read
        result = orl_file_failed(k.log, old);
    if (tree)
        fts_close(tree);
    orl_names_finish(&k.listed);
    return result;
}
