// Views: where the viewer is, where they look, and what part of it the window frames.
// A frame is a picture of height 1: focal lengths and the principal point's offset from the
// middle in that unit, so that a photograph's own framing survives any window.
import {across, add, dot, length, mix, mix3, normalize, quatFromRotation, rotate, rotateBack, rotationFromQuat, row,
        scale, slerp, sub} from "./math.js";

// Quarters, clockwise, that turn a picture of each EXIF orientation upright (orl_photo_upright).
const QUARTERS = [0, 0, 0, 2, 2, 1, 1, 3, 3];
export const quartersOf = photo => QUARTERS[photo.orientation] || 0;

export function photoView(photo)
{
    let {r, width, height, fx, fy, cx, cy} = photo;
    for (let i = quartersOf(photo); i > 0; i--) {
        r = [-r[3], -r[4], -r[5], r[0], r[1], r[2], r[6], r[7], r[8]];
        [width, height, fx, fy, cx, cy] = [height, width, fy, fx, height - cy, cx];
    }
    return {eye: photo.eye, r, frame: {aspect: width / height, fx: fx / height, fy: fy / height,
            x: (cx - width / 2) / height, y: cy / height - 0.5}};
}

// Pixels of the frame's height in a window: all of the frame shows, but in upright windows, where
// that would widen the field of view beyond use, it is cut as much as the window is filled up.
export function frameHeight(frame, width, height)
{
    const contain = Math.min(width / frame.aspect, height);
    const cover = Math.max(width / frame.aspect, height);
    return width < height && frame.aspect > 1 ? Math.sqrt(contain * cover) : contain;
}

// The place and rotation that the rows of cam_from_world say.
export function poseOf(rows)
{
    const r = rows.flatMap(line => line.slice(0, 3));
    return {r, eye: scale(rotateBack(r, rows.map(line => line[3])), -1)};
}

// The camera of a view for a picture of this many pixels, as the renderer takes it.
export function cameraOf(view, width, height)
{
    const s = frameHeight(view.frame, width, height), {r, eye} = view;
    return {width, height, r, eye, fx: view.frame.fx * s, fy: view.frame.fy * s,
            cx: width / 2 + view.frame.x * s, cy: height / 2 + view.frame.y * s};
}

export const forwardOf = view => row(view.r, 2);
export const rightOf = view => row(view.r, 0);
export const upOf = view => scale(row(view.r, 1), -1);

// Right, up and ahead of a view that looks straight ahead there.
export function levelAxes(view, up)
{
    const forward = forwardOf(view);
    let ahead = across(forward, up);
    if (length(ahead) < 0.2) // looking straight down or up
        ahead = across(scale(upOf(view), dot(forward, up) < 0 ? 1 : -1), up);
    return [normalize(across(rightOf(view), up)), up, normalize(ahead)];
}

export function mixViews(a, b, t)
{
    const frame = {};
    for (const key of Object.keys(a.frame))
        frame[key] = mix(a.frame[key], b.frame[key], t);
    return {eye: mix3(a.eye, b.eye, t), frame,
            r: rotationFromQuat(slerp(quatFromRotation(a.r), quatFromRotation(b.r), t))};
}

// Where a camera sees a point: pixels, and its depth; null: outside its picture.
export function project(camera, point)
{
    const [x, y, z] = rotate(camera.r, sub(point, camera.eye));
    const at = [camera.fx * x / z + camera.cx, camera.fy * y / z + camera.cy, z];
    return z > 0 && at[0] > 0 && at[1] > 0 && at[0] < camera.width && at[1] < camera.height ? at : null;
}

// The point at that depth under a place of a camera's picture, pixels.
export function unproject({r, eye, fx, fy, cx, cy}, x, y, depth)
{
    return add(eye, rotateBack(r, [(x - cx) / fx * depth, (y - cy) / fy * depth, depth]));
}

const BEHIND = 1.04; // depths that differ by less may be of one surface

// Is a point behind the surface that its pixel shows? 0: no surface.
export const isBehind = (depth, surface) => surface > 0 && depth > BEHIND * surface;

// --- in files: keyframes of src/scene/path.c, views of walk.json ---

export const fovOf = frame => 2 * Math.atan(0.5 / frame.fy) * 180 / Math.PI; // from top to bottom, degrees

export function viewToKey({r, eye, frame})
{
    const rows = [0, 1, 2].map(i => [...row(r, i), -dot(row(r, i), eye)]);
    return {cam_from_world: rows, fov_y_deg: fovOf(frame)};
}

// null unless it is one; the frame is `frame`, its focal length aside.
export function viewFromKey(key, frame)
{
    const fy = 0.5 / Math.tan(key.fov_y_deg * Math.PI / 360);
    if (!(fy > 0.05 && fy < 50))
        return null;
    return {...poseOf(key.cam_from_world), frame: {...frame, fx: fy * frame.fx / frame.fy, fy}};
}

// A key with the whole frame, so that a view at a photograph stays that photograph's.
export function viewToSaved(view)
{
    const {aspect, fx, x, y} = view.frame;
    return {...viewToKey(view), frame: {aspect, fx, x, y}};
}

// null unless it is one; without a frame of its own it has that of `home`, centred.
export function viewFromSaved(saved, home)
{
    const view = viewFromKey(saved, {...home.frame, x: 0, y: 0});
    return view && saved.frame ? {...view, frame: {...saved.frame, fy: view.frame.fy}} : view;
}

// --- in the address ---

const digits = x => String(Number(x.toPrecision(6)));
const PLACE_NUMBERS = 8; // eye, rotation, focal length; the rest of the frame may follow

export function viewToText({eye, r, frame})
{
    return [...eye, ...quatFromRotation(r), frame.fy, frame.fx, frame.aspect, frame.x, frame.y].map(digits).join(",");
}

// null unless it is one; without the rest of the frame it is that of `home`, centred.
export function viewFromText(text, home)
{
    const n = text.split(",").map(Number), [fy, ...rest] = n.slice(PLACE_NUMBERS - 1);
    if (!n.every(Number.isFinite) || !(fy > 0.05 && fy < 50) || (rest.length !== 0 && rest.length !== 4))
        return null;
    const [fx, aspect, x, y] = rest.length ? rest : [fy, home.frame.aspect, 0, 0];
    if (!(fx > 0.05 && fx < 50 && aspect > 0.1 && aspect < 10 && Math.abs(x) < 2 && Math.abs(y) < 2))
        return null;
    const q = n.slice(3, 7), size = Math.hypot(...q);
    if (!(size > 0.1))
        return null;
    return {eye: n.slice(0, 3), r: rotationFromQuat(q.map(x => x / size)), frame: {aspect, fx, fy, x, y}};
}
