// The photographs that can paint a tile of the screen best, for the renderer and for the page. RESTS: the backdrop
// rests in the photographs.
#include "gather/backdrop.glsl"
#include "shared/constants.h"

// Takes a sample point p of the tile into account (z 0: no depth there; guess: 1 where it is estimated) if
// the photograph shows it.
void candidate_sample(photo source, vec3 p, float guess, inout float least, inout float seen)
{
    vec2 pixel;
    float z;
    bool backdrop = false;
#ifdef RESTS
    backdrop = guess > 0.0 && photo_backdrop(source, p, pixel);
#endif
    if (!(p.z > 0.0) || !(photo_project(source, p, pixel, z) || backdrop))
        return;
    float share = backdrop ? 1.0 : photo_unhidden_share(source, photo_depths(source, pixel), z);
    float hidden = share > 0.9 ? 1.0 : 8.0;
    least = min(least, photo_penalty(source, p) * hidden);
    seen += 1.0 / hidden;
}

// The least penalty at any sample point, raised a little for photographs that see few points.
float candidate_penalty(float least, float seen)
{
    return seen == 0.0 ? NOT_SEEN : least * (1.0 + 1.0 / max(seen, 0.1));
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
