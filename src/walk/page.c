// The page of a site: the files of web/, and the shader functions that the page shares with the
// renderer. In web/index.html, names in double braces mark what differs between a folder and a
// single file.
#include <errno.h>
#include <fts.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <libwebsockets.h>

#include "core/file.h"
#include "core/memory.h"
#include "gpu/shader_table.h"
#include "walk/internal.h"
#include "walk/web_table.h"

static const char index_name[] = "index.html";
// Of the renderer's shaders those that the page includes.
static const char *const shared_shaders[] = {
    "edges/edge.glsl", "edges/speck.glsl", "fill/slope.glsl", "fill/softened.glsl", "gather/backdrop.glsl",
    "gather/bicubic.glsl", "gather/blend.glsl", "gather/candidates.glsl", "gather/consider.glsl",
    "gather/guess_blur.glsl", "gather/hidden.glsl", "gather/penalty.glsl", "gather/projection.glsl",
    "gather/sample/srgb.glsl", "gather/stored.glsl", "guess/apply.glsl", "guess/cost.glsl", "guess/path.glsl",
    "guess/pick.glsl", "guess/planes.glsl", "proxy/holes.glsl", "proxy/octahedron.glsl", "proxy/point.glsl",
    "proxy/push.glsl", "proxy/support.glsl", "proxy/surfel.glsl", "shared/constants.h", "shared/penalty.h",
    "shared/pixel.glsl", "shared/srgb.glsl", "soft/coarse.glsl", "soft/luma.glsl", "soft/mixed.glsl",
    "soft/opacity.glsl", "soft/seen.glsl", "soft/shown.glsl", NULL};
static const size_t FILE_MAX = (size_t)1 << 30;

// --- the page from web/index.html ---

struct page {
    const struct orl_log *log;
    const char *title, *poster; // poster: "": none
    const struct site *site;    // whose files the page holds; NULL: it loads them
    FILE *out;
    enum orl_result result; // the first failure
};

const char *orl_walk_page_file(const char *name)
{
    const struct orl_web_file *f = orl_web_table;
    while (f->name && strcmp(f->name, name) != 0)
        f++;
    return f->text; // the table ends with zeros
}

static void put_base64(struct page *page, const uint8_t *data, size_t size)
{
    enum { BYTES = 3 << 10 }; // encoded at once; a multiple of three, so that only the last part is filled up
    char text[BYTES / 3 * 4 + 2]; // libwebsockets asks for a byte more than it writes
    for (size_t i = 0; i < size; i += BYTES) {
        size_t left = size - i;
        int length = lws_b64_encode_string((const char *)data + i, left < BYTES ? (int)left : BYTES, text, sizeof text);
        if (length < 0)
            page->result = orl_fail(page->log, ORL_ERR_EXTERNAL, "the page's files cannot be encoded");
        fwrite(text, 1, length < 0 ? 0 : (size_t)length, page->out);
    }
}

static void put_title(struct page *page)
{
    for (const char *c = page->title; *c; c++) {
        const char *coded = *c == '<' ? "&lt;" : *c == '&' ? "&amp;" : *c == '"' ? "&quot;" : NULL;
        fprintf(page->out, "%.*s", coded ? (int)strlen(coded) : 1, coded ? coded : c);
    }
}

static void put_style(struct page *page)
{
    fprintf(page->out, "<style>%s</style>", orl_walk_page_file("style.css"));
}

// What is needed is found one after the other, unless the page names all of it.
static void put_scripts(struct page *page)
{
    if (*page->poster) // of a live walk a token may stand in the address
        fputs("<link rel=\"preload\" href=\"manifest.json\" as=\"fetch\" crossorigin>\n", page->out);
    for (const struct orl_web_file *f = orl_web_table; f->name; f++)
        if (strncmp(f->name, "js/", 3) == 0)
            fprintf(page->out, "<link rel=\"modulepreload\" href=\"%s\">\n", f->name);
    fputs("<script type=\"module\" src=\"js/main.js\"></script>", page->out);
}

// Puts a module as base64 of a data: address. Such an address is no place to be relative to, so what the module
// imports as "./NAME" becomes "oriel/NAME".
static void put_module(struct page *page, const char *module)
{
    static const char relative[] = "from \"./", named[] = "from \"oriel/";
    struct orl_bytes plain = {0};
    for (const char *at; (at = strstr(module, relative)) != NULL; module = at + strlen(relative)) {
        ORL_THEN(page->result, orl_bytes_add(page->log, &plain, module, (size_t)(at - module)));
        ORL_THEN(page->result, orl_bytes_add(page->log, &plain, named, strlen(named)));
    }
    ORL_THEN(page->result, orl_bytes_add(page->log, &plain, module, strlen(module)));
    put_base64(page, (const uint8_t *)plain.data, plain.size);
    free(plain.data);
}

// Every module under the name by which others import it.
static void put_modules(struct page *page)
{
    const char *before = "";
    fputs("<script type=\"importmap\">{\"imports\": {", page->out);
    for (const struct orl_web_file *f = orl_web_table; f->name; f++) {
        if (strncmp(f->name, "js/", 3) != 0)
            continue;
        fprintf(page->out, "%s\n\"oriel/%s\": \"data:text/javascript;base64,", before, f->name + 3);
        put_module(page, f->text);
        fputs("\"", page->out);
        before = ",";
    }
    fputs("\n}}</script>\n<script type=\"module\">import \"oriel/main.js\";</script>", page->out);
}

static void put_file(struct page *page, const char *path, const char *before)
{
    uint8_t *data = NULL;
    size_t size = 0;
    ORL_THEN(page->result, orl_file_read(page->log, ORL_PATH(page->site->dir, "%s", path), FILE_MAX, &data, &size));
    fprintf(page->out, "%s\"%s\": \"", before, path);
    put_base64(page, data, size);
    fputs("\"", page->out);
    free(data);
}

static void put_files(struct page *page)
{
    struct orl_names paths = {0};
    fputs("<script type=\"application/json\" id=\"files\">{", page->out);
    ORL_THEN(page->result, orl_site_files(page->log, page->site->dir, true, &paths));
    for (size_t i = 0; i < paths.count && page->result == ORL_OK; i++)
        put_file(page, paths.items[i], i ? ",\n" : "");
    fputs("}</script>", page->out);
    orl_names_finish(&paths);
}

// Puts what stands in the place of {{key}}. A page that holds all files finds the poster among them, so it needs no
// address for it.
static void put_value(struct page *page, const char *key, size_t length)
{
    const bool holds = page->site;
    const struct {
        const char *key, *text;
        void (*put)(struct page *page); // where there is no text
    } values[] = {{"title", NULL, put_title},
                  {"icon", holds ? "data:," : "icon.svg", NULL},
                  {"poster", page->poster, NULL},
                  {"style", holds ? NULL : "<link rel=\"stylesheet\" href=\"style.css\">", put_style},
                  {"modules", NULL, holds ? put_modules : put_scripts},
                  {"files", holds ? NULL : "", put_files}};
    for (size_t i = 0; i < ORL_COUNT(values); i++)
        if (strlen(values[i].key) == length && strncmp(values[i].key, key, length) == 0) {
            if (values[i].text)
                fputs(values[i].text, page->out);
            else
                values[i].put(page);
            return;
        }
    page->result = orl_fail(page->log, ORL_ERR_FORMAT, "%s: {{%.*s}} is not known", index_name, (int)length, key);
}

// The text of the page, which the caller releases with free(); NULL, logged: an error, which is page->result.
static char *make_page(struct page *page, size_t *size)
{
    char *text = NULL;
    const char *rest = orl_walk_page_file(index_name);
    page->out = open_memstream(&text, size);
    for (const char *open; page->out && page->result == ORL_OK && (open = strstr(rest, "{{")) != NULL;) {
        const char *close = strstr(open, "}}");
        fwrite(rest, 1, (size_t)(open - rest), page->out);
        put_value(page, open + 2, close ? (size_t)(close - open) - 2 : 0);
        rest = close ? close + 2 : open + 2;
    }
    if (page->out)
        fputs(rest, page->out);
    if ((!page->out || fclose(page->out) != 0) && page->result == ORL_OK)
        page->result = orl_fail(page->log, ORL_ERR_MEMORY, "no memory for the page");
    if (page->result == ORL_OK)
        return text;
    free(text);
    return NULL;
}

char *orl_walk_index(const struct orl_log *log, const char *title, const char *poster)
{
    size_t size;
    return make_page(&(struct page){.log = log, .title = title, .poster = poster}, &size);
}

static enum orl_result write_index(struct site *site)
{
    char *page = orl_walk_index(site->log, site->params->title, "poster.jpg");
    enum orl_result result = page ? orl_site_write(site, index_name, page, strlen(page)) : ORL_ERR_MEMORY;
    free(page);
    return result;
}

static const char own_shaders[] = "shaders/"; // in the table of the page's files

// All shaders in one file, their text by name: a request for each would hold up the first picture.
static enum orl_result write_shaders(struct site *site)
{
    json_t *shaders = json_object();
    enum orl_result result = ORL_OK;
    size_t prefix = strlen(own_shaders);
    for (const struct orl_web_file *f = orl_web_table; f->name; f++)
        if (strncmp(f->name, own_shaders, prefix) == 0)
            json_object_set_new(shaders, f->name + prefix, json_string(f->text));
    for (const char *const *name = shared_shaders; *name && result == ORL_OK; name++) {
        const struct orl_shader_file *f = orl_shader_table;
        while (f->name && strcmp(f->name, *name) != 0)
            f++;
        if (json_object_set_new(shaders, *name, json_string(f->text)) != 0)
            result = orl_fail(site->log, ORL_ERR_NOT_FOUND, "%s: the page needs this shader", *name);
    }
    char *text = json_dumps(shaders, JSON_COMPACT);
    ORL_THEN(result, text ? orl_site_write(site, "shaders.json", text, strlen(text)) : ORL_ERR_MEMORY);
    free(text);
    json_decref(shaders);
    return result;
}

enum orl_result orl_site_page(struct site *site)
{
    ORL_TRY(write_index(site));
    for (const struct orl_web_file *f = orl_web_table; f->name; f++)
        if (strcmp(f->name, index_name) != 0 && strncmp(f->name, own_shaders, strlen(own_shaders)) != 0)
            ORL_TRY(orl_site_write(site, f->name, f->text, strlen(f->text)));
    return write_shaders(site);
}

// --- the site as one file ---

enum orl_result orl_site_files(const struct orl_log *log, const char *dir, bool data,
                               struct orl_names *paths)
{
    char *roots[] = {(char *)dir, NULL};
    FTS *tree = fts_open(roots, FTS_PHYSICAL | FTS_NOCHDIR, NULL);
    enum orl_result result = tree ? ORL_OK : ORL_ERR_MEMORY;
    for (FTSENT *entry; result == ORL_OK && (entry = fts_read(tree));) {
        const char *path = entry->fts_path + strlen(dir);
        path += *path == '/';
        if (entry->fts_errno)
            result = orl_fail(log, ORL_ERR_IO, "%s: %s", entry->fts_path, strerror(entry->fts_errno));
        else if (entry->fts_info == FTS_F && (!data || !orl_walk_page_file(path))) // data is what the page requests by name
            result = orl_names_add(log, paths, path);
    }
    if (result == ORL_OK && errno != 0) // of fts_read
        result = orl_file_failed(log, dir);
    if (tree)
        fts_close(tree);
    orl_names_sort(paths);
    return result;
}

enum orl_result orl_site_pack(struct site *site, const char *file)
{
    struct page page = {.log = site->log, .title = site->params->title, .poster = "", .site = site};
    size_t size = 0;
    char *text = make_page(&page, &size);
    enum orl_result result = page.result;
    ORL_THEN(result, orl_file_write(site->log, file, text, size));
    site->report->bytes = site->report->first_bytes = size;
    free(text);
    return result;
}
