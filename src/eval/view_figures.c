#include "core/json.h"
#include "eval/eval.h"

#define AT(member) offsetof(struct orl_eval_view, member)

const struct orl_figure orl_figures[] = {
    {"psnr_db", "PSNR", 7, 2, 1, ORL_FIGURES_PICTURE, AT(metrics.psnr_db)},
    {"psnr_cc_db", "fitted", 7, 2, 1, ORL_FIGURES_PICTURE, AT(metrics.psnr_cc_db)},
    {"psnr_covered_db", "covered", 7, 2, 1, ORL_FIGURES_PICTURE, AT(metrics.psnr_covered_db)},
    {"ssim", "SSIM", 7, 4, 1, ORL_FIGURES_PICTURE, AT(metrics.ssim)},
    {"flip", "FLIP", 7, 4, 1, ORL_FIGURES_PICTURE, AT(flip)},
    {"crumbs", "crumbs", 7, 1, 1, ORL_FIGURES_PICTURE, AT(metrics.crumbs)},
    {"coverage", "cover%", 7, 1, 100, ORL_FIGURES_PICTURE, AT(metrics.coverage)},
    {"completeness", "full%", 6, 1, 100, ORL_FIGURES_PICTURE, AT(metrics.completeness)},
    {"ncc_error", "1-NCC", 7, 4, 1, ORL_FIGURES_PICTURE, AT(metrics.ncc_error)},
    {"render_ms", "ms", 9, 1, 1, ORL_FIGURES_PICTURE, AT(render_ms)},
    {"cpu_ms", NULL, 0, 0, 1, ORL_FIGURES_PICTURE, AT(cpu_ms)},
    {"pu21_psnr_db", "PU21 dB", 9, 2, 1, ORL_FIGURES_RADIANCE, AT(radiance.pu21_psnr_db)},
    {"mu_psnr_db", "mu dB", 9, 2, 1, ORL_FIGURES_RADIANCE, AT(radiance.mu_psnr_db)},
    {"log2_rmse", "stops", 9, 4, 1, ORL_FIGURES_RADIANCE, AT(radiance.log2_rmse)},
    {"log2_rmse_fitted", "fitted", 9, 4, 1, ORL_FIGURES_RADIANCE, AT(radiance.log2_rmse_fitted)},
    {"vehicle_psnr_db", "PSNR", 9, 2, 1, ORL_FIGURES_VEHICLE, AT(vehicle.psnr_db)},
    {"vehicle_crumbs", "crumbs", 9, 1, 1, ORL_FIGURES_VEHICLE, AT(vehicle.crumbs)},
    {"vehicle_coverage", "cover%", 9, 1, 100, ORL_FIGURES_VEHICLE, AT(vehicle.coverage)},
    {0},
};

bool orl_figures_known(enum orl_figure_group group, const struct orl_eval *eval)
{
    return group == ORL_FIGURES_PICTURE || (group == ORL_FIGURES_RADIANCE && eval->has_truth) ||
           (group == ORL_FIGURES_VEHICLE && eval->has_vehicle);
}

double orl_figure_value(const struct orl_figure *figure, const struct orl_eval_view *view)
{
    const double *value = (const void *)((const char *)view + figure->offset);
    return *value;
}

// --- the report: field names are fixed; others may be added ---

// Adds a view's figures to the object; NULL, which releases the object: one is no number.
static json_t *add_figures(const struct orl_eval *eval, const struct orl_eval_view *view, json_t *object)
{
    for (const struct orl_figure *f = orl_figures; f->name; f++) {
        if (!orl_figures_known(f->group, eval) ||
            json_object_set_new(object, f->name, json_real(orl_figure_value(f, view))) == 0)
            continue;
        json_decref(object);
        return NULL;
    }
    return object;
}

// NULL: a figure is no number.
static json_t *views_json(const struct orl_eval *eval)
{
    json_t *views = json_array();
    for (size_t i = 0; views && i < eval->view_count; i++) {
        const struct orl_eval_view *view = &eval->views[i];
        json_t *object = json_pack("{s:o, s:[ii]}", "photo",
                                   orl_json_string(eval->scene->photos[view->photo].name), "size",
                                   view->width, view->height);
        if (json_array_append_new(views, add_figures(eval, view, object)) != 0) {
            json_decref(views);
            views = NULL;
        }
    }
    return views;
}

json_t *orl_eval_report(const struct orl_eval *eval)
{
    const struct orl_eval_view *first = &eval->views[0];
    json_t *passes = json_object(), *owners = json_object();
    for (size_t i = 0; i < eval->pass_count; i++)
        json_object_set_new(passes, eval->passes[i].name, json_real(eval->passes[i].ms));
    for (int owner = 0; owner < ORL_OWNER_COUNT; owner++)
        json_object_set_new(owners, orl_owner_names[owner],
                            json_integer((json_int_t)eval->device_bytes[owner]));
    return json_pack("{s:o, s:s, s:s*, s:s, s:[ii], s:o, s:o, s:o, s:o}", "scene",
                     orl_json_string(eval->scene->dir), "method", eval->method, "setting",
                     eval->setting[0] ? eval->setting : NULL, "device", eval->device, "size",
                     first->width, first->height, "views", views_json(eval), "mean",
                     add_figures(eval, &eval->mean, json_object()), "passes_ms", passes,
                     "device_bytes", owners);
}
