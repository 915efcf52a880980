// How soft a guess is to be painted.

// Where photographs differ by this much, square roots of light, a guess is fully in doubt.
const float GUESS_DIFFERENCE = 0.1;
// Doubt in what one photograph shows alone: often enough it is right, and sharp.
const float GUESS_ALONE = 0.5;
// The same guess on the ground, which is known far better.
const float GROUND_DOUBT = 0.3;

// How far colour on guessed depth may lie from its place, log2 of pixels: in proportion to parallax
// (Eisemann 2007, Filtered Blending), the less the more the photographs agree. penalty: of the best
// one; share: its part in the colour.
float guess_blur(vec3 p, float penalty, float difference, float share)
{
    float alone = clamp(5.0 * share - 4.0, 0.0, 1.0);
    float doubt = clamp(max(difference / GUESS_DIFFERENCE, GUESS_ALONE * alone), 0.0, 1.0);
    float depths = p.z * dot(ground.xyz, vec3(p.xy / p.z, 1.0)); // of the ground's
    doubt *= abs(depths - 1.0) < 1e-3 ? GROUND_DOUBT : 1.0;
    return log2(max(blur_per_radian * view_focal.x * penalty * doubt, 1.0));
}
