// Which points a photograph sees: a depth buffer of all points from its camera.
#ifndef ORL_SCENE_DEPTH_BUFFER_H
#define ORL_SCENE_DEPTH_BUFFER_H

#include "oriel/camera.h"
#include "oriel/points.h"

struct orl_depth_buffer {
    int width, height;
    double scale; // depth buffer pixels per pixel of the photograph
    float *z;     // owned; INFINITY: no surface
};

// Draws all points, as squares that face the camera, into a buffer of at most 512 pixels to a side.
enum orl_result orl_depth_buffer_draw(const struct orl_log *log, const struct orl_view *view,
                                      const struct orl_points *points,
                                      struct orl_depth_buffer *buffer) ORL_CHECK_RESULT;
void orl_depth_buffer_finish(struct orl_depth_buffer *buffer);
// Where the view shows a place: its pixel and its depth. False when the place lies outside.
bool orl_view_shows(const struct orl_view *view, const double world[3], double pixel[2],
                    double *depth);
// The same for a point.
bool orl_point_project(const struct orl_view *view, const float position[3], double pixel[2],
                       double *depth);
// True when nothing is clearly nearer at the photograph's pixel or within one pixel of the buffer
// around it: poses and depths are inexact, and what is compared in several photographs needs room.
bool orl_depth_buffer_shows(const struct orl_depth_buffer *buffer, const double pixel[2],
                            double depth);

#endif
