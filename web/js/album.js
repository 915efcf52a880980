// In place of the walk, where a browser cannot draw it: the photographs, and the maker's notes, to
// step through.
import {Navigator} from "./navigation.js";
import {nearestPhoto} from "./photos.js";
import {text} from "./strings.js";
import {button, byId, make, paragraphs, showHint, showProgress, showUpright, Thumbs} from "./ui.js";
import {viewFromSaved} from "./view.js";

const STEPS = {Comma: -1, PageUp: -1, ArrowLeft: -1, Period: 1, PageDown: 1, ArrowRight: 1};

export class Album {
    // why: what a visitor is told
    constructor(files, manifest, photos, why)
    {
        Object.assign(this, {files, photos, why});
        this.home = new Navigator(manifest, photos, {calm: true, pivotAt: () => null}).home;
        this.image = make("img", {alt: ""});
        byId("stage").remove();
        byId("over").classList.add("album");
        byId("head").after(make("div", {id: "album"}, this.image), byId("tools"), byId("thumbs"));
        this.thumbs = new Thumbs(photos, files, photo => this.show(photo));
        byId("thumbs").hidden = false;
        this.thumbs.open();
        byId("tools").append(...[-1, 1].map(by => button(by < 0 ? text.actions.previous : text.actions.next,
                                                         () => this.step(by))));
        byId("attribution").textContent = manifest.walk.attribution || "";
        this.fillNotes(manifest.walk.notes || []);
        window.addEventListener("keydown", event => event.code in STEPS && this.step(STEPS[event.code]));
        this.show(nearestPhoto(photos, this.home));
    }

    fillNotes(notes)
    {
        const panel = byId("note");
        panel.ariaLabel = text.notes.title;
        panel.append(...notes.flatMap((note, i) => [
            button(text.notes.mark(i + 1, note.title), () => this.show(this.photoOf(note))),
            ...paragraphs(note.text),
        ]));
        panel.hidden = notes.length === 0;
    }

    // The photograph that is nearest to the view which its maker gave a note, else the one that shows.
    photoOf(note)
    {
        const view = note.view && viewFromSaved(note.view, this.home);
        return view ? nearestPhoto(this.photos, view) : this.photo;
    }

    step(by)
    {
        const {length} = this.photos;
        this.show(this.photos[(this.photo.number + by + length) % length]);
    }

    async show(photo)
    {
        this.photo = photo;
        const said = text.atPhoto(photo.number + 1, this.photos.length, photo.name);
        byId("place").textContent = said;
        this.thumbs.mark(photo);
        showHint(this.why);
        showProgress(1);
        await showUpright(this.image, photo, photo.picture, this.files);
        if (this.photo === photo)
            this.image.alt = said;
    }
}
