// The man page, completions for shells and the reference of all commands, from their tables.
#include <string.h>

#include "cli/help.h"
#include "oriel/render.h"

// --- what all pages need ---

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
    print_man(out, command->usage);
    fprintf(out, "\n.PP\n");
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
                 "0 if the whole job was done, 2 if an argument or an input file is wrong or not "
                 "supported, 130 after an interruption, 1 after any other failure.\n"
                 ".SH ENVIRONMENT\n.TP\n.B ORIEL_COLMAP\nnames the program colmap when it is not on "
                 "PATH.\n.SH SEE ALSO\n.BR colmap (1),\nthe guide in the package's documentation\n");
}

// --- completions: shells ask the program for each word ---

void page_bash(FILE *out)
{
    fprintf(out, "# Completion of oriel for bash.\n_oriel()\n{\n"
                 "    mapfile -t COMPREPLY < <(\"$1\" help --complete \"${COMP_WORDS[@]:1:COMP_CWORD}\" | cut -f 1)\n"
                 "}\ncomplete -o default -F _oriel oriel\n");
}

void page_zsh(FILE *out)
{
    // A colon parts a word from its meaning.
    fprintf(out, "#compdef oriel\n# Completion of oriel for zsh.\nlocal -a found\n"
                 "found=(${(f)\"$($words[1] help --complete \"${(@)words[2,CURRENT]}\")\"})\n"
                 "found=(\"${(@)found//:/\\\\:}\")\nfound=(\"${(@)found/$'\\t'/:}\")\n"
                 "if (( $#found )); then\n    _describe oriel found\nelse\n    _files\nfi\n");
}

void page_fish(FILE *out)
{
    fprintf(out, "# Completion of oriel for fish.\nfunction __oriel_complete\n"
                 "    set -l words (commandline -opc)\n    set -l begun (commandline -ct)\n"
                 "    $words[1] help --complete $words[2..] \"$begun\"\nend\n"
                 "complete -c oriel -n 'count (__oriel_complete) >/dev/null' -fa '(__oriel_complete)'\n");
}

// A line for the word, with its meaning after a tab, if it begins as typed.
static void offer(const char *begun, const char *prefix, const char *name, const char *meaning)
{
    char word[64];
    snprintf(word, sizeof word, "%s%s", prefix, name);
    if (strncmp(word, begun, strlen(begun)) == 0)
        printf("%s\t%s\n", word, meaning);
}

static void offer_commands(const char *begun, bool hidden)
{
    for (size_t i = 0; commands[i]; i++)
        if (commands[i]->hidden == hidden)
            offer(begun, "", commands[i]->name, commands[i]->brief);
    if (!hidden)
        offer(begun, "", "job", "what the jobs of plan call");
}

static void offer_values(const char *begun, const struct orl_option *row)
{
    char name[ORL_OPTION_TEXT];
    for (size_t i = 0; row->kind == ORL_VALUE_CHOICE && orl_option_name(row, i, name); i++)
        offer(begun, "", name, "");
    for (const struct orl_method *m = orl_methods; strcmp(row->name, "method") == 0 && m->name; m++)
        offer(begun, "", m->name, m->description);
}

void help_complete(size_t count, const char *const *words)
{
    bool job = count > 1 && strcmp(words[0], "job") == 0;
    words += job;
    count -= job;
    const char *begun = count ? words[count - 1] : "", *before = count > 1 ? words[count - 2] : "";
    const struct command *command = count > 1 ? command_find(words[0], job) : NULL;
    if (count < 2)
        offer_commands(begun, job);
    if (count < 2 && !job)
        offer(begun, "", "version", "print the version");
    if (!command)
        return;
    const struct orl_option *const sets[] = {command->rows(), common_option_rows()};
    for (size_t i = 0; i < ORL_COUNT(sets); i++)
        for (const struct orl_option *row = sets[i]; row->name; row++)
            if (strncmp(before, "--", 2) == 0 && strcmp(before + 2, row->name) == 0)
                offer_values(begun, row);
            else if (*begun == '-')
                offer(begun, "--", row->name, row->help);
    if (command == &command_help && *begun != '-' && *before != '-')
        offer_commands(begun, false);
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
