// Annotations: marks on surfaces with a title and a text, and the view that shows each best. Their
// maker places them, and says how a walk begins; visitors read them.
import {distance, dot} from "./math.js";
import {MODES} from "./navigation.js";
import {text} from "./strings.js";
import {button, byId, make, paragraphs} from "./ui.js";
import {forwardOf, project, viewFromSaved, viewToSaved} from "./view.js";

const READ_MS = 4000, MS_PER_LETTER = 55; // that a tour stays at an annotation
const NEAR = 0.05, NEAR_COSINE = 0.97;    // of the scene's distance, and of directions: where a path passes

const isNear = (a, b, most) => a !== null && distance(a.eye, b.eye) < most &&
                               dot(forwardOf(a), forwardOf(b)) > NEAR_COSINE;

export class Notes {
    // seen(point): false where a surface is before it; settings: manifest.walk;
    // pick(x, y): a promise of the point under a CSS pixel, null: none;
    // save(settings): a promise of whether they were saved; null: nothing can be changed
    // reveal(): shows the card
    // route: the maker's path as a tour, {plays, play()}; null: a tour goes from annotation to annotation
    constructor(navigator, settings, {canvas, seen, pick, save, wake, reveal, route})
    {
        Object.assign(this, {navigator, canvas, seen, pick, saveAll: save, wake, reveal, route});
        this.near = -1; // annotation that the route passes; -1: none
        this.settings = {...settings, notes: [...(settings.notes || [])]};
        this.layer = byId("marks");
        this.card = byId("note");
        this.card.ariaLabel = text.notes.one;
        this.placing = false;
        this.tour = 0; // its timer; 0: none plays
        if (save)
            this.buildMaker();
        this.fill();
    }

    // --- marks ---

    fill()
    {
        this.marks = this.settings.notes.map((note, i) => {
            const ariaLabel = text.notes.mark(i + 1, note.title);
            return button(String(i + 1), () => this.open(i), {className: "mark", title: note.title, ariaLabel,
                                                              wasBehind: false, hidden: true}); // until update()
        });
        this.layer.replaceChildren(...this.marks);
        if (this.list)
            this.list.replaceChildren(...this.settings.notes.map((note, i) => this.row(note, i)));
        this.wake();
    }

    // camera: of the window, in CSS pixels
    update(camera)
    {
        this.settings.notes.forEach((note, i) => {
            const at = project(camera, note.position), mark = this.marks[i];
            mark.hidden = !at;
            if (!at)
                return;
            mark.style.transform = `translate(${at[0]}px, ${at[1]}px) translate(-50%, -50%)`;
            const behind = this.seen(note.position) === false;
            if (mark.classList.toggle("behind", behind) !== mark.wasBehind)
                mark.ariaLabel = (behind ? text.notes.behind : text.notes.mark)(i + 1, note.title);
            mark.wasBehind = behind;
        });
    }

    get points() { return this.settings.notes.map(note => note.position); }

    open(i, flies = true)
    {
        const t = text.notes, all = this.settings.notes, note = all[i], close = button(text.close, () => this.close());
        const turn = by => {
            this.stopTour();
            this.open((i + by + all.length) % all.length);
        };
        const steps = all.length < 2 ? [] : [
            button(t.previous, () => turn(-1)), button(t.next, () => turn(1)),
            button(this.touring ? t.pause : t.play, () => this.toggleTour(i))];
        this.card.replaceChildren(make("h2", {textContent: note.title}),
                                  ...paragraphs(note.text),
                                  make("div", {className: "row"}, ...steps, close,
                                       make("span", {className: "small", textContent: t.ofAll(i + 1, all.length)})));
        this.reveal();
        const view = note.view && viewFromSaved(note.view, this.navigator.home);
        if (view && flies)
            this.navigator.flyTo(view);
        this.opened = this.marks[i];
        (this.touring && steps.length ? steps[2] : close).focus();
        this.wake();
    }

    // --- a tour: the maker's path, or one annotation after the other ---

    get touring() { return this.route ? this.route.plays : this.tour !== 0; }

    // i: annotation to begin at, or to stay at
    toggleTour(i = 0)
    {
        if (this.touring) {
            this.stopTour();
        } else if (this.route) {
            this.near = -1;
            this.route.play();
        } else {
            this.play(i);
            return;
        }
        if (!this.card.hidden)
            this.open(i, false);
    }

    // While the route plays: shows the annotation that was written where it passes; null: it has stopped.
    pass(view)
    {
        if (!view) {
            if (this.near >= 0 && !this.card.hidden)
                this.open(this.near, false);
            return;
        }
        const near = this.settings.notes.findIndex(note => note.view &&
            isNear(viewFromSaved(note.view, this.navigator.home), view, NEAR * this.navigator.distance));
        if (near !== this.near && near >= 0)
            this.open(near, false);
        this.near = near;
    }

    play(i)
    {
        const all = this.settings.notes, words = `${all[i].title} ${all[i].text || ""}`;
        this.tour = setTimeout(() => this.play((i + 1) % all.length), READ_MS + MS_PER_LETTER * words.length);
        this.open(i);
    }

    stopTour()
    {
        if (this.route && this.route.plays)
            this.route.play(); // a second time: pauses
        clearTimeout(this.tour);
        this.tour = 0;
    }

    close()
    {
        this.stopTour();
        this.card.hidden = true;
        (this.opened && this.opened.isConnected ? this.opened : this.canvas).focus();
    }

    // --- for the maker ---

    buildMaker()
    {
        const t = text.notes, maker = byId("maker"), s = this.settings;
        const line = (label, key) => make("label", {className: "line"}, label, make("input", {
            type: "text", maxLength: 200, value: s[key] || "",
            onchange: event => this.change({[key]: event.target.value})}));
        const modes = s.modes || MODES;
        this.modeInputs = MODES.map(name => make("input", {
            type: "checkbox", value: name, checked: modes.includes(name),
            onchange: event => this.changeModes(event.target)}));
        this.list = make("ol");
        this.title = make("input", {type: "text", maxLength: 200});
        this.words = make("textarea", {rows: 3, maxLength: 2000});
        this.said = make("p", {role: "status"});
        maker.ariaLabel = t.title;
        maker.append(
            make("h2", {textContent: t.title}), make("label", {className: "line"}, t.name, this.title),
            make("label", {className: "line"}, t.words, this.words),
            make("div", {className: "row"}, button(t.placeMiddle, () => this.place(window.innerWidth / 2, window.innerHeight / 2)),
                 button(t.place, () => this.startPlacing())), this.list,
            make("h2", {textContent: t.walk}), line(t.siteTitle, "title"), line(t.attribution, "attribution"),
            button(t.start, () => this.change({start: viewToSaved(this.navigator.view)})),
            make("fieldset", {}, make("legend", {textContent: t.modes}),
                 ...this.modeInputs.map(input => make("label", {}, input, text.actions[input.value]))),
            this.said);
    }

    // A short touch of the picture; a drag looks around for the place.
    tap(x, y)
    {
        if (this.placing)
            this.place(x, y);
    }

    startPlacing()
    {
        this.placing = true;
        this.said.textContent = text.notes.clickSurface;
    }

    stopPlacing()
    {
        this.placing = false;
        this.said.textContent = "";
    }

    async place(x, y)
    {
        this.placing = false;
        const view = this.navigator.view, position = await this.pick(x, y);
        if (!position) {
            this.said.textContent = text.notes.noSurface;
            return;
        }
        const note = {title: this.title.value || text.notes.one, text: this.words.value, position,
                      view: viewToSaved(view)};
        this.title.value = this.words.value = "";
        this.change({notes: [...this.settings.notes, note]});
    }

    row(note, i)
    {
        const remove = button("✕", () => this.change({notes: this.settings.notes.filter(n => n !== note)}),
                              {ariaLabel: text.notes.remove(note.title)});
        return make("li", {className: "row"}, button(note.title, () => this.open(i)), remove);
    }

    changeModes(input)
    {
        const modes = this.modeInputs.filter(other => other.checked).map(other => other.value);
        if (modes.length)
            this.change({modes});
        else
            input.checked = true;
    }

    async change(what)
    {
        Object.assign(this.settings, what);
        this.fill();
        this.said.textContent = text.notes.saving;
        this.said.textContent = await this.saveAll(this.settings) ? text.notes.saved : text.notes.notSaved;
    }
}
