// The unstructured lumigraph's penalty (Buehler 2001), a power of its inverse.
#include "gather/penalty.glsl"

float weight_of(photo shot, Point at)
{
    float penalty = photo_penalty(shot, at.p);
    float share = at.guessed ? 0.1 / penalty
                          : photo_surface_penalty(0.1) / photo_surface_penalty(penalty);
    // What sums and products stay finite with, and no photograph gets lost with.
    float weight =
        clamp(pow(share, at.guessed ? opt.guess_sharpness : opt.sharpness), 1e-10, 1e18);
    return at.guessed ? weight * photo_beside(penalty) : weight;
}

// Of a photograph a tenth of a radian away.
float weight_unit(bool guessed)
{
    return 1.0;
}
