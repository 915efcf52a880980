// Private to src/render: one view while it is rendered, from the surface to the picture.
#ifndef ORL_RENDER_FRAME_H
#define ORL_RENDER_FRAME_H

#include "oriel/render.h"

struct proxy;
struct photos;
struct prefetch;
struct paint;

// The result of a proxy, which is all that later passes see of it.
struct surface {
    int width, height;
    struct orl_tex *depth;  // R32F: z in camera space; 0: none; < 0: estimated background
    struct orl_tex *normal; // RGBA16F: camera frame, 0: none; w: 1 if a primitive is visible
};

// What every pass gets. What a pass alone needs, and what outlives a frame, is in its own struct.
struct frame {
    struct orl_gpu *gpu;
    const struct orl_scene *scene;
    const struct orl_view *view;
    const struct orl_render_params *params;
    bool radiance;             // photographs are sampled as radiance
    bool reads_chroma;         // colours of photographs are luma, and chroma in a second texture
    bool finishes;             // the painter leaves finished pixels (struct orl_painter)
    struct orl_progressive *progressive; // NULL: the frame waits for its photographs
    bool normals;              // the surface has normals
    const bool *skip;          // per photograph: leave it out; NULL: use all
    struct proxy *proxy;       // draws the surfaces of this view and of the photographs
    struct surface surface;    // surface that the view sees
    struct photos *photos;     // photographs on the device
    struct prefetch *prefetch; // what was prepared for this frame, hull/prefetch.h; NULL: nothing
    struct paint *paint;       // what the passes that make colours keep, paint/paint.h
    // Indices of the photographs that this frame asks, ascending; memory of the renderer.
    size_t *chosen;
    float (*selected)[4];      // by the selection: weight of each; x y z its own use
    size_t chosen_count;
    // Pixels as in shaders/shared/pixel.glsl, finished at the end. Half floats if the painter
    // finishes pixels.
    struct orl_tex *picture;
};

// Makes *tex fit the frame's picture and the format. Destroys it if it is not `wanted`.
enum orl_result orl_frame_target(const struct frame *frame, const char *tag, bool wanted, GLenum format,
                                 struct orl_tex **tex) ORL_CHECK_RESULT;

// True if background depth is estimated where no surface covers a pixel.
bool orl_params_guess(const struct orl_render_params *params);
// How many pixels of a photograph a pixel of the view covers each way where both are equally far, in
// the mean over the photographs; at least 1. What is known of the scene by photographs, such as where
// a silhouette is, is as exact as their pixels, whatever the view's are.
double orl_frame_footprint(const struct frame *frame);
// The scene's ground for image_block and gather_block; zeros if the frame's estimated depth is not
// limited by the ground.
void orl_frame_ground(const struct frame *frame, float ground[4]);
// The rows of cam_from_world's rotation, and the camera's centre.
void orl_set_pose(const struct orl_pose *pose, float rotation[3][4], float eye[4]);
void orl_set_focal(const struct orl_camera *camera, float focal[4]);

#endif
