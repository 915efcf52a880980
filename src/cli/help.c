#include "cli/help.h"

#include <string.h>

enum { INDENT = 30, WIDTH = 100 };

void help_facts(const struct orl_option *row, char facts[HELP_FACTS])
{
    char name[ORL_OPTION_TEXT], preset[64] = "";
    bool choice = row->kind == ORL_VALUE_CHOICE, told = strstr(row->help, "default") != NULL;
    if (choice && row->preset >= 0 && orl_option_name(row, (size_t)row->preset, name))
        snprintf(preset, sizeof preset, "default %s", name);
    else if (!choice && !told && orl_option_has_preset(row))
        snprintf(preset, sizeof preset, "default %.10g", row->preset);
    facts[0] = '\0';
    // Limits that only guard against nonsense are not worth telling.
    if (choice || ((row->kind == ORL_VALUE_INT || row->kind == ORL_VALUE_NUMBER) && row->high < 1000))
        orl_option_allowed(row, facts);
    size_t used = strlen(facts);
    snprintf(facts + used, HELP_FACTS - used, "%s%s", used && *preset ? "; " : "", preset);
}

// Prints words from column `column` on, in lines that begin at INDENT.
static void print_wrapped(FILE *out, int column, const char *text)
{
    for (text += strspn(text, " "); *text; text += strspn(text, " ")) {
        int length = (int)strcspn(text, " ");
        if (column > INDENT && column + 1 + length > WIDTH) {
            fprintf(out, "\n%*s", INDENT, "");
            column = INDENT;
        }
        column += fprintf(out, "%s%.*s", column > INDENT ? " " : "", length, text);
        text += length;
    }
    fprintf(out, "\n");
}

static void print_option(FILE *out, const struct orl_option *row)
{
    char facts[HELP_FACTS], text[1024];
    help_facts(row, facts);
    snprintf(text, sizeof text, *facts ? "%s (%s)" : "%s", row->help, facts);
    int used = fprintf(out, "  --%s%s%s", row->name, *row->meta ? " " : "", row->meta);
    fprintf(out, used < INDENT ? "%*s" : "\n%*s", used < INDENT ? INDENT - used : INDENT, "");
    print_wrapped(out, INDENT, text);
}

void help_print(FILE *out, const struct command *command)
{
    fprintf(out, "usage: oriel %s%s %s\n\n%s\n", command->hidden ? "job " : "", command->name,
            command->usage, command->summary);
    if (command->print_more)
        command->print_more(out);
    fprintf(out, "\noptions:\n");
    for (const struct orl_option *row = command->rows(); row->name; row++)
        print_option(out, row);
    for (const struct orl_option *row = common_option_rows(); row->name; row++)
        print_option(out, row);
}

void help_print_overview(FILE *out)
{
    fprintf(out, "usage: oriel COMMAND ...    (oriel help COMMAND says more)\n");
    for (size_t g = 0; g < COMMAND_GROUP_COUNT; g++) {
        fprintf(out, "\n%s\n", command_groups[g]);
        for (size_t i = 0; commands[i]; i++)
            if (commands[i]->group == g && !commands[i]->hidden)
                fprintf(out, "  %-10s %s\n", commands[i]->name, commands[i]->brief);
    }
    fprintf(out, "  %-10s %s\n", "job", "what the jobs of plan call; oriel help job lists it");
    fprintf(out, "  %-10s %s\n", "version", "print the version");
}

void help_print_jobs(FILE *out)
{
    fprintf(out, "usage: oriel job COMMAND ...    (oriel help COMMAND says more)\n\n"
                 "What only the jobs of oriel plan call:\n");
    for (size_t i = 0; commands[i]; i++)
        if (commands[i]->hidden)
            fprintf(out, "  %-10s %s\n", commands[i]->name, commands[i]->brief);
}
