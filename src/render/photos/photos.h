// Private to src/render: photographs and their depth maps on the device, within a budget.
#ifndef ORL_RENDER_PHOTOS_H
#define ORL_RENDER_PHOTOS_H

#include "render/frame/frame.h"
#include "render/proxy/proxy.h"
#include "render/photos/photo_loader.h"
#include "oriel/radiance.h"

// Where a photograph is stored. All photographs share two texture arrays. A slot is one layer of
// both, and holds the photograph in its top left corner.
struct photo_state {
    bool asked;  // the renderer's parameters ask for it
    bool usable; // they do, and its file of this time step is not known to be damaged
    int slot; // layer of the arrays; -1: not resident
    bool has_color, has_mask, has_soft;
    int depth_divide;   // its depth has 1/depth_divide of the size of depth_camera; 0: no depth
    uint64_t depth_key; // of the frame that its depth was drawn for
    unsigned last_use;
    float white;  // of radiance: scale of its colours on the device
    bool rounded; // its values were rounded to 8 bits
    struct orl_camera color_camera, depth_camera; // at the resident size, pixels of level 0
    struct orl_camera drawn_camera; // of the depth map that the resident one is picked from
};

struct photos {
    const struct orl_scene *scene;
    struct photo_state *states; // per photograph of the scene
    struct orl_tex *color;      // mipmapped: sRGB, or radiance * confidence, confidence
    struct orl_tex *chroma;     // of textures=ycc, whose color is luma: Cb, Cr; else NULL
    struct orl_tex_params color_params; // of color
    GLenum format;              // of color
    struct orl_tex *loading;    // a photograph before compression; NULL: none is being loaded
    struct orl_tex *depth;      // z; < 0: estimated in a hole, 0: none; NULL: no method asked for it
    struct orl_tex_params depth_params; // of depth
    struct orl_tex *soft;       // R8: luma of soft splats, shaders/soft/keep.comp; NULL: not asked for
    struct orl_tex *mask;       // R8: which pixels are the subject's; NULL: not asked for yet
    struct orl_tex *background; // pictures of the place without the subject; NULL: not asked for
    size_t *background_of;      // per slot: 1 + the photograph whose background it holds; 0: none.
                                // It outlives a time step. Owned
    const struct orl_progress *progress; // see struct orl_renderer_params
    size_t uploaded;            // bytes of photographs and masks that went to the device
    bool silhouettes, places, soft_splats; // methods may ask for mask, for background, for soft
    int slot_count, divide;     // divide: photographs are loaded at 1/divide of their size
    unsigned clock;
    int time_step;                 // scene->frame of what is resident
    bool radiance;              // see struct orl_renderer_params
    struct orl_sensor sensor;
    float ev_darkest, ev_brightest; // of the photographs in use
    uint64_t depth_key;             // orl_photos_depth_key of the frame that is drawn
    // What was read of the time step that is drawn before it was (hull/prefetch.h). NULL: nothing.
    struct photo_loader *ahead;
    struct orl_image *masks_ahead;  // per photograph, as orl_photo_mask_read reads them
    struct photo_loader *loader;    // NULL until progressive.c needs it
    bool were_absent;               // some that the last progressive frame chose
    struct photo_costs {            // seconds that each took last, for progressive.c
        double color, coarse, depth;
    } costs;
};

// textures.c: the texture format that was asked for, or that the scene states. ORL_ERR_FORMAT: the
// scene states one that is unknown to this program.
enum orl_result orl_textures_choose(const struct orl_log *log, const struct orl_scene *scene,
                                    const struct orl_renderer_params *params,
                                    enum orl_textures *textures) ORL_CHECK_RESULT;
// textures.c: the texture format for `textures`, if the device and the kind of pixels allow it.
GLenum orl_textures_format(const struct orl_gpu *gpu, bool radiance, enum orl_textures textures);
enum orl_result orl_photos_init(struct orl_gpu *gpu, const struct orl_scene *scene,
                                const struct orl_renderer_params *params, size_t budget_bytes,
                                struct photos *photos);
void orl_photos_finish(struct orl_gpu *gpu, struct photos *photos); // also after a failure of init
// Evicts all photographs if the scene shows another time step than they do. Those that could not be
// read may be there then.
void orl_photos_follow_time_step(struct photos *photos);
// Makes a photograph's colour resident, and its depth if asked for, drawn
// by the frame's proxy with the frame's parameters. Evicts the least recently used photograph
// if all slots are taken.
enum orl_result orl_photos_require(const struct frame *frame, size_t photo, bool depth);
// Makes a texture of the slots, of the photographs' size, unless it is there.
enum orl_result orl_photos_array(struct orl_gpu *gpu, const struct photos *photos, GLenum format, const char *tag,
                                 struct orl_tex **tex);
// Brings the mask of a resident photograph to the device: 1 within the subject, 0.5 on its boundary
// (Goldluecke 2003, section 3), 1 throughout where the photograph has none.
enum orl_result orl_photos_require_mask(const struct frame *frame, size_t photo);
// What the depth maps of photographs are made of: equal keys mean equal maps.
uint64_t orl_photos_depth_key(const struct frame *frame);
// True if all photographs in use have such a picture.
bool orl_photos_backgrounds(const struct photos *photos);
// True if the background of a photograph that has a slot is on the device.
bool orl_photos_has_background(const struct photos *photos, size_t photo);
// Brings the picture to the device, into the slot of its photograph, which gets one if it has none.
enum orl_result orl_photos_require_background(const struct frame *frame, size_t photo);

// --- occluders.c: what a photograph shows before the scene and has no points ---

// Reads the photograph's occluders: U8 x1 of any size, 255 where they are. One without any gets an
// empty image.
enum orl_result orl_occluders_read(const struct orl_log *log, const struct orl_scene *scene,
                                   size_t photo, struct orl_image *mask);
// Makes the occluders of a photograph the nearest in its depth map, which has just been drawn and
// has kept[] pixels, so that it paints nothing that lies behind them.
enum orl_result orl_occluders_put(const struct frame *frame, size_t photo, const int kept[2]);

// --- the steps of the above, for progressive.c ---

// Makes a photograph's colour resident. The pixels of `image` may be replaced.
enum orl_result orl_photos_put(struct orl_gpu *gpu, struct photos *photos, size_t index,
                               struct orl_image *image) ORL_CHECK_RESULT;
// Draws the depth of a resident photograph at 1/divide of its size.
enum orl_result orl_photos_draw_depth(const struct frame *frame, size_t index,
                                      int divide) ORL_CHECK_RESULT;
// The photograph's depth_divide if its depth was drawn as this frame asks for it, else 0.
int orl_photos_depth_divide(const struct frame *frame, size_t photo);
struct orl_camera orl_photos_depth_camera(const struct photo_state *state, int divide);

// --- select.c ---

// True if the frame may be painted from the photograph.
bool orl_frame_may_use(const struct frame *frame, size_t photo);
// The penalty of shaders/shared/penalty.h for a photograph and a world point; negative if the point
// is outside the photograph. eye: the view's camera centre; view_focal: its fx, pixels.
double orl_photo_penalty(const struct orl_view *photo, const double eye[3], double view_focal,
                         const double point[3]);

// --- progressive.c: photographs for the frames of a viewer, which must not wait for them ---

// For a progressive frame: brings chosen photographs to the device, the most useful first, within
// the frame's time, and removes those from frame->chosen that are not there. Sets the count of
// missing photographs. depth: the frame needs their depth, too.
enum orl_result orl_progressive_admit(struct frame *frame, bool depth) ORL_CHECK_RESULT;
// Before a frame's surface is drawn: may the frame need the proxy's colours, for which the surface
// must have normals? They cost about a tenth of a frame, so this is guessed from the frame before.
bool orl_progressive_underpaints(const struct frame *frame);

#endif
