// oriel help: what --help says, and the pages that are made of the same tables.
#include <stdio.h>
#include <string.h>

#include "cli/help.h"

#define HELP_FORMS(NAME) \
    NAME(HELP_TEXT, "text") NAME(HELP_MAN, "man") NAME(HELP_BASH, "bash") NAME(HELP_ZSH, "zsh") \
    NAME(HELP_FISH, "fish") NAME(HELP_MARKDOWN, "markdown")
enum help_form { HELP_FORMS(ORL_ENUMERATOR) };
#define HELP_OPTIONS(ROW) \
    ROW(form, "as", CHOICE(help_form, HELP_FORMS, HELP_TEXT, "FORM"), \
        "of all commands: the man page, completions for a shell, or the reference")
COMMAND_OPTIONS(help_options, HELP_OPTIONS)

static enum orl_result run_help(struct call *call)
{
    static void (*const pages[])(FILE *out) = {
        [HELP_TEXT] = help_print_overview, [HELP_MAN] = page_man, [HELP_BASH] = page_bash,
        [HELP_ZSH] = page_zsh, [HELP_FISH] = page_fish, [HELP_MARKDOWN] = page_markdown};
    const struct help_options *o = call->options;
    const struct command *command = NULL;
    if (call->inputs[0] && strcmp(call->inputs[0], "job") == 0) {
        help_print_jobs(stdout);
        return ORL_OK;
    }
    if (call->inputs[0] && !(command = command_find(call->inputs[0], false)))
        command = command_find(call->inputs[0], true);
    if (call->inputs[0] && !command)
        return orl_fail(call->log, ORL_ERR_ARGUMENT, "unknown command %s; oriel help lists all",
                        call->inputs[0]);
    if (command)
        help_print(stdout, command);
    else
        pages[o->form](stdout);
    return ORL_OK;
}

const struct command command_help = {
    .name = "help", .group = COMMAND_JOB,
    .brief = "say more about a command",
    .usage = "[COMMAND] [--as FORM]",
    .summary = "Says what --help of the command does; without one, which commands there are.",
    COMMAND_TABLE(help_options), .inputs_min = 0, .inputs_max = 1, .run = run_help,
};
