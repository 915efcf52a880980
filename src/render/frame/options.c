// Which options of rendering there are, and what reads each.
#include <string.h>

#include "render/frame/method.h"

const struct orl_option *orl_render_option_find(const char *key)
{
    size_t length = strcspn(key, "=");
    for (const struct orl_option *o = orl_render_options(); o->name; o++)
        if (strlen(o->name) == length && strncmp(o->name, key, length) == 0)
            return o;
    return NULL;
}

bool orl_render_params_equal(const struct orl_render_params *params, const char *condition)
{
    char text[ORL_OPTION_TEXT];
    const char *name = condition + strcspn(condition, "=") + 1;
    size_t length = strcspn(name, " ");
    if (strncmp(condition, "sample=", strlen("sample=")) == 0)
        return (strncmp(name, "radiance", length) == 0) == (params->sample == ORL_SAMPLE_RADIANCE);
    const struct orl_option *option = orl_render_option_find(condition);
    return option && orl_render_option_read(option, params) && orl_option_print(option, params, text) &&
           strlen(text) == length && strncmp(text, name, length) == 0;
}

const char *orl_render_params_first(const struct orl_render_params *params, const char *conditions, bool truth)
{
    for (; *conditions; conditions += strcspn(conditions, " "), conditions += strspn(conditions, " "))
        if (orl_render_params_equal(params, conditions) == truth)
            return conditions;
    return NULL;
}

bool orl_render_option_read(const struct orl_option *option, const struct orl_render_params *params)
{
    return !*option->readers || orl_render_params_first(params, option->readers, true);
}
