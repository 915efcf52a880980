// Method and options of the frames that a server draws: a form made from the renderer's own table.
// The server checks what is set, and says what is wrong with it.
import {text} from "./strings.js";
import {button, byId, make} from "./ui.js";

export class MethodPanel {
    // methods: manifest.methods; choose(name, settings): asks the server, which answers by told()
    constructor(methods, choose)
    {
        Object.assign(this, {methods, choose});
        this.options = new Map(methods.options.map(option => [option.key, option]));
        this.settings = {};  // that this client has changed, as the server has accepted them
        this.asked = null;   // {name, settings} that the server has not answered
        this.select = make("select", {onchange: () => this.ask(this.select.value, {})},
                           ...methods.list.map(m => make("option", {textContent: m.name})));
        this.about = make("p");
        this.rows = make("div");
        this.problem = make("p", {className: "problem", role: "alert"});
        const element = byId("method"), t = text.methods;
        element.ariaLabel = t.title;
        element.append(make("h2", {textContent: t.title}), make("label", {className: "line"}, t.method, this.select),
                       this.about, this.problem, this.rows,
                       button(t.reset, () => this.ask(this.chosen.name, {})));
        this.show(methods.chosen);
    }

    ask(name, settings)
    {
        this.asked = {name, settings};
        this.choose(name, Object.entries(settings).map(([key, value]) => `${key}=${value}`));
    }

    // What the server draws by from now on, and why it is not what was asked for; "": it is.
    told(choice, problem)
    {
        if (problem === "")
            this.settings = this.asked ? this.asked.settings : {};
        else if (choice.name !== this.chosen.name)
            this.settings = {};
        this.asked = null;
        this.show(choice);
        this.problem.textContent = problem;
    }

    show(choice)
    {
        const {key} = document.activeElement && document.activeElement.dataset || {};
        this.chosen = choice;
        this.select.value = choice.name;
        this.about.textContent = this.methods.list.find(m => m.name === choice.name).description;
        this.rows.replaceChildren(...Object.entries(choice.values).map(([k, value]) => this.row(this.options.get(k), value)));
        if (key)
            this.rows.querySelector(`[data-key="${key}"]`)?.focus();
    }

    row(option, value)
    {
        const help = option.help.replaceAll("`", ""), known = "names" in option;
        const input = known
            ? make("select", {}, ...option.names.map(name => make("option", {textContent: name})))
            : make("input", {type: "number", min: option.least, max: option.most, step: "any"});
        const range = known ? "" : text.methods.range(option.least, option.most, option.unit);
        input.value = value;
        input.dataset.key = option.key;
        input.addEventListener("change", () =>
            this.ask(this.chosen.name, {...this.settings, [option.key]: input.value}));
        const changed = option.key in this.settings ? " changed" : "";
        return make("label", {className: `line option${changed}`, title: range ? `${help} ${range}` : help},
                    option.key.replaceAll("_", " "), input);
    }
}
