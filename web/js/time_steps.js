// The time of a sequence: which time step shows, and the bar that plays it.
import {text} from "./strings.js";
import {button, make} from "./ui.js";

const RATE = 25; // time steps a second at normal speed
const SPEEDS = [0.25, 0.5, 1, 2];

export class TimeSteps {
    // onChange(): another time step is to be shown.
    constructor(count, bar, onChange)
    {
        Object.assign(this, {count, onChange, timeStep: 0, playing: false, loops: true, speed: 1});
        const t = text.timeSteps;
        this.button = button("", () => this.toggle());
        this.slider = make("input", {type: "range", min: 0, max: count - 1, step: 1, value: 0, title: t.slider,
                                     oninput: () => this.show(Number(this.slider.value))});
        this.place = make("output");
        const speed = make("select", {title: t.speed, onchange: () => {
            this.speed = Number(speed.value);
            this.restart();
        }}, ...SPEEDS.map(value => make("option", {value, textContent: `${value}\u00d7`, selected: value === 1})));
        const loop = make("input", {type: "checkbox", checked: true, onchange: () => {
            this.loops = loop.checked;
            this.restart(); // or the rounds that have passed would count, and end it at once
        }});
        bar.append(this.button, button("\u2039", () => this.show(this.timeStep - 1), {title: t.back}),
                   button("\u203a", () => this.show(this.timeStep + 1), {title: t.forth}), this.slider,
                   this.place, speed, make("label", {}, loop, t.loop));
        bar.hidden = false;
        this.tell();
    }

    toggle()
    {
        this.playing = !this.playing;
        if (this.playing && !this.loops && this.timeStep === this.count - 1)
            this.timeStep = 0;
        this.restart();
        this.tell();
        this.onChange();
    }

    // One time step, at rest.
    show(timeStep)
    {
        this.playing = false;
        this.timeStep = (timeStep + this.count) % this.count;
        this.tell();
        this.onChange();
    }

    restart()
    {
        this.from = this.timeStep;
        this.since = performance.now();
    }

    tell()
    {
        this.button.textContent = this.playing ? "\u275a\u275a" : "\u25b6";
        this.button.title = this.playing ? text.timeSteps.pause : text.timeSteps.play;
        this.slider.value = this.timeStep;
        this.place.textContent = text.timeSteps.place(this.timeStep + 1, this.count);
    }

    // While it plays: lets time run to now. Time steps that a slow picture has no time for are left out.
    advance()
    {
        const at = this.from + Math.floor((performance.now() - this.since) / 1000 * RATE * this.speed);
        this.timeStep = this.loops ? at % this.count : Math.min(at, this.count - 1);
        this.playing = this.loops || this.timeStep < this.count - 1;
        this.tell();
    }

    // The time step that shows, and the one that the picture after next will show if each takes so long.
    get pair()
    {
        const ahead = this.playing ? Math.max(1, Math.round(this.step || 1)) : 0;
        const next = this.timeStep + ahead;
        return [this.timeStep, this.loops ? next % this.count : Math.min(next, this.count - 1)];
    }

    // Says how long a picture took, milliseconds.
    measured(took)
    {
        const step = took / 1000 * RATE * this.speed;
        this.step = this.step ? this.step + 0.3 * (step - this.step) : step;
    }
}
