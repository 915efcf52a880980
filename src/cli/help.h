// What there is to read of commands, from their tables.
#ifndef ORL_CLI_HELP_H
#define ORL_CLI_HELP_H

#include "cli/command.h"

// The commands in their groups.
void help_print_overview(FILE *out);
// The hidden commands.
void help_print_jobs(FILE *out);
// What oriel COMMAND --help says.
void help_print(FILE *out, const struct command *command);
// "(auto, full; default auto)" or "(1 to 16; default 8)" for an option; "" where its help says all.
enum { HELP_FACTS = 256 };
void help_facts(const struct orl_option *row, char facts[HELP_FACTS]);

// Whole pages (pages.c).
void page_man(FILE *out);
void page_bash(FILE *out);
void page_zsh(FILE *out);
void page_fish(FILE *out);
void page_markdown(FILE *out);
// Prints what the last of the words after "oriel" can become: a line each, its meaning after a tab. Nothing: a
// file, or what nobody knows.
void help_complete(size_t count, const char *const *words);

#endif
