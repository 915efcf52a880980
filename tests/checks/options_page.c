// Prints docs/reference/options.md from the option table.
#include <stdio.h>

#include "oriel/render.h"

static void print_reader(const char *readers)
{
    if (!*readers) {
        printf("every frame");
        return;
    }
    printf("`");
    for (const char *c = readers; *c; c++)
        *c == ' ' ? printf("`, `") : putchar(*c);
    printf("`");
}

static void print_values(const struct orl_option *option)
{
    char name[ORL_OPTION_TEXT];
    if (option->kind == ORL_VALUE_FLOAT) {
        printf("%g to %g%s%s", option->low, option->high, *option->meta ? " " : "",
               option->meta);
        return;
    }
    for (size_t i = 0; orl_option_name(option, i, name); i++)
        printf("%s`%s`", i ? ", " : "", name);
}

static void print_options(void)
{
    printf("| option | values | read by | what it does | `oriel tune` tries |\n"
           "|---|---|---|---|---|\n");
    for (const struct orl_option *o = orl_render_options(); o->name; o++) {
        printf("| `%s` | ", o->name);
        print_values(o);
        printf(" | ");
        print_reader(o->readers);
        printf(" | %s | ", o->help);
        for (int i = 0; i < o->try_count; i++)
            printf("%s%g", i ? ", " : "", o->tries[i]);
        printf(" |\n");
    }
}

static void print_methods(void)
{
    printf("| option |");
    for (const struct orl_method *m = orl_methods; m->name; m++)
        printf(" %s |", m->name);
    printf("\n|---|");
    for (const struct orl_method *m = orl_methods; m->name; m++)
        printf("---|");
    printf("\n");
    for (const struct orl_option *o = orl_render_options(); o->name; o++) {
        printf("| `%s` |", o->name);
        for (const struct orl_method *m = orl_methods; m->name; m++) {
            char text[ORL_OPTION_TEXT];
            orl_option_print(o, &m->params, text);
            printf(orl_render_option_read(o, &m->params) ? " %s |" : " |", text);
        }
        printf("\n");
    }
}

int main(void)
{
    printf("# Options of rendering\n\n"
           "`--set KEY=VALUE` of `oriel render`, `walk`, `hdr`, `eval`, `bench`, `tune` and `trim` takes these. An "
           "option\nthat nothing reads with the method's choices is an error that names its readers. This page is made "
           "from the option\ntable (`include/oriel/option_list.h`) by the program `options_page` of the tests; a test "
           "fails when the two differ.\n\n"
           "## What each option means\n\n");
    print_options();
    printf("\n## What each method sets\n\nEmpty: the method does not read it.\n\n");
    print_methods();
    return 0;
}
