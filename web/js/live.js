// The picture as a server draws it: one request for a frame at a time over a WebSocket.
import {text} from "oriel/strings.js";

const HEADER_BYTES = 16;
const LAYERS = ["color", "depth", "normal", "coverage", "points"];
const QUALITY_MOVING = 75, QUALITY_STILL = 90;
const PIXELS_MOST = 2.0e6; // the server refuses more than 4 million
const RETRY_MS = 1500;

export class LivePicture {
    static async open(canvas, files, manifest, photos, onChange)
    {
        const picture = new LivePicture(canvas, photos, onChange);
        await picture.connect(files);
        return picture;
    }

    constructor(canvas, photos, onChange)
    {
        this.canvas = canvas;
        this.context = canvas.getContext("2d", {alpha: false});
        this.all = photos;
        this.onChange = onChange;
        this.layers = LAYERS;
        this.pixelsMost = PIXELS_MOST;
        this.number = 0;       // of the last request
        this.asked = null;     // {number, at} of the one that is under way
        this.next = null;      // to ask for once it has come
        this.shown = null;     // number, milliseconds, size of the frame that shows
        this.waiting = [];     // for a picture of its own: {request, done}
        this.bytes = 0;
    }

    connect(files)
    {
        const address = files.url("live");
        address.protocol = address.protocol === "https:" ? "wss:" : "ws:";
        return new Promise((resolve, reject) => {
            this.socket = new WebSocket(address, "oriel-walk");
            this.socket.binaryType = "arraybuffer";
            this.socket.onopen = () => {
                this.lost = false;
                resolve();
                this.onChange();
            };
            this.socket.onmessage = event => this.receive(event.data);
            this.socket.onclose = () => {
                reject(new Error(text.noServer));
                this.lost = true;
                this.asked = null;
                setTimeout(() => this.connect(files).catch(() => {}), RETRY_MS);
            };
        });
    }

    // --- frames ---

    draw(full, camera, layer)
    {
        this.next = this.describe(camera, layer, camera === full ? QUALITY_STILL : QUALITY_MOVING);
        this.ask();
    }

    describe(camera, layer, quality)
    {
        const {width, height, fx, fy, cx, cy, r, eye} = camera;
        return {number: ++this.number, size: [width, height], focal: [fx, fy, cx, cy], r, eye,
                layer: LAYERS[layer], quality};
    }

    ask()
    {
        if (this.asked || this.lost || !(this.next || this.waiting.length))
            return;
        const request = this.waiting.length ? this.waiting[0].request : this.next;
        if (request === this.next)
            this.next = null;
        this.asked = {number: request.number, at: performance.now()};
        this.socket.send(JSON.stringify(request));
    }

    async receive(data)
    {
        const [number, microseconds, width, height] = new Uint32Array(data, 0, 4);
        const image = await createImageBitmap(new Blob([data.slice(HEADER_BYTES)], {type: "image/jpeg"}));
        const took = performance.now() - this.asked.at;
        this.bytes += data.byteLength;
        this.asked = null;
        if (this.waiting.length && this.waiting[0].request.number === number) {
            this.waiting.shift().done(image);
        } else {
            Object.assign(this.canvas, {width, height});
            this.context.drawImage(image, 0, 0);
            image.close();
            this.shown = {number, took, server: microseconds / 1000, width, height};
        }
        this.ask();
        this.onChange(took);
    }

    get complete() { return !this.asked && !this.next && !this.lost && this.shown !== null; }
    get presentable() { return this.shown !== null; }
    get loadedShare() { return 1; }

    // A frame of its own.
    async capture(camera, layer)
    {
        const image = await new Promise(done => {
            this.waiting.push({request: this.describe(camera, layer, 100), done});
            this.ask();
        });
        const canvas = Object.assign(document.createElement("canvas"), {width: image.width, height: image.height});
        canvas.getContext("2d").drawImage(image, 0, 0);
        return canvas;
    }

    middle() { return null; }
    forEachPoint() {}

    figures()
    {
        const s = this.shown;
        return {size: s ? text.size(s.width, s.height) : "–", points: "–", photos: text.photos(this.all.length),
                loaded: text.memory(this.bytes), memory: "–",
                device: s ? text.byServer(s.server, s.took) : text.noServer};
    }
}
