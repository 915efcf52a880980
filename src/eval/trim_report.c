// The report of oriel trim as JSON.
#include <jansson.h>

#include "core/json.h"
#include "eval/trim.h"

static json_t *figures_json(const struct orl_trim_figures *f)
{
    return json_pack("{s:I, s:I, s:I, s:I, s:I, s:I, s:f, s:f, s:f, s:f, s:f, s:f}", "points",
                     (json_int_t)f->points, "photographs", (json_int_t)f->photographs,
                     "point_bytes", (json_int_t)f->point_bytes, "photo_bytes",
                     (json_int_t)f->photo_bytes, "device_bytes", (json_int_t)f->device_bytes,
                     "file_bytes", (json_int_t)f->file_bytes, "frame_ms", f->frame_ms, "psnr_db",
                     f->psnr_db, "ssim", f->ssim, "worst_loss_db", f->worst_loss_db,
                     "held_psnr_db", f->held_psnr_db, "held_ssim", f->held_ssim);
}

static json_t *step_json(const struct orl_trim_step *s)
{
    return json_pack("{s:s, s:o, s:f, s:f, s:b, s:f, s:f, s:f, s:f}", "part",
                     orl_trim_part_names[s->part], "what", orl_json_string(s->what), "loss_db",
                     s->loss_db, "loss_ssim", s->loss_ssim, "taken", s->taken, "bytes", s->bytes,
                     "ms", s->ms, "total_loss_db", s->total_loss_db, "total_loss_ssim",
                     s->total_loss_ssim);
}

enum orl_result orl_trim_write_json(const struct orl_log *log, const char *path,
                                    const struct orl_scene *scene, const char *device,
                                    const struct orl_trim *trim)
{
    json_t *steps = json_array();
    for (size_t i = 0; i < trim->step_count; i++)
        json_array_append_new(steps, step_json(&trim->steps[i]));
    json_t *root = json_pack(
        "{s:o, s:s, s:s, s:o, s:o, s:o, s:b, s:I, s:o}", "scene", orl_json_string(scene->dir),
        "device", device, "method", trim->choice.method->name, "settings",
        orl_choice_settings(&trim->choice), "before",
        figures_json(&trim->before), "after", figures_json(&trim->after), "complete",
        trim->complete, "undone", (json_int_t)trim->undone, "steps", steps);
    enum orl_result result = orl_json_write(log, path, root);
    json_decref(root);
    return result;
}
