// A path of the camera through keyframes: recorded, edited, played.
import {durationOf, secondsFrom, viewAt} from "./keyframes.js";
import {clamp} from "./math.js";
import {nerfstudioPath, orielPath, readPath} from "./path_files.js";
import {text} from "./strings.js";
import {byId, button, make, save} from "./ui.js";
import {viewFromKey, viewToKey} from "./view.js";

export class PathEditor {
    // tour: the maker's path, undefined: none; onTour(view): while a path plays, null at its end
    // render(path, format): asks the server for it, keep(path): makes it the visitors' tour, undefined:
    // none; null: there is no server
    constructor(navigator, {name, tour, onTour, render, keep})
    {
        const t = text.path;
        Object.assign(this, {navigator, onTour, plays: false});
        this.keys = [];         // views, some with seconds to the next one
        this.element = byId("path");
        this.element.ariaLabel = text.path.title;
        this.list = make("ol");
        this.seconds = make("input", {type: "number", min: 0.5, max: 3600, step: 0.5, value: 0,
                                      onchange: () => this.setDuration(Number(this.seconds.value))});
        this.scrubber = make("input", {type: "range", min: 0, max: 1, step: 0.001, value: 0, ariaLabel: text.path.scrub,
                                       oninput: () => this.show(Number(this.scrubber.value))});
        this.playing = button(text.path.play, () => this.play());
        this.said = make("p", {role: "status"});
        this.saving = [
            button(t.saveOriel, () => save(`${name()}.path.json`, orielPath(this.keys, this.duration))),
            button(t.saveNerfstudio,
                   () => save(`${name()}.camera_path.json`, nerfstudioPath(this.keys, this.duration)))];
        this.element.append(
            make("h2", {textContent: t.title}), button(t.add, () => this.add()), ...this.loading(), this.list,
            make("p", {className: "small", textContent: t.columns}),
            make("label", {}, t.seconds, this.seconds), this.scrubber, this.playing, ...this.saving);
        if (render)
            this.addRendering(render);
        if (keep)
            this.element.append(make("div", {className: "row"}, button(t.forVisitors, () =>
                keep(this.keys.length > 1 ? orielPath(this.keys, this.duration) : undefined))));
        this.element.append(this.said);
        if (tour) {
            this.load(t.title, JSON.stringify(tour));
            this.said.textContent = ""; // nobody has asked for it
        }
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

    // A button that asks for a file, whose path takes the place of this one.
    loading()
    {
        const onchange = async () => {
            const [chosen] = file.files;
            if (chosen)
                this.load(chosen.name, await chosen.text());
            file.value = ""; // the same file may be chosen again
        };
        const file = make("input", {type: "file", accept: ".json,application/json", hidden: true, onchange});
        return [button(text.path.load, () => file.click()), file];
    }

    // A path that cannot be read leaves the one that is there.
    load(name, content)
    {
        try {
            this.keys = readPath(content, this.navigator.photos, this.navigator.home.frame);
            this.said.textContent = text.path.loaded(name, this.keys.length);
        } catch (error) {
            this.said.textContent = text.path.notLoaded(name, error.message);
        }
        this.fill();
    }

    addRendering(render)
    {
        this.format = make("select", {ariaLabel: text.path.format},
                           ...["mp4", "png", "exr"].map(f => make("option", {textContent: f})));
        this.bar = make("progress", {max: 1, value: 0, hidden: true, ariaLabel: text.path.rendering});
        this.start = button(text.path.render,
                            () => render(orielPath(this.keys, this.duration), this.format.value));
        this.saving.push(this.start);
        this.element.append(make("div", {className: "row"}, this.format, this.start), this.bar);
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
        this.change(keys => keys.push(this.navigator.view));
    }

    change(what)
    {
        this.said.textContent = ""; // of a path that was another one
        what(this.keys);
        this.fill();
    }

    fill()
    {
        const many = this.keys.length > 1;
        this.list.replaceChildren(...this.keys.map((key, i) => this.row(key, i)));
        this.seconds.value = Number(durationOf(this.keys).toFixed(2));
        for (const element of this.saving)
            element.disabled = this.keys.length === 0;
        this.playing.disabled = this.scrubber.disabled = this.seconds.disabled = !many;
    }

    row(key, i)
    {
        const t = text.path, last = i === this.keys.length - 1;
        const number = (label, more, edit) => make("input", {
            type: "number", ariaLabel: label, title: label, ...more,
            onchange: event => this.change(keys => keys[i] = edit(Number(event.target.value)))});
        const degrees = {min: 5, max: 150, step: 1, value: viewToKey(key).fov_y_deg.toFixed(0)};
        const fov = number(t.fov(i + 1), degrees, value =>
            ({...(viewFromKey({...viewToKey(key), fov_y_deg: value}, key.frame) || key), seconds: key.seconds}));
        const times = {min: 0.1, max: 3600, step: 0.1, value: Number(secondsFrom(key).toFixed(2))};
        const seconds = number(t.speed(i + 1), {...times, className: "seconds", disabled: last}, value =>
            ({...key, seconds: clamp(value || 0, 0.1, 3600)}));
        const small = (sign, label, run, disabled = false) => button(sign, run, {ariaLabel: label, title: label, disabled});
        const swap = by => () => this.change(keys => [keys[i], keys[i + by]] = [keys[i + by], keys[i]]);
        return make("li", {className: "row"},
                    button(t.key(i + 1), () => this.navigator.flyTo(this.keys[i])), fov, seconds,
                    small("⟲", t.replace(i + 1), () => this.change(keys => {
                        keys[i] = {...this.navigator.view, seconds: key.seconds};
                    })),
                    small("↑", t.up(i + 1), swap(-1), i === 0),
                    small("↓", t.down(i + 1), swap(1), last),
                    small("✕", t.remove(i + 1), () => this.change(keys => keys.splice(i, 1))));
    }

    // --- playing ---

    show(share)
    {
        const view = viewAt(this.keys, share);
        this.navigator.setView(view);
        if (this.plays)
            this.onTour(view);
    }

    stopPlaying()
    {
        cancelAnimationFrame(this.next);
        this.plays = false;
        this.playing.textContent = text.path.play;
        this.onTour(null);
    }

    // From where the slider is, or from the start. A second time: pauses.
    play()
    {
        if (this.plays) {
            this.stopPlaying();
            return;
        }
        this.plays = true;
        this.playing.textContent = text.path.pause;
        const start = performance.now(), ms = 1000 * this.duration, from = Number(this.scrubber.value);
        const step = now => {
            const share = clamp((now - start) / ms + (from < 1 ? from : 0), 0, 1);
            const goes = this.keys.length > 1 && !this.navigator.flying;
            if (goes) {
                this.scrubber.value = share;
                this.show(share);
            }
            if (goes && share < 1)
                this.next = requestAnimationFrame(step);
            else
                this.stopPlaying();
        };
        this.next = requestAnimationFrame(step);
    }
}
