// Where depth steps, a pixel shows what is on both sides, as shaders/edges/antialias.comp makes it.
uniform sampler2D composed, depth;

// Second differences of inverse depth, parts of the largest: from none of it to all.
const float STEP_FROM = 0.004, STEP_FULL = 0.012;

float inverse_at(ivec2 at)
{
    float z = texelFetch(depth, at, 0).x;
    return z > 0.0 ? 1.0 / z : 0.0;
}

vec3 antialiased(ivec2 at)
{
    vec3 own = texelFetch(composed, at, 0).rgb;
    if (min(at.x, at.y) < 1 || any(greaterThanEqual(at, textureSize(depth, 0) - 1)))
        return own;
    float middle = inverse_at(at), bend = 0.0, most = middle;
    ivec2 along[4] = ivec2[4](ivec2(1, 0), ivec2(-1, 1), ivec2(0, 1), ivec2(1, 1));
    for (int n = 0; n < 4; n++) {
        float before = inverse_at(at - along[n]), after = inverse_at(at + along[n]);
        bend = max(bend, abs(before + after - 2.0 * middle));
        most = max(most, max(before, after));
    }
    float share = clamp((bend / max(most, 1e-30) - STEP_FROM) / (STEP_FULL - STEP_FROM), 0.0, 1.0);
    if (!(share > 0.0))
        return own;
    float aside = 0.35 * share;
    vec3 sum = vec3(0.0);
    for (int n = 0; n < 9; n++) {
        ivec2 off = ivec2(n % 3, n / 3) - 1;
        sum += sqrt(texelFetch(composed, at + off, 0).rgb) * (off.x != 0 ? aside : 1.0) *
               (off.y != 0 ? aside : 1.0);
    }
    sum /= (1.0 + 2.0 * aside) * (1.0 + 2.0 * aside);
    return sum * sum;
}
