// Tables of options. A table is a macro, #define LIST(ROW), which says everything about each option
// once, in a row such as
//
//     ROW(views, "views", INT(8, 1, 100, "N"), "photographs, at most")
//
// ROW(field, flag, kind, help[, of]): the member of the struct, the option without "--", one of the
// kinds below with default, range and placeholder, one line of help, and what the option is part of
// (struct orl_option). Options of rendering have more (option_list.h). ORL_OPTION_MEMBER, ORL_OPTION_PRESET and ORL_OPTION_ROWS make the struct, its
// defaults and the rows of such a table; core/arguments.h parses, prints and records by the rows.
#ifndef ORIEL_OPTION_ROW_H
#define ORIEL_OPTION_ROW_H

#include <stddef.h>
#include <stdint.h>

#include "oriel/names.h"

enum { ORL_OPTION_TEXT = 32, ORL_TRIES_MAX = 6 };
typedef char orl_word[ORL_OPTION_TEXT];

struct orl_size {
    int width, height; // 0 0: not given
};
struct orl_part {
    int index, count; // part `index` of `count`, from 0 on; 0 0: not given
};
// Photographs by their place in the order of names, from 0.
struct orl_test_block {
    int first, end; // first to end - 1; end 0: none
};

enum orl_value_kind {
    ORL_VALUE_FLAG,   // bool
    ORL_VALUE_TEXT,   // const char *
    ORL_VALUE_PATH,   // const char *; recorded as an absolute path
    ORL_VALUE_NEEDED, // const char * that must be given
    ORL_VALUE_INT,    // int in [low, high]; a default outside means that none was given
    ORL_VALUE_NUMBER, // double, the same
    ORL_VALUE_SEED,   // uint32_t
    ORL_VALUE_MIB,    // size_t, bytes; given in MiB, [1, high]; 0: not given
    ORL_VALUE_SIZE,   // struct orl_size: WxH
    ORL_VALUE_LIST,   // struct orl_names: A,B,C, or the option repeated
    ORL_VALUE_CHOICE, // enum, or int where -1 is none; one of a few names
    ORL_VALUE_PART,   // struct orl_part: K/N
    ORL_VALUE_BLOCK,  // struct orl_test_block: A:B
    ORL_VALUE_FLOAT,  // float in [low, high]
    ORL_VALUE_WORD,   // orl_word: one of a few names, and zeros
    ORL_VALUE_SLOT,   // pointer to one of a few structs that begin with their names
};

struct orl_option {
    const char *name; // without "--"; NULL after the last row
    enum orl_value_kind kind;
    size_t offset, size; // of the member
    double preset, low, high;
    // One of these has the names of a choice. An extension, as of a file, is no part of a name.
    const char *words;                    // each followed by a space
    const char *(*name_at)(size_t index); // NULL past the last
    const void *const *slots;             // ended by NULL
    const char *meta;  // placeholder such as "DIR"; of a FLOAT its unit
    const char *help;
    // What the option is part of, as words; "-": never recorded. STAGE=KEY: the stage's key has the
    // value under this name. STAGE?KEY: only if it is not the default.
    const char *of;
    // Of an option of rendering, which is given as NAME=VALUE: the choices that make anything read it, as
    // "NAME=VALUE" separated by spaces, any of which is enough; "": every frame does. NULL: one of a command.
    const char *readers;
    double tries[ORL_TRIES_MAX]; // values that oriel tune tries, ascending
    int try_count;               // 0: oriel tune does not change it
};
// The `index`-th name of a choice; false past the end.
bool orl_option_name(const struct orl_option *row, size_t index, char name[ORL_OPTION_TEXT]);
// Prints a number or choice as it is given; false: it is not given.
bool orl_option_print(const struct orl_option *row, const void *values, char text[ORL_OPTION_TEXT]);
// The value of a number. That of a size in memory is in MiB.
double orl_option_number(const struct orl_option *row, const void *values);
// True if both have the same value.
bool orl_option_equal(const struct orl_option *row, const void *a, const void *b);

// An enum and its names from one list, #define LIST(NAME) NAME(ENUMERATOR, "name") ...
#define ORL_ENUMERATOR(value, name) value,
#define ORL_ENUM_NAME(value, name) name,
#define ORL_ENUM_WORD(value, name) name " "

#define ORL_MEMBER_FLAG bool
#define ORL_MEMBER_TEXT(meta) const char *
#define ORL_MEMBER_PATH(meta) const char *
#define ORL_MEMBER_NEEDED(meta) const char *
#define ORL_MEMBER_INT(preset, low, high, meta) int
#define ORL_MEMBER_NUMBER(preset, low, high, meta) double
#define ORL_MEMBER_SEED uint32_t
#define ORL_MEMBER_MIB(high) size_t
#define ORL_MEMBER_SIZE struct orl_size
#define ORL_MEMBER_LIST(meta) struct orl_names
#define ORL_MEMBER_CHOICE(type, list, preset, meta) enum type
#define ORL_MEMBER_MAYBE(list, meta) int
#define ORL_MEMBER_NAMED(name_at, preset, meta) int
#define ORL_MEMBER_PART struct orl_part
#define ORL_MEMBER_BLOCK struct orl_test_block
#define ORL_MEMBER_FLOAT(preset, low, high, unit) float
#define ORL_MEMBER_WORD(name_at, preset) orl_word
#define ORL_MEMBER_SLOT(type, slots, preset) const struct type *
#define ORL_OPTION_MEMBER(field, flag, kind, ...) ORL_MEMBER_##kind field;

#define ORL_PRESET_FLAG false
#define ORL_PRESET_TEXT(meta) NULL
#define ORL_PRESET_PATH(meta) NULL
#define ORL_PRESET_NEEDED(meta) NULL
#define ORL_PRESET_INT(preset, low, high, meta) preset
#define ORL_PRESET_NUMBER(preset, low, high, meta) preset
#define ORL_PRESET_SEED 1
#define ORL_PRESET_MIB(high) 0
#define ORL_PRESET_SIZE {0, 0}
#define ORL_PRESET_LIST(meta) {0, 0, NULL}
#define ORL_PRESET_CHOICE(type, list, preset, meta) preset
#define ORL_PRESET_MAYBE(list, meta) (-1)
#define ORL_PRESET_NAMED(name_at, preset, meta) preset
#define ORL_PRESET_PART {0, 0}
#define ORL_PRESET_BLOCK {0, 0}
#define ORL_PRESET_FLOAT(preset, low, high, unit) preset
#define ORL_PRESET_WORD(name_at, preset) preset
#define ORL_PRESET_SLOT(type, slots, preset) preset
#define ORL_OPTION_PRESET(field, flag, kind, ...) .field = ORL_PRESET_##kind,

// A member of another struct with the same option, from `o`.
#define ORL_OPTION_COPY(field, ...) .field = o->field,

#define ORL_FACTS_FLAG .kind = ORL_VALUE_FLAG, .meta = ""
#define ORL_FACTS_TEXT(text) .kind = ORL_VALUE_TEXT, .meta = text
#define ORL_FACTS_PATH(text) .kind = ORL_VALUE_PATH, .meta = text
#define ORL_FACTS_NEEDED(text) .kind = ORL_VALUE_NEEDED, .meta = text
#define ORL_FACTS_INT(value, least, most, text) \
    .kind = ORL_VALUE_INT, .preset = value, .low = least, .high = most, .meta = text
#define ORL_FACTS_NUMBER(value, least, most, text) \
    .kind = ORL_VALUE_NUMBER, .preset = value, .low = least, .high = most, .meta = text
#define ORL_FACTS_SEED .kind = ORL_VALUE_SEED, .preset = 1, .high = INT32_MAX, .meta = "N"
#define ORL_FACTS_MIB(most) .kind = ORL_VALUE_MIB, .low = 1, .high = most, .meta = "MIB"
#define ORL_FACTS_SIZE .kind = ORL_VALUE_SIZE, .meta = "WxH"
#define ORL_FACTS_LIST(text) .kind = ORL_VALUE_LIST, .meta = text
#define ORL_FACTS_CHOICE(type, list, value, text) \
    .kind = ORL_VALUE_CHOICE, .preset = value, .words = list(ORL_ENUM_WORD), .meta = text
#define ORL_FACTS_MAYBE(list, text) \
    .kind = ORL_VALUE_CHOICE, .preset = -1, .words = list(ORL_ENUM_WORD), .meta = text
#define ORL_FACTS_NAMED(function, value, text) \
    .kind = ORL_VALUE_CHOICE, .preset = value, .name_at = function, .meta = text
#define ORL_FACTS_PART .kind = ORL_VALUE_PART, .meta = "K/N"
#define ORL_FACTS_BLOCK .kind = ORL_VALUE_BLOCK, .meta = "A:B"
#define ORL_FACTS_FLOAT(value, least, most, unit) \
    .kind = ORL_VALUE_FLOAT, .low = least, .high = most, .meta = unit
#define ORL_FACTS_WORD(function, value) .kind = ORL_VALUE_WORD, .name_at = function, .meta = ""
#define ORL_FACTS_SLOT(type, list, value) .kind = ORL_VALUE_SLOT, .slots = list, .meta = ""
// `options_here`: a name that ORL_OPTION_ROWS gives to the table's struct.
#define ORL_OPTION_FACTS(field, flag, facts, ...) \
    {.name = flag, .offset = offsetof(options_here, field), .size = sizeof((options_here *)0)->field, \
     ORL_FACTS_##facts, __VA_ARGS__},

// Defines a function that returns the rows of a table.
#define ORL_OPTION_ROWS(function, type, list)                                                    \
    const struct orl_option *function(void)                                                         \
    {                                                                                            \
        typedef struct type options_here;                                                        \
        static const struct orl_option rows[] = {list(ORL_OPTION_FACTS) {0}};                       \
        return rows;                                                                             \
    }

#endif
