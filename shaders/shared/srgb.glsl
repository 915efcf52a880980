// The sRGB transfer functions (IEC 61966-2-1).

// A polynomial, fitted to within 1/16 of a step of 8 bits, stands for the power, which takes a software
// renderer several times as long.
vec3 srgb_decode(vec3 c)
{
    vec3 power = 0.00106119 + c * (0.02795274 + c * (0.56383286 + c * (0.51827439 - 0.11112118 * c)));
    return mix(c * (1.0 / 12.92), power, greaterThan(c, vec3(0.04045)));
}

vec3 srgb_encode(vec3 c)
{
    return mix(12.92 * c, 1.055 * pow(max(c, 0.0031308), vec3(1.0 / 2.4)) - 0.055,
               greaterThan(c, vec3(0.0031308)));
}
