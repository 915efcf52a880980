// The distance between two places, once the maker of the scene has told one length.
import {distance} from "./math.js";
import {text} from "./strings.js";
import {button, byId, make} from "./ui.js";
import {project} from "./view.js";

export class Ruler {
    // unit: metres of one unit of the scene; 0: not known. pick(x, y): as Notes takes it.
    // save(metres): keeps the unit with the scene; null: nothing can be changed
    constructor(unit, {pick, save, wake})
    {
        Object.assign(this, {unit, pick, save, wake});
        this.line = byId("line");
        this.said = make("p", {id: "length", role: "status"});
        this.element = byId("ruler");
        this.element.ariaLabel = text.actions.ruler;
        this.element.append(make("h2", {textContent: text.actions.ruler}), this.said,
                            button(text.ruler.again, () => this.begin()), ...(save ? [this.teaching()] : []));
        this.begin();
    }

    get on() { return !this.element.hidden; }

    begin()
    {
        this.ends = [];
        this.tell();
    }

    tell()
    {
        const t = text.ruler, two = this.ends.length === 2;
        this.said.textContent = !two ? [t.first, t.second][this.ends.length]
                                : this.unit ? t.metres(this.unit * distance(...this.ends)) : t.unknown;
        if (this.known)
            this.known.hidden = !two;
        this.wake();
    }

    // Of the maker: how long what has been measured is.
    teaching()
    {
        const metres = make("input", {type: "number", min: 0.001, step: "any"});
        this.known = make("div", {className: "row"}, make("label", {}, text.ruler.known, metres),
                          button(text.ruler.keep, () => this.teach(Number(metres.value))));
        return this.known;
    }

    teach(metres)
    {
        const units = distance(...this.ends);
        if (!(metres > 0 && units > 0))
            return;
        this.unit = metres / units;
        this.save(this.unit);
        this.tell();
    }

    async tap(x, y)
    {
        const point = await this.pick(x, y);
        if (!point) {
            this.said.textContent = text.nothingThere;
            return;
        }
        this.ends = this.ends.length === 2 ? [point] : [...this.ends, point];
        this.tell();
    }

    // camera: of the window, in CSS pixels
    update(camera)
    {
        const ends = this.on ? this.ends.map(end => project(camera, end)).filter(Boolean) : [];
        this.line.setAttribute("points", ends.map(([x, y]) => `${x},${y}`).join(" "));
    }
}
