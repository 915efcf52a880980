// The page of a site: the files of web/, and the shader functions that the page shares with the
// renderer. In web/index.html, names in double braces mark what differs between a folder and a
// single file.
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "gpu/shader_table.h"
#include "walk/internal.h"
#include "walk/web_table.h"

static const char index_name[] = "index.html";
static const char *const shared_shaders[] = {
    "gather/backdrop.glsl", "gather/bicubic.glsl", "gather/blend.glsl", "gather/candidates.glsl",
    "gather/consider.glsl", "gather/guess_blur.glsl", "gather/hidden.glsl", "gather/penalty.glsl",
    "gather/projection.glsl", "gather/sample/srgb.glsl",
    "guess/apply.glsl", "guess/cost.glsl", "guess/path.glsl", "guess/pick.glsl", "guess/planes.glsl",
    "proxy/octahedron.glsl", "proxy/push.glsl", "proxy/surfel.glsl", "shared/constants.h",
    "shared/penalty.h", "shared/pixel.glsl", "shared/srgb.glsl", "soft/coarse.glsl", "soft/luma.glsl",
    "soft/mixed.glsl", "soft/opacity.glsl", "soft/seen.glsl", "soft/shown.glsl", NULL};
static const size_t FILE_MAX = (size_t)1 << 30;

// --- growing text ---

struct text {
    const struct orl_log *log;
    struct orl_bytes bytes;
    enum orl_result result; // the first failure; nothing is added after it
};

static void add_bytes(struct text *text, const char *data, size_t size)
{
    if (text->result == ORL_OK)
        text->result = orl_bytes_add(text->log, &text->bytes, data, size);
}

static void add(struct text *text, const char *string)
{
    add_bytes(text, string, strlen(string));
}

static void add_base64(struct text *text, const uint8_t *data, size_t size)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < size; i += 3) {
        size_t left = size - i;
        uint32_t bits = (uint32_t)data[i] << 16 | (left > 1 ? (uint32_t)data[i + 1] << 8 : 0) |
                        (left > 2 ? data[i + 2] : 0);
        char four[4] = {digits[bits >> 18], digits[bits >> 12 & 63],
                        left > 1 ? digits[bits >> 6 & 63] : '=', left > 2 ? digits[bits & 63] : '='};
        add_bytes(text, four, 4);
    }
}

static void add_html(struct text *text, const char *string)
{
    for (; *string; string++) {
        if (*string == '<')
            add(text, "&lt;");
        else if (*string == '&')
            add(text, "&amp;");
        else if (*string == '"')
            add(text, "&quot;");
        else
            add_bytes(text, string, 1);
    }
}

// --- the page from web/index.html ---

struct value {
    const char *key;
    struct text text;
};

// The text of a file of the page. All names are literals; a file that is not embedded is empty.
static const char *web_file(const char *name)
{
    for (const struct orl_web_file *f = orl_web_table; f->name; f++)
        if (strcmp(f->name, name) == 0)
            return f->text;
    return "";
}

// Fills `page` with the template, each {{key}} replaced by its value.
static void fill_template(const struct value *values, size_t count, struct text *page)
{
    const char *rest = web_file(index_name);
    for (const char *open; (open = strstr(rest, "{{")) != NULL;) {
        const char *close = strstr(open, "}}");
        size_t length = close ? (size_t)(close - open) - 2 : 0;
        add_bytes(page, rest, (size_t)(open - rest));
        bool found = false;
        for (size_t i = 0; close && i < count; i++) {
            const struct value *v = &values[i];
            if (strlen(v->key) != length || strncmp(v->key, open + 2, length) != 0)
                continue;
            found = true;
            add_bytes(page, v->text.bytes.data, v->text.bytes.size);
            if (page->result == ORL_OK)
                page->result = v->text.result;
        }
        if (!found && page->result == ORL_OK)
            page->result = orl_fail(page->log, ORL_ERR_FORMAT, "%s: {{%.*s}} is not known",
                                    index_name, (int)length, open + 2);
        rest = close ? close + 2 : open + 2;
    }
    add(page, rest);
}

enum { TITLE, ICON, POSTER, STYLE, MODULES, FILES, VALUES };

static void start_values(const struct orl_log *log, const char *title,
                         struct value values[VALUES])
{
    static const char *const keys[VALUES] = {"title", "icon", "poster", "style", "modules",
                                              "files"};
    for (int i = 0; i < VALUES; i++)
        values[i] = (struct value){.key = keys[i], .text = {.log = log}};
    add_html(&values[TITLE].text, title);
}

static void finish_values(struct value values[VALUES])
{
    for (int i = 0; i < VALUES; i++)
        free(values[i].text.bytes.data);
}

// What is needed is found one after the other, unless the page names all of it.
static void add_scripts(struct text *text, bool published)
{
    if (published) // of a live walk a token may stand in the address
        add(text, "<link rel=\"preload\" href=\"manifest.json\" as=\"fetch\" crossorigin>\n");
    for (const struct orl_web_file *f = orl_web_table; f->name; f++) {
        if (strncmp(f->name, "js/", 3) != 0)
            continue;
        add(text, "<link rel=\"modulepreload\" href=\"");
        add(text, f->name);
        add(text, "\">\n");
    }
    add(text, "<script type=\"module\" src=\"js/main.js\"></script>");
}

char *orl_walk_index(const struct orl_log *log, const char *title, const char *poster)
{
    struct value values[VALUES];
    struct text page = {.log = log};
    start_values(log, title, values);
    add(&values[POSTER].text, poster);
    add(&values[STYLE].text, "<link rel=\"stylesheet\" href=\"style.css\">");
    add(&values[ICON].text, "icon.svg");
    add_scripts(&values[MODULES].text, *poster != '\0');
    fill_template(values, VALUES, &page);
    finish_values(values);
    if (page.result == ORL_OK)
        return page.bytes.data;
    free(page.bytes.data);
    return NULL;
}

// Writes a file that is loaded before the page shows anything.
static enum orl_result write_first(struct site *site, const char *name, const char *text)
{
    site->report->first_bytes += strlen(text);
    return orl_site_write(site, name, text, strlen(text));
}

static enum orl_result write_index(struct site *site)
{
    char *page = orl_walk_index(site->log, site->params->title, "poster.jpg");
    enum orl_result result = page ? write_first(site, index_name, page) : ORL_ERR_MEMORY;
    free(page);
    return result;
}

static const char own_shaders[] = "shaders/"; // in the table of the page's files

// True for files of the renderer's shaders that the page includes.
static bool is_shared(const char *name)
{
    for (int i = 0; shared_shaders[i]; i++)
        if (strcmp(name, shared_shaders[i]) == 0)
            return true;
    return false;
}

// All shaders in one file, their text by name: a request for each would hold up the first picture.
static enum orl_result write_shaders(struct site *site)
{
    json_t *shaders = json_object();
    size_t prefix = strlen(own_shaders);
    for (const struct orl_web_file *f = orl_web_table; f->name; f++)
        if (strncmp(f->name, own_shaders, prefix) == 0)
            json_object_set_new(shaders, f->name + prefix, json_string(f->text));
    for (const struct orl_shader_file *f = orl_shader_table; f->name; f++)
        if (is_shared(f->name))
            json_object_set_new(shaders, f->name, json_string(f->text));
    char *text = json_dumps(shaders, JSON_COMPACT);
    enum orl_result result = text ? write_first(site, "shaders.json", text) : ORL_ERR_MEMORY;
    free(text);
    json_decref(shaders);
    return result;
}

enum orl_result orl_site_page(struct site *site)
{
    enum orl_result result = write_index(site);
    for (const struct orl_web_file *f = orl_web_table; result == ORL_OK && f->name; f++) {
        if (strcmp(f->name, index_name) == 0 ||
            strncmp(f->name, own_shaders, strlen(own_shaders)) == 0)
            continue;
        result = write_first(site, f->name, f->text);
    }
    return result == ORL_OK ? write_shaders(site) : result;
}

// --- the site as one file ---

// Adds a module as a data: address. Such an address is no place to be relative to, so what the module
// imports as "./NAME" becomes "oriel/NAME".
static void add_module(struct text *text, const char *module)
{
    static const char relative[] = "from \"./", named[] = "from \"oriel/";
    struct text plain = {.log = text->log};
    for (const char *at; (at = strstr(module, relative)) != NULL; module = at + strlen(relative)) {
        add_bytes(&plain, module, (size_t)(at - module));
        add(&plain, named);
    }
    add(&plain, module);
    add_base64(text, (const uint8_t *)plain.bytes.data, plain.bytes.size);
    if (text->result == ORL_OK)
        text->result = plain.result;
    free(plain.bytes.data);
}

// Adds every module under the name by which others import it.
static void add_modules(struct text *text)
{
    bool first = true;
    add(text, "<script type=\"importmap\">{\"imports\": {");
    for (const struct orl_web_file *f = orl_web_table; f->name; f++) {
        if (strncmp(f->name, "js/", 3) != 0)
            continue;
        add(text, first ? "\n\"oriel/" : ",\n\"oriel/");
        add(text, f->name + 3);
        add(text, "\": \"data:text/javascript;base64,");
        add_module(text, f->text);
        add(text, "\"");
        first = false;
    }
    add(text, "\n}}</script>\n<script type=\"module\">import \"oriel/main.js\";</script>");
}

// True for data files, which the page requests by name.
static bool is_data(const char *path)
{
    return strcmp(path, index_name) != 0 && strcmp(path, "style.css") != 0 &&
           strcmp(path, "icon.svg") != 0 && strncmp(path, "js/", 3) != 0;
}

// As orl_site_files, of what is below `folder` of the site.
static enum orl_result list_files(const struct orl_log *log, const char *dir, const char *folder,
                                  bool data, struct orl_names *paths)
{
    struct orl_names names = {0};
    char *here = orl_path_join(log, dir, folder);
    enum orl_result result = here ? orl_dir_list(log, here, &names) : ORL_ERR_MEMORY;
    for (size_t i = 0; i < names.count && result == ORL_OK; i++) {
        char *path = orl_format(log, "%s%s%s", folder, *folder ? "/" : "", names.items[i]);
        char *full = path ? orl_path_join(log, dir, path) : NULL;
        if (!full)
            result = ORL_ERR_MEMORY;
        else if (orl_path_is_dir(full))
            result = list_files(log, dir, path, data, paths);
        else if (!data || is_data(path))
            result = orl_names_add(log, paths, path);
        free(full);
        free(path);
    }
    orl_names_finish(&names);
    free(here);
    return result;
}

enum orl_result orl_site_files(const struct orl_log *log, const char *dir, bool data,
                               struct orl_names *paths)
{
    return list_files(log, dir, "", data, paths);
}

static void add_file(const struct site *site, const char *path, struct text *text)
{
    uint8_t *data = NULL;
    size_t size = 0;
    if (text->result == ORL_OK)
        text->result = orl_file_read(site->log, ORL_PATH(site->dir, "%s", path), FILE_MAX, &data, &size);
    if (data) {
        add(text, text->bytes.size ? ",\n\"" : "\"");
        add(text, path);
        add(text, "\": \"");
        add_base64(text, data, size);
        add(text, "\"");
    }
    free(data);
}

static void add_files(const struct site *site, struct text *text)
{
    struct orl_names paths = {0};
    text->result = orl_site_files(site->log, site->dir, true, &paths);
    for (size_t i = 0; i < paths.count && text->result == ORL_OK; i++)
        add_file(site, paths.items[i], text);
    orl_names_finish(&paths);
}

enum orl_result orl_site_pack(struct site *site, const char *file)
{
    struct value values[VALUES];
    struct text page = {.log = site->log}, files = {.log = site->log};
    start_values(site->log, site->params->title, values);
    add(&values[ICON].text, "data:,");
    add(&values[STYLE].text, "<style>");
    add(&values[STYLE].text, web_file("style.css"));
    add(&values[STYLE].text, "</style>");
    add_modules(&values[MODULES].text);
    add_files(site, &files);
    add(&values[FILES].text, "<script type=\"application/json\" id=\"files\">{");
    add_bytes(&values[FILES].text, files.bytes.data, files.bytes.size);
    add(&values[FILES].text, "}</script>");
    // The page finds the poster in its own table of files, so it needs no address for it.
    fill_template(values, VALUES, &page);
    enum orl_result result = files.result != ORL_OK ? files.result : page.result;
    ORL_THEN(result, orl_file_write(site->log, file, page.bytes.data, page.bytes.size));
    site->report->bytes = site->report->first_bytes = page.bytes.size;
    finish_values(values);
    free(files.bytes.data);
    free(page.bytes.data);
    return result;
}
