// What moves in a site: a hull and photographs for each time step. Files are loaded in the order in which
// time shows them; what is decoded waits for the frame that shows it.
import {bytesOf} from "./files.js";
import {decodePicture, filesOf} from "./photos.js";
import {Cloud} from "./points.js";

export class Moving {
    // onChange(): another time step is ready.
    constructor(device, files, manifest, photos, onChange)
    {
        Object.assign(this, {device, files, photos, onChange, wanted: 0, shown: -1, ready: null, decoding: false});
        this.steps = manifest.steps.map(({points, photos = manifest.photos}) =>
            ({photos, files: [points, ...photos.flatMap(filesOf)]}));
        this.cloud = null;
        this.steps.forEach((step, number) => {
            step.loaded = new Promise((done, failed) => files.schedule(
                () => 1 + (number - this.wanted + this.steps.length) % this.steps.length,
                () => this.load(step).then(done, error => {
                    failed(error);
                    throw error;
                })));
            step.loaded.catch(() => {}); // the files say what is wrong
        });
    }

    async load(step)
    {
        [step.hull, ...step.pictures] = await Promise.all(step.files.map(file => this.files.get(file.file)));
    }

    get complete() { return this.shown === this.wanted; }

    get bytes() { return bytesOf(this.steps.flatMap(step => step.files)); }

    // Begins what a frame at time step `now` needs, before which `next` will be shown. What was made in the
    // meantime is put into the renderer, late or not: time leaves out what there was no time for.
    show(renderer, now, next)
    {
        this.wanted = now;
        if (this.ready)
            this.put(renderer);
        if (this.decoding || (this.shown === now && next === now))
            return;
        const number = this.shown === now ? next : now;
        if (number !== this.shown)
            this.decode(number);
    }

    async decode(number)
    {
        const step = this.steps[number];
        this.decoding = true;
        try {
            await step.loaded;
            this.ready = {number, pictures: await Promise.all(step.pictures.map(decodePicture))};
        } finally {
            this.decoding = false;
        }
        this.onChange();
    }

    put(renderer)
    {
        const {number, pictures} = this.ready, step = this.steps[number];
        this.ready = null;
        this.shown = number;
        this.cloud?.release();
        this.cloud = new Cloud(this.device, step.hull);
        renderer.clouds = [renderer.clouds[0], this.cloud];
        this.photos.forEach((photo, i) => renderer.photos.replace(photo, step.photos[i], pictures[2 * i], pictures[2 * i + 1]));
        pictures.forEach(picture => picture.close());
    }
}
