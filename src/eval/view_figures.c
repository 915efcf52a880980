#include "eval/view_figures.h"

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
