// oriel import: makes a scene from known cameras and their pictures.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/summary.h"
#include "core/memory.h"
#include "preprocess/import.h"
#include "scene/known_cameras.h"

struct options {
    const char *silhouettes, *points, *mesh, *frames, *quality, *room, *test_block;
    int max_vram_mib;
    struct orl_names test_list;
    struct orl_import_params params;
};

// Parses a range of frames "A:B" or "A:B:STEP"; either end may be missing.
static enum orl_result parse_frames(const struct orl_log *log, const char *text,
                                    struct orl_frame_range *range)
{
    char *at;
    long first = strtol(text, &at, 10), end = 0, step = 1;
    bool good = *at == ':' && first >= 0 && first < 1000000;
    if (good) {
        at++;
        end = *at && *at != ':' ? strtol(at, &at, 10) : 0;
        good = end == 0 || (end > first && end <= 1000000);
    }
    if (good && *at == ':')
        step = strtol(at + 1, &at, 10);
    if (!good || *at || step < 1 || step > 1000000)
        return orl_fail(log, ORL_ERR_ARGUMENT, "--frames %s: must be FIRST:END or FIRST:END:STEP, "
                        "END being left out", text);
    range->first = (int)first;
    range->step = (int)step;
    range->count = end ? (int)((end - first + step - 1) / step) : 0;
    return ORL_OK;
}

static enum orl_result parse_silhouettes(const struct orl_log *log, const char *text,
                                         struct orl_import_params *params)
{
    char rest;
    if (!text) {
        params->silhouettes = params->masks_dir    ? ORL_SILHOUETTES_GIVEN
                              : params->background ? ORL_SILHOUETTES_BACKGROUND
                                                   : ORL_SILHOUETTES_NONE;
        return ORL_OK;
    }
    bool threshold = sscanf(text, "dark=%d%c", &params->dark_threshold, &rest) == 1;
    if ((!threshold && strcmp(text, "dark") != 0) || params->dark_threshold > 254 ||
        (threshold && params->dark_threshold < 0))
        return orl_fail(log, ORL_ERR_ARGUMENT, "--silhouettes %s: must be dark or dark=0 to "
                        "dark=254; --masks and --background say so themselves", text);
    if (params->masks_dir)
        return orl_fail(log, ORL_ERR_ARGUMENT, "--masks and --silhouettes exclude each other");
    params->silhouettes = ORL_SILHOUETTES_DARK;
    return ORL_OK;
}

static enum orl_result parse_points(const struct orl_log *log, const struct options *o,
                                    struct orl_import_params *params)
{
    bool densify = o->points && strcmp(o->points, "densify") == 0;
    bool none = o->points && strcmp(o->points, "none") == 0;
    params->points = !o->points ? ORL_IMPORT_STATED_POINTS
                     : densify  ? ORL_IMPORT_DENSIFY
                     : none     ? ORL_IMPORT_NO_POINTS
                                : ORL_IMPORT_CLOUD;
    params->points_file = params->points == ORL_IMPORT_CLOUD ? o->points : NULL;
    for (int i = 0; o->quality && orl_quality_names[i]; i++)
        if (strcmp(o->quality, orl_quality_names[i]) == 0) {
            params->densify.quality = (enum orl_quality)i;
            return ORL_OK;
        }
    return o->quality ? orl_fail(log, ORL_ERR_ARGUMENT, "--quality %s: must be draft, standard or "
                                 "high", o->quality)
                      : ORL_OK;
}

// Parses the name of a file, or hull[=SIDE[,TRIANGLES]].
static enum orl_result parse_mesh(const struct orl_log *log, const char *text,
                                  struct orl_import_params *params)
{
    char rest;
    if (!text || strncmp(text, "hull", 4) != 0 || (text[4] && text[4] != '=')) {
        params->mesh = text;
        return ORL_OK;
    }
    params->hull_side = 128;
    params->hull_triangles = 20000;
    int got = text[4] ? sscanf(text, "hull=%d,%d%c", &params->hull_side, &params->hull_triangles,
                               &rest) : 1;
    if (got < 1 || got > 2 || params->hull_side < 1 || params->hull_triangles < 0)
        return orl_fail(log, ORL_ERR_ARGUMENT, "--mesh %s: must be a file or "
                        "hull[=SIDE[,TRIANGLES]]", text);
    return ORL_OK;
}

// Parses the two corners of a room.
static enum orl_result parse_room(const struct orl_log *log, const char *text,
                                  struct orl_room *room)
{
    double *a = room->low, *b = room->high;
    char rest;
    if (!text)
        return ORL_OK;
    room->known = sscanf(text, "%lf,%lf,%lf,%lf,%lf,%lf%c", &a[0], &a[1], &a[2], &b[0], &b[1],
                         &b[2], &rest) == 6;
    for (int k = 0; k < 3; k++)
        room->known = room->known && isfinite(a[k]) && isfinite(b[k]) && a[k] < b[k];
    if (!room->known)
        return orl_fail(log, ORL_ERR_ARGUMENT, "--room %s: must be X,Y,Z,X,Y,Z of its lowest and "
                        "its highest corner", text);
    return ORL_OK;
}

static enum orl_result run(const struct terminal *terminal, const void *given,
                           const struct arg_common *common, const char *cameras)
{
    const struct options *o = given;
    const struct orl_log *log = &terminal->log;
    struct orl_import_params params = o->params;
    enum orl_result result = ORL_OK;
    params.cameras = cameras;
    params.test_list = &o->test_list;
    params.densify.shader_dir = common->shader_dir;
    params.densify.max_vram_bytes = (size_t)o->max_vram_mib << 20;
    if (!params.out)
        return orl_fail(log, ORL_ERR_ARGUMENT, "import: --out SCENE is missing");
    result = args_held_out(log, params.test_every, &o->test_list, o->test_block,
                           &params.test_block);
    if (result == ORL_OK && o->frames)
        result = parse_frames(log, o->frames, &params.frames);
    if (result == ORL_OK)
        result = parse_points(log, o, &params);
    if (result == ORL_OK)
        result = parse_silhouettes(log, o->silhouettes, &params);
    if (result == ORL_OK)
        result = parse_mesh(log, o->mesh, &params);
    if (result == ORL_OK)
        result = parse_room(log, o->room, &params.room);
    if (result == ORL_OK)
        result = orl_import(log, &params, &terminal->progress);
    return result == ORL_OK ? summary_print(log, params.out) : result;
}

int cmd_import(int argc, char **argv)
{
    struct options o = {.params = {ORL_IMPORT_DEFAULTS}};
    struct orl_import_params *p = &o.params;
    const struct arg_option options[] = {
        {"out", ARG_STRING, &p->out, "SCENE", "the scene folder to make", 0, 0},
        {"images", ARG_STRING, &p->images_dir, "DIR",
         "pictures, numbered folders or clips, named as the cameras", 0, 0},
        {"masks", ARG_STRING, &p->masks_dir, "DIR", "silhouettes, named as the cameras", 0, 0},
        {"silhouettes", ARG_STRING, &o.silhouettes, "dark[=T]",
         "the subject is what is brighter than T (0 to 254; found unless told)", 0, 0},
        {"background", ARG_STRING, &p->background, "DIR",
         "pictures or clips without the subject: what differs is the subject", 0, 0},
        {"frames", ARG_STRING, &o.frames, "A:B[:STEP]", "moments A to B - 1 of a sequence", 0, 0},
        {"test-every", ARG_INT, &p->test_every, "N", "hold out every N-th photograph by name", 2,
         100000},
        {"test-list", ARG_LIST, &o.test_list, "A,B,..", "hold out these photographs", 0, 0},
        {"test-block", ARG_STRING, &o.test_block, "A:B",
         "hold out photographs A to B - 1 in the order of names, from 0: the protocol beyond", 0, 0},
        {"max-size", ARG_INT, &p->max_size, "PX",
         "larger side of photographs in the scene (any)", 64, 16384},
        {"points", ARG_STRING, &o.points, "none|densify|FILE",
         "a cloud as PLY, or made as prepare does (what the file of cameras names)", 0, 0},
        {"quality", ARG_STRING, &o.quality, "NAME", "of densify: draft, standard or high", 0, 0},
        {"max-vram", ARG_INT, &o.max_vram_mib, "MIB", "device memory that densify keeps to", 1,
         1 << 20},
        {"mesh", ARG_STRING, &o.mesh, "FILE|hull",
         "a mesh as PLY or OBJ, or hull[=SIDE[,TRIANGLES]] of the silhouettes", 0, 0},
        {"room", ARG_STRING, &o.room, "X,Y,Z,X,Y,Z",
         "the room that the subject is in: its lowest and highest corner, world", 0, 0},
        {"pixel-centre", ARG_NUMBER, &p->pixel_centre, "X",
         "coordinate of the first pixel's centre, 0 or 0.5 (as is the format's custom)", 0, 0.5},
        {0},
    };
    char *formats = orl_known_formats_text(NULL);
    char *summary = formats ? orl_format(NULL, "Makes a scene from known cameras. CAMERAS is one of these "
                                         "files, or a folder that has one:\n%s", formats) : NULL;
    const struct arg_command command = {
        .name = "import", .usage = "CAMERAS --out SCENE [options]",
        .summary = summary ? summary : "Makes a scene from known cameras.",
        .options = options, .positionals_min = 1, .positionals_max = 1};
    int status = command_main(&command, argc, argv, run, &o);
    orl_names_finish(&o.test_list);
    free(formats);
    free(summary);
    return status;
}
