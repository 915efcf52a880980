// The picture as a server draws it: one request for a frame at a time over a WebSocket.
import {text} from "./strings.js";
import {make, showHint} from "./ui.js";
import {isBehind, project, unproject} from "./view.js";

const HEADER_WORDS = 6;
const LAYERS = ["color", "depth", "normal", "coverage", "points"];
const QUALITY_MOVING = 75, QUALITY_STILL = 90;
const PIXELS_MAX = 2.0e6; // the server refuses more than 4 million
const SIDES = [16, 4096];  // the least and the longest, as the server takes them
const RETRY_MS = 1500;
const SILENT_MS = 8000; // a server that has not answered for so long is said to hang
const TOO_LARGE = 1009; // why a server closes: a message is longer than it takes
const LOADING_MAX = 48; // photographs of a frame
const MAP_POINT_BYTES = 16;

export class LivePicture {
    static async open(canvas, files, manifest, photos, onChange)
    {
        const picture = new LivePicture(canvas, photos, onChange);
        const [points] = await Promise.all([files.get("map.bin"), picture.connect(files)]);
        picture.mapPoints = points;
        return picture;
    }

    constructor(canvas, photos, onChange)
    {
        Object.assign(this, {canvas, onChange, all: photos, layers: LAYERS});
        this.context = canvas.getContext("2d", {alpha: false});
        this.remote = true;    // frames come later than they are asked for
        Object.assign(this, {pixelsMost: PIXELS_MAX, sides: SIDES});
        this.number = 0;       // of the last request
        this.asked = null;     // {at, marks} of the one that is under way
        this.next = null;      // to ask for once it has come
        this.shown = null;     // number, milliseconds, size of the frame that shows
        this.waiting = [];     // for a picture of its own: {request, done}
        this.bytes = 0;
        this.ev = 0;
        this.tone = "srgb";
        this.points = [];      // in the world, whose visibility frames tell
        this.marks = [];       // of the latest request: {point, at}, of those in its picture
        this.seen = new Map(); // of the points: false where a surface is before the point
        this.measures = false; // frames at rest tell what they took
        this.measured = null;  // the last of what they told
        this.method = null;    // {name, settings} that was chosen
        this.unsaved = null;   // {settings, done: [resolve()], newer} that the server has not answered;
                               // newer: they are not what was sent last
        this.problem = "";     // why no frames come
        this.site = null;      // {promise, resolve, reject, onProgress} of who waits for the site's data
        this.onRendering = this.onMethod = () => {};
        window.addEventListener("beforeunload", event => {
            if (this.unsaved)
                event.preventDefault();
        });
    }

    connect(files)
    {
        const address = files.url("live");
        address.protocol = address.protocol === "https:" ? "wss:" : "ws:";
        return new Promise(resolve => {
            this.socket = new WebSocket(address, "oriel-walk");
            this.socket.binaryType = "arraybuffer";
            this.socket.onopen = () => {
                this.opened();
                resolve();
            };
            this.socket.onmessage = event => typeof event.data === "string"
                ? this.hear(JSON.parse(event.data)) : this.receive(event.data);
            this.socket.onclose = ({code}) => {
                if (code === TOO_LARGE && this.unsaved)
                    this.hearOfSettings(false);
                this.closed();
                setTimeout(() => this.connect(files).then(resolve), RETRY_MS);
            };
        });
    }

    // What the server does not know of this client is told again.
    opened()
    {
        this.lost = false;
        this.problem = "";
        if (this.method)
            this.tell({method: this.method.name, set: this.method.settings});
        if (this.site)
            this.tell({site: true});
        if (this.unsaved)
            this.tellSettings();
        this.onChange();
    }

    closed()
    {
        const newly = !this.lost;
        this.lost = true;
        this.asked = null;
        this.problem = text.noServer;
        showHint(this.problem); // before the walk begins, nothing else says so
        clearTimeout(this.silence);
        if (this.renders)
            this.hear({rendering: {done: 0, total: 0, problem: text.noServer}});
        if (newly)
            this.onChange();
    }

    // False: the server is away. What waits for it is told once it is back.
    tell(message)
    {
        const open = this.socket.readyState === WebSocket.OPEN;
        if (open)
            this.socket.send(JSON.stringify(message));
        return open;
    }

    // --- frames ---

    draw(full, camera, layer)
    {
        const rests = camera === full;
        this.next = this.describe(camera, layer, rests ? QUALITY_STILL : QUALITY_MOVING, rests);
        const marks = this.points.map(point => ({point, at: project(camera, point)})).filter(m => m.at);
        this.next.picks = marks.map(m => [Math.floor(m.at[0]), Math.floor(m.at[1])]);
        this.marks = marks;
        this.latest = this.next;
        this.ask();
    }

    // rest: the view does not move, so the server may take more time for its photographs
    describe(camera, layer, quality, rest)
    {
        const {width, height, fx, fy, cx, cy, r, eye} = camera;
        const timeSteps = this.timeSteps ? {time_steps: this.timeSteps.pair} : {};
        return {...timeSteps, number: ++this.number, size: [width, height], focal: [fx, fy, cx, cy], r, eye,
                layer: LAYERS[layer], quality, rest, ev: this.ev, tone: this.tone,
                measure: rest && this.measures};
    }

    setExposure(ev) { this.ev = ev; }
    setTone(name) { this.tone = name; }

    ask()
    {
        if (this.asked || this.lost || !(this.next || this.waiting.length))
            return;
        const request = this.waiting.length ? this.waiting[0].request : this.next;
        if (request === this.next)
            this.next = null;
        this.asked = {at: performance.now(), marks: this.marks};
        this.tell(request);
        this.silence = setTimeout(() => {
            this.problem = text.silentServer;
            this.onChange();
        }, SILENT_MS);
    }

    async receive(data)
    {
        clearTimeout(this.silence);
        this.problem = "";
        const [number, microseconds, width, height, missing, picks] = new Uint32Array(data, 0, HEADER_WORDS);
        const depths = new Float32Array(data, 4 * HEADER_WORDS, picks);
        const image = await createImageBitmap(new Blob([data.slice(4 * (HEADER_WORDS + picks))], {type: "image/jpeg"}));
        const {asked} = this;
        this.bytes += data.byteLength;
        if (!asked) { // the server went away meanwhile
            image.close();
            return;
        }
        const took = performance.now() - asked.at;
        this.asked = null;
        const own = this.waiting.length && this.waiting[0].request.number === number ? this.waiting[0] : null;
        if (own && missing) {
            image.close(); // asked for again until its photographs are there
        } else if (own) {
            this.waiting.shift().done({image, depths});
        } else {
            Object.assign(this.canvas, {width, height});
            this.context.drawImage(image, 0, 0);
            image.close();
            this.seen = new Map(asked.marks.map(({point, at}, i) => [point, !isBehind(at[2], depths[i])]));
            this.shown = {number, took, server: microseconds / 1000, width, height, missing};
        }
        // A picture at rest gets better while its photographs come.
        const {latest} = this;
        if (missing && !own && !this.next && latest.rest && latest.number === number)
            this.next = this.latest = {...latest, number: ++this.number};
        this.ask();
        this.onChange(took);
    }

    get complete() { return !this.asked && !this.next && !this.lost && this.shown !== null; }
    get presentable() { return this.shown !== null; }
    get awaits() { return false; }
    get loadedShare() { return this.shown ? 1 - Math.min(this.shown.missing / LOADING_MAX, 0.9) : 0; }

    // A frame of its own.
    async capture(camera, layer)
    {
        const {image} = await this.own(camera, layer, {});
        const canvas = make("canvas", {width: image.width, height: image.height});
        canvas.getContext("2d").drawImage(image, 0, 0);
        return canvas;
    }

    own(camera, layer, more)
    {
        return new Promise(done => {
            this.waiting.push({request: {...this.describe(camera, layer, 100, true), ...more}, done});
            this.ask();
        });
    }

    // The point under a pixel of the window's camera; null: nothing is known of it.
    async pick(camera, x, y)
    {
        const at = [Math.floor(x), Math.floor(y)];
        const {image, depths: [picked]} = await this.own(camera, 0, {picks: [at]});
        image.close();
        return picked > 0 ? unproject(camera, at[0] + 0.5, at[1] + 0.5, picked) : null;
    }

    // --- what is no frame ---

    hear(message)
    {
        if ("saved" in message && this.unsaved)
            this.hearOfSettings(message.saved);
        if (message.rendering) {
            const {done, total, problem} = message.rendering;
            this.renders = done < total && !problem;
            this.onRendering(message.rendering);
        }
        if (message.figures)
            this.measured = message.figures;
        if (message.choice)
            this.onMethod(message.choice, message.problem);
        if (message.site && this.site)
            this.hearOfSite(message.site);
    }

    // The server answers by onMethod(choice, problem).
    choose(name, settings)
    {
        this.method = {name, settings};
        this.tell({method: name, set: settings});
    }

    // True once the settings of the walk are with the scene. They hold all that was changed, so the
    // newest alone are told, one at a time, and again to a server that was away.
    save(settings)
    {
        const told = this.unsaved;
        return new Promise(done => {
            this.unsaved = {settings, done: [...(told ? told.done : []), done], newer: told !== null};
            if (!told)
                this.tellSettings();
        });
    }

    tellSettings()
    {
        this.unsaved.newer = false;
        this.tell({save: this.unsaved.settings});
    }

    hearOfSettings(saved)
    {
        if (this.unsaved.newer) {
            this.tellSettings();
            return;
        }
        this.unsaved.done.forEach(done => done(saved));
        this.unsaved = null;
    }

    // A promise that the published site's data are on the server; onProgress(done, total) until then.
    prepareSite(onProgress)
    {
        this.site = {...Promise.withResolvers(), onProgress};
        this.tell({site: true});
        return this.site.promise;
    }

    hearOfSite({done, total, ready, problem})
    {
        const {site} = this;
        if (!ready && !problem) {
            site.onProgress(done, total);
            return;
        }
        this.site = null;
        if (ready)
            site.resolve();
        else
            site.reject(new Error(problem));
    }

    // With the exposure and the tone curve that frames have now.
    render(path, format)
    {
        this.renders = this.tell({render: path, format, ev: this.ev, tone: this.tone});
        if (!this.renders)
            this.onRendering({done: 0, total: 0, problem: text.noServer});
    }

    middle() { return null; }

    forEachPoint(visit)
    {
        const view = new DataView(this.mapPoints);
        for (let at = 0; at < view.byteLength; at += MAP_POINT_BYTES)
            visit([0, 4, 8].map(k => view.getFloat32(at + k, true)), [12, 13, 14].map(k => view.getUint8(at + k)));
    }

    figures()
    {
        const s = this.shown, m = this.measured;
        return {size: s ? text.size(s.width, s.height) : "–", points: "–", photos: text.photos(this.all.length),
                loaded: text.memory(this.bytes),
                memory: text.memory(m ? Object.values(m.memory).reduce((a, b) => a + b) : 0), device: s ? text.byServer(s.server, s.took) : text.noServer};
    }

    // Of the last frame at rest, as the server measured it: groups of rows of label and value.
    get details()
    {
        const m = this.measured;
        if (!m)
            return [];
        const times = [...m.passes, [text.drawing, m.draw_ms], [text.encoding, m.encode_ms]];
        return [[text.passes, times.map(([name, ms]) => [name, text.milliseconds(ms)])],
                [text.memoryBy, Object.entries(m.memory).map(([owner, bytes]) => [text.owners[owner], text.memory(bytes)])]];
    }
}
