// The picture as this browser draws it: points and photographs on its own graphics chip.
import {bytesOf} from "./files.js";
import {Device} from "./gl.js";
import {clamp, distance} from "./math.js";
import {Moving} from "./moving.js";
import {decodePicture, filesOf, rankPhotos} from "./photos.js";
import {Cloud} from "./points.js";
import {LAYERS, Renderer, TONES} from "./renderer.js";
import {text} from "./strings.js";
import {make} from "./ui.js";
import {isBehind, project} from "./view.js";

const RANK_EVERY = 250; // milliseconds, while moving
const LOOK_EVERY = 200;
const SOFT_LAST = 1e3; // urgency of soft splats: behind photographs and points
const MIDDLE_MAX = 5; // of the scene's distance: a guess may lie a thousand times as far
const handheld = matchMedia("(pointer: coarse)").matches;

// Bytes for photographs on the graphics chip. Phones grant a page little of their memory, and neither Safari nor
// Firefox tells how much there is.
function photoBudget()
{
    const gigabytes = navigator.deviceMemory || (handheld ? 2 : 4);
    return Math.min(gigabytes >= 8 ? 768 : gigabytes >= 4 ? 384 : 160, handheld ? 256 : 768) * 2 ** 20;
}

// Without thumbnails. Photographs of time steps are counted with these.
const totalBytes = ({photos, points, soft, steps}) => bytesOf([points.coarse, ...points.files,
                                                               ...(steps ? [] : photos.flatMap(filesOf)),
                                                               ...(soft ? [soft, ...photos.map(photo => photo.soft)] : [])]);

const decodeFile = async (files, {file}) => decodePicture(await files.get(file));

const decode = (files, photo) => Promise.all(filesOf(photo).map(file => decodeFile(files, file)));

export class LocalPicture {
    // onChange: something has arrived that makes the picture better
    static async open(canvas, files, manifest, photos, onChange)
    {
        const wanted = [files.json("shaders.json"), files.get(manifest.points.coarse.file)];
        const first = manifest.steps ? null : decode(files, photos[manifest.start]);
        const device = new Device(canvas, Boolean(manifest.radiance)); // takes a while, in which files come
        const [sources, coarse] = await Promise.all(wanted);
        return new LocalPicture(canvas, device, files, manifest, photos, onChange, sources, coarse, first);
    }

    // first: what decode() gives of the photograph of the start
    constructor(canvas, device, files, manifest, photos, onChange, sources, coarse, first)
    {
        Object.assign(this, {canvas, device, files, manifest, onChange, first, all: photos, layers: LAYERS});
        this.tones = manifest.radiance ? TONES : [];
        this.problem = "";     // why no frames come
        this.remote = false;   // a frame is there once draw() returns
        // Of a picture, whatever the screen: each takes some 120 bytes on the graphics chip.
        this.pixelsMost = handheld ? 1.0e6 : 2.6e6;
        this.sides = [2, Infinity];
        this.cloud = new Cloud(device, coarse);
        this.renderer = new Renderer(device, sources, manifest, photos, this.cloud, photoBudget());
        this.moving = manifest.steps ? new Moving(device, files, manifest, onChange) : null;
        this.timeSteps = null; // of the page
        this.allBytes = totalBytes(manifest) + (this.moving ? this.moving.bytes : 0);
        this.lookedAt = 0;
        this.rank = [photos[manifest.start]]; // until a view is drawn
        this.points = [];      // in the world, whose visibility frames tell
        this.seen = new Map(); // of those: false where a surface is before the point
        this.eye = photos[manifest.start].eye;
        canvas.addEventListener("webglcontextlost", event => {
            event.preventDefault();
            this.problem = text.lostDevice;
            onChange();
        });
        canvas.addEventListener("webglcontextrestored", () => location.reload());
        this.request(photos[manifest.start]);
        manifest.points.files.forEach((file, number) => files.schedule(() => this.pointsUrgency(file), async () => {
            this.cloud.addFile(number, await files.get(file.file));
            onChange();
        }));
        if (manifest.soft)
            this.requestSoft(null, async () => this.renderer.addSoft(await files.get(manifest.soft.file)));
    }

    // --- loading ---

    // Time steps come with their photographs.
    request(photo)
    {
        if (photo.asked || this.moving)
            return;
        photo.asked = true;
        this.files.schedule(() => this.photoUrgency(photo), () => this.loadPhoto(photo));
    }

    // Photographs of the view first, and between them the points that are near.
    photoUrgency(photo)
    {
        const place = this.wanted.indexOf(photo);
        return place < 0 ? Infinity : place;
    }

    pointsUrgency(file)
    {
        if (this.rankedAt === undefined)
            return Infinity; // the first frame does without
        const nearest = [0, 1, 2].map(k => clamp(this.eye[k], file.box[k], file.box[3 + k]));
        return 1.5 + 8 * distance(nearest, this.eye) / this.manifest.distance;
    }

    async loadPhoto(photo)
    {
        const begun = photo.number === this.manifest.start && this.first;
        if (begun)
            this.first = null;
        this.renderer.photos.add(photo, ...await (begun || decode(this.files, photo)));
        if (photo.soft)
            this.requestSoft(photo, async () =>
                this.renderer.photos.addSoft(photo, await decodeFile(this.files, photo.soft)));
        this.onChange();
    }

    // Soft splats, or what they show in a photograph. They change the picture once the last of their files is there,
    // and the view rests.
    requestSoft(photo, load)
    {
        this.files.schedule(() => this.hasPhotos ? SOFT_LAST + this.rank.indexOf(photo) : Infinity, async () => {
            await load();
            if (this.complete)
                this.onChange();
        });
    }

    // What is wanted for the view; photographs that made room for others are asked for again.
    rankFor(camera, rests)
    {
        const store = this.renderer.photos, now = performance.now();
        if (!rests && now - this.rankedAt < RANK_EVERY)
            return;
        this.rankedAt = now;
        this.eye = camera.eye;
        this.rank = rankPhotos(this.all, camera, this.manifest.distance);
        for (const photo of this.wanted) {
            if (photo.slot >= 0)
                photo.lastUse = ++store.clock;
            this.request(photo);
        }
        this.files.next();
    }

    // The photographs that the view wants, and whether they are here: false until a view is drawn.
    get wanted() { return this.rank.slice(0, this.renderer.photos.slots); }
    get hasPhotos() { return this.rankedAt !== undefined && this.wanted.every(photo => photo.slot >= 0); }

    // Everything that the view wants is here.
    get complete()
    {
        return this.cloud.loaded === this.cloud.points && (!this.moving || this.moving.complete) &&
               this.wanted.every(photo => photo.slot >= 0 && (photo.hasSoft || !photo.soft)) &&
               (this.renderer.soft !== null || !this.manifest.soft);
    }

    // Good enough to take the poster's place: the photograph that shows most of the view is there, or a
    // frame would put it there.
    get presentable() { return this.rank[0].slot >= 0 || Boolean(this.moving && this.moving.ready); }
    // Frames would show the coarse points alone until the first photograph has come.
    get awaits() { return !this.moving && !this.presentable; }
    get loadedShare() { return this.complete ? 1 : Math.min(this.files.bytes / this.allBytes, 0.99); }

    // --- frames ---

    // full: the window's camera at full resolution; camera: the same with fewer pixels, perhaps.
    draw(full, camera, layer)
    {
        const {width, height} = camera;
        if (this.problem)
            return;
        if (this.canvas.width !== width || this.canvas.height !== height)
            Object.assign(this.canvas, {width, height});
        this.rankFor(full, camera === full);
        this.drawInto(camera, layer, camera === full);
        if (this.points.length && (camera === full || performance.now() - this.lookedAt > LOOK_EVERY))
            this.look(camera);
    }

    // An eye of a headset, into its part of a framebuffer.
    drawEye(camera, layer, part)
    {
        this.rankFor(camera, false);
        this.drawInto(camera, layer, false, part);
    }

    drawInto(camera, layer, whole, part)
    {
        if (this.moving)
            this.moving.show(this.renderer, this.timeSteps ? this.timeSteps.pair : [0, 0], this.wanted);
        this.renderer.draw(camera, layer, whole);
        this.renderer.show(layer, whole, part);
    }

    // Milliseconds of a frame, which is waited for.
    timeOf(camera)
    {
        const start = performance.now();
        this.renderer.draw(camera, 0, false);
        this.renderer.depthAt(0, 0);
        return performance.now() - start;
    }

    // Reading depth waits for the graphics chip, so not every frame does.
    look(camera)
    {
        this.lookedAt = performance.now();
        const places = this.points.map(point => [point, project(camera, point)]).filter(([, at]) => at);
        this.seen = new Map(places.map(([point, at]) =>
            [point, !isBehind(at[2], this.renderer.depthAt(at[0], at[1]))]));
    }

    async capture(camera, layer)
    {
        const image = this.renderer.capture(camera, layer);
        const canvas = make("canvas", {width: image.width, height: image.height});
        canvas.getContext("2d").putImageData(image, 0, 0);
        return canvas;
    }

    setTone(name) { this.renderer.tone = Math.max(TONES.indexOf(name), 0); }
    setExposure(ev) { this.renderer.exposure = 2 ** ev; }

    // The point under a pixel of the window's camera; null: nothing is known of it.
    async pick(camera, x, y)
    {
        const f = this.renderer.frame;
        return f ? this.renderer.pointAt(x * f.width / camera.width, y * f.height / camera.height) : null;
    }

    // What the middle of the picture shows, in the world, if it is near enough to turn around, else a
    // point before it; null: nothing is known of it.
    middle()
    {
        const f = this.renderer.frame;
        const most = MIDDLE_MAX * this.manifest.distance;
        return f ? this.renderer.pointAt(f.width / 2, f.height / 2, most) : null;
    }

    forEachPoint(visit) { this.cloud.forEachCoarse(visit); }

    get details() { return []; }

    figures()
    {
        const {renderer} = this, f = renderer.frame;
        return {
            size: text.size(f.width, f.height), points: `${renderer.drawn} / ${this.cloud.loaded}`,
            photos: text.ofLoaded(renderer.used, renderer.photos.ready.length, this.all.length),
            loaded: text.bytes(Math.min(this.files.bytes, this.allBytes), this.allBytes), // which leaves thumbnails out
            memory: text.memory(this.device.bytes + this.cloud.bytes), device: this.device.name,
        };
    }
}
