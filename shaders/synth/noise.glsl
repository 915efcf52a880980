// Hashes and value noise, the same on every device. Needs Params.
uint hash_cell(ivec3 c)
{
    uvec3 u = uvec3(c);
    uint h = u.x * 0x8da6b343u ^ u.y * 0xd8163841u ^ u.z * 0xcb1ab31fu ^ seed.x;
    h ^= h >> 15;
    h *= 0x2c1b3c6du;
    h ^= h >> 12;
    h *= 0x297a2d39u;
    return h ^ (h >> 15);
}

float unit_float(uint h)
{
    return float(h >> 8) * (1.0 / 16777216.0);
}

float hash1(ivec3 c)
{
    return unit_float(hash_cell(c));
}

// Three values in [0, 1) from one hash.
vec3 spread(uint h)
{
    return vec3(h & 1023u, (h >> 10) & 1023u, (h >> 20) & 1023u) * (1.0 / 1024.0);
}

// Value noise in [-1, 1] (w) and its gradient (xyz).
vec4 noise_gradient(vec3 p)
{
    vec3 base = floor(p);
    vec3 f = p - base;
    ivec3 c = ivec3(base);
    vec3 u = f * f * (3.0 - 2.0 * f);
    vec3 du = 6.0 * f * (1.0 - f);
    float a = hash1(c), b = hash1(c + ivec3(1, 0, 0));
    float d = hash1(c + ivec3(0, 1, 0)), e = hash1(c + ivec3(1, 1, 0));
    float g = hash1(c + ivec3(0, 0, 1)), h = hash1(c + ivec3(1, 0, 1));
    float i = hash1(c + ivec3(0, 1, 1)), j = hash1(c + ivec3(1, 1, 1));
    float k0 = a, k1 = b - a, k2 = d - a, k3 = g - a;
    float k4 = a - b - d + e, k5 = a - d - g + i, k6 = a - b - g + h;
    float k7 = b + d + g + j - a - e - i - h;
    float value = k0 + k1 * u.x + k2 * u.y + k3 * u.z + k4 * u.x * u.y + k5 * u.y * u.z +
                  k6 * u.z * u.x + k7 * u.x * u.y * u.z;
    vec3 gradient = du * vec3(k1 + k4 * u.y + k6 * u.z + k7 * u.y * u.z,
                              k2 + k5 * u.z + k4 * u.x + k7 * u.z * u.x,
                              k3 + k6 * u.x + k5 * u.y + k7 * u.x * u.y);
    return vec4(2.0 * gradient, 2.0 * value - 1.0);
}

float noise(vec3 p)
{
    return noise_gradient(p).w;
}

// Visibility of a pattern of `frequency` (per metre) in a pixel of `footprint` metres: it fades out
// before the pattern would alias.
float visible(float frequency, float footprint)
{
    return clamp(2.0 - 2.5 * frequency * footprint, 0.0, 1.0);
}

// Octaves of noise from `frequency` upwards, each `gain` times weaker and twice as fine; w: sum,
// xyz: gradient for bumps. Octaves too fine for the pixel are omitted.
vec4 octaves(vec3 p, float frequency, int count, float gain, float footprint)
{
    vec4 sum = vec4(0.0);
    float amplitude = 1.0;
    for (int i = 0; i < count; i++) {
        float share = visible(frequency, footprint);
        if (share <= 0.0)
            break;
        vec4 n = noise_gradient(p * frequency + float(i) * vec3(17.3, 5.7, 11.9));
        sum += amplitude * share * vec4(n.xyz, n.w);
        amplitude *= gain;
        frequency *= 2.03;
    }
    return sum;
}

// Falls from 1 at `low` to 0 at `high`.
float fall(float low, float high, float x)
{
    return 1.0 - smoothstep(low, high, x);
}
