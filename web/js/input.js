// Keys, mouse, wheel and fingers, as the navigator understands them.
import {clamp} from "./math.js";

const MOVES = { // right, up, forward
    KeyW: [0, 0, 1], KeyS: [0, 0, -1], KeyA: [-1, 0, 0], KeyD: [1, 0, 0], KeyQ: [0, -1, 0],
    KeyE: [0, 1, 0], ArrowUp: [0, 0, 1], ArrowDown: [0, 0, -1], ArrowLeft: [-1, 0, 0],
    ArrowRight: [1, 0, 0],
};
const TURNS = {ArrowUp: [0, 1], ArrowDown: [0, -1], ArrowLeft: [-1, 0], ArrowRight: [1, 0]};
const DEAD = 0.15;          // of a stick's way, which means nothing
const PAD_EVERY = 100;      // milliseconds between two looks at a gamepad at rest
const WHEEL_STEP = 0.0004;  // of the scene's distance, per pixel of the wheel
const FINGER_STEP = 0.0015; // the same per pixel of two fingers
const TAP_MS = 300, TAP_PX = 6; // longer, or farther, is a drag
const TWICE_MS = 400, TWICE_PX = 30; // between two taps that are one double tap
const OWN_KEYS = ["range", "radio", "checkbox", "file"]; // inputs that no letters are typed into

// The key as its layout has it; of a layout without Latin letters, as its place has it elsewhere.
function keyOf(event)
{
    const key = event.key.toLowerCase(), [, letter] = /^Key([A-Z])$/.exec(event.code) || [];
    if (key.length !== 1 || key < "\x7f")
        return key;
    return letter ? letter.toLowerCase() : {Comma: ",", Period: "."}[event.code] || key;
}

export class Input {
    // focal(): of the camera, CSS pixels; actions: by key; holdsWheel(): is the wheel the walk's? If not,
    // onWheelLeft(). onTap(x, y), onTwice(x, y): one and two short touches of a place
    constructor(canvas, navigator, {focal, actions, wake, holdsWheel, onWheelLeft, onTap, onTwice})
    {
        Object.assign(this, {canvas, navigator, focal, actions, wake, holdsWheel, onWheelLeft, onTap, onTwice});
        this.pressed = new Set();
        this.tapped = new Set(); // since the last frame: a short touch of a key counts too
        this.fast = false;
        this.pointers = new Map();
        window.addEventListener("keydown", event => this.keyDown(event));
        window.addEventListener("keyup", event => this.keyUp(event));
        for (const kind of ["blur", "visibilitychange"])
            window.addEventListener(kind, () => this.pressed.clear(), true);
        canvas.addEventListener("pointerdown", event => this.pointerDown(event));
        canvas.addEventListener("pointermove", event => this.pointerMove(event));
        canvas.addEventListener("pointerup", event => this.pointerUp(event));
        canvas.addEventListener("pointercancel", event => this.pointers.delete(event.pointerId));
        canvas.addEventListener("wheel", event => this.wheel(event), {passive: false});
        for (const kind of ["gesturestart", "gesturechange"]) // of Safari on a Mac, which has no wheel for it
            canvas.addEventListener(kind, event => this.pinch(event));
        canvas.addEventListener("contextmenu", event => event.preventDefault());
        window.addEventListener("gamepadconnected", () => this.watchPads());
    }

    // --- gamepads, which have no events of their sticks ---

    watchPads()
    {
        this.watching = this.watching || setInterval(() => {
            if (Object.values(this.pads()).flat().some(x => x !== 0))
                this.wake();
        }, PAD_EVERY);
    }

    // {keys, turn} of all gamepads: the left stick moves, the right one looks, triggers lift and lower.
    pads()
    {
        const live = x => Math.abs(x) > DEAD ? x : 0, keys = [0, 0, 0], turn = [0, 0];
        for (const pad of this.watching ? navigator.getGamepads() : []) {
            if (!pad || pad.axes.length < 4)
                continue;
            const [x, y, turnX, turnY] = pad.axes.map(live), lift = i => pad.buttons[i] ? pad.buttons[i].value : 0;
            [x, lift(7) - lift(6), -y].forEach((v, k) => keys[k] += v);
            [turnX, -turnY].forEach((v, k) => turn[k] += v);
        }
        return {keys, turn};
    }

    get dragging() { return this.pointers.size > 0; }

    // --- keys ---

    // Fields keep what is typed into them, sliders and the like the keys that set them.
    taken({target, key, ctrlKey, metaKey, altKey})
    {
        const control = target.closest("input, select, textarea, button");
        if (ctrlKey || metaKey || altKey || target.closest("dialog[open]"))
            return true;
        if (!control || key === "Escape")
            return false;
        if (control.tagName === "BUTTON")
            return key === "Enter" || key === " ";
        return !OWN_KEYS.includes(control.type) || key.length > 1 || key === " ";
    }

    keyDown(event)
    {
        if (event.key === "Meta") // a Mac tells of no other key that is let go of before this one
            this.pressed.clear();
        if (this.taken(event))
            return;
        this.fast = event.shiftKey;
        if (event.code in MOVES) {
            this.pressed.add(event.code);
            this.tapped.add(event.code);
            event.preventDefault();
            this.wake();
            return;
        }
        // French and Czech keyboards have digits with shift alone.
        const action = this.actions.get(keyOf(event)) || this.actions.get(event.code.replace("Digit", ""));
        if (action && !event.repeat) {
            event.preventDefault();
            action();
            this.wake();
        }
    }

    keyUp(event)
    {
        this.fast = event.shiftKey;
        this.pressed.delete(event.code);
    }

    // {keys, turn, fast} for Navigator.update.
    state()
    {
        const keys = [0, 0, 0], turn = [0, 0];
        const codes = new Set([...this.pressed, ...this.tapped]);
        this.tapped.clear();
        for (const code of codes) {
            if (this.fast && code in TURNS)
                TURNS[code].forEach((x, k) => turn[k] += x);
            else
                MOVES[code].forEach((x, k) => keys[k] += x);
        }
        const pads = this.pads(), both = (own, pad) => own.map((x, k) => clamp(Math.sign(x) + pad[k], -1, 1));
        return {keys: both(keys, pads.keys), turn: both(turn, pads.turn), fast: this.fast};
    }

    // --- pointers ---

    pointerDown(event)
    {
        this.canvas.focus({preventScroll: true});
        this.canvas.setPointerCapture(event.pointerId);
        this.pointers.set(event.pointerId, [event.clientX, event.clientY]);
        this.down = this.pointers.size === 1 && event.button === 0
            ? {at: [event.clientX, event.clientY], time: event.timeStamp} : null;
        this.wake();
    }

    pointerUp(event)
    {
        const at = [event.clientX, event.clientY], {down, last} = this, far = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1]);
        this.pointers.delete(event.pointerId);
        this.wake();
        this.down = this.last = null;
        if (!down || event.timeStamp - down.time > TAP_MS || far(at, down.at) > TAP_PX)
            return;
        if (last && down.time - last.time < TWICE_MS && far(at, last.at) < TWICE_PX) {
            this.onTwice(...at);
        } else {
            this.last = {at, time: event.timeStamp};
            this.onTap(...at);
        }
    }

    pointerMove(event)
    {
        const before = this.pointers.get(event.pointerId);
        if (!before)
            return;
        const now = [event.clientX, event.clientY];
        if (this.pointers.size === 1 && !(event.buttons & 6)) {
            this.navigator.drag(now[0] - before[0], now[1] - before[1], this.focal());
        } else if (this.pointers.size === 1) { // another button slides
            this.slide(now[0] - before[0], now[1] - before[1], 0);
        } else if (this.pointers.size === 2) {
            const other = [...this.pointers].find(([id]) => id !== event.pointerId)[1];
            const apart = p => Math.hypot(p[0] - other[0], p[1] - other[1]);
            this.slide((now[0] - before[0]) / 2, (now[1] - before[1]) / 2, apart(now) - apart(before));
        }
        this.pointers.set(event.pointerId, now);
    }

    // The scene follows the fingers: pixels sideways, along the picture, and apart. Upwards moves
    // forwards where one walks.
    slide(dx, dy, pinch)
    {
        const s = FINGER_STEP, walks = this.navigator.mode === "walk";
        this.navigator.step(-dx * s, walks ? 0 : dy * s, pinch * s + (walks ? dy * s : 0));
    }

    // Of a trackpad. Fingers on a screen are pointers too.
    pinch(event)
    {
        event.preventDefault();
        if (event.type === "gesturechange" && !this.dragging)
            this.navigator.zoom(event.scale / this.pinched);
        this.pinched = event.scale;
    }

    wheel(event)
    {
        if (!this.holdsWheel()) {
            this.onWheelLeft();
            return;
        }
        event.preventDefault();
        const pixels = event.deltaY * [1, 30, 300][event.deltaMode];
        if (event.ctrlKey)
            this.navigator.zoom(Math.exp(-pixels / 300));
        else
            this.navigator.step(0, 0, -pixels * WHEEL_STEP);
    }
}
