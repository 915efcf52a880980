// Everything around the picture: tools, panel, photographs, help, comparison.
import {icons} from "./icons.js";
import {text} from "./strings.js";
import {frameHeight, photoView, quartersOf} from "./view.js";

export const byId = id => document.getElementById(id);

// properties: such as ariaLabel, and handlers such as onclick
export function make(tag, properties = {}, ...children)
{
    const element = Object.assign(document.createElement(tag), properties);
    element.append(...children);
    return element;
}

export const button = (textContent, onclick, more = {}) =>
    make("button", {type: "button", textContent, onclick, ...more});

// words: may be undefined
export const paragraphs = words => (words || "").split("\n").map(line => make("p", {textContent: line}));

// Offers a Blob, or a value as JSON, as a file to keep.
export function save(name, what)
{
    const blob = what instanceof Blob ? what
                                      : new Blob([JSON.stringify(what, null, 1)], {type: "application/json"});
    const link = make("a", {href: URL.createObjectURL(blob), download: name});
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

function icon(name)
{
    const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
    const path = document.createElementNS("http://www.w3.org/2000/svg", "path");
    svg.setAttribute("viewBox", "0 0 24 24");
    svg.ariaHidden = true;
    path.setAttribute("d", icons[name]);
    svg.append(path);
    return svg;
}

const BUTTON_MIN = 28, BUTTON_MAX = 42; // CSS pixels

// actions: {id: {run, key, pressed}}; pressed() for those that are on or off. wake(): one has been run
export class Tools {
    constructor(actions, wake)
    {
        const bar = byId("tools");
        bar.ariaLabel = text.toolbar;
        Object.assign(this, {wake, toggles: []});
        for (const [id, action] of Object.entries(actions))
            this.add(id, action);
    }

    add(id, action)
    {
        const label = `${text.actions[id]} (${action.key.toUpperCase()})`;
        const onclick = () => {
            action.run();
            this.wake();
        };
        const button = make("button", {type: "button", title: label, ariaLabel: label, id: `tool-${id}`, onclick}, icon(id));
        byId("tools").append(button);
        if (action.pressed)
            this.toggles.push([button, action.pressed]);
    }

    // In rows of equal length, as few as the window has room for.
    fit()
    {
        const bar = byId("tools"), count = bar.childElementCount;
        const room = window.innerWidth - 30, rows = Math.ceil(count * BUTTON_MIN / room);
        const wide = rows === 1 && count * BUTTON_MAX > room ? 2 : rows;
        bar.style.gridTemplateColumns = `repeat(${Math.ceil(count / wide)}, minmax(0, ${BUTTON_MAX}px))`;
    }

    update()
    {
        for (const [button, pressed] of this.toggles)
            button.ariaPressed = pressed();
    }
}

// --- panel ---

export class Panel {
    // tones: {name, description} of curves; none: there is no choice. onDrawer: null: neither is there
    // of who draws
    constructor({layers, layer, tones, onLayer, onExposure, onTone, onDrawer, onBenchmark})
    {
        this.element = byId("panel");
        this.onLayer = onLayer;
        this.layers = make("fieldset");
        this.setLayers(layers, layer);
        const list = make("dl");
        this.figures = {};
        for (const [id, label] of Object.entries(text.figure)) {
            this.figures[id] = make("dd", {id: `figure-${id}`});
            list.append(make("dt", {textContent: label}), this.figures[id]);
        }
        const stops = make("output", {textContent: text.stops(0)});
        const exposure = make("input", {type: "range", min: -6, max: 6, step: 0.1, value: 0, oninput: () => {
            stops.textContent = text.stops(Number(exposure.value));
            onExposure(Number(exposure.value));
        }});
        const curve = this.curve = make("select", {onchange: () => onTone(curve.value)},
                                        ...tones.map(t => make("option", {textContent: t.name, title: t.description})));
        this.details = make("div");
        this.element.ariaLabel = text.actions.panel;
        this.element.append(this.layers,
                            make("label", {className: "line"}, text.exposure, stops, exposure),
                            ...(tones.length ? [make("label", {className: "line"}, text.tone, curve)] : []),
                            ...(onDrawer ? this.drawers(onDrawer) : []),
                            make("h2", {textContent: text.figures}), list, this.details,
                            this.bench = button(text.benchmark, onBenchmark),
                            make("p", {textContent: text.madeBy}));
    }

    // What can be chosen from, which depends on who draws.
    setLayers(layers, layer)
    {
        this.choices = layers.map((id, i) => make("input", {
            type: "radio", name: "layer", value: id, checked: i === layer, onchange: () => this.onLayer(i)}));
        this.layers.replaceChildren(
            make("legend", {textContent: text.layerLegend}),
            ...this.choices.map((input, i) => make("label", {}, input, text.layers[layers[i]])));
    }

    setLayer(layer) { this.choices[layer].checked = true; }

    drawers(onDrawer)
    {
        const {legend, ...names} = text.drawers;
        this.drawer = Object.fromEntries(Object.keys(names).map((id, i) => [id, make("input", {
            type: "radio", name: "drawer", value: id, checked: i === 0, onchange: () => onDrawer(id)})]));
        this.drawerSaid = make("p", {className: "small", role: "status"});
        return [make("fieldset", {}, make("legend", {textContent: legend}),
                     ...Object.entries(names).map(([id, name]) => make("label", {}, this.drawer[id], name))),
                this.drawerSaid];
    }

    // id: who draws; "" as long as it prepares. The server alone knows tone curves.
    showDrawer(id, said)
    {
        if (id)
            this.drawer[id].checked = true;
        this.curve.disabled = id === "browser";
        this.drawerSaid.textContent = said;
    }

    // details: groups [title, rows of label and value]
    show(figures, details)
    {
        for (const [id, value] of Object.entries(figures))
            this.figures[id].textContent = value;
        this.details.replaceChildren(...details.flatMap(([title, rows]) => [
            make("h2", {textContent: title}),
            make("dl", {}, ...rows.flatMap(([label, value]) => [make("dt", {textContent: label}),
                                                                make("dd", {textContent: value})]))]));
    }
}

// --- photographs ---

export class Thumbs {
    constructor(photos, files, goTo)
    {
        this.element = byId("thumbs");
        this.element.ariaLabel = text.photographs;
        this.buttons = photos.map(photo => {
            const image = make("img", {alt: "", loading: "lazy"});
            const button = make("button", {type: "button", title: photo.name, onclick: () => goTo(photo),
                                           ariaLabel: text.thumb(photo.number + 1, photo.name)}, image);
            button.style.aspectRatio = photoView(photo).frame.aspect;
            return {button, image, photo};
        });
        Object.assign(this, {files, current: null});
        this.element.append(...this.buttons.map(b => b.button));
    }

    async open()
    {
        for (const b of this.buttons)
            if (!b.image.src)
                await showUpright(b.image, b.photo, b.photo.thumb, this.files);
    }

    mark(photo)
    {
        if (photo === this.current)
            return;
        for (const [i, b] of this.buttons.entries())
            b.button.ariaCurrent = photo !== null && i === photo.number;
        this.current = photo;
        if (photo && !this.element.hidden) {
            // The strip alone, not what it stands in.
            const {button} = this.buttons[photo.number], strip = this.element;
            strip.scrollLeft = button.offsetLeft - strip.offsetLeft - (strip.clientWidth - button.offsetWidth) / 2;
        }
    }
}

// --- pictures over the picture ---

// To where the window shows a frame.
export function fit(image, frame, aspect)
{
    const height = frameHeight(frame, window.innerWidth, window.innerHeight);
    Object.assign(image.style, {height: `${height}px`, width: `${height * aspect}px`});
}

// A file of a photograph, whose pixels are as the camera stored them, fills the box around the image, upright.
export async function showUpright(image, photo, {file}, files)
{
    image.awaits = file;
    const src = await files.address(file);
    if (image.awaits !== file)
        return; // another one was asked for meanwhile
    const quarters = quartersOf(photo), widened = quarters % 2 ? photo.width / photo.height : 1;
    Object.assign(image, {src, onload: () => URL.revokeObjectURL(src)});
    Object.assign(image.style, {width: `${100 * widened}%`, height: `${100 / widened}%`,
                                transform: `translate(-50%, -50%) rotate(${90 * quarters}deg)`});
}

const srgbEncode = x => x > 0.0031308 ? 1.055 * x ** (1 / 2.4) - 0.055 : 12.92 * x;

// The photograph that the viewer stands at, over the part of the picture right of a slider.
export class Compare {
    // radiance: as PhotoStore takes it
    constructor(files, radiance)
    {
        Object.assign(this, {files, radiance, on: false, photo: null});
        this.element = byId("compare");
        this.image = this.element.querySelector("img");
        const slider = this.element.querySelector("input");
        slider.ariaLabel = text.compareSlider;
        slider.addEventListener("input", () => this.element.style.setProperty("--share", `${slider.value}vw`));
        byId("left-side").textContent = text.sides.own;
        if (radiance) {
            this.image.style.filter = "url(#shown)";
            this.setExposure(0);
        }
    }

    // Files of radiance are no pictures to look at: a table makes them such.
    setExposure(ev)
    {
        if (!this.radiance)
            return;
        const {peak, mu} = this.radiance, table = [...Array(256).keys()].map(i =>
            srgbEncode(Math.min(2 ** ev * peak * Math.expm1(i / 255 * Math.log1p(mu)) / mu, 1)).toFixed(4));
        for (const channel of byId("shown").firstElementChild.children)
            channel.setAttribute("tableValues", table.join(" "));
    }

    // photo: that the viewer is at; null: none
    update(photo, view)
    {
        const shows = this.on && photo !== null;
        this.element.hidden = !shows;
        if (!shows)
            return;
        if (photo !== this.photo) {
            this.photo = photo;
            byId("right-side").textContent = photo.held_out ? text.sides.heldOut : text.sides.photograph;
            showUpright(this.image, photo, photo.picture, this.files);
        }
        fit(this.image.parentElement, view.frame, view.frame.aspect);
    }
}

// --- words ---

// has(key): is there something that this key does?
export function buildHelp(has)
{
    const dialog = byId("help"), list = make("dl"), title = make("h2", {textContent: text.helpTitle, tabIndex: -1});
    const fingersAlone = matchMedia("(any-pointer: coarse)").matches && !matchMedia("(any-pointer: fine)").matches;
    const works = keys => keys && (!/^[A-Z](, [A-Z])*$/.test(keys) || keys.toLowerCase().split(", ").some(has));
    for (const [keys, what, fingers] of text.help.filter(row => fingersAlone ? row[2] : works(row[0]))) {
        const ways = fingersAlone ? fingers[0].toUpperCase() + fingers.slice(1)
                                  : fingers ? `${keys}, ${text.or} ${fingers}` : keys;
        list.append(make("dt", {textContent: ways}), make("dd", {textContent: what}));
    }
    dialog.ariaLabel = text.helpTitle;
    dialog.append(title, list, make("p", {textContent: text.helpShare}), button(text.close, () => dialog.close()));
    return {
        // The heading takes the focus: the button would scroll the dialog to its end. Browsers refuse
        // the attribute "autofocus" in a page within another one's frame, with a warning.
        show()
        {
            dialog.showModal();
            title.focus();
        },
    };
}

const PASSING_MS = 4000;
let lasting = "", passingEnds = 0; // its timer; 0: the lasting hint shows

export function showHint(message)
{
    const hint = byId("hint");
    lasting = message;
    if (!passingEnds && hint.textContent !== message)
        hint.textContent = message;
}

// For some seconds, in place of the lasting hint.
export function showPassing(message)
{
    byId("hint").textContent = message;
    clearTimeout(passingEnds);
    passingEnds = setTimeout(() => {
        passingEnds = 0;
        showHint(lasting);
    }, PASSING_MS);
}

const PROBLEM_MS = 12000;
let problemEnds = 0;

// stays: the page cannot go on.
export function showProblem(message, stays = false)
{
    byId("problem").textContent = message;
    clearTimeout(problemEnds);
    if (!stays)
        problemEnds = setTimeout(() => byId("problem").textContent = "", PROBLEM_MS);
}

export function showProgress(share)
{
    const bar = byId("progress");
    bar.classList.toggle("done", share >= 1);
    bar.ariaValueNow = Math.round(100 * share);
    bar.ariaLabel = share < 1 ? text.loadingShare(share) : text.loading;
    bar.firstElementChild.style.width = `${100 * share}%`;
}
