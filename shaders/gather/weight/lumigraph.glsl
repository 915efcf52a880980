// Weight from the penalty of the unstructured lumigraph (Buehler 2001): a power of its inverse.
#include "gather/penalty.glsl"

float weight_of(photo source, Point at)
{
    float penalty = photo_penalty(source, at.p);
    float share = at.guessed ? 0.1 / penalty
                          : photo_surface_penalty(0.1) / photo_surface_penalty(penalty);
    // The bounds keep sums and products finite, and the weight of every photograph above zero.
    float weight = clamp(pow(share, opt.sharpness), 1e-10, 1e18);
    return at.guessed ? weight * photo_beside(penalty) : weight;
}

// Weight of a photograph at an angle of a tenth of a radian.
float weight_unit(bool guessed)
{
    return 1.0;
}
