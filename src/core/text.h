// Text from untrusted sources: names and contents of files.
#ifndef ORL_CORE_TEXT_H
#define ORL_CORE_TEXT_H

#include "oriel/common.h"

// True when a list, which ends with NULL, has the text.
bool orl_text_is_one_of(const char *text, const char *const *list);

// Length of the mark that some editors put ahead of UTF-8 text: 3 or 0.
size_t orl_utf8_mark_length(const void *text, size_t size);
// True when text begins as UTF-16 does.
bool orl_is_utf16(const void *text, size_t size);

// Copies as much of `text` as fits into `size` bytes. Control characters other than newline and
// tab, which could manipulate a terminal, and bytes that are not UTF-8 become "\xNN".
enum { ORL_TEXT_SHOWN = 1024 }; // buffer size in bytes; holds most file names completely
void orl_text_escape(const char *text, char *out, size_t size);

#endif
