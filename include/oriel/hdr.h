// Radiance views of a scene photographed at several exposures.
#ifndef ORIEL_HDR_H
#define ORIEL_HDR_H

#include "oriel/radiance.h"
#include "oriel/render.h"

// FUSED: one gather in radiance; the weight of each photograph is its geometric weight times how
// well exposed it is at that pixel. SERIES: Airieau 2012, section 4, renders an ordinary picture
// from each series of photographs, then merges the pictures by how well exposed they are.
#define ORL_HDR_MERGES(NAME) NAME(ORL_HDR_FUSED, "fused") NAME(ORL_HDR_SERIES, "series")
enum orl_hdr_merge { ORL_HDR_MERGES(ORL_ENUMERATOR) ORL_HDR_MERGE_COUNT };
// By enum orl_hdr_merge, ended by NULL.
extern const char *const orl_hdr_merge_names[ORL_HDR_MERGE_COUNT + 1];

struct orl_hdr_params {
    enum orl_hdr_merge merge;
    struct orl_render_params render; // options of every picture
    struct orl_sensor sensor;
    const bool *use;       // per photograph: may it be used? NULL: all that are not held out
    size_t max_vram_bytes; // 0: no limit
    int samples;           // supersampling: pictures are drawn this many times as large
                           // in each direction and averaged, [1, 4]; cost grows with its square
};
#define ORL_HDR_DEFAULTS .merge = ORL_HDR_FUSED, .sensor = {ORL_SENSOR_DEFAULTS}, .samples = 1

struct orl_hdr;
// The scene and gpu must outlive *out. Logs a warning if there is only a single exposure.
// ORL_ERR_ARGUMENT: the merge is ORL_HDR_SERIES, and photographs are radiance already.
enum orl_result orl_hdr_create(struct orl_gpu *gpu, const struct orl_scene *scene,
                               const struct orl_hdr_params *params,
                               struct orl_hdr **out) ORL_CHECK_RESULT;
void orl_hdr_destroy(struct orl_hdr **hdr);
// Draws a view in radiance, where 1 is white at the scene's middle exposure. `skip`: as for
// orl_renderer_draw. frame->confidence is the mean confidence weight of the samples of each pixel.
enum orl_result orl_hdr_draw(struct orl_hdr *hdr, const struct orl_view *view, const bool *skip,
                             struct orl_frame *frame) ORL_CHECK_RESULT;

// --- panorama ---

struct orl_panorama {
    double position[3];    // world
    double forward[3];     // world: viewing direction of its centre, before it is made level
    double up[3];          // world, not zero
    int width, height;     // [8, 32768] each; equirectangular
};
// Sets position and forward to those of the photograph `at`; NULL: forward to the photographs' mean,
// position is left alone. And `up` to their mean upward direction, since
// people hold cameras level. ORL_ERR_NOT_FOUND: there is none of this name.
enum orl_result orl_panorama_place(const struct orl_log *log, const struct orl_scene *scene,
                                   const char *at, struct orl_panorama *panorama) ORL_CHECK_RESULT;
// All directions from a point: longitude +pi to -pi from left to right, 0 (forward) in the
// middle, latitude +pi/2 (up) at the top: OpenEXR's latitude-longitude map. frame->depth is
// the distance to the point; normals are in the frame of x right, y down, z forward, as if
// looking at the centre. Directions that no photograph sees take their neighbours' colour,
// with coverage and confidence 0; merged by series, what a view has filled in stays.
enum orl_result orl_hdr_draw_panorama(struct orl_hdr *hdr, const struct orl_panorama *panorama,
                                      const bool *skip, struct orl_frame *frame) ORL_CHECK_RESULT;
// The panorama's position and orientation as a view of its centre, with a placeholder camera of its
// size. False if `up` has zero length.
bool orl_panorama_view(const struct orl_panorama *panorama, struct orl_view *view);

#endif
