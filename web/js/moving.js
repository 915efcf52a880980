// What moves in a site: a hull and photographs for each time step. Files are loaded in the order in which
// time shows them; what is decoded waits for the frame that shows it.
import {bytesOf} from "./files.js";
import {decodePicture, filesOf} from "./photos.js";
import {Cloud} from "./points.js";

export class Moving {
    // onChange(): another time step is ready.
    constructor(device, files, manifest, onChange)
    {
        Object.assign(this, {device, files, onChange, wanted: 0, shown: -1, ready: null, decoding: false});
        this.steps = manifest.steps.map(({points, photos = manifest.photos}) =>
            ({photos, files: [points, ...photos.flatMap(filesOf)], broken: false}));
        this.cloud = null;
        this.steps.forEach((step, number) => {
            step.loaded = new Promise(done => files.schedule(
                () => 1 + (number - this.wanted + this.steps.length) % this.steps.length,
                () => this.load(step).finally(done)));
        });
    }

    async load(step)
    {
        [step.hull, ...step.pictures] = await Promise.all(step.files.map(file => this.files.get(file.file)));
    }

    get complete() { return this.shown === this.wanted || this.steps[this.wanted].broken; }

    get bytes() { return bytesOf(this.steps.flatMap(step => step.files)); }

    // Begins what a frame at time step `now` needs, before which `next` will be shown, painted from the photographs
    // `wanted`. What was made in the meantime is put into the renderer, late or not: time leaves out what there was no
    // time for.
    show(renderer, [now, next], wanted)
    {
        this.wanted = now;
        if (this.ready)
            this.put(renderer);
        const usable = [now, next].filter(number => !this.steps[number].broken);
        const number = usable.find(one => one !== this.shown) ?? usable[0];
        const lacks = number !== this.shown || wanted.some(photo => photo.slot < 0);
        if (number !== undefined && lacks && !this.decoding)
            this.decode(number, wanted);
    }

    // A time step whose files are not there, or are no pictures, is left out: the one before stays.
    async decode(number, wanted)
    {
        const step = this.steps[number];
        this.decoding = true;
        await step.loaded; // the files say what is wrong
        try {
            if (step.pictures)
                this.ready = {number, wanted, pictures: await Promise.all(wanted.map(photo => this.pair(step, photo)))};
        } finally {
            this.decoding = false;
            step.broken = !this.ready;
            this.onChange();
        }
    }

    // What a time step shows of a photograph: picture and depth.
    pair({pictures}, {number})
    {
        return Promise.all(pictures.slice(2 * number, 2 * number + 2).map(decodePicture));
    }

    put(renderer)
    {
        const {number, wanted, pictures} = this.ready, step = this.steps[number];
        this.ready = null;
        this.shown = number;
        const cloud = new Cloud(this.device, step.hull);
        this.cloud?.release();
        this.cloud = cloud;
        renderer.clouds = [renderer.clouds[0], this.cloud];
        renderer.photos.replace(wanted, step.photos, pictures);
    }
}
