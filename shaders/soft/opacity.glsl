// A soft splat in a view, and its opacity there, for the renderer and for the page.

// Opacities below this are not drawn, and none is above OPACITY_MAX.
const float OPACITY_MIN = 1.0 / 255.0, OPACITY_MAX = 0.99;

struct seen_splat {
    vec2 centre;
    vec3 inverse; // covariance's: xx, xy, yy
    float opacity;
    vec3 color;
};

// Opacity at an offset from the centre, pixels; 0: not drawn there.
float seen_opacity(seen_splat s, vec2 off)
{
    float power = -0.5 * (s.inverse.x * off.x * off.x + s.inverse.z * off.y * off.y) - s.inverse.y * off.x * off.y;
    float opacity = s.opacity * exp(min(power, 0.0));
    return opacity < OPACITY_MIN ? 0.0 : min(opacity, OPACITY_MAX);
}
