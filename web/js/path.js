// A path of the camera through keyframes: recorded, edited, played, saved.
import {mix, quatFromRotation, rotationFromQuat, slerp} from "oriel/math.js";
import {text} from "oriel/strings.js";
import {byId, button, make, save} from "oriel/ui.js";
import {viewFromKey, viewToKey} from "oriel/view.js";

const FPS = 24;
const SECONDS_A_KEY = 3; // from a keyframe to the next, until somebody sets another time
const SIZE = [1280, 720]; // of a video

const secondsFrom = key => key.seconds || SECONDS_A_KEY;

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
    const key = n => keys[Math.min(Math.max(n, 0), keys.length - 1)], a = key(i), b = key(i + 1);
    const eye = [0, 1, 2].map(k => spline(key(i - 1).eye[k], a.eye[k], b.eye[k], key(i + 2).eye[k], times, t));
    const frame = {};
    for (const name of Object.keys(a.frame))
        frame[name] = mix(a.frame[name], b.frame[name], t);
    for (const name of ["fx", "fy"]) // as orl_view_interpolate
        frame[name] = a.frame[name] ** (1 - t) * b.frame[name] ** t;
    return {eye, frame, r: rotationFromQuat(slerp(quatFromRotation(a.r), quatFromRotation(b.r), t))};
}

// The file that `oriel render --path` reads.
export function orielPath(keys, seconds)
{
    const frames = Math.max(Math.round(seconds * FPS) + 1, 2);
    return {...(keys.length > 1 ? {frames} : {}),
            keyframes: keys.map(key => ({...viewToKey(key), seconds: secondsFrom(key)}))};
}

// nerfstudio's camera_path.json: every frame, axes as in OpenGL, row by row.
export function nerfstudioPath(keys, seconds)
{
    const count = keys.length > 1 ? Math.max(Math.round(seconds * FPS) + 1, 2) : 1;
    const views = [...Array(count).keys()].map(i => count > 1 ? viewAt(keys, i / (count - 1)) : keys[0]);
    return {
        camera_type: "perspective", render_width: SIZE[0], render_height: SIZE[1], fps: FPS, seconds,
        camera_path: views.map(({r, eye, frame}) => ({
            camera_to_world: [0, 1, 2].flatMap(k => [r[k], -r[3 + k], -r[6 + k], eye[k]]).concat(0, 0, 0, 1),
            fov: viewToKey({r, eye, frame}).fov_y_deg, aspect: SIZE[0] / SIZE[1],
        })),
    };
}

export class PathEditor {
    // render(path, format): asks the server for it; null: there is no server
    constructor(navigator, {wake, name, render})
    {
        this.navigator = navigator;
        this.wake = wake;
        this.name = name;
        this.keys = [];         // views, some with seconds to the next one
        this.element = byId("path");
        this.element.setAttribute("aria-label", text.path.title);
        this.list = make("ol");
        this.seconds = make("input", {type: "number", min: 0.5, max: 3600, step: 0.5, value: 0});
        this.seconds.addEventListener("change", () => this.setDuration(Number(this.seconds.value)));
        this.scrubber = make("input", {type: "range", min: 0, max: 1, step: 0.001, value: 0});
        this.scrubber.setAttribute("aria-label", text.path.scrub);
        this.scrubber.addEventListener("input", () => this.show(Number(this.scrubber.value)));
        this.playing = button(text.path.play, () => this.play());
        this.element.append(
            make("h2", {textContent: text.path.title}), button(text.path.add, () => this.add()), this.list,
            make("p", {className: "small", textContent: text.path.columns}),
            make("label", {}, text.path.seconds, this.seconds), this.scrubber, this.playing,
            button(text.path.saveOriel, () => save(`${name()}.path.json`, orielPath(this.keys, this.duration))),
            button(text.path.saveNerfstudio,
                   () => save(`${name()}.camera_path.json`, nerfstudioPath(this.keys, this.duration))));
        if (render)
            this.addRendering(render);
        this.fill();
    }

    get duration() { return Math.max(durationOf(this.keys), 0.5); }

    // Each part takes the share of it that it took before.
    setDuration(seconds)
    {
        const factor = seconds / durationOf(this.keys);
        if (factor > 0)
            this.keys = this.keys.map(key => ({...key, seconds: secondsFrom(key) * factor}));
        this.fill();
    }

    addRendering(render)
    {
        this.format = make("select", {}, ...["mp4", "png", "exr"].map(f => make("option", {textContent: f})));
        this.format.setAttribute("aria-label", text.path.format);
        this.bar = make("progress", {max: 1, value: 0, hidden: true});
        this.bar.setAttribute("aria-label", text.path.rendering);
        this.said = make("p", {role: "status"});
        this.start = button(text.path.render,
                            () => render(orielPath(this.keys, this.duration), this.format.value));
        this.element.append(make("div", {className: "row"}, this.format, this.start), this.bar, this.said);
    }

    // Of the server: {done, total, file, problem}
    showRendering({done, total, file, problem})
    {
        this.bar.hidden = done >= total || Boolean(problem);
        this.bar.value = total ? done / total : 0;
        this.said.textContent = problem ? text.path.failed(problem)
                                : done < total ? text.path.rendered(done, total) : text.path.written(file);
    }

    // --- keyframes ---

    add()
    {
        this.keys.push(this.navigator.view);
        this.fill();
    }

    change(what)
    {
        what(this.keys);
        this.fill();
        this.wake();
    }

    fill()
    {
        const many = this.keys.length > 1;
        this.list.replaceChildren(...this.keys.map((key, i) => this.row(key, i)));
        this.seconds.value = Number(durationOf(this.keys).toFixed(2));
        for (const element of this.element.querySelectorAll(":scope > button:not(:first-of-type), :scope > .row button"))
            element.disabled = this.keys.length === 0;
        this.playing.disabled = this.scrubber.disabled = this.seconds.disabled = !many;
    }

    row(key, i)
    {
        const t = text.path, fov = make("input", {type: "number", min: 5, max: 150, step: 1,
                                                  value: viewToKey(key).fov_y_deg.toFixed(0)});
        fov.setAttribute("aria-label", t.fov(i + 1));
        fov.title = t.fov(i + 1);
        fov.addEventListener("change", () => this.change(keys => {
            keys[i] = {...(viewFromKey({...viewToKey(key), fov_y_deg: Number(fov.value)}, key.frame) || key),
                       seconds: key.seconds};
        }));
        const seconds = make("input", {type: "number", min: 0.1, max: 3600, step: 0.1, title: t.speed(i + 1),
                                       value: Number(secondsFrom(key).toFixed(2)), className: "seconds"});
        seconds.setAttribute("aria-label", t.speed(i + 1));
        seconds.disabled = i === this.keys.length - 1;
        seconds.addEventListener("change", () => this.change(keys => {
            keys[i] = {...key, seconds: Math.min(Math.max(Number(seconds.value) || 0, 0.1), 3600)};
        }));
        const small = (sign, label, run, off = false) => {
            const b = button(sign, run);
            b.setAttribute("aria-label", label);
            b.title = label;
            b.disabled = off;
            return b;
        };
        const swap = by => () => this.change(keys => [keys[i], keys[i + by]] = [keys[i + by], keys[i]]);
        return make("li", {className: "row"},
                    button(t.key(i + 1), () => {
                        this.navigator.flyTo(this.keys[i]);
                        this.wake();
                    }), fov, seconds,
                    small("⟲", t.replace(i + 1), () => this.change(keys => {
                        keys[i] = {...this.navigator.view, seconds: key.seconds};
                    })),
                    small("↑", t.up(i + 1), swap(-1), i === 0),
                    small("↓", t.down(i + 1), swap(1), i === this.keys.length - 1),
                    small("✕", t.remove(i + 1), () => this.change(keys => keys.splice(i, 1))));
    }

    // --- playing ---

    show(share)
    {
        this.navigator.setView(viewAt(this.keys, share));
        this.wake();
    }

    play()
    {
        const start = performance.now(), ms = 1000 * this.duration, turn = this.turn = (this.turn || 0) + 1;
        const step = now => {
            const share = Math.min(Math.max((now - start) / ms, 0), 1);
            if (turn !== this.turn || this.keys.length < 2 || this.navigator.flying)
                return;
            this.scrubber.value = share;
            this.show(share);
            if (share < 1)
                requestAnimationFrame(step);
        };
        requestAnimationFrame(step);
    }
}
