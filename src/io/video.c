#include "io/video.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>

#include "core/file.h"
#include "core/process.h"

enum orl_result orl_video_encode(const struct orl_log *log, const struct orl_progress *progress,
                                 const char *frames_dir, double fps, const char *path)
{
    struct orl_atomic_file file = {0};
    char rate[32];
    snprintf(rate, sizeof rate, "%g", fps);
    char *pattern = orl_path_join(log, frames_dir, "%05d.png");
    enum orl_result result = pattern ? orl_atomic_begin(log, path, &file) : ORL_ERR_MEMORY;
    if (result == ORL_OK) {
        // Most players support only even sizes and 4:2:0 chroma subsampling.
        const char *const argv[] = {"ffmpeg", "-nostdin", "-loglevel", "error", "-y",
                                    "-framerate", rate, "-i", pattern,
                                    "-vf", "crop=trunc(iw/2)*2:trunc(ih/2)*2",
                                    "-c:v", "libx264", "-crf", "18", "-pix_fmt", "yuv420p",
                                    "-movflags", "+faststart", file.temp, NULL};
        result = orl_process_run(log, &(struct orl_process_params){.argv = argv,
                                                                   .progress = progress}, NULL);
    }
    if (result == ORL_OK)
        result = orl_atomic_commit(log, &file);
    orl_atomic_abort(&file);
    free(pattern);
    return result;
}

enum orl_result orl_video_decode(const struct orl_log *log, const struct orl_progress *progress,
                                 const char *path, const struct orl_frame_range *range,
                                 const char *frames_dir)
{
    char select[64], most[16];
    struct orl_names names = {0};
    ORL_REQUIRE(log, range->first >= 0 && range->count >= 0 && range->step >= 1);
    snprintf(select, sizeof select, "select=gte(n\\,%d)*not(mod(n-%d\\,%d))", range->first,
             range->first, range->step);
    snprintf(most, sizeof most, "%d", range->count ? range->count : INT_MAX);
    char *pattern = orl_path_join(log, frames_dir, "%05d.ppm");
    if (!pattern)
        return ORL_ERR_MEMORY;
    const char *const argv[] = {"ffmpeg", "-nostdin", "-loglevel", "error", "-noautorotate",
                                "-i", path, "-map", "0:v:0", "-vf", select, "-vsync", "0",
                                "-frames:v", most, "-start_number", "0", pattern, NULL};
    enum orl_result result = orl_process_run(
        log, &(struct orl_process_params){.argv = argv, .progress = progress}, NULL);
    free(pattern);
    if (result == ORL_OK)
        result = orl_dir_list(log, frames_dir, &names);
    if (result == ORL_OK && !names.count)
        result = orl_fail(log, ORL_ERR_DATA, "%s: this clip has no frame %d", path, range->first);
    orl_names_finish(&names);
    return result;
}
