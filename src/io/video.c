#include "io/video.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "core/process.h"
#include "core/text.h"

bool orl_video_is(const char *path)
{
    return orl_path_has_extension(path, "3gp avi flv insv m2ts m4v mkv mov mp4 mpeg mpg mts mxf ogv ts "
                                        "webm wmv");
}

char *orl_video_numbered(const struct orl_log *log, const char *dir, const char *numbers)
{
    char *name = orl_array(log, 2 * strlen(dir) + strlen(numbers) + 2, 1), *end = name;
    for (; name && *dir; dir++) {
        if (*dir == '%')
            *end++ = '%';
        *end++ = *dir;
    }
    if (name)
        sprintf(end, "/%s", numbers);
    return name;
}

// --- tags ---

struct tags {
    double seconds;
    int width, height;
    char aspect[32], range[16], matrix[32], transfer[32], primaries[32], fields[16];
    char side_data[64], profile[8];
};

// Takes a line "key=value".
static void take_tag(void *priv, const char *line)
{
    struct tags *t = priv;
    const struct {
        const char *key;
        char *value;
        size_t size;
    } texts[] = {
        {"sample_aspect_ratio=", t->aspect, sizeof t->aspect},
        {"color_range=", t->range, sizeof t->range},
        {"color_space=", t->matrix, sizeof t->matrix},
        {"color_transfer=", t->transfer, sizeof t->transfer},
        {"color_primaries=", t->primaries, sizeof t->primaries},
        {"field_order=", t->fields, sizeof t->fields},
        {"dv_profile=", t->profile, sizeof t->profile},
    };
    double seconds;
    if (sscanf(line, "duration=%lf", &seconds) == 1 && isfinite(seconds) && seconds > 0)
        t->seconds = seconds;
    if (sscanf(line, "width=%d", &t->width) == 1 || sscanf(line, "height=%d", &t->height) == 1)
        return;
    for (size_t i = 0; i < ORL_COUNT(texts); i++)
        if (strncmp(line, texts[i].key, strlen(texts[i].key)) == 0)
            snprintf(texts[i].value, texts[i].size, "%s", line + strlen(texts[i].key));
    if (strncmp(line, "side_data_type=Spherical", 24) == 0)
        snprintf(t->side_data, sizeof t->side_data, "spherical");
}

static enum orl_result read_tags(const struct orl_log *log, const struct orl_progress *progress,
                                 const char *path, struct tags *tags)
{
    static const char entries[] =
        "stream=width,height,sample_aspect_ratio,color_range,color_space,color_transfer,"
        "color_primaries,field_order:stream_side_data=side_data_type,dv_profile:format=duration";
    const char *const argv[] = {"ffprobe", "-v", "error", "-select_streams", "V:0",
                                "-show_entries", entries, "-of", "default=noprint_wrappers=1",
                                ORL_VIDEO_FILE(path), NULL};
    enum orl_result result = orl_process_run(log, &(struct orl_process_params){
        .argv = argv, .progress = progress, .line = take_tag, .line_priv = tags}, NULL);
    if (result == ORL_ERR_NOT_FOUND)
        return orl_fail(log, result, "%s: ffmpeg is needed to take frames out of a video (Debian: "
                        "apt install ffmpeg)", path);
    if (result == ORL_OK && tags->width < 1)
        result = orl_fail(log, ORL_ERR_DATA, "%s: no video in it", path);
    return result;
}

static bool is_told(const char *tag)
{
    static const char *const untold[] = {"", "unknown", "unspecified", "reserved", "N/A", NULL};
    return !orl_text_is_one_of(tag, untold);
}

static bool is_hdr(const struct tags *tags)
{
    return strcmp(tags->transfer, "smpte2084") == 0 || strcmp(tags->transfer, "arib-std-b67") == 0;
}

static bool is_wide(const struct tags *tags)
{
    static const char *const wide[] = {"bt2020", "smpte431", "smpte432", NULL};
    return orl_text_is_one_of(tags->primaries, wide);
}

static enum orl_result check_tags(const struct orl_log *log, const char *path,
                                  const struct tags *tags)
{
    static const char *const matrices[] = {"gbr", "bt709", "fcc", "bt470bg", "smpte170m",
                                           "smpte240m", "bt2020nc", NULL};
    static const char *const transfers[] = {
        "bt709", "bt470m", "gamma22", "bt470bg", "gamma28", "smpte170m", "smpte240m",
        "iec61966-2-1", "iec61966-2-4", "bt1361e", "bt2020-10", "bt2020-12", "smpte2084",
        "arib-std-b67", NULL};
    if (*tags->side_data)
        return orl_fail(log, ORL_ERR_UNSUPPORTED, "%s: a panorama; Oriel needs pictures of ordinary "
                        "lenses: export flat views of it", path);
    if (strcmp(tags->profile, "5") == 0)
        return orl_fail(log, ORL_ERR_UNSUPPORTED, "%s: its colours are those of Dolby Vision "
                        "profile 5, which ffmpeg does not decode; convert it to SDR", path);
    if (is_told(tags->matrix) && !orl_text_is_one_of(tags->matrix, matrices))
        return orl_fail(log, ORL_ERR_UNSUPPORTED, "%s: its colour matrix, %s, is not known; "
                        "convert it to BT.709", path, tags->matrix);
    if (is_told(tags->transfer) && !orl_text_is_one_of(tags->transfer, transfers))
        return orl_fail(log, ORL_ERR_UNSUPPORTED, "%s: its transfer curve, %s, is not known; "
                        "convert it to BT.709", path, tags->transfer);
    return ORL_OK;
}

// The matrix as the filter "scale" calls it. An untagged video has that of its primaries, else as
// players have it: BT.709 from 720 lines on.
static const char *matrix_of(const struct tags *tags)
{
    int lines = tags->width < tags->height ? tags->width : tags->height;
    if (is_told(tags->matrix))
        return "auto";
    if (is_hdr(tags) || strcmp(tags->primaries, "bt2020") == 0)
        return "bt2020";
    if (is_told(tags->primaries))
        return strcmp(tags->primaries, "smpte170m") == 0 || strcmp(tags->primaries, "bt470bg") == 0
                   ? "bt601" : "bt709";
    return lines >= 720 ? "bt709" : "bt601";
}

static void set_filters(const struct tags *tags, bool square, struct orl_video *video)
{
    static const char *const interlaced[] = {"tt", "bb", "tb", "bt", NULL};
    bool stretch = square && is_told(tags->aspect) && strcmp(tags->aspect, "1:1") != 0 &&
                   strcmp(tags->aspect, "0:1") != 0;
    char light[192] = "";
    if (is_hdr(tags))
        snprintf(light, sizeof light, "format=gbrp16le,zscale=min=gbr:rin=full:tin=%s:pin=%s:"
                 "t=linear:npl=203:agamma=0:p=bt709,format=gbrpf32le,zscale=t=iec61966-2-1,",
                 tags->transfer, is_told(tags->primaries) ? tags->primaries : "bt2020");
    else if (is_wide(tags))
        snprintf(light, sizeof light, "format=gbrp16le,zscale=min=gbr:rin=full:tin=iec61966-2-1:"
                 "pin=%s:t=iec61966-2-1:p=bt709,", tags->primaries);
    if (orl_text_is_one_of(tags->fields, interlaced))
        snprintf(video->first, sizeof video->first, "bwdif=mode=send_frame,");
    snprintf(video->colours, sizeof video->colours, "scale=%sin_color_matrix=%s%s,%sformat=gbrp,",
             stretch ? "w='2*round(iw*max(sar,1)/2)':h='2*round(ih*max(1/sar,1)/2)':" : "",
             matrix_of(tags), stretch ? ",setsar=1" : "", light);
}

enum orl_result orl_video_inspect(const struct orl_log *log, const struct orl_progress *progress,
                                  const char *path, bool square, struct orl_video *video)
{
    struct tags tags = {0};
    memset(video, 0, sizeof *video);
    ORL_TRY(read_tags(log, progress, path, &tags));
    ORL_TRY(check_tags(log, path, &tags));
    if (is_hdr(&tags))
        orl_logf(log, ORL_LOG_INFO, "%s: HDR (%s), brought to SDR: light above 203 cd/m2 is "
                 "clipped", path, *tags.transfer == 's' ? "PQ" : "HLG");
    video->seconds = tags.seconds;
    set_filters(&tags, square, video);
    return ORL_OK;
}

// --- frames ---

enum orl_result orl_video_can_encode(const struct orl_log *log, const char *path)
{
    const char *const argv[] = {"ffmpeg", "-version", NULL};
    enum orl_result result = orl_process_run(log, &(struct orl_process_params){.argv = argv}, NULL);
    return result == ORL_ERR_NOT_FOUND ? orl_fail(log, result, "%s: ffmpeg is needed to write a video (Debian: "
                                                  "apt install ffmpeg)", path)
                                       : result;
}

enum orl_result orl_video_encode(const struct orl_log *log, const struct orl_progress *progress,
                                 const char *frames_dir, double fps, const char *path)
{
    struct orl_atomic_file file = {0};
    char rate[32];
    snprintf(rate, sizeof rate, "%g", fps);
    char *frames = orl_video_numbered(log, frames_dir, "%05d.png");
    enum orl_result result = frames ? orl_atomic_begin(log, path, &file) : ORL_ERR_MEMORY;
    // Most players support only even sizes and 4:2:0 chroma subsampling.
    const char *const argv[] = {"ffmpeg", "-nostdin", "-loglevel", "error", "-y",
                                "-framerate", rate, "-i", frames,
                                "-vf", "crop=trunc(iw/2)*2:trunc(ih/2)*2,"
                                       "scale=out_color_matrix=bt709:out_range=tv:"
                                       "flags=accurate_rnd",
                                "-c:v", "libx264", "-crf", "18", "-pix_fmt", "yuv420p",
                                "-colorspace", "bt709", "-color_primaries", "bt709",
                                "-color_trc", "iec61966-2-1", "-color_range", "tv",
                                "-movflags", "+faststart", ORL_VIDEO_FILE(file.temp), NULL};
    ORL_THEN(result, orl_process_run(log, &(struct orl_process_params){.argv = argv, .progress = progress}, NULL));
    ORL_THEN(result, orl_atomic_commit(log, &file));
    orl_atomic_abort(&file);
    free(frames);
    return result;
}

enum orl_result orl_video_decode(const struct orl_log *log, const struct orl_progress *progress,
                                 const char *path, const struct orl_frame_range *range,
                                 const char *frames_dir)
{
    char most[16];
    struct orl_names names = {0};
    struct orl_video video;
    ORL_REQUIRE(log, range->first >= 0 && range->count >= 0 && range->step >= 1);
    ORL_TRY(orl_video_inspect(log, progress, path, false, &video));
    snprintf(most, sizeof most, "%d", range->count ? range->count : INT_MAX);
    char *filters = orl_format(log, "%sselect=gte(n\\,%d)*not(mod(n-%d\\,%d)),%snull",
                               video.first, range->first, range->first, range->step,
                               video.colours);
    char *frames = orl_video_numbered(log, frames_dir, "%05d.ppm");
    const char *const argv[] = {"ffmpeg", "-nostdin", "-loglevel", "error", "-noautorotate",
                                "-i", ORL_VIDEO_FILE(path), "-map", "0:V:0", "-vf", filters,
                                "-fps_mode", "passthrough", "-frames:v", most, "-start_number", "0", frames, NULL};
    enum orl_result result = filters && frames ? ORL_OK : ORL_ERR_MEMORY;
    ORL_THEN(result, orl_process_run(log, &(struct orl_process_params){.argv = argv, .progress = progress}, NULL));
    free(filters);
    free(frames);
    ORL_THEN(result, orl_dir_list(log, frames_dir, &names));
    if (result == ORL_OK && !names.count)
        result = orl_fail(log, ORL_ERR_DATA, "%s: this clip has no frame %d", path, range->first);
    orl_names_finish(&names);
    return result;
}
