#include "core/text.h"

#include <stdio.h>
#include <string.h>

// Length in bytes of the UTF-8 character at the start of `text`; 0 when there is none.
static size_t utf8_length(const char *text)
{
    const unsigned char *c = (const unsigned char *)text;
    if (c[0] < 0x80)
        return c[0] ? 1 : 0;
    size_t length = c[0] >= 0xf0 ? 4 : c[0] >= 0xe0 ? 3 : 2;
    if (c[0] < 0xc2 || c[0] > 0xf4)
        return 0;
    for (size_t i = 1; i < length; i++)
        if ((c[i] & 0xc0) != 0x80)
            return 0;
    // Overlong forms, surrogates and values above U+10FFFF are invalid (RFC 3629).
    bool bad = (c[0] == 0xe0 && c[1] < 0xa0) || (c[0] == 0xed && c[1] > 0x9f) ||
               (c[0] == 0xf0 && c[1] < 0x90) || (c[0] == 0xf4 && c[1] > 0x8f);
    return bad ? 0 : length;
}

bool orl_text_is_one_of(const char *text, const char *const *list)
{
    while (*list && strcmp(text, *list) != 0)
        list++;
    return *list != NULL;
}

// Marks, embeddings and isolates of direction (Unicode Standard Annex 9), by which a name shows as
// another one, and the separators of lines and paragraphs.
static bool turns_text(const unsigned char *c)
{
    if (c[0] == 0xd8)
        return c[1] == 0x9c; // U+061C
    return c[0] == 0xe2 && ((c[1] == 0x80 && (c[2] == 0x8e || c[2] == 0x8f || // U+200E, U+200F
                                              (c[2] >= 0xa8 && c[2] <= 0xae))) || // to U+202E
                            (c[1] == 0x81 && c[2] >= 0xa6 && c[2] <= 0xa9)); // U+2066 to U+2069
}

static bool controls_terminal(const unsigned char *c)
{
    return (c[0] < 0x20 && c[0] != '\n' && c[0] != '\t') || c[0] == 0x7f ||
           (c[0] == 0xc2 && c[1] < 0xa0) || turns_text(c); // C1 controls, U+0080 to U+009F
}

void orl_text_escape(const char *text, char *out, size_t size)
{
    size_t used = 0;
    while (*text) {
        const unsigned char *c = (const unsigned char *)text;
        size_t length = utf8_length(text);
        char coded[5];
        const char *from = text;
        bool escaped = length == 0 || controls_terminal(c);
        if (escaped) { // further bytes are invalid alone: escaped next
            snprintf(coded, sizeof coded, "\\x%02x", c[0]);
            from = coded;
        }
        size_t wide = escaped ? 4 : length;
        if (used + wide + 1 > size)
            break;
        memcpy(out + used, from, wide);
        used += wide;
        text += escaped ? 1 : length;
    }
    if (size)
        out[used] = '\0';
}

size_t orl_utf8_mark_length(const void *text, size_t size)
{
    return size >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0 ? 3 : 0;
}

bool orl_is_utf16(const void *text, size_t size)
{
    return size >= 2 && (memcmp(text, "\xff\xfe", 2) == 0 || memcmp(text, "\xfe\xff", 2) == 0);
}
