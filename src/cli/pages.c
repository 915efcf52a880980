// The man page, completions for shells and the reference of all commands, from their tables.
#include <string.h>

#include "cli/help.h"
#include "oriel/render.h"

// --- what all pages need ---

// Options of the command, and then those of every command, which end with a NULL name.
static const struct orl_option *option_at(const struct command *command, size_t index)
{
    const struct orl_option *row = command->rows();
    for (; row->name && index; row++)
        index--;
    return row->name ? row : &common_option_rows()[index];
}

// Writes text with a backslash before each of the characters in `special`.
static void print_escaped(FILE *out, const char *text, const char *special)
{
    for (; *text; text++)
        fprintf(out, strchr(special, *text) ? "\\%c" : "%c", *text);
}

static const char *job_word(const struct command *command)
{
    return command->hidden ? "job " : "";
}

// The `index`-th word that an option's value can be; false past the last, or where it is not one of
// a few.
static bool value_at(const struct orl_option *row, size_t index, char name[ORL_OPTION_TEXT])
{
    if (row->kind == ORL_VALUE_CHOICE)
        return orl_option_name(row, index, name);
    for (size_t i = 0; i <= index && strcmp(row->name, "method") == 0; i++) {
        if (!orl_methods[i].name)
            return false;
        snprintf(name, ORL_OPTION_TEXT, "%s", orl_methods[i].name);
    }
    return strcmp(row->name, "method") == 0;
}

static void print_values(FILE *out, const struct orl_option *row)
{
    char name[ORL_OPTION_TEXT];
    for (size_t i = 0; value_at(row, i, name); i++)
        fprintf(out, "%s%s", i ? " " : "", name);
}

static bool has_values(const struct orl_option *row)
{
    char name[ORL_OPTION_TEXT];
    return value_at(row, 0, name);
}

static bool is_file(const struct orl_option *row)
{
    static const char *const words[] = {"FILE", "DIR", "SCENE", "SITE"};
    for (size_t i = 0; i < ORL_COUNT(words); i++)
        if (strstr(row->meta, words[i]))
            return true;
    return false;
}

static void print_commands(FILE *out, bool hidden)
{
    for (size_t i = 0; commands[i]; i++)
        if (commands[i]->hidden == hidden)
            fprintf(out, "%s ", commands[i]->name);
}

// --- the man page ---

static void print_man(FILE *out, const char *text)
{
    print_escaped(out, text, "\\-");
}

static void print_man_option(FILE *out, const struct orl_option *row)
{
    char facts[HELP_FACTS];
    help_facts(row, facts);
    fprintf(out, ".TP\n\\fB\\-\\-");
    print_man(out, row->name);
    fprintf(out, "\\fR \\fI");
    print_man(out, row->meta);
    fprintf(out, "\\fR\n\\&");
    print_man(out, row->help);
    if (*facts)
        fprintf(out, " (");
    print_man(out, facts);
    fprintf(out, "%s\n", *facts ? ")" : "");
}

static void print_man_command(FILE *out, const struct command *command)
{
    fprintf(out, ".SS \"oriel %s%s\"\n.B oriel %s%s\n", job_word(command), command->name,
            job_word(command), command->name);
    for (const char *line = command->usage; *line; line += strspn(line, " \n")) {
        size_t length = strcspn(line, "\n");
        char text[256];
        snprintf(text, sizeof text, "%.*s", (int)length, line);
        print_man(out, text);
        fprintf(out, "\n");
        line += length;
    }
    fprintf(out, ".PP\n");
    print_man(out, command->summary);
    fprintf(out, "\n");
    if (command->print_more) {
        fprintf(out, ".PP\n.nf\n");
        command->print_more(out);
        fprintf(out, ".fi\n");
    }
    for (const struct orl_option *row = command->rows(); row->name; row++)
        print_man_option(out, row);
}

void page_man(FILE *out)
{
    fprintf(out, ".TH ORIEL 1 \"\" \"oriel " ORL_VERSION "\" \"User Commands\"\n"
                 ".SH NAME\noriel \\- walk through photographs of a place\n"
                 ".SH SYNOPSIS\n.B oriel\n.I COMMAND\n[\\fIARGUMENT\\fR...] [\\fIOPTION\\fR...]\n"
                 ".SH DESCRIPTION\n"
                 "Makes a scene from handheld photographs and renders views of it that nobody took: as "
                 "pictures, as video, and in the browser.\n"
                 ".SH OPTIONS\nEvery command takes these.\n");
    for (const struct orl_option *row = common_option_rows(); row->name; row++)
        print_man_option(out, row);
    fprintf(out, ".SH COMMANDS\n");
    for (size_t i = 0; commands[i]; i++)
        print_man_command(out, commands[i]);
    fprintf(out, ".SH EXIT STATUS\n"
                 "0 if the whole job was done, 2 if an argument or an input file is wrong, 130 after "
                 "an interruption, 1 after any other failure.\n"
                 ".SH ENVIRONMENT\n.TP\n.B ORIEL_COLMAP\nnames the program colmap when it is not on "
                 "PATH.\n.SH SEE ALSO\n.BR colmap (1),\nthe guide in the package's documentation\n");
}

// --- completions ---

void page_bash(FILE *out)
{
    fprintf(out, "# Completion of oriel for bash.\n_oriel()\n{\n"
                 "    local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD-1]}\n"
                 "    local command=${COMP_WORDS[1]} first=1 words=\n"
                 "    [ \"$command\" != job ] || { command=\"job ${COMP_WORDS[2]}\"; first=2; }\n"
                 "    if [ \"$COMP_CWORD\" -le \"$first\" ]; then\n"
                 "        words='");
    print_commands(out, false);
    fprintf(out, "job version'\n        [ \"$first\" -eq 1 ] || words='");
    print_commands(out, true);
    fprintf(out, "'\n        mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$cur\")\n        return\n    fi\n"
                 "    case \"$command $prev\" in\n");
    for (size_t i = 0; commands[i]; i++)
        for (const struct orl_option *row = commands[i]->rows(); row->name; row++)
            if (has_values(row)) {
                fprintf(out, "    '%s%s --%s') words='", job_word(commands[i]), commands[i]->name,
                        row->name);
                print_values(out, row);
                fprintf(out, "' ;;\n");
            }
    fprintf(out, "    'help '*) words='");
    print_commands(out, false);
    fprintf(out, "' ;;\n    esac\n    if [ -z \"$words\" ] && [[ $cur == -* ]]; then\n"
                 "        case $command in\n");
    for (size_t i = 0; commands[i]; i++) {
        fprintf(out, "        '%s%s') words='", job_word(commands[i]), commands[i]->name);
        for (size_t k = 0; option_at(commands[i], k)->name; k++)
            fprintf(out, "--%s ", option_at(commands[i], k)->name);
        fprintf(out, "' ;;\n");
    }
    fprintf(out, "        esac\n    fi\n    mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$cur\")\n}\n"
                 "complete -o default -F _oriel oriel\n");
}

static void print_zsh_option(FILE *out, const struct orl_option *row)
{
    fprintf(out, " \\\n            '%s--%s[", row->kind == ORL_VALUE_LIST ? "*" : "", row->name);
    for (const char *c = row->help; *c; c++) // a quote ends the word that it stands in
        fprintf(out, *c == '\'' ? "'\\''" : strchr("[]:\\", *c) ? "\\%c" : "%c", *c);
    fprintf(out, "]");
    if (row->kind != ORL_VALUE_FLAG) {
        fprintf(out, ":");
        print_escaped(out, row->meta, ":[]");
        fprintf(out, has_values(row) ? ":(" : ":");
        print_values(out, row);
        fprintf(out, has_values(row) ? ")" : is_file(row) ? "_files" : " ");
    }
    fprintf(out, "'");
}

void page_zsh(FILE *out)
{
    fprintf(out, "#compdef oriel\n# Completion of oriel for zsh.\n_oriel()\n{\n"
                 "    local command=$words[2]\n"
                 "    if (( CURRENT == 2 )); then\n        compadd -- ");
    print_commands(out, false);
    fprintf(out, "job version\n        return\n    fi\n"
                 "    if [[ $command == job ]]; then\n"
                 "        if (( CURRENT == 3 )); then\n            compadd -- ");
    print_commands(out, true);
    fprintf(out, "\n            return\n        fi\n        command=\"job $words[3]\"\n"
                 "        shift words\n        (( CURRENT-- ))\n    fi\n"
                 "    shift words\n    (( CURRENT-- ))\n    case $command in\n");
    for (size_t i = 0; commands[i]; i++) {
        fprintf(out, "    '%s%s')\n        _arguments", job_word(commands[i]), commands[i]->name);
        for (size_t k = 0; option_at(commands[i], k)->name; k++)
            print_zsh_option(out, option_at(commands[i], k));
        fprintf(out, " \\\n            '*:file:_files'\n        ;;\n");
    }
    fprintf(out, "    esac\n}\n_oriel \"$@\"\n");
}

void page_fish(FILE *out)
{
    static const char *const first = "__fish_use_subcommand";
    fprintf(out, "# Completion of oriel for fish.\n");
    for (size_t i = 0; commands[i]; i++) {
        const struct command *command = commands[i];
        char seen[64];
        snprintf(seen, sizeof seen, "__fish_seen_subcommand_from %s", command->name);
        fprintf(out, "complete -c oriel -n '%s' -fa %s -d '",
                command->hidden ? "__fish_seen_subcommand_from job" : first, command->name);
        print_escaped(out, command->brief, "'\\");
        fprintf(out, "'\n");
        for (size_t k = 0; option_at(command, k)->name; k++) {
            const struct orl_option *row = option_at(command, k);
            fprintf(out, "complete -c oriel -n '%s' -l %s%s", seen, row->name,
                    row->kind == ORL_VALUE_FLAG ? "" : is_file(row) ? " -r" : " -x");
            if (has_values(row)) {
                fprintf(out, " -a '");
                print_values(out, row);
                fprintf(out, "'");
            }
            fprintf(out, " -d '");
            print_escaped(out, row->help, "'\\");
            fprintf(out, "'\n");
        }
    }
    fprintf(out, "complete -c oriel -n '%s' -fa 'job version'\n", first);
}

// --- the reference ---

static void print_markdown_option(FILE *out, const struct orl_option *row)
{
    char facts[HELP_FACTS];
    help_facts(row, facts);
    fprintf(out, "| `--%s%s", row->name, *row->meta ? " " : "");
    print_escaped(out, row->meta, "|");
    fprintf(out, "` | ");
    print_escaped(out, row->help, "|<*_");
    fprintf(out, " | %s |\n", facts);
}

void page_markdown(FILE *out)
{
    fprintf(out, "# Options of commands\n\n"
                 "What `oriel help COMMAND` says, made of the same tables by `oriel help --as "
                 "markdown`; a test fails when the two\ndiffer. [Commands](../guide/commands.md) says "
                 "what each is for. Every command also takes these:\n\n"
                 "| option | what it does | values |\n|---|---|---|\n");
    for (const struct orl_option *row = common_option_rows(); row->name; row++)
        print_markdown_option(out, row);
    for (size_t i = 0; commands[i]; i++) {
        const struct command *command = commands[i];
        fprintf(out, "\n## %s%s\n\n    oriel %s%s %s\n\n%s\n", job_word(command), command->name,
                job_word(command), command->name, command->usage, command->summary);
        if (command->print_more) {
            fprintf(out, "\n```\n");
            command->print_more(out);
            fprintf(out, "```\n");
        }
        if (command->rows()->name)
            fprintf(out, "\n| option | what it does | values |\n|---|---|---|\n");
        for (const struct orl_option *row = command->rows(); row->name; row++)
            print_markdown_option(out, row);
    }
}
