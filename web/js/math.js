// Vectors of three numbers, rotations as nine (rows) and quaternions w x y z. Conventions are
// COLMAP's: x right, y down, z forward; cam_from_world.
export const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const scale = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) =>
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const length = a => Math.sqrt(dot(a, a));
export const distance = (a, b) => length(sub(a, b));
export const clamp = (x, low, high) => Math.min(Math.max(x, low), high);

export function normalize(a)
{
    const l = length(a);
    return l > 0 ? scale(a, 1 / l) : a;
}

// The part of `a` across a unit vector.
export const across = (a, up) => sub(a, scale(up, dot(a, up)));

export const row = (r, i) => [r[3 * i], r[3 * i + 1], r[3 * i + 2]];
export const rotate = (r, v) => [dot(row(r, 0), v), dot(row(r, 1), v), dot(row(r, 2), v)];
export const rotateBack = (r, v) => [0, 1, 2].map(k => r[k] * v[0] + r[3 + k] * v[1] + r[6 + k] * v[2]);

// Each row of the product is b's transpose applied to a row of a.
export const multiply = (a, b) => [0, 1, 2].flatMap(i => rotateBack(b, row(a, i)));

// Rotation by an angle about a unit axis.
export function rotation(axis, angle)
{
    const [x, y, z] = axis, c = Math.cos(angle), s = Math.sin(angle), d = 1 - c;
    return [c + x * x * d, x * y * d - z * s, x * z * d + y * s,
            y * x * d + z * s, c + y * y * d, y * z * d - x * s,
            z * x * d - y * s, z * y * d + x * s, c + z * z * d];
}

export function quatFromRotation(r)
{
    const trace = r[0] + r[4] + r[8];
    let q;
    if (trace > 0) {
        const s = 2 * Math.sqrt(trace + 1);
        q = [s / 4, (r[7] - r[5]) / s, (r[2] - r[6]) / s, (r[3] - r[1]) / s];
    } else {
        const i = r[0] > r[4] ? (r[0] > r[8] ? 0 : 2) : (r[4] > r[8] ? 1 : 2);
        const j = (i + 1) % 3, k = (i + 2) % 3;
        const s = 2 * Math.sqrt(Math.max(1 + r[4 * i] - r[4 * j] - r[4 * k], 1e-12));
        q = [(r[3 * k + j] - r[3 * j + k]) / s, 0, 0, 0];
        q[1 + i] = s / 4;
        q[1 + j] = (r[3 * j + i] + r[3 * i + j]) / s;
        q[1 + k] = (r[3 * k + i] + r[3 * i + k]) / s;
    }
    return normalizeQuat(q);
}

function normalizeQuat(q)
{
    const l = Math.hypot(...q) || 1;
    return q.map(x => x / l);
}

export function rotationFromQuat([w, x, y, z])
{
    return [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),
            2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
            2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)];
}

export function slerp(a, b, t)
{
    let cosine = a.reduce((sum, x, i) => sum + x * b[i], 0);
    const sign = cosine < 0 ? -1 : 1;
    cosine = Math.min(Math.abs(cosine), 1);
    const angle = Math.acos(cosine), sine = Math.sin(angle);
    const u = sine > 1e-6 ? Math.sin((1 - t) * angle) / sine : 1 - t;
    const v = sine > 1e-6 ? Math.sin(t * angle) / sine : t;
    return normalizeQuat(a.map((x, i) => u * x + sign * v * b[i]));
}

export const mix = (a, b, t) => a + (b - a) * t;
export const mix3 = (a, b, t) => [mix(a[0], b[0], t), mix(a[1], b[1], t), mix(a[2], b[2], t)];
