#include "preprocess/arguments.h"

#include <stdlib.h>

#include "core/memory.h"

static void add(json_t *list, const char *option, json_t *value)
{
    json_array_append_new(list, json_string(option));
    json_array_append_new(list, value);
}

static void add_path(json_t *list, const char *option, const char *path)
{
    char *real = path ? realpath(path, NULL) : NULL;
    if (path && option)
        json_array_append_new(list, json_string(option));
    if (path)
        json_array_append_new(list, json_string(real ? real : path));
    free(real);
}

static void add_number(json_t *list, const char *option, double value)
{
    if (value > 0)
        add(list, option, json_sprintf("%.10g", value));
}

static bool add_names(const struct orl_log *log, json_t *list, const struct orl_names *names)
{
    char *text = orl_strdup(log, "");
    for (size_t i = 0; text && names && i < names->count; i++) {
        char *longer = orl_format(log, "%s%s%s", text, i ? "," : "", names->items[i]);
        free(text);
        text = longer;
    }
    if (text && *text)
        add(list, "--test-list", json_string(text));
    free(text);
    return text != NULL;
}

json_t *orl_prepare_arguments(const struct orl_log *log, const struct orl_prepare_params *p)
{
    json_t *list = json_array();
    for (size_t i = 0; i < p->input_count; i++)
        add_path(list, NULL, p->inputs[i]);
    add(list, "--quality", json_string(orl_quality_names[p->quality]));
    add(list, "--camera-sharing", json_string(orl_camera_sharing_names[p->sharing]));
    add(list, "--matching", json_string(orl_matching_names[p->matching]));
    add(list, "--mapper", json_string(orl_mapper_names[p->mapper]));
    add(list, "--densifier", json_string(orl_densifier_names[p->densifier]));
    add(list, "--keep", json_string(orl_keep_names[p->keep]));
    add(list, "--mesh", json_string(orl_prepare_mesh_names[p->mesh]));
    add(list, "--hull", json_string(orl_hull_use_names[p->hull]));
    add(list, "--occluders", json_string(orl_occluder_search_names[p->occluders]));
    add(list, "--adapt", json_string(orl_adapt_effort_names[p->adapt]));
    add(list, "--leave-out", json_string(orl_leave_out_names[p->leave_out]));
    add(list, "--seed", json_sprintf("%u", p->seed));
    add_number(list, "--fps", p->fps);
    add_number(list, "--frames", p->frames);
    add_number(list, "--max-size", p->max_size);
    add_number(list, "--test-every", p->test_every);
    if (p->test_block.end > 0)
        add(list, "--test-block", json_sprintf("%d:%d", p->test_block.first, p->test_block.end));
    add_number(list, "--radius-neighbours", p->radius_neighbours);
    add_number(list, "--radius-overlap", p->radius_overlap);
    add_number(list, "--fuse-cluster", p->fuse_cluster);
    add_number(list, "--adapt-budget", p->adapt_budget_s);
    add_number(list, "--max-vram", (double)(p->max_vram_bytes >> 20));
    add_number(list, "--max-ram", (double)(p->max_ram_bytes >> 20));
    add_path(list, "--masks", p->masks_dir);
    add_path(list, "--exposures", p->exposures);
    if (!add_names(log, list, p->test_list)) {
        json_decref(list);
        return NULL;
    }
    return list;
}
