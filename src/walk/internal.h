// Private to src/walk: a site while it is written.
#ifndef ORL_WALK_INTERNAL_H
#define ORL_WALK_INTERNAL_H

#include <jansson.h>

#include "core/file.h"
#include "oriel/gpu.h"
#include "render/output/tone.h"
#include "soft/soft_raster.h"
#include "walk/publish.h"
#include "walk/settings.h"

// Radiance x of a photograph's file is log(1 + mu x / peak) / log(1 + mu), in 8 bits.
struct site_range {
    double peak, mu;
};

struct site {
    const struct orl_log *log;
    struct orl_scene *scene;
    const struct orl_publish_params *params;
    struct orl_gpu *gpu;
    struct orl_renderer *renderer;
    struct orl_render_params render; // options of the method oriel, as tuned for the scene
    struct site_range range;         // of radiance
    const char *dir;                 // the folder that is written to
    const char *folder;              // within it, of what is written now: "" or "steps/NNNNN/"
    bool carves;                     // silhouettes say where the subject is (site_steps.c)
    struct orl_render_params subject; // of li, which shows it
    struct orl_room room;            // around the subject, of the first time step: known or a guess
    json_t *settings;                // owned: settings.h
    size_t start;                    // the photograph at which the walk begins unless they say
    struct orl_soft_raster soft;     // owned: the scene's soft splats, which the page draws; 0 of them: none
    struct orl_publish_report *report;
};

// A file of the site as in its manifest: {"file", "bytes"}. `path` is relative to the site. NULL,
// logged: the file is missing.
json_t *orl_site_file(const struct site *site, const char *path);
enum orl_result orl_site_write(struct site *site, const char *path, const void *data, size_t size);

// --- points (cells.c) ---

// Writes points/ in site->folder and sets *out to its part of the manifest.
enum orl_result orl_site_points(struct site *site, const struct orl_points *points, size_t max_points,
                                json_t **out) ORL_CHECK_RESULT;
// Those of the scene.
enum orl_result orl_site_scene_points(struct site *site, json_t **out) ORL_CHECK_RESULT;

// --- a subject made of silhouettes, which may move (site_steps.c) ---

// Prepares the first time step: site->room and the points of its walls. Nothing without silhouettes.
enum orl_result orl_site_room(struct site *site, struct orl_points *walls) ORL_CHECK_RESULT;
// Gives the pixels without depth the depth of the room's walls.
void orl_site_room_depth(const struct site *site, const struct orl_view *view, struct orl_image *depth);
// Writes steps/, the subject and the photographs of each time step, but for the photographs of the first,
// which the site itself has, and sets *steps to the manifest's array, likewise.
enum orl_result orl_site_steps(struct site *site, json_t **steps) ORL_CHECK_RESULT;

// --- photographs (site_photos.c) ---

// Writes photos/, depth/ and thumbs/ in site->folder, and sets *photos to the manifest's array, which is owned by the
// caller even after an error.
enum orl_result orl_site_photos(struct site *site, json_t **photos);
// What the scene's radiance is published in: from well below what its brightest photographs see to
// what its darkest ones clip at.
struct site_range orl_site_range(const struct orl_scene *scene);
// Writes poster.jpg: the start view, drawn by the renderer.
enum orl_result orl_site_poster(struct site *site);

// --- soft splats (site_soft.c) ---

// If the scene shows soft splats, prepares site->soft, writes soft/splats.bin, and sets *soft to its part of the
// manifest, else to NULL.
enum orl_result orl_site_soft(struct site *site, json_t **soft) ORL_CHECK_RESULT;
// Writes what the splats show in a photograph.
enum orl_result orl_site_soft_photo(struct site *site, const struct orl_view *view, const char *path) ORL_CHECK_RESULT;

// --- manifest (site_manifest.c) ---

// Writes manifest.json with these parts. steps: NULL of a scene without silhouettes; soft: NULL without splats.
enum orl_result orl_site_manifest(struct site *site, json_t *points, json_t *photos, json_t *steps, json_t *soft);

// The entries that the manifests of a site and of a server have in common.
json_t *orl_walk_manifest(const struct orl_scene *scene, const json_t *settings, const char *title,
                          size_t start);
json_t *orl_walk_photo(const struct orl_photo *photo, const struct orl_camera *camera);
// Finds the training photograph that is nearest to all others, or to a thousand of them. ORL_ERR_DATA: there is none.
enum orl_result orl_walk_start(const struct orl_log *log, const struct orl_scene *scene,
                               size_t *start);
// The title asked for, else that of the settings, else the name of the scene's folder without its
// parent folders; the caller releases it with free().
char *orl_walk_title(const struct orl_log *log, const struct orl_scene *scene, const char *asked,
                     const json_t *settings);

// --- page (page.c) ---

// Writes the page, its modules and its shaders.
enum orl_result orl_site_page(struct site *site);
// The text of a file of web/ by its path in there; NULL: there is none.
const char *orl_walk_page_file(const char *name);
// The text of index.html; the caller releases it with free(). NULL, logged: an error. poster: the
// picture's file, "": none.
char *orl_walk_index(const struct orl_log *log, const char *title, const char *poster);
// Adds the paths of the files of a finished site; with `data`, of those that the page requests by name:
// all but page and modules.
enum orl_result orl_site_files(const struct orl_log *log, const char *dir, bool data,
                               struct orl_names *paths);
// Writes the finished site as one HTML file.
enum orl_result orl_site_pack(struct site *site, const char *file);

// --- what a site holds that Oriel did not write (site_keep.c) ---

// Writes files.json: the names of the finished site's files.
enum orl_result orl_site_list(const struct site *site);
// Puts into the new site what its owner has put into the earlier one at `old`: all that its
// files.json does not name, such as .git and CNAME. ORL_ERR_ARGUMENT: such a file has the name of
// one of the new site's.
enum orl_result orl_site_keep(const struct site *site, const char *old);

// --- the server's frames (frames.c) ---

enum walk_layer { WALK_COLOR, WALK_DEPTH, WALK_NORMAL, WALK_COVERAGE, WALK_POINTS, WALK_LAYERS };

enum { WALK_PICKS_MAX = 256 };

// A client's request for a frame.
struct walk_request {
    uint32_t number; // the client's number for the request, returned with the frame
    struct orl_view view;
    enum walk_layer layer;
    int quality;     // quality of the JPEG
    struct orl_tone_params tone;
    bool at_rest;    // the client's view does not move
    // Of a sequence, from 0: what the frame shows, and what the next one will.
    int time_step, expected;
    bool measures;   // asks for what the frame took
    size_t pick_count;
    int picks[WALK_PICKS_MAX][2]; // pixels whose depth it asks for
};
// Reads a request from a message. Returns false for a message that the server does not answer.
bool orl_walk_request_read(json_t *message, struct walk_request *request);

// Reads "ev" and "tone" of a message, both optional. Returns false if they are not valid.
bool orl_walk_tone_read(const json_t *message, struct orl_tone_params *tone);

// Words of 32 bits before the picture: number, microseconds, width, height, photographs that are
// not complete yet, and the count of picked pixels, whose depths follow as floats (0: none).
enum { WALK_FRAME_WORDS = 6 };

struct walk_renderer {
    const struct orl_log *log;
    struct orl_gpu *gpu;
    struct orl_renderer *renderer;
    struct orl_scene *scene; // the renderer's
    float typical; // typical depth of the scene
    double draw_s; // seconds that a moving frame takes without loading photographs, smoothed
};
// A frame that is drawn and encoded.
struct walk_frame {
    uint8_t *data; // owned: room, header, depths, JPEG
    size_t size;   // without the room
    // Owned, if the request measures: {"draw_ms", "encode_ms", "passes": [[NAME, MS]], "memory":
    // {OWNER: BYTES}}. Passes are timed one by one, which slows the frame down on a software
    // renderer.
    json_t *figures;
};
// Draws and encodes a frame, with `before` bytes of room in front of its header. `params`: of a
// view at rest.
enum orl_result orl_walk_frame(struct walk_renderer *walk, const struct walk_request *request,
                               const struct orl_render_params *params, size_t before,
                               struct walk_frame *frame);
// Draws the start view until its first photographs are there, for a few seconds of processor time:
// the first frame of a client finds programs compiled and something to paint from.
enum orl_result orl_walk_warm_up(struct walk_renderer *walk,
                                 const struct orl_render_params *params);

#endif
