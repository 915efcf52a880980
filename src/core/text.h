// Text that comes from elsewhere: names of files, what a file says.
#ifndef ORL_CORE_TEXT_H
#define ORL_CORE_TEXT_H

#include "oriel/common.h"

// Bytes of the UTF-8 character that `text` begins with; 0: it begins with none.
size_t orl_utf8_length(const char *text);
bool orl_utf8_valid(const char *text);

// Copies what fits. Control characters other than newline and tab, which could make a terminal
// lie, and bytes that are not UTF-8 become "\xNN".
enum { ORL_TEXT_SHOWN = 1024 }; // bytes that show most names of files whole
void orl_text_escape(const char *text, char *out, size_t size);

#endif
