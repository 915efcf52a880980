// One self-contained HTML page of a report.
#include "eval/report_page.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/json.h"
#include "core/memory.h"

enum { JPEG_MAX_BYTES = 1 << 24 };

static void put_base64(FILE *out, const uint8_t *data, size_t size)
{
    static const char digits[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < size; i += 3) {
        unsigned bits = (unsigned)data[i] << 16;
        bits |= i + 1 < size ? (unsigned)data[i + 1] << 8 : 0;
        bits |= i + 2 < size ? (unsigned)data[i + 2] : 0;
        fputc(digits[bits >> 18], out);
        fputc(digits[bits >> 12 & 63], out);
        fputc(i + 1 < size ? digits[bits >> 6 & 63] : '=', out);
        fputc(i + 2 < size ? digits[bits & 63] : '=', out);
    }
}

// Writes "NAME":"data:..", of one picture.
static enum orl_result put_picture(const struct orl_log *log, FILE *out, const char *dir,
                                   const char *name, bool *first)
{
    uint8_t *data = NULL;
    size_t size = 0;
    char *path = orl_path_join(log, dir, name), *key = NULL;
    json_t *text = orl_json_string(name);
    enum orl_result result = path && text ? ORL_OK : ORL_ERR_MEMORY;
    if (result == ORL_OK)
        result = orl_file_read(log, path, JPEG_MAX_BYTES, &data, &size);
    if (result == ORL_OK) {
        key = json_dumps(text, JSON_ENCODE_ANY | JSON_ESCAPE_SLASH);
        result = key ? ORL_OK : ORL_ERR_MEMORY;
    }
    if (result == ORL_OK) {
        fprintf(out, "%s%s:\"data:image/jpeg;base64,", *first ? "" : ",\n", key);
        put_base64(out, data, size);
        fputc('"', out);
        *first = false;
    }
    json_decref(text);
    free(key);
    free(data);
    free(path);
    return result;
}

static enum orl_result put_pictures(const struct orl_log *log, FILE *out,
                                    const struct orl_page *page)
{
    bool first = true;
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < page->pictures->count; i++)
        result = put_picture(log, out, page->dir, page->pictures->items[i], &first);
    return result;
}

static enum orl_result put_data(const struct orl_log *log, FILE *out, const json_t *root)
{
    // Slashes are escaped, since the data must not contain "</script>".
    char *data = json_dumps(root, JSON_COMPACT | JSON_ESCAPE_SLASH | JSON_REAL_PRECISION(7));
    if (!data)
        return orl_fail(log, ORL_ERR_MEMORY, "no memory for a report's page");
    fputs(data, out);
    free(data);
    return ORL_OK;
}

// Writes the template up to a mark and moves *rest behind the mark.
static void put_until(FILE *out, const char **rest, const char *mark)
{
    const char *at = strstr(*rest, mark);
    fwrite(*rest, 1, at ? (size_t)(at - *rest) : strlen(*rest), out);
    *rest = at ? at + strlen(mark) : *rest + strlen(*rest);
}

static enum orl_result put_page(const struct orl_log *log, FILE *out, const struct orl_page *page)
{
    const char *rest = page->html;
    put_until(out, &rest, "@STYLE@");
    fputs(orl_page_style, out);
    put_until(out, &rest, "@DATA@");
    enum orl_result result = put_data(log, out, page->data);
    put_until(out, &rest, "@PICTURES@");
    if (result == ORL_OK)
        result = put_pictures(log, out, page);
    put_until(out, &rest, "@SCRIPT@");
    fputs(orl_page_script, out);
    fputs(rest, out);
    return result;
}

enum orl_result orl_page_write(const struct orl_log *log, const struct orl_page *page)
{
    struct orl_atomic_file file = {0};
    char *path = orl_path_join(log, page->dir, page->file);
    enum orl_result result = path ? orl_atomic_begin(log, path, &file) : ORL_ERR_MEMORY;
    FILE *out = result == ORL_OK ? fopen(file.temp, "wb") : NULL;
    if (result == ORL_OK && !out)
        result = orl_fail(log, ORL_ERR_IO, "%s: cannot write", path);
    if (out) {
        result = put_page(log, out, page);
        bool ok = !ferror(out);
        ok = fclose(out) == 0 && ok;
        if (result == ORL_OK && !ok)
            result = orl_fail(log, ORL_ERR_IO, "%s: cannot write", path);
    }
    if (result == ORL_OK)
        result = orl_atomic_commit(log, &file);
    orl_atomic_abort(&file);
    free(path);
    return result;
}
