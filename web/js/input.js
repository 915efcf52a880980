// Keys, mouse, wheel and fingers, as the navigator understands them.
import {clamp} from "oriel/math.js";

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

export class Input {
    // focal(): of the camera, CSS pixels; actions: by key
    constructor(canvas, navigator, {focal, actions, wake})
    {
        this.navigator = navigator;
        this.canvas = canvas;
        this.focal = focal;
        this.actions = actions;
        this.wake = wake;
        this.pressed = new Set();
        this.tapped = new Set(); // since the last frame: a short touch of a key counts too
        this.fast = false;
        this.pointers = new Map();
        window.addEventListener("keydown", event => this.keyDown(event));
        window.addEventListener("keyup", event => this.keyUp(event));
        window.addEventListener("blur", () => this.pressed.clear());
        canvas.addEventListener("pointerdown", event => this.pointerDown(event));
        canvas.addEventListener("pointermove", event => this.pointerMove(event));
        for (const kind of ["pointerup", "pointercancel"])
            canvas.addEventListener(kind, event => this.pointers.delete(event.pointerId));
        canvas.addEventListener("wheel", event => this.wheel(event), {passive: false});
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

    // Sliders and lists keep their own keys.
    taken(event)
    {
        const target = event.target;
        return event.ctrlKey || event.metaKey || event.altKey || target.closest("dialog[open]") ||
               (target.closest("input, select, textarea") !== null && event.key !== "Escape") ||
               (target.closest("button") !== null && (event.key === "Enter" || event.key === " "));
    }

    keyDown(event)
    {
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
        const action = this.actions.get(event.key.toLowerCase());
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
        this.wake();
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
        this.wake();
    }

    // The scene follows the fingers: pixels sideways, along the picture, and apart. Upwards moves
    // forwards where one walks.
    slide(dx, dy, pinch)
    {
        const s = FINGER_STEP, walks = this.navigator.mode === "walk";
        this.navigator.step(-dx * s, walks ? 0 : dy * s, pinch * s + (walks ? dy * s : 0));
    }

    wheel(event)
    {
        event.preventDefault();
        const pixels = event.deltaY * [1, 30, 300][event.deltaMode];
        if (event.ctrlKey)
            this.navigator.zoom(Math.exp(-pixels / 300));
        else
            this.navigator.step(0, 0, -pixels * WHEEL_STEP);
        this.wake();
    }
}
