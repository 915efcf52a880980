// oriel methods: lists the rendering methods and their options.
#include <stdio.h>
#include <string.h>

#include "cli/command.h"
#include "core/arguments.h"
#include "oriel/render.h"

static void print_list(void)
{
    for (const struct orl_method *m = orl_methods; m->name; m++) {
        char cost[128];
        orl_method_cost(m, cost, sizeof cost);
        printf("%-14s %s\n%-14s source: %s\n%-14s asks: %s\n%-14s cost: %s\n", m->name,
               m->description, "", m->source, "", orl_method_asks(m), "", cost);
    }
    printf("\noriel methods NAME lists the options of one.\n");
}

// Prints an option's value and range.
static void print_option(const struct orl_option *option, const struct orl_render_params *params)
{
    char value[ORL_OPTION_TEXT], allowed[ORL_OPTION_ALLOWED + 32];
    orl_option_print(option, params, value);
    orl_option_allowed(option, allowed);
    size_t used = strlen(allowed);
    snprintf(allowed + used, sizeof allowed - used, "%s%s", *option->meta ? " " : "", option->meta);
    printf("%-18s %-12s %-30s %s\n", option->name, value, allowed, option->help);
}

static enum orl_result print_method(const struct orl_log *log, const char *name)
{
    const struct orl_method *method = orl_method_find(log, name);
    if (!method)
        return ORL_ERR_ARGUMENT;
    char cost[128];
    orl_method_cost(method, cost, sizeof cost);
    printf("%s: %s\nsource: %s\nasks: %s\ncost: %s\n\n%-18s %-12s %-30s %s\n", method->name,
           method->description, method->source, orl_method_asks(method), cost, "option", "value",
           "allowed", "what it is");
    for (const struct orl_option *o = orl_render_options(); o->name; o++)
        if (orl_render_option_read(o, &method->params))
            print_option(o, &method->params);
    return ORL_OK;
}

static enum orl_result run_methods(struct call *call)
{
    if (call->inputs[0])
        return print_method(call->log, call->inputs[0]);
    print_list();
    return ORL_OK;
}

const struct command command_methods = {
    .name = "methods", .group = COMMAND_LOOK,
    .brief = "list the methods of rendering and their options",
    .usage = "[NAME]",
    .summary = "Lists the methods of rendering; of one, the options that it reads, with their values.",
    .rows = no_option_rows, .inputs_min = 0, .inputs_max = 1, .run = run_methods,
};
