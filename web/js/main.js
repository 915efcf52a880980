// The walk: loads the site, draws when something changes, and joins input, picture and tools.
import {Files} from "oriel/files.js";
import {Device} from "oriel/gl.js";
import {Input} from "oriel/input.js";
import {Map2d} from "oriel/map.js";
import {clamp, distance} from "oriel/math.js";
import {Navigator, MODES} from "oriel/navigation.js";
import {makePhotos, preselect} from "oriel/photos.js";
import {Cloud} from "oriel/points.js";
import {LAYERS, loadShaders, Renderer} from "oriel/renderer.js";
import {text} from "oriel/strings.js";
import {buildHelp, byId, Compare, Panel, showHint, showProgress, Thumbs, Tools} from "oriel/ui.js";
import {cameraOf, frameHeight, photoView, viewFromText, viewToText} from "oriel/view.js";

const PIXELS_MOST = 2.6e6;                // of a picture, whatever the screen
const SCALES = [1, 0.75, 0.5, 0.35, 0.25]; // of it while moving
const FRAME_LONG = 38, FRAME_SHORT = 14;  // milliseconds: fewer pixels, more pixels
const REFINE_AFTER = 140;                 // milliseconds of rest
const POSTER_SHARE = 0.625;               // height to width: POSTER_* of site_photos.c

// Bytes for photographs on the graphics chip: what phones stand, more where there is more.
function photoBudget()
{
    const gigabytes = navigator.deviceMemory || (matchMedia("(pointer: coarse)").matches ? 2 : 8);
    return (gigabytes >= 8 ? 768 : gigabytes >= 4 ? 384 : 160) * 2 ** 20;
}

class Walk {
    constructor(files, manifest, sources, coarse)
    {
        this.files = files;
        this.manifest = manifest;
        this.canvas = byId("canvas");
        this.photos = makePhotos(manifest);
        this.device = new Device(this.canvas);
        this.cloud = new Cloud(this.device, coarse);
        this.renderer = new Renderer(this.device, sources, manifest, this.photos, this.cloud, photoBudget());
        this.layer = 0;
        this.scale = 0;          // index into SCALES
        this.frames = [];        // milliseconds of the last frames while moving
        this.dirty = true;
        this.restSince = 0;
        this.refined = false;
        this.lastTime = 0;
        this.allBytes = totalBytes(manifest) + coarse.byteLength;
        this.navigator = new Navigator(manifest, this.photos, {
            calm: matchMedia("(prefers-reduced-motion: reduce)").matches,
            pivotAt: () => this.middle(),
        });
        this.buildTools();
        this.readAddress();
        window.addEventListener("hashchange", () => this.readAddress());
        window.addEventListener("resize", () => this.wake());
        this.canvas.setAttribute("aria-label", text.canvas);
        this.canvas.addEventListener("webglcontextlost", event => {
            event.preventDefault();
            showHint(text.lostDevice, true);
        });
        this.canvas.addEventListener("webglcontextrestored", () => location.reload());
        this.placePoster();
        this.requestAll();
        this.running = false;
        this.wake();
    }

    // --- tools ---

    buildTools()
    {
        const nav = this.navigator, help = buildHelp();
        const toggle = id => () => {
            byId(id).hidden = !byId(id).hidden;
            this.wake();
        };
        const shown = id => () => !byId(id).hidden;
        const mode = name => ({run: () => this.act(() => nav.setMode(name)), pressed: () => nav.mode === name});
        this.thumbs = new Thumbs(this.photos, this.files, photo => this.act(() => nav.goTo(photo)));
        const actions = {
            home: {key: "h", run: () => this.act(() => nav.goHome())},
            previous: {key: ",", run: () => this.act(() => nav.browse(-1))},
            next: {key: ".", run: () => this.act(() => nav.browse(1))},
            snap: {key: "p", run: () => this.act(() => nav.snap())},
            ...Object.fromEntries(MODES.map((name, i) => [name, {key: String(i + 1), ...mode(name)}])),
            layer: {key: "l", run: () => this.setLayer((this.layer + 1) % LAYERS.length)},
            compare: {key: "c", run: () => this.toggleCompare(), pressed: () => this.compare.on},
            thumbs: {key: "t", pressed: shown("thumbs"), run: () => {
                toggle("thumbs")();
                this.thumbs.open();
            }},
            map: {key: "m", run: toggle("map"), pressed: shown("map")},
            panel: {key: "i", run: toggle("panel"), pressed: shown("panel")},
            screenshot: {key: "x", run: () => this.saveScreenshot()},
            full: {key: "f", run: () => this.toggleFull(), pressed: () => document.fullscreenElement !== null},
            help: {key: "?", run: () => help.showModal()},
        };
        this.tools = new Tools(actions);
        this.compare = new Compare(this.files);
        this.panel = new Panel({layer: this.layer, onLayer: layer => this.setLayer(layer)});
        this.map = new Map2d(nav, this.cloud, photo => this.act(() => nav.goTo(photo)));
        this.input = new Input(this.canvas, nav, {
            focal: () => this.windowCamera(1).fx, wake: () => this.wake(),
            actions: new Map(Object.values(actions).map(a => [a.key, a.run])),
        });
        document.addEventListener("fullscreenchange", () => this.wake());
    }

    act(what)
    {
        what();
        this.wake();
    }

    setLayer(layer)
    {
        this.layer = layer;
        this.panel.setLayer(layer);
        this.refined = false;
        this.wake();
    }

    toggleCompare()
    {
        this.compare.on = !this.compare.on;
        if (this.compare.on && !this.navigator.at)
            this.navigator.snap();
        this.wake();
    }

    toggleFull()
    {
        if (document.fullscreenElement)
            document.exitFullscreen();
        else
            document.documentElement.requestFullscreen();
    }

    saveScreenshot()
    {
        const image = this.renderer.capture(this.windowCamera(1), this.layer);
        const canvas = Object.assign(document.createElement("canvas"), {width: image.width, height: image.height});
        canvas.getContext("2d").putImageData(image, 0, 0);
        canvas.toBlob(blob => {
            const link = document.createElement("a");
            link.href = URL.createObjectURL(blob);
            link.download = `${this.manifest.title}.png`;
            link.click();
            setTimeout(() => URL.revokeObjectURL(link.href), 10000);
        });
        this.refined = false;
        this.wake();
    }

    // --- the address ---

    readAddress()
    {
        const parts = new URLSearchParams(location.hash.slice(1)), nav = this.navigator;
        const photo = parts.has("p") ? this.photos[Number(parts.get("p")) - 1] : undefined;
        const view = parts.has("v") ? viewFromText(parts.get("v"), nav.home) : null;
        if (MODES.includes(parts.get("mode")))
            nav.setMode(parts.get("mode"));
        if (photo)
            nav.setView(photoView(photo), photo);
        else if (view)
            nav.setView(view);
        this.wake();
    }

    writeAddress()
    {
        const nav = this.navigator, parts = new URLSearchParams();
        if (nav.at)
            parts.set("p", nav.at.number + 1);
        else
            parts.set("v", viewToText(nav.view));
        if (nav.mode !== "walk")
            parts.set("mode", nav.mode);
        const hash = `#${parts.toString().replaceAll("%2C", ",")}`;
        if (hash !== location.hash)
            history.replaceState(null, "", hash);
    }

    // --- loading ---

    requestAll()
    {
        this.rank = [];
        for (const photo of this.photos)
            this.files.schedule(() => this.photoUrgency(photo), () => this.loadPhoto(photo));
        this.manifest.points.files.forEach((file, number) =>
            this.files.schedule(() => this.pointsUrgency(file), () => this.loadPoints(file, number)));
    }

    // Photographs of the view first, and with every two of them a part of the points.
    photoUrgency(photo)
    {
        const place = this.rank.indexOf(photo);
        return place < 0 || place >= this.renderer.photos.slots ? Infinity : place;
    }

    pointsUrgency(file)
    {
        const {eye} = this.navigator.view, box = file.box;
        const nearest = [0, 1, 2].map(k => clamp(eye[k], box[k], box[3 + k]));
        return 1.5 + 8 * distance(nearest, eye) / this.manifest.distance;
    }

    async loadPhoto(photo)
    {
        const options = {colorSpaceConversion: "none", premultiplyAlpha: "none"};
        const picture = async file => createImageBitmap(new Blob([await this.files.get(file)]), options);
        const both = await Promise.all([picture(photo.picture.file), picture(photo.depth.file)]);
        this.renderer.photos.add(photo, ...both);
        this.loaded();
    }

    async loadPoints(file, number)
    {
        this.cloud.addFile(number, await this.files.get(file.file));
        this.loaded();
    }

    loaded()
    {
        this.refined = false;
        this.wake();
    }

    // What is wanted for the view; photographs that made room for others are asked for again.
    rankPhotos(camera)
    {
        const store = this.renderer.photos, all = this.photos;
        this.rank = preselect(all, camera, this.manifest.distance, all.length);
        for (const photo of this.rank.slice(0, store.slots)) {
            if (photo.slot >= 0)
                photo.lastUse = ++store.clock;
            else if (photo.dropped)
                this.files.schedule(() => this.photoUrgency(photo), () => this.loadPhoto(photo));
            photo.dropped = false;
        }
        this.files.next();
    }

    // Everything that this view wants is here.
    get complete()
    {
        return this.cloud.loaded === this.cloud.points &&
               this.rank.slice(0, this.renderer.photos.slots).every(p => p.slot >= 0);
    }

    // --- frames ---

    windowCamera(share)
    {
        const ratio = window.devicePixelRatio || 1;
        let width = window.innerWidth * ratio, height = window.innerHeight * ratio;
        const fit = Math.min(1, Math.sqrt(PIXELS_MOST / (width * height))) * share;
        width = Math.max(Math.round(width * fit), 2);
        height = Math.max(Math.round(height * fit), 2);
        return cameraOf(this.navigator.view, width, height);
    }

    middle()
    {
        const f = this.renderer.frame;
        return f ? this.renderer.pointAt(f.width / 2, f.height / 2) : null;
    }

    wake()
    {
        this.dirty = true;
        if (!this.running) {
            this.running = true;
            this.lastTime = 0;
            requestAnimationFrame(time => this.tick(time));
        }
    }

    tick(time)
    {
        const passed = this.lastTime ? time - this.lastTime : 16;
        this.lastTime = time;
        const {keys, turn, fast} = this.input.state(), nav = this.navigator;
        const moves = nav.update(Math.min(passed, 100) / 1000, keys, turn, fast);
        const changed = nav.changed;
        nav.changed = false;
        if (changed || moves)
            this.restSince = time;
        const rests = time - this.restSince > REFINE_AFTER && !this.input.dragging;
        if (changed || (this.dirty && !rests))
            this.drawFrame(rests || !this.refined && this.frames.length === 0 ? 0 : this.scale, passed);
        else if (rests && !this.refined)
            this.drawFrame(0, 0);
        else if (this.dirty)
            this.showState();
        this.dirty = false;
        if (rests && this.refined) {
            this.writeAddress();
            this.running = false;
            return;
        }
        requestAnimationFrame(next => this.tick(next));
    }

    drawFrame(scale, passed)
    {
        const full = this.windowCamera(1), started = performance.now();
        if (this.canvas.width !== full.width || this.canvas.height !== full.height)
            Object.assign(this.canvas, {width: full.width, height: full.height});
        const camera = scale ? this.windowCamera(SCALES[scale]) : full;
        this.rankPhotos(full);
        this.renderer.draw(camera, this.layer);
        this.renderer.show(this.layer);
        this.refined = scale === 0;
        this.adapt(passed, performance.now() - started);
        this.showState();
    }

    // While moving, frames follow one another as fast as they are drawn.
    adapt(passed, own)
    {
        if (passed > 0 && passed < 2000) {
            this.frames.push(Math.max(passed, own));
            this.frames = this.frames.slice(-8);
        }
        if (this.frames.length < 4)
            return;
        const mean = this.frames.reduce((a, b) => a + b) / this.frames.length;
        this.frameMs = mean;
        const step = mean > FRAME_LONG ? 1 : mean < FRAME_SHORT ? -1 : 0;
        const next = clamp(this.scale + step, 0, SCALES.length - 1);
        if (next !== this.scale)
            this.frames = [];
        this.scale = next;
    }

    // --- what is said about it ---

    showState()
    {
        const nav = this.navigator, renderer = this.renderer, ready = renderer.photos.ready.length;
        this.tools.update();
        this.map.draw();
        this.thumbs.mark(nav.at);
        this.compare.update(nav.at, nav.view);
        byId("place").textContent = nav.at ? text.atPhoto(nav.at.number + 1, this.photos.length, nav.at.name) : "";
        showHint(this.compare.on && !nav.at && !nav.flying ? text.standAtPhoto : nav.farOut ? text.farOut : "");
        showProgress(this.complete ? 1 : Math.min(this.files.bytes / this.allBytes, 0.99));
        if (this.shouldShowPicture())
            byId("poster").classList.add("away");
        if (byId("panel").hidden)
            return;
        const f = renderer.frame;
        this.panel.show({
            frame: this.frameMs ? text.milliseconds(this.frameMs) : "–", size: text.size(f.width, f.height),
            points: `${renderer.drawn} / ${this.cloud.loaded}`,
            photos: text.ofLoaded(renderer.used, ready, this.photos.length),
            loaded: text.bytes(this.files.bytes, this.allBytes),
            memory: text.memory(this.device.bytes + this.cloud.bytes), device: this.device.name,
        });
    }

    // The poster is the start view: it stays until the picture is as good, or the viewer moves on.
    shouldShowPicture()
    {
        const start = this.navigator.at && this.navigator.at.number === this.manifest.start;
        return !start || this.rank.slice(0, 3).every(p => p.slot >= 0);
    }

    placePoster()
    {
        const poster = byId("poster"), frame = this.navigator.home.frame;
        const h = frameHeight(frame, window.innerWidth, window.innerHeight);
        Object.assign(poster.style, {height: `${h}px`, width: `${h / POSTER_SHARE}px`});
        if (!this.navigator.at || this.navigator.at.number !== this.manifest.start)
            poster.classList.add("away");
    }
}

function totalBytes(manifest)
{
    const photos = manifest.photos.reduce((sum, p) => sum + p.picture.bytes + p.depth.bytes, 0);
    return photos + manifest.points.files.reduce((sum, f) => sum + f.bytes, 0);
}

async function start()
{
    const fail = error => showHint(text.failed(error.message), true);
    window.addEventListener("error", event => fail(event.error || event));
    window.addEventListener("unhandledrejection", event => fail(event.reason));
    showProgress(0.02);
    const files = new Files(error => {
        console.error(error);
        fail(error);
    });
    const poster = byId("poster");
    if (files.embedded)
        poster.src = await files.address("poster.jpg");
    const manifest = await files.json("manifest.json");
    const [sources, coarse] = await Promise.all([loadShaders(files), files.get(manifest.points.coarse.file)]);
    window.oriel = new Walk(files, manifest, sources, coarse);
}

start().catch(error => {
    console.error(error);
    showHint(text.failed(error.message), true);
});
