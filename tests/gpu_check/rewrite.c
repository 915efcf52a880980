// Rewrites the text of a shader so that its indexes are checked: a[i] becomes
// a[orl_check_index(i, a.length(), SITE)], which GLSL accepts for arrays in buffers, blocks and
// structs, for other arrays and for vectors. The coordinates of imageLoad(b, i) and texelFetch(t, p, l) are
// compared with the size of what they read. The rewriting knows tokens, but no grammar. Where it
// takes a declaration for an index, the program does not compile.
#include <ctype.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "gpu_check/gpu_check.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))

// --- text ---

static bool is_word(char c)
{
    return isalnum((unsigned char)c) || c == '_';
}

// What Oriel puts where a file begins and goes on, ahead of #line.
static const char file_mark[] = "// source ";

// A copy in which comments are spaces, but for the marks of files.
static char *blank_comments(const char *text)
{
    char *copy = strdup(text);
    for (char *p = copy; *p; p++) {
        bool block = p[0] == '/' && p[1] == '*', line = p[0] == '/' && p[1] == '/';
        if ((!block && !line) || strncmp(p, file_mark, strlen(file_mark)) == 0)
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
    return word < before && !is_one_of(word, (size_t)(before - word), others, COUNT(others)) &&
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
    const char *text, *end; // without comments
    FILE *out, *notes;      // the new text; where each index is
    unsigned sites;         // indexes so far
};

static void put(FILE *out, const char *from, const char *to)
{
    fwrite(from, 1, (size_t)(to - from), out);
}

// The same on one line, so that the lines after it keep their numbers.
static void put_line(FILE *out, const char *from, const char *to)
{
    for (; from < to; from++)
        fputc(*from == '\n' ? ' ' : *from, out);
}

// The file and line of a place, by the marks ahead of it.
static void put_place(FILE *out, const char *text, const char *at)
{
    static const char line_mark[] = "#line ";
    const char *file = "";
    long line = 1;
    for (const char *p = text, *next; (next = strchr(p, '\n')) && next < at; p = next + 1) {
        if (strncmp(p, file_mark, strlen(file_mark)) == 0)
            file = p + strcspn(p, ":") + 2;
        if (strncmp(p, line_mark, strlen(line_mark)) == 0)
            line = strtol(p + strlen(line_mark), NULL, 10);
        else
            line++;
    }
    fprintf(out, "shaders/%.*s:%ld: ", (int)strcspn(file, "\n"), file, line);
}

// Ends a call of a checking function with the number of the expression, and notes where that is.
static void put_site(struct writer *w, const char *from, const char *to)
{
    fprintf(w->out, ", %uu)", ++w->sites);
    fprintf(w->notes, "// site %u: ", w->sites);
    put_place(w->notes, w->text, from);
    put_line(w->notes, from, to);
    fputc('\n', w->notes);
}

static void rewrite(struct writer *w, const char *from, const char *to);

// At a bracket: the index, checked where it is one. Returns where to go on.
static const char *rewrite_index(struct writer *w, const char *open, const char *to)
{
    const char *close = closing(open, to), *base = base_start(w->text, open);
    bool type = close + 1 < w->end && (close[1] == '(' || is_word(close[1]));
    if (close == to || !base || type || is_literal(open + 1, close) ||
        is_declared_at(w->text, base)) {
        fputc(*open, w->out);
        return open + 1;
    }
    fputs("[orl_check_index(", w->out);
    rewrite(w, open + 1, close);
    fputs(", ", w->out);
    put_line(w->out, base, open);
    fputs(".length()", w->out);
    put_site(w, base, close + 1);
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
    const char *open = word;
    while (open < to && is_word(*open))
        open++;
    size_t length = (size_t)(open - word);
    bool fetches = length == 10 && memcmp(word, "texelFetch", 10) == 0;
    bool image = length > 5 && memcmp(word, "image", 5) == 0 && isupper((unsigned char)word[5]) &&
                 strncmp(word, "imageSize", 9) != 0;
    const char *close = open < to && *open == '(' ? closing(open, to) : to;
    if ((!fetches && !image) || close == to) {
        put(w->out, word, open);
        return open;
    }
    const char *name_end = argument_end(open + 1, close);
    const char *at_end = name_end < close ? argument_end(name_end + 1, close) : close;
    put(w->out, word, name_end);
    if (name_end == close)
        return close;
    fputs(fetches ? ", orl_check_fetch(" : ", orl_check_image(", w->out);
    rewrite(w, name_end + 1, at_end);
    fputs(fetches ? ", textureSize(" : ", imageSize(", w->out);
    put_line(w->out, open + 1, name_end);
    if (fetches)
        put_line(w->out, at_end, close); // the level
    fputc(')', w->out);
    put_site(w, word, close + 1);
    rewrite(w, at_end, close);
    return close;
}

static void rewrite(struct writer *w, const char *from, const char *to)
{
    for (const char *p = from; p < to;) {
        if (*p == '[')
            p = rewrite_index(w, p, to);
        else if (is_word(*p))
            p = rewrite_word(w, p, to);
        else
            fputc(*p++, w->out);
    }
}

char *gpu_check_text(const char *text)
{
    char *blank = blank_comments(text), *out = NULL, *notes = NULL;
    size_t out_size, notes_size, version = strcspn(text, "\n");
    struct writer w = {.text = blank, .end = blank + strlen(blank),
                       .out = open_memstream(&out, &out_size),
                       .notes = open_memstream(&notes, &notes_size)};
    // Behind #version, ahead of the marks that number the lines of files.
    put(w.out, blank, blank + version);
    fprintf(w.out, "\n%s", gpu_check_index);
    rewrite(&w, blank + version, w.end);
    fclose(w.notes);
    fputs(notes, w.out);
    fclose(w.out);
    free(notes);
    free(blank);
    return out;
}
