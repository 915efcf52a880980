// Text from untrusted sources: names and contents of files.
#ifndef ORL_CORE_TEXT_H
#define ORL_CORE_TEXT_H

#include "oriel/common.h"

// Length in bytes of the UTF-8 character at the start of `text`; 0 when there is none.
size_t orl_utf8_length(const char *text);
bool orl_utf8_valid(const char *text);

// Copies as much of `text` as fits into `size` bytes. Control characters other than newline and
// tab, which could manipulate a terminal, and bytes that are not UTF-8 become "\xNN".
enum { ORL_TEXT_SHOWN = 1024 }; // buffer size in bytes; holds most file names completely
void orl_text_escape(const char *text, char *out, size_t size);

#endif
