// Keyframes: views with seconds to the next one, and the views between them.
import {clamp} from "./math.js";
import {mixViews} from "./view.js";

export const SECONDS_A_KEY = 3; // from a keyframe to the next, until somebody sets another time

export const secondsFrom = key => key.seconds || SECONDS_A_KEY;

// Of the whole path: the last keyframe's own seconds lead nowhere.
export const durationOf = keys => keys.slice(0, -1).reduce((sum, key) => sum + secondsFrom(key), 0);

// The segment that a share of the time lies in, and the place in it from 0 to 1.
function segmentAt(keys, share)
{
    let left = share * durationOf(keys), i = 0;
    while (i < keys.length - 2 && left >= secondsFrom(keys[i]))
        left -= secondsFrom(keys[i++]);
    return [i, Math.min(left / secondsFrom(keys[i]), 1)];
}

// Between b and c with neighbours a and d, as src/scene/path.c has it; seconds of the three segments.
function spline(a, b, c, d, [before, own, after], t)
{
    const leave = (c - a) * own / (before + own), arrive = (d - b) * own / (own + after), way = c - b;
    return b + t * (leave + t * (3 * way - 2 * leave - arrive + t * (leave + arrive - 2 * way)));
}

// The view at a share of the time along the keyframes.
export function viewAt(keys, share)
{
    const [i, t] = segmentAt(keys, share), own = secondsFrom(keys[i]);
    const times = [i > 0 ? secondsFrom(keys[i - 1]) : own, own, i < keys.length - 2 ? secondsFrom(keys[i + 1]) : own];
    const key = n => keys[clamp(n, 0, keys.length - 1)], a = key(i), b = key(i + 1);
    const eye = [0, 1, 2].map(k => spline(key(i - 1).eye[k], a.eye[k], b.eye[k], key(i + 2).eye[k], times, t));
    const view = {...mixViews(a, b, t), eye};
    for (const name of ["fx", "fy"]) // as orl_view_interpolate
        view.frame[name] = a.frame[name] ** (1 - t) * b.frame[name] ** t;
    return view;
}
