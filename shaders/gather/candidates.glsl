// The photographs that can paint a tile of the screen best, for the renderer and for the page. The file that includes
// this one defines
//   float depth_at(ivec2 at): the view's depth, < 0: estimated.
// RESTS: the backdrop rests in the photographs.
#include "gather/backdrop.glsl"
#include "shared/constants.h"

const int ACROSS = 3; // sample points of a tile in each direction

// Sample points of a tile in the view's camera frame; z 0: no depth there. guess: 1 where the depth
// is estimated, else 0. side: of tiles, size: of the view, pixels.
void sample_depths(ivec2 tile, int side, ivec2 size, out vec3 points[ACROSS * ACROSS],
                   out float guess[ACROSS * ACROSS])
{
    for (int i = 0; i < ACROSS * ACROSS; i++) {
        ivec2 at = tile * side + (2 * ivec2(i % ACROSS, i / ACROSS) + 1) * side / (2 * ACROSS);
        at = min(at, size - 1);
        float depth = depth_at(at);
        points[i] = vec3((vec2(at) + 0.5 - view_focal.zw) / view_focal.xy, 1.0) * abs(depth);
        guess[i] = depth < 0.0 ? 1.0 : 0.0;
    }
}

// Takes a sample point p of the tile into account (z 0: no depth there; guess: 1 where it is estimated) if
// the photograph shows it.
void candidate_sample(photo source, vec3 p, float guess, inout float least)
{
    vec2 pixel;
    float z;
    bool backdrop = false;
#ifdef RESTS
    backdrop = guess > 0.0 && photo_backdrop(source, p, pixel);
#endif
    if (!(p.z > 0.0) || !(photo_project(source, p, pixel, z) || backdrop))
        return;
    // An estimated depth may be wrong, so it does not count what hides the point there.
    bool in_sight = guess > 0.0 || photo_unhidden_share(source, photo_depths(source, pixel), z) > 0.9;
    least = min(least, photo_penalty(source, p) * (in_sight ? 1.0 : 8.0));
}

// Insertion sort, best first.
void candidate_insert(float penalty, int photo, inout float best[ORL_CANDIDATES], inout int index[ORL_CANDIDATES])
{
    for (int c = 0; c < ORL_CANDIDATES; c++) {
        if (penalty < best[c]) {
            float b = best[c];
            int n = index[c];
            best[c] = penalty;
            index[c] = photo;
            penalty = b;
            photo = n;
        }
    }
}

// The photographs of a tile, of the first `photos`: best first, -1: none.
void list_candidates(ivec2 tile, int side, ivec2 size, int photos, out int index[ORL_CANDIDATES])
{
    vec3 points[ACROSS * ACROSS];
    float guess[ACROSS * ACROSS];
    sample_depths(tile, side, size, points, guess);
    float best[ORL_CANDIDATES];
    for (int c = 0; c < ORL_CANDIDATES; c++) {
        best[c] = NOT_SEEN;
        index[c] = -1;
    }
    int i = 0;
    do { // the condition comes last: see tiled.comp
        float least = NOT_SEEN; // penalty at any sample point
        photo source = photo_at(i);
        for (int s = 0; s < ACROSS * ACROSS; s++)
            candidate_sample(source, points[s], guess[s], least);
        candidate_insert(i < photos ? least : NOT_SEEN, i, best, index);
        i++;
    } while (i < photos);
}
