// Rewrites the text of a shader so that its indexes are checked: a[i] becomes
// a[orl_check_index(i, a.length(), SITE)], which GLSL accepts for arrays in buffers, blocks and
// structs, for other arrays and for vectors. The coordinates of imageLoad(b, i) and texelFetch(t, p, l) are
// compared with the size of what they read. The rewriting knows tokens, but no grammar. Where it
// takes a declaration for an index, the program does not compile.
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "gpu/check.h"

enum { COLUMN_BITS = 12, LINE_BITS = 14 };

uint32_t orl_check_site_pack(const struct orl_check_site *site)
{
    return (uint32_t)site->file << (LINE_BITS + COLUMN_BITS) |
           (site->line & ((1u << LINE_BITS) - 1)) << COLUMN_BITS |
           (site->column & ((1u << COLUMN_BITS) - 1));
}

struct orl_check_site orl_check_site_unpack(uint32_t word)
{
    return (struct orl_check_site){.file = word >> (LINE_BITS + COLUMN_BITS),
                                   .line = word >> COLUMN_BITS & ((1u << LINE_BITS) - 1),
                                   .column = word & ((1u << COLUMN_BITS) - 1)};
}

// --- text ---

static bool is_word(char c)
{
    return isalnum((unsigned char)c) || c == '_';
}

// A copy in which comments are spaces.
static char *blank_comments(const struct orl_log *log, const char *text)
{
    char *copy = orl_strdup(log, text);
    for (char *p = copy; p && *p; p++) {
        bool block = p[0] == '/' && p[1] == '*';
        if (!block && !(p[0] == '/' && p[1] == '/'))
            continue;
        const char *end = block ? strstr(p + 2, "*/") : strchr(p, '\n');
        end = end ? end + (block ? 2 : 0) : p + strlen(p);
        for (; p < end; p++)
            *p = *p == '\n' ? '\n' : ' ';
        p--;
    }
    return copy;
}

// The bracket that closes the one at `open`; the end of the text if there is none.
static const char *closing(const char *open, const char *end)
{
    int depth = 0;
    for (const char *p = open; p < end; p++) {
        depth += *p == '(' || *p == '[' || *p == '{';
        depth -= *p == ')' || *p == ']' || *p == '}';
        if (depth == 0)
            return p;
    }
    return end;
}

// The bracket that opens the one at `close`; the start of the text if there is none.
static const char *opening(const char *start, const char *close)
{
    int depth = 0;
    for (const char *p = close; p > start; p--) {
        depth += *p == ')' || *p == ']' || *p == '}';
        depth -= *p == '(' || *p == '[' || *p == '{';
        if (depth == 0)
            return p;
    }
    return start;
}

static const char *skip_spaces_back(const char *start, const char *p)
{
    while (p > start && isspace((unsigned char)p[-1]))
        p--;
    return p;
}

static const char *word_start(const char *start, const char *p)
{
    while (p > start && is_word(p[-1]))
        p--;
    return p;
}

// Where the expression starts that the bracket at `open` indexes: a, a.b, a[i].b. NULL: it has a
// call in it or is none.
static const char *base_start(const char *start, const char *open)
{
    const char *p = open;
    for (;;) {
        while (p > start && p[-1] == ']')
            p = opening(start, p - 1);
        const char *word = word_start(start, p);
        if (word == p || isdigit((unsigned char)*word))
            return NULL;
        if (word == start || word[-1] != '.')
            return word;
        p = word - 1;
    }
}

static bool is_one_of(const char *word, size_t length, const char *const *words, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (strlen(words[i]) == length && memcmp(words[i], word, length) == 0)
            return true;
    return false;
}

// Does a directive (#endif) stand on the line that ends between `from` and `to`?
static bool directive_ends_between(const char *start, const char *from, const char *to)
{
    if (!memchr(from, '\n', (size_t)(to - from)))
        return false;
    while (from > start && from[-1] != '\n')
        from--;
    return *from == '#';
}

// Is the word ahead of `p` a type, so that a name is declared there?
static bool type_ends_at(const char *start, const char *p)
{
    static const char *const others[] = {"return", "else", "do", "case"};
    const char *before = skip_spaces_back(start, p);
    const char *word = word_start(start, before);
    return word < before && !is_one_of(word, (size_t)(before - word), others, ORL_COUNT(others)) &&
           !directive_ends_between(start, before, p);
}

// Is the name at `base` declared here: float a[3], b[3]?
static bool is_declared_at(const char *start, const char *base)
{
    if (type_ends_at(start, base))
        return true;
    const char *p = skip_spaces_back(start, base);
    if (p == start || p[-1] != ',')
        return false;
    // A list: is it that of a declaration, or of arguments?
    for (p--; p > start && !strchr(";{}(\n[", p[-1]); p--)
        if (p[-1] == ')' || p[-1] == ']')
            p = opening(start, p - 1) + 1;
    while (isspace((unsigned char)*p))
        p++;
    if (p > start && strchr("([", p[-1]))
        return false;
    while (is_word(*p))
        p++;
    return isspace((unsigned char)*p) && type_ends_at(start, p + 1);
}

static bool is_literal(const char *from, const char *to)
{
    for (; from < to; from++)
        if (!isdigit((unsigned char)*from) && !isspace((unsigned char)*from) && *from != 'u')
            return false;
    return true;
}

// --- rewriting ---

struct writer {
    const struct orl_log *log;
    const char *text, *end; // without comments
    unsigned file;
    struct orl_bytes out;
    bool failed;
};

static void put(struct writer *w, const char *text, size_t length)
{
    w->failed = w->failed || orl_bytes_add(w->log, &w->out, text, length) != ORL_OK;
}

static void put_text(struct writer *w, const char *text)
{
    put(w, text, strlen(text));
}

// The same on one line, so that the lines after it keep their numbers.
static void put_line(struct writer *w, const char *from, const char *to)
{
    for (; from < to; from++)
        put(w, *from == '\n' ? " " : from, 1);
}

static void put_site(struct writer *w, const char *at)
{
    struct orl_check_site site = {.file = w->file, .line = 1};
    const char *line = w->text;
    for (const char *p = w->text; p < at; p++)
        if (*p == '\n') {
            site.line++;
            line = p + 1;
        }
    site.column = (unsigned)(at - line);
    char text[32];
    snprintf(text, sizeof text, ", %uu)", orl_check_site_pack(&site));
    put_text(w, text);
}

static void rewrite(struct writer *w, const char *from, const char *to);

// At a bracket: the index, checked where it is one. Returns where to go on.
static const char *rewrite_index(struct writer *w, const char *open, const char *to)
{
    const char *close = closing(open, to), *base = base_start(w->text, open);
    bool type = close + 1 < w->end && (close[1] == '(' || is_word(close[1]));
    if (close == to || !base || type || is_literal(open + 1, close) ||
        is_declared_at(w->text, base)) {
        put(w, open, 1);
        return open + 1;
    }
    put_text(w, "[orl_check_index(");
    rewrite(w, open + 1, close);
    put_text(w, ", ");
    put_line(w, base, open);
    put_text(w, ".length()");
    put_site(w, open);
    return close;
}

// The comma that ends an argument which starts at `p`, or `end`.
static const char *argument_end(const char *p, const char *end)
{
    for (; p < end && *p != ','; p++)
        if (*p == '(' || *p == '[')
            p = closing(p, end);
    return p < end ? p : end;
}

// At a word: the call of a texel function with its coordinates checked, else the word.
static const char *rewrite_word(struct writer *w, const char *word, const char *to)
{
    static const char *const fetch[] = {"texelFetch"};
    const char *open = word;
    while (open < to && is_word(*open))
        open++;
    size_t length = (size_t)(open - word);
    bool fetches = is_one_of(word, length, fetch, ORL_COUNT(fetch));
    bool image = (length > 5 && memcmp(word, "image", 5) == 0 && isupper((unsigned char)word[5]) &&
                  strncmp(word, "imageSize", 9) != 0);
    const char *close = open < to && *open == '(' ? closing(open, to) : to;
    if ((!fetches && !image) || close == to) {
        put(w, word, length);
        return open;
    }
    const char *name_end = argument_end(open + 1, close);
    const char *at_end = name_end < close ? argument_end(name_end + 1, close) : close;
    put(w, word, (size_t)(name_end - word));
    if (name_end == close)
        return close;
    put_text(w, fetches ? ", orl_check_fetch(" : ", orl_check_image(");
    rewrite(w, name_end + 1, at_end);
    put_text(w, fetches ? ", textureSize(" : ", imageSize(");
    put_line(w, open + 1, name_end);
    if (fetches)
        put_line(w, at_end, close); // the level
    put_text(w, ")");
    put_site(w, word);
    rewrite(w, at_end, close);
    return close;
}

static void rewrite(struct writer *w, const char *from, const char *to)
{
    for (const char *p = from; p < to && !w->failed;) {
        if (*p == '[') {
            p = rewrite_index(w, p, to);
        } else if (is_word(*p)) {
            p = rewrite_word(w, p, to);
        } else {
            put(w, p, 1);
            p++;
        }
    }
}

char *orl_check_source(const struct orl_log *log, const char *text, unsigned file)
{
    char *blank = blank_comments(log, text);
    if (!blank)
        return NULL;
    struct writer w = {.log = log, .text = blank, .end = blank + strlen(blank), .file = file};
    put_text(&w, "");
    rewrite(&w, w.text, w.end);
    free(blank);
    if (w.failed) {
        free(w.out.data);
        return NULL;
    }
    return w.out.data;
}

const char *orl_check_expression(const char *text, const struct orl_check_site *site,
                                 size_t *length)
{
    const char *p = text;
    for (unsigned line = 1; p && line < site->line; line++) {
        p = strchr(p, '\n');
        p = p ? p + 1 : NULL;
    }
    if (!p || strcspn(p, "\n") <= site->column)
        return NULL;
    p += site->column;
    const char *start = *p == '[' ? base_start(text, p) : p;
    p += strcspn(p, "[(");
    const char *close = closing(p, p + strlen(p));
    *length = start && *close ? (size_t)(close + 1 - start) : 0;
    return *length ? start : NULL;
}
