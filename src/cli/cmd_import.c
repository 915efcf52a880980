// oriel import: makes a scene from known cameras and their pictures.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "cli/command_output.h"
#include "core/memory.h"
#include "preprocess/import.h"
#include "scene/known_cameras.h"

#define IMPORT_OPTIONS(ROW) \
    ROW(out, "out", NEEDED("SCENE"), "the scene folder to make") \
    ROW(images_dir, "images", TEXT("DIR"), \
        "pictures, numbered folders or clips, named as the cameras") \
    ROW(masks_dir, "masks", TEXT("DIR"), "silhouettes, named as the cameras") \
    ROW(silhouettes, "silhouettes", TEXT("dark[=T]"), \
        "the subject is what is brighter than T (0 to 254; found unless told)") \
    ROW(background, "background", TEXT("DIR"), \
        "pictures or clips without the subject: what differs is the subject") \
    ROW(frames, "frames", TEXT("A:B[:STEP]"), "time steps A to B - 1 of a sequence") \
    ORL_HELD_OUT_OPTIONS(ROW) \
    ROW(max_size, "max-size", INT(0, 64, 16384, "PX"), \
        "larger side of photographs in the scene (any)") \
    ROW(points, "points", TEXT("none|densify|FILE"), \
        "a cloud as PLY, or made as prepare does (what the file of cameras names, or fused.ply)") \
    ROW(quality, "quality", CHOICE(orl_quality, ORL_QUALITIES, ORL_QUALITY_STANDARD, "NAME"), \
        "of densify") \
    ROW(max_vram_bytes, "max-vram", MIB(1 << 20), "device memory that densify keeps to") \
    ROW(mesh, "mesh", TEXT("FILE|hull"), \
        "a mesh as PLY or OBJ, or hull[=SIDE[,TRIANGLES]] of the silhouettes") \
    ROW(room, "room", TEXT("X,Y,Z,X,Y,Z"), \
        "the room that the subject is in: its lowest and highest corner, world") \
    ROW(pixel_centre, "pixel-centre", NUMBER(-1, 0, 0.5, "X"), \
        "coordinate of the first pixel's centre, 0 or 0.5 (as is the format's custom)")
COMMAND_OPTIONS(import_options, IMPORT_OPTIONS)

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
                                                   : ORL_SILHOUETTES_STATED;
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

static void choose_points(const struct import_options *o, struct orl_import_params *params)
{
    bool densify = o->points && strcmp(o->points, "densify") == 0;
    bool none = o->points && strcmp(o->points, "none") == 0;
    params->points = !o->points ? ORL_IMPORT_STATED_POINTS
                     : densify  ? ORL_IMPORT_DENSIFY
                     : none     ? ORL_IMPORT_NO_POINTS
                                : ORL_IMPORT_CLOUD;
    params->points_file = params->points == ORL_IMPORT_CLOUD ? o->points : NULL;
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

static enum orl_result run_import(struct call *call)
{
    const struct import_options *o = call->options;
    const struct orl_log *log = call->log;
    struct orl_import_params params = {
        ORL_IMPORT_DEFAULTS, .cameras = call->inputs[0], .out = o->out,
        .images_dir = o->images_dir, .masks_dir = o->masks_dir, .background = o->background,
        .max_size = o->max_size, .test_every = o->test_every, .test_list = &o->test_list,
        .test_block = o->test_block};
    params.pixel_centre = o->pixel_centre;
    params.densify.quality = o->quality;
    params.densify.shader_dir = call->common->shader_dir;
    params.densify.max_vram_bytes = o->max_vram_bytes;
    choose_points(o, &params);
    ORL_TRY(command_held_out(log, o->test_every, &o->test_list, o->test_block));
    if (o->frames)
        ORL_TRY(parse_frames(log, o->frames, &params.frames));
    ORL_TRY(parse_silhouettes(log, o->silhouettes, &params));
    ORL_TRY(parse_mesh(log, o->mesh, &params));
    ORL_TRY(parse_room(log, o->room, &params.room));
    ORL_TRY(orl_import(log, &params, call->progress));
    return summary_print(log, params.out);
}

static void print_formats(FILE *out)
{
    char *formats = orl_known_formats_text(NULL);
    fprintf(out, "%s", formats ? formats : "");
    free(formats);
}

const struct command command_import = {
    .name = "import", .group = COMMAND_MAKE,
    .brief = "make a scene from known cameras, silhouettes, sequences",
    .usage = "CAMERAS --out SCENE [options]",
    .summary = "Makes a scene from known cameras. CAMERAS is one of these files, or a folder that has one:",
    .print_more = print_formats,
    COMMAND_TABLE(import_options), .inputs_min = 1, .inputs_max = 1, .run = run_import,
};
