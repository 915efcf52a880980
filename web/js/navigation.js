// Where the viewer is and how they get on: walk, fly, orbit, and flights from place to place.
import {across, add, clamp, distance, dot, length, mix, multiply, normalize, rotate, rotateBack, rotation,
        scale, sub} from "./math.js";
import {nearestPhoto} from "./photos.js";
import {forwardOf, levelAxes, mixViews, photoView, rightOf, upOf, viewFromSaved} from "./view.js";

const SPEED = 0.35;          // of the scene's distance, a second
const FASTER = 3;
const TURN_SPEED = 1.2;      // radians a second
const SETTLE = 0.12;         // seconds in which speed follows the keys
const FLIGHT_MIN = 0.5, FLIGHT_MAX = 1.8; // seconds
const PITCH_MAX = 1.45;     // radians from the horizon
const NEAR = 0.35;           // of the way to a point that is left when one goes there
const UNDERFOOT = 0.3;       // of the eye's height: no more above the ground is the ground
const ROOM = 0.3;            // of the scene's distance, around photographs, that is free to walk
const ASKED = 300;           // photographs, at most, that tell how far apart they are
const HINT_FROM = 0.6;       // share of the way to the border of that
export const MODES = ["walk", "fly", "orbit"];

const smooth = t => t * t * (3 - 2 * t);

function median(values)
{
    const sorted = [...values].sort((a, b) => a - b);
    return sorted[sorted.length >> 1] || 0;
}

export class Navigator {
    // calm: no flights, no gliding; pivotAt: () => the point in the middle of the picture, or null
    constructor(manifest, photos, {calm, pivotAt})
    {
        const {ground, distance: typical} = manifest;
        Object.assign(this, {photos, ground, calm, pivotAt, distance: typical, up: normalize(manifest.up)});
        this.wake = () => {}; // told that the view changes, or will
        const first = photoView(photos[manifest.start]), settings = manifest.walk;
        const start = settings.start ? viewFromSaved(settings.start, first) : null;
        this.home = start || first;
        this.homePhoto = start ? null : photos[manifest.start];
        this.modes = MODES.filter(mode => !settings.modes || settings.modes.includes(mode));
        this.mode = this.homeMode = this.modes[0];
        this.speed = [0, 0, 0]; // right, up, forward
        this.flight = null;
        this.pivot = null; // of mode "orbit"; null: not chosen yet
        const some = photos.filter((p, i) => i % Math.ceil(photos.length / ASKED) === 0); // whose neighbours are looked for
        const apart = some.map(p => photos.reduce((least, q) => q === p ? least : Math.min(least, distance(p.eye, q.eye)),
                                                  Infinity));
        this.room = Math.max(ROOM * this.distance, 2 * median(apart.filter(Number.isFinite)));
        this.setView(this.home, this.homePhoto);
    }

    // photo: the one whose view this is, if any
    setView(view, photo = null)
    {
        this.view = view;
        this.at = photo;
        this.changed = true;
        this.wake();
    }

    setMode(mode)
    {
        this.wake();
        this.mode = mode;
        this.pivot = null;
    }

    // What the view turns around, chosen when it is first needed: by then the picture shows the view.
    choosePivot()
    {
        this.pivot ||= this.pivotAt() || add(this.view.eye, scale(forwardOf(this.view), this.distance));
        return this.pivot;
    }

    get flying() { return this.flight !== null; }

    // --- turning ---

    // Radians: to the right, upwards.
    turn(yaw, pitch)
    {
        this.flight = null;
        const {view, up} = this;
        const height = Math.asin(clamp(dot(forwardOf(view), up), -1, 1));
        const least = Math.min(-PITCH_MAX, height), most = Math.max(PITCH_MAX, height);
        pitch = clamp(height + pitch, least, most) - height;
        // New rows are the old ones turned in the world: r' = r * turn^-1.
        const yawed = multiply(view.r, rotation(up, yaw));
        const r = multiply(rotation([1, 0, 0], -pitch), yawed);
        if (this.mode === "orbit") {
            const pivot = this.choosePivot(), offset = rotate(view.r, sub(view.eye, pivot));
            this.setView({...view, r, eye: add(pivot, rotateBack(r, offset))});
        } else {
            this.setView({...view, r});
        }
    }

    // Drag by pixels; focal: the camera's, in the same pixels.
    drag(dx, dy, focal)
    {
        const turns = this.mode === "orbit" ? -2 : 1;
        this.turn(-Math.atan(dx / focal) * turns, Math.atan(dy / focal) * turns);
    }

    zoom(factor)
    {
        const f = this.view.frame, fy = clamp(f.fy * factor, 0.3, 10), s = fy / f.fy;
        this.setView({...this.view, frame: {...f, fx: f.fx * s, fy}});
    }

    // --- moving ---

    // By a share of the scene's distance: right, up, forward.
    step(right, up, forward)
    {
        this.flight = null;
        this.shift([right, up, forward].map(x => x * this.distance));
    }

    // Directions of the keys in the world.
    axes()
    {
        if (this.mode === "walk")
            return levelAxes(this.view, this.up);
        return [rightOf(this.view), this.mode === "fly" ? this.up : upOf(this.view), forwardOf(this.view)];
    }

    shift(by)
    {
        const axes = this.axes(), {view} = this;
        let way = [0, 1, 2].reduce((sum, k) => add(sum, scale(axes[k], by[k])), [0, 0, 0]);
        if (length(way) === 0)
            return;
        if (this.mode === "walk")
            way = this.held(way);
        let eye = add(view.eye, way);
        if (this.mode === "orbit" && by[2] !== 0 && by[0] === 0 && by[1] === 0) {
            const from = sub(view.eye, this.choosePivot()); // never through the pivot
            const factor = Math.exp(-by[2] / Math.max(length(from), 1e-9));
            eye = add(this.pivot, scale(from, clamp(factor, 0.2, 5)));
        } else if (this.mode === "orbit") {
            this.pivot = add(this.choosePivot(), way);
        }
        this.setView({...view, eye});
    }

    // Distance along the ground to the nearest photograph.
    apart(eye)
    {
        return Math.min(...this.photos.map(p => length(across(sub(eye, p.eye), this.up))));
    }

    // Of the room around photographs: 0 among them, 1 at its border.
    get outness() { return this.apart(this.view.eye) / this.room; }
    get farOut() { return this.outness > HINT_FROM; }

    // A step of the walker: softer and softer towards the border, free on the way back.
    held(way)
    {
        const {eye} = this.view, now = this.apart(eye), then = this.apart(add(eye, way));
        if (then <= now)
            return way;
        const left = clamp((1 - now / this.room) / (1 - HINT_FROM), 0, 1);
        return scale(way, left);
    }

    // Eye height above the plane through the origin along `up` that the walker comes to rest at.
    eyeHeight()
    {
        const {eye} = this.view;
        if (this.ground)
            return this.ground.height - this.ground.plane[3];
        let sum = 0, total = 0;
        for (const p of this.photos) {
            const weight = 1 / (distance(p.eye, eye) ** 2 + (0.02 * this.distance) ** 2);
            sum += weight * dot(p.eye, this.up);
            total += weight;
        }
        return sum / total;
    }

    // keys: right, up, forward in [-1, 1]; turn: yaw, pitch in [-1, 1]. True while anything moves.
    update(seconds, keys, turn, fast)
    {
        if (this.flight)
            return this.fly(seconds);
        const wanted = keys.map(k => k * SPEED * this.distance * (fast ? FASTER : 1));
        const follow = this.calm ? 1 : 1 - Math.exp(-seconds / SETTLE);
        this.speed = this.speed.map((s, k) => mix(s, wanted[k], follow));
        if (length(this.speed) < 1e-3 * this.distance)
            this.speed = [0, 0, 0];
        const moves = length(this.speed) > 0;
        if (moves)
            this.shift(this.speed.map(s => s * seconds));
        if (moves && this.mode === "walk")
            this.settle(seconds);
        if (turn[0] || turn[1])
            this.turn(turn[0] * TURN_SPEED * seconds, turn[1] * TURN_SPEED * seconds);
        return moves || turn[0] !== 0 || turn[1] !== 0;
    }

    // While walking the eye comes to its height above the ground.
    settle(seconds)
    {
        const {view, up} = this, off = this.eyeHeight() - dot(view.eye, up);
        this.setView({...view, eye: add(view.eye, scale(up, off * (1 - Math.exp(-3 * seconds))))});
    }

    // --- flights ---

    flyTo(view, photo = null)
    {
        this.speed = [0, 0, 0];
        const angle = Math.acos(clamp(dot(forwardOf(view), forwardOf(this.view)), -1, 1));
        const far = distance(view.eye, this.view.eye) / this.distance;
        const seconds = clamp(0.4 + 0.5 * angle + 0.8 * far, FLIGHT_MIN, FLIGHT_MAX);
        this.flight = this.calm ? null : {from: this.view, to: view, photo, seconds, passed: 0};
        if (this.calm)
            this.setView(view, photo);
        this.wake();
        if (this.mode === "orbit") // another place has another middle
            this.setMode(this.modes.find(mode => mode !== "orbit") || "orbit");
    }

    fly(seconds)
    {
        const f = this.flight;
        f.passed += seconds;
        const t = Math.min(f.passed / f.seconds, 1);
        if (t < 1) {
            this.setView(mixViews(f.from, f.to, smooth(t)));
        } else {
            this.flight = null;
            this.setView(f.to, f.photo);
        }
        return true;
    }

    // To a point that is seen: onto the ground, or near anything else.
    approach(point)
    {
        const {view, up, ground} = this, walks = this.mode === "walk", to = sub(point, view.eye);
        const underfoot = walks && ground && dot(point, up) + ground.plane[3] < UNDERFOOT * ground.height;
        let way = scale(walks ? across(to, up) : to, underfoot ? 1 : 1 - NEAR); // walkers keep the eye's height
        for (let i = 0; i < 20 && walks && this.apart(add(view.eye, way)) > this.room; i++)
            way = scale(way, 0.8);
        this.flyTo({...view, eye: add(view.eye, way)});
    }

    goTo(photo) { this.flyTo(photoView(photo), photo); }
    goHome() { this.flyTo(this.home, this.homePhoto); }
    snap() { this.goTo(nearestPhoto(this.photos, this.view)); }

    // The photograph that is `by` further on, from the one that the viewer is at or flies to.
    browse(by)
    {
        const from = this.flight && this.flight.photo || this.at;
        if (!from)
            return this.snap();
        const n = this.photos.length;
        this.goTo(this.photos[((from.number + by) % n + n) % n]);
    }
}
