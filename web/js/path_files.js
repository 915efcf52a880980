// Files of paths: Oriel's own keyframes, and nerfstudio's camera_path.json.
import {secondsFrom, SECONDS_A_KEY, viewAt} from "./keyframes.js";
import {cross, dot, normalize, sub} from "./math.js";
import {text} from "./strings.js";
import {fovOf, photoView, viewFromKey, viewToKey} from "./view.js";

const FPS = 24;
const SIZE = [1280, 720]; // of a video
const SECONDS_MIN = 0.01, SECONDS_MAX = 3600; // from a keyframe to the next, as src/scene/path.c
const KEYS_MAX = 2000;

// --- writing ---

// The file that `oriel render --path` reads.
export function orielPath(keys, seconds)
{
    const frames = Math.max(Math.round(seconds * FPS) + 1, 2);
    return {...(keys.length > 1 ? {frames} : {}),
            keyframes: keys.map(key => ({...viewToKey(key), seconds: secondsFrom(key)}))};
}

// From camera to world, row by row, with axes as in OpenGL.
const openglMatrix = ({r, eye}) => [0, 1, 2].flatMap(k => [r[k], -r[3 + k], -r[6 + k], eye[k]]).concat(0, 0, 0, 1);

// nerfstudio's camera_path.json: its viewer goes on with the keyframes, its renderer takes every frame.
export function nerfstudioPath(keys, seconds)
{
    const aspect = SIZE[0] / SIZE[1];
    const count = keys.length > 1 ? Math.max(Math.round(seconds * FPS) + 1, 2) : 1;
    const views = [...Array(count).keys()].map(i => count > 1 ? viewAt(keys, i / (count - 1)) : keys[0]);
    return {
        camera_type: "perspective", render_width: SIZE[0], render_height: SIZE[1], fps: FPS, seconds,
        is_cycle: false, smoothness_value: 0, default_fov: fovOf(keys[0].frame), default_transition_sec: SECONDS_A_KEY,
        keyframes: keys.map((key, i) => ({
            matrix: openglMatrix(key), fov: fovOf(key.frame), aspect, override_transition_enabled: i > 0,
            override_transition_sec: i > 0 ? secondsFrom(keys[i - 1]) : null, // from the one before
        })),
        camera_path: views.map(view => ({camera_to_world: openglMatrix(view), fov: fovOf(view.frame), aspect})),
    };
}

// --- reading ---

const isNumbers = (list, count) => Array.isArray(list) && list.length === count && list.every(Number.isFinite);

function isRotation(r)
{
    const rows = [0, 3, 6].map(i => r.slice(i, i + 3));
    return rows.every((a, i) => rows.every((b, j) => Math.abs(dot(a, b) - (i === j ? 1 : 0)) < 1e-3));
}

// The rows of cam_from_world that a keyframe states; null: none that are usable.
function rowsOf(key)
{
    const rows = key.cam_from_world;
    if (rows)
        return Array.isArray(rows) && rows.length === 3 && rows.every(row => isNumbers(row, 4)) ? rows : null;
    const {position, target, up = [0, -1, 0]} = key;
    if (![position, target, up].every(v => isNumbers(v, 3)))
        return null;
    const forward = normalize(sub(target, position)), right = normalize(cross(forward, up));
    return [right, cross(forward, right), forward].map(axis => [...axis, -dot(axis, position)]);
}

// A keyframe of Oriel; null: it is not usable.
function orielView(key, photos, frame)
{
    if (typeof key.photo === "string") {
        const photo = photos.find(p => p.name === key.photo), view = photo && photoView(photo);
        return view && key.fov_y_deg ? viewFromKey({...viewToKey(view), fov_y_deg: key.fov_y_deg}, view.frame)
                                     : view || null;
    }
    const rows = rowsOf(key);
    return rows && viewFromKey({cam_from_world: rows, fov_y_deg: key.fov_y_deg || fovOf(frame)}, frame);
}

// A keyframe or a frame of nerfstudio: its matrix row by row, or column by column as older files have
// it, in a text; null: it is not usable.
function nerfstudioView(entry, frame)
{
    const given = entry.matrix || entry.camera_to_world, list = typeof given === "string" ? JSON.parse(given) : given;
    if (!isNumbers(list, 16))
        return null;
    const byColumn = typeof given === "string" || list[12] || list[13] || list[14];
    const m = byColumn ? list.map((_, i) => list[i % 4 * 4 + (i >> 2)]) : list;
    const axes = [0, 1, 2].map(k => [0, 1, 2].map(i => (k ? -1 : 1) * m[4 * i + k]));
    const eye = [m[3], m[7], m[11]];
    return viewFromKey({cam_from_world: axes.map(axis => [...axis, -dot(axis, eye)]), fov_y_deg: entry.fov}, frame);
}

function nerfstudioKeys(json, frame)
{
    const kept = Array.isArray(json.keyframes) && json.keyframes.length > 0;
    const entries = kept ? json.keyframes : json.camera_path;
    const usual = !kept ? 1 / (json.fps || FPS)
                        : json.default_transition_sec || (json.seconds || 0) / Math.max(entries.length - 1, 1) || SECONDS_A_KEY;
    return entries.map((entry, i) => {
        const next = entries[i + 1] || {}, view = nerfstudioView(entry, frame);
        return view && {...view, seconds: next.override_transition_enabled && next.override_transition_sec || usual};
    });
}

function orielKeys(json, photos, frame)
{
    const keys = json.keyframes, timed = keys.some(key => "seconds" in key);
    const usual = !timed && json.frames > 1 ? (json.frames - 1) / FPS / Math.max(keys.length - 1, 1) : 1;
    return keys.map(key => {
        const view = orielView(key, photos, frame);
        return view && {...view, seconds: key.seconds === undefined ? usual : key.seconds};
    });
}

// The keyframes of a file's text: views with seconds to the next one. frame: of those that state none.
// Throws an error that says what is wrong.
export function readPath(content, photos, frame)
{
    const json = JSON.parse(content), isList = list => Array.isArray(list) && list.length > 0 && list.length <= KEYS_MAX;
    if (!json || !isList(json.camera_path || json.keyframes))
        throw new Error(text.path.noPath(KEYS_MAX));
    const keys = json.camera_path ? nerfstudioKeys(json, frame) : orielKeys(json, photos, frame);
    const wrong = keys.findIndex(key => !key || !isRotation(key.r) || !key.eye.every(Number.isFinite) ||
                                        !(key.seconds >= SECONDS_MIN && key.seconds <= SECONDS_MAX));
    if (wrong >= 0)
        throw new Error(text.path.badKey(wrong + 1));
    return keys;
}
