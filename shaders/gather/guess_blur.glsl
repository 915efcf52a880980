// Blur of colour on estimated background depth.

// Difference between photographs, in square roots of light, at which the estimated depth is fully
// uncertain.
const float GUESS_DIFFERENCE = 0.1;
// Uncertainty of colour from a single photograph, which is often right and sharp.
const float GUESS_ALONE = 0.5;
// Factor on the uncertainty on the ground, whose depth is known far better.
const float GROUND_UNCERTAINTY = 0.3;

// How far colour on estimated depth may be displaced, log2 of pixels. It grows with the parallax
// (Eisemann 2007, Filtered Blending) and shrinks as the photographs agree. penalty: of the best
// photograph; difference: between photographs, square roots of light; share: the best photograph's
// part of the weight.
float guess_blur(vec3 p, float penalty, float difference, float share)
{
    float alone = clamp(5.0 * share - 4.0, 0.0, 1.0);
    float uncertainty = clamp(max(difference / GUESS_DIFFERENCE, GUESS_ALONE * alone), 0.0, 1.0);
    float depths = p.z * dot(ground.xyz, vec3(p.xy / p.z, 1.0)); // fraction of the ground's depth
    uncertainty *= abs(depths - 1.0) < 1e-3 ? GROUND_UNCERTAINTY : 1.0;
    return log2(max(blur_per_radian * view_focal.x * penalty * uncertainty, 1.0));
}
