// The walk: loads the site, draws when something changes, and joins input, picture and tools.
import {Album} from "./album.js";
import {benchmark} from "./benchmark.js";
import {Files} from "./files.js";
import {hasHeadset, Headset} from "./headset.js";
import {NoDevice} from "./gl.js";
import {Input} from "./input.js";
import {LivePicture} from "./live.js";
import {LocalPicture} from "./local.js";
import {Map2d} from "./map.js";
import {clamp, cross, scale} from "./math.js";
import {MethodPanel} from "./methods.js";
import {TimeSteps} from "./time_steps.js";
import {Navigator} from "./navigation.js";
import {Notes} from "./notes.js";
import {Ruler} from "./ruler.js";
import {PathEditor} from "./path.js";
import {makePhotos} from "./photos.js";
import {language, text} from "./strings.js";
import {buildHelp, byId, Compare, fit, make, Panel, save, showHint, showPassing, showProblem, showProgress, Thumbs, Tools} from "./ui.js";
import {cameraOf, levelAxes, photoView, viewFromText, viewToText} from "./view.js";

const SCALES = [1, 0.75, 0.5, 0.35, 0.25]; // of the resolution, while moving
const FRAME_LONG = 38, FRAME_SHORT = 20;  // milliseconds: fewer pixels, more pixels. Screens show 60 frames a second.
const LIVE_LONG = 75, LIVE_SHORT = 40;    // the same of frames that come over the network
const REFINE_AFTER = 140;                 // milliseconds of rest
const RIGHT = ["path", "maker", "method", "ruler"]; // panels that share a place
const SHEETS = ["panel", ...RIGHT, "map", "note"]; // of which a narrow window shows one
const OVER = ["thumbs", "record", ...SHEETS]; // actions that open what ui=none hides
const NARROW = matchMedia("(max-width: 1099px)"); // as style.css has it
const POSTER_SHARE = 0.625;               // height to width: POSTER_* of site_photos.c

class Walk {
    constructor(files, manifest, photos)
    {
        this.files = files;
        this.manifest = manifest;
        this.canvas = byId("canvas");
        this.photos = photos;
        this.layer = 0;
        this.scale = 0;          // index into SCALES
        this.sharpMs = 0;        // that a frame at full resolution may take
        this.finest = 0;         // of SCALES that this movement may have
        this.frames = [];        // milliseconds of the last frames while moving
        this.dirty = true;
        this.restSince = 0;
        this.refined = false;
        this.lastTime = 0;
        this.navigator = new Navigator(manifest, this.photos, {
            calm: matchMedia("(prefers-reduced-motion: reduce)").matches,
            pivotAt: () => this.picture.middle(),
        });
        this.running = false;
        this.headset = null;
        this.onFrame = null; // told that a frame has been drawn, or has come
        this.ev = 0; // exposure, stops
        this.asked = Object.fromEntries(new URLSearchParams(location.search)); // by whoever made the link
    }

    get bare() { return this.asked.ui === "none"; }

    // The picture can be drawn from now on.
    begin(picture)
    {
        this.picture = picture;
        this.navigator.wake = () => this.wake();
        this.server = picture.remote ? picture : null;
        this.own = picture.remote ? null : picture; // drawn by this browser
        this.timeSteps = this.manifest.time_steps > 1 && !this.manifest.follows && (picture.remote || picture.moving)
            ? new TimeSteps(this.manifest.time_steps, byId("time-steps"), () => this.change(() => {})) : null;
        picture.timeSteps = this.timeSteps;
        this.buildTools();
        this.readAddress();
        this.resized();
        this.scale = picture.remote ? 0 : SCALES.length - 1; // until a frame has told
        byId("over").classList.toggle("bare", this.bare);
        window.addEventListener("hashchange", () => this.readAddress());
        window.addEventListener("resize", () => this.resized());
        this.watchPixels();
        NARROW.addEventListener("change", () => this.reveal(SHEETS.find(id => !byId(id).hidden)));
        this.canvas.ariaLabel = text.canvas;
        this.wake();
        if (this.own)
            this.offerHeadset();
    }

    async offerHeadset()
    {
        if (!await hasHeadset())
            return;
        const headset = new Headset(this.own, this.manifest, this.navigator.up, stood => this.leftHeadset(stood));
        const run = () => headset.on ? headset.leave() : headset.enter(this.navigator.view, this.layer, this.sharpMs)
            .catch(error => showPassing(text.failed(error.message)));
        this.headset = headset;
        this.tools.add("headset", {key: "v", run, pressed: () => headset.on});
        this.tools.fit();
        this.input.actions.set("v", run);
    }

    // The walk goes on where its wearer stood, with a level horizon.
    leftHeadset(stood)
    {
        const nav = this.navigator;
        if (stood) {
            const [, up, ahead] = levelAxes(stood, nav.up);
            nav.setView({...nav.view, eye: stood.eye, r: [...cross(ahead, up), ...scale(up, -1), ...ahead]});
        }
        this.change(() => {});
    }

    resized()
    {
        fit(byId("poster"), this.navigator.home.frame, 1 / POSTER_SHARE);
        this.tools.fit();
        this.change(() => {});
    }

    // A window that goes to another screen may keep its size, but not the size of its pixels.
    watchPixels()
    {
        const same = matchMedia(`(resolution: ${window.devicePixelRatio}dppx)`);
        same.addEventListener("change", () => {
            this.resized();
            this.watchPixels();
        }, {once: true});
    }

    // Opens a picture on a canvas. Its changes count while it is the one that shows.
    static async open(walk, canvas, files, manifest, photos)
    {
        const kind = manifest.live ? LivePicture : LocalPicture;
        let picture = null;
        picture = await kind.open(canvas, files, manifest, photos, took => {
            if (walk.picture === picture)
                walk.changed(took);
        });
        return picture;
    }

    // Something came that makes the picture better; took: milliseconds, of a frame that has come.
    changed(took)
    {
        if (took !== undefined) {
            this.timeSteps?.measured(took);
            this.adapt(took, 0);
            this.onFrame?.();
        } else {
            this.refined = false;
            this.restSince = performance.now(); // more may be coming
        }
        this.wake();
    }

    // --- tools ---

    buildTools()
    {
        const nav = this.navigator, {tour, notes = []} = this.manifest.walk;
        const toggle = id => () => this.toggle(id);
        const shown = id => () => !byId(id).hidden;
        const edits = Boolean(this.manifest.edits);
        const mode = name => ({run: () => nav.setMode(name), pressed: () => nav.mode === name});
        this.thumbs = new Thumbs(this.photos, this.files, photo => nav.goTo(photo));
        const actions = {
            home: {key: "h", run: () => nav.goHome()},
            // Where Dvorak has comma and full stop, there are two of the keys that move.
            previous: {key: ",", also: "pageup", run: () => nav.browse(-1)},
            next: {key: ".", also: "pagedown", run: () => nav.browse(1)},
            snap: {key: "p", run: () => nav.snap()},
            ...Object.fromEntries(nav.modes.map((name, i) => [name, {key: String(i + 1), ...mode(name)}])),
            layer: {key: "l", run: () => this.setLayer((this.layer + 1) % this.picture.layers.length)},
            compare: {key: "c", run: () => this.toggleCompare(), pressed: () => this.compare.on},
            thumbs: {key: "t", pressed: shown("thumbs"), run: () => {
                toggle("thumbs")();
                this.thumbs.open();
            }},
            map: {key: "m", run: toggle("map"), pressed: shown("map")},
            panel: {key: "i", pressed: shown("panel"), run: () => {
                if (this.server)
                    this.server.measures = byId("panel").hidden;
                this.refined = false;
                toggle("panel")();
            }},
            path: {key: "k", run: toggle("path"), pressed: shown("path")},
            record: {key: "r", run: () => {
                this.path.add();
                this.reveal("path");
            }},
            ...(tour || notes.length > 1 ? {tour: {key: "g", run: () => this.notes.toggleTour(), pressed: () => this.notes.touring}} : {}),
            ...(this.manifest.walk.unit_m || edits ? {ruler: {key: "u", run: toggle("ruler"), pressed: shown("ruler")}} : {}),
            ...(edits ? {maker: {key: "n", run: toggle("maker"), pressed: shown("maker")}} : {}),
            ...(this.manifest.methods ? {method: {key: "o", pressed: shown("method"), run: () => {
                if (this.picture.remote)
                    toggle("method")();
            }}} : {}),
            screenshot: {key: "x", run: () => this.saveScreenshot()},
            ...(document.fullscreenEnabled ? {full: {key: "f", run: () => this.toggleFull(),
                                                     pressed: () => Boolean(document.fullscreenElement)}} : {}),
            help: {key: "?", run: () => help.show()},
        };
        for (const id of this.bare ? OVER : [])
            delete actions[id];
        const help = buildHelp(key => Object.values(actions).some(action => action.key === key));
        this.tools = new Tools(actions, () => this.wake());
        this.compare = new Compare(this.files, this.manifest.radiance);
        this.panel = new Panel({layers: this.picture.layers, layer: this.layer, tones: this.manifest.tones ||
                                    this.picture.tones.map(name => ({name, description: text.tones[name]})),
                                onLayer: layer => this.setLayer(layer),
                                onExposure: ev => this.change(() => this.setExposure(ev)),
                                onTone: name => this.change(() => this.picture.setTone(name)),
                                onDrawer: this.server && !this.manifest.follows ? id => this.drawBy(id) : null,
                                onBenchmark: () => this.measure()});
        if (this.manifest.methods)
            this.makeMethods();
        this.makePath(edits);
        this.notes = new Notes(nav, this.manifest.walk, {
            canvas: this.canvas, wake: () => this.wake(), seen: point => this.picture.seen.get(point),
            reveal: () => this.reveal("note"), route: this.manifest.walk.tour ? this.path : null,
            pick: (x, y) => this.pick(x, y), save: edits ? settings => this.server.save(settings) : null,
        });
        this.ruler = new Ruler(this.manifest.walk.unit_m || 0, {
            wake: () => this.wake(), pick: (x, y) => this.pick(x, y),
            save: edits ? unit => this.notes.change({unit_m: unit}) : null,
        });
        byId("attribution").textContent = this.manifest.walk.attribution || "";
        this.map = new Map2d(nav, this.picture, photo => nav.goTo(photo));
        this.input = new Input(this.canvas, nav, {
            focal: () => this.windowCamera(1).fx, wake: () => this.wake(),
            actions: new Map([["escape", () => this.closeTop()],
                              ...Object.values(actions).flatMap(a => [a.key, a.also].map(key => [key, a.run]))]),
            holdsWheel: () => this.holdsWheel(), onWheelLeft: () => showPassing(text.clickFirst),
            onTap: (x, y) => (this.ruler.on ? this.ruler : this.notes).tap(x, y), onTwice: (x, y) => this.goThere(x, y),
        });
        document.addEventListener("fullscreenchange", () => this.wake());
    }

    // --- panels ---

    toggle(id)
    {
        if (byId(id).hidden)
            this.reveal(id);
        else
            byId(id).hidden = true;
        this.wake();
    }

    // Shows a panel, in the place of those that it shares its place with.
    reveal(id)
    {
        const crowd = NARROW.matches ? SHEETS : RIGHT;
        for (const other of crowd.includes(id) ? crowd : [])
            byId(other).hidden = other !== id;
        if (id)
            byId(id).hidden = false;
        this.wake();
    }

    // Of what is open, that which has the focus, else the last of it.
    closeTop()
    {
        const open = ["thumbs", ...SHEETS].filter(id => !byId(id).hidden);
        const id = open.find(one => byId(one).contains(document.activeElement)) || open.pop();
        if (this.notes.placing)
            this.notes.stopPlacing();
        else if (id === "note")
            this.notes.close();
        else if (id)
            this.toggle(id);
        if (id !== "note")
            this.canvas.focus();
    }

    // --- what the pointer does ---

    // Within another page the wheel scrolls that page until the walk has the focus, unless the address
    // says otherwise.
    holdsWheel()
    {
        const {wheel} = this.asked;
        return wheel === "walk" || (wheel !== "page" && (window.top === window || document.hasFocus()));
    }

    // To what a place of the window shows.
    async goThere(x, y)
    {
        const point = await this.pick(x, y);
        if (point)
            this.navigator.approach(point);
        else
            showPassing(text.nothingThere);
    }

    makePath(edits)
    {
        this.path = new PathEditor(this.navigator, {
            name: () => this.manifest.title,
            tour: this.manifest.walk.tour, onTour: view => this.notes.pass(view),
            keep: edits ? tour => this.notes.change({tour}) : null,
            render: edits ? (path, format) => this.server.render(path, format) : null,
        });
        if (edits)
            this.server.onRendering = state => this.path.showRendering(state);
    }

    // The point of a surface under a place of the window, CSS pixels; null: there is none.
    pick(x, y)
    {
        const camera = this.windowCamera(1), s = camera.width / window.innerWidth;
        return this.picture.pick(camera, x * s, y * s);
    }

    makeMethods()
    {
        this.methods = new MethodPanel(this.manifest.methods, (name, settings) => this.server.choose(name, settings));
        this.server.onMethod = (choice, problem) => this.change(() => this.methods.told(choice, problem));
    }

    setExposure(ev)
    {
        this.ev = ev;
        this.picture.setExposure(ev);
        this.compare.setExposure(ev);
    }

    // --- who draws ---

    // Of a page with a server: "server", or "browser" as a visitor of the published page sees it.
    async drawBy(id)
    {
        this.drawer = id;
        try {
            if (id === "browser")
                this.own = await (this.opening ||= this.openOwn());
            if (this.drawer === id)
                this.show(id === "browser" ? this.own : this.server);
        } catch (error) {
            this.opening = null;
            this.panel.showDrawer("server", text.failed(error.message));
        }
    }

    // The published site's renderer, on a canvas above the server's, which keeps the pointer.
    async openOwn()
    {
        await this.server.prepareSite((done, total) => {
            if (this.drawer === "browser")
                this.panel.showDrawer("", text.preparing(done, total));
        });
        const files = new Files(this.files.onError, "site/"), manifest = await files.json("manifest.json");
        const canvas = make("canvas", {id: "own", hidden: true});
        canvas.ariaHidden = true;
        this.canvas.after(canvas);
        try {
            return await Walk.open(this, canvas, files, manifest, makePhotos(manifest));
        } catch (error) {
            canvas.remove();
            throw error;
        }
    }

    show(picture)
    {
        const name = this.picture.layers[this.layer];
        this.picture = picture;
        picture.timeSteps = this.timeSteps;
        this.layer = Math.max(picture.layers.indexOf(name), 0);
        this.panel.setLayers(picture.layers, this.layer);
        this.panel.showDrawer(picture.remote ? "server" : "browser", "");
        if (this.own)
            this.own.canvas.hidden = picture.remote;
        if (this.manifest.methods) {
            byId("tool-method").disabled = !picture.remote;
            byId("method").hidden ||= !picture.remote;
        }
        this.frames = [];
        this.scale = this.firstScale();
        this.change(() => picture.setExposure(this.ev));
    }

    // Something that makes the picture another one.
    change(what)
    {
        what();
        this.refined = false;
        this.wake();
    }

    async measure()
    {
        this.panel.bench.disabled = true;
        showPassing(text.measuring);
        save(`${this.manifest.title}.benchmark.json`, await benchmark(this));
        this.panel.bench.disabled = false;
    }

    setLayer(layer)
    {
        this.layer = layer;
        this.change(() => this.panel.setLayer(layer));
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
        (document.fullscreenElement ? document.exitFullscreen() : document.documentElement.requestFullscreen())
            .catch(error => showPassing(text.failed(error.message)));
    }

    async saveScreenshot()
    {
        const canvas = await this.picture.capture(this.windowCamera(1), this.layer);
        canvas.toBlob(blob => save(`${this.manifest.title}.png`, blob));
        this.change(() => {});
    }

    // --- the address ---

    // What follows the # is this visitor's view; what stands before it is said by who made the link.
    readAddress()
    {
        const parts = new URLSearchParams(location.hash.slice(1)), nav = this.navigator;
        const photo = this.photoOf(parts.get("p")) || (parts.has("v") ? null : this.photoOf(this.asked.start));
        const view = parts.has("v") ? viewFromText(parts.get("v"), nav.home) : null;
        const mode = parts.get("mode") || this.asked.mode;
        if (photo)
            nav.setView(photoView(photo), photo);
        else if (view)
            nav.setView(view);
        nav.setMode(nav.modes.includes(mode) ? mode : nav.mode);
    }

    // By number from 1, or by name, with its extension or without.
    photoOf(said)
    {
        return this.photos[Number(said) - 1] ||
               this.photos.find(({name}) => name === said || name.replace(/\.[^.]*$/, "") === said);
    }

    writeAddress()
    {
        const nav = this.navigator, parts = new URLSearchParams();
        if (nav.at)
            parts.set("p", nav.at.number + 1);
        else
            parts.set("v", viewToText(nav.view));
        if (nav.mode !== nav.homeMode)
            parts.set("mode", nav.mode);
        const hash = `#${parts.toString().replaceAll("%2C", ",")}`;
        try {
            if (hash !== location.hash)
                history.replaceState(null, "", hash);
        } catch {} // Safari takes a hundred in half a minute; the next rest tries again
    }

    // --- frames ---

    windowCamera(share)
    {
        const ratio = window.devicePixelRatio || 1;
        let width = window.innerWidth * ratio, height = window.innerHeight * ratio;
        const {pixelsMost, sides: [least, most]} = this.picture;
        const fit = Math.min(1, Math.sqrt(pixelsMost / (width * height)), most / Math.max(width, height)) * share;
        width = Math.max(Math.round(width * fit), least);
        height = Math.max(Math.round(height * fit), least);
        return cameraOf(this.navigator.view, width, height);
    }

    wake()
    {
        this.dirty = true;
        if (!this.running) {
            this.running = true;
            this.lastTime = 0;
            requestAnimationFrame(time => this.run(time));
        }
    }

    // Frame by frame until nothing changes any more, or something fails.
    run(time)
    {
        let more = false;
        try {
            more = this.tick(time);
        } finally {
            this.running = more;
        }
        if (more)
            requestAnimationFrame(next => this.run(next));
    }

    // A frame, if one is due. Returns whether another one follows.
    tick(time)
    {
        if (this.headset?.on)
            return false;
        const passed = this.lastTime ? time - this.lastTime : 16;
        this.lastTime = time;
        const {keys, turn, fast} = this.input.state(), nav = this.navigator;
        const moves = nav.update(Math.min(passed, 100) / 1000, keys, turn, fast);
        if (this.picture.awaits && !this.shouldShowPicture()) {
            this.showState();
            return false;
        }
        const plays = this.timeSteps?.playing;
        if (plays)
            this.timeSteps.advance();
        const changed = nav.changed || plays || this.manifest.follows; // what is seen changes by itself
        nav.changed = false;
        if (changed || moves)
            this.restSince = time;
        const rests = time - this.restSince > this.refineAfter && !this.input.dragging;
        if (changed || (this.dirty && !rests)) {
            this.drawFrame(rests ? 0 : this.scale, passed);
        } else if (rests && !this.refined) {
            this.finest = 0;
            this.drawFrame(0, 0);
        } else if (this.dirty) {
            this.showState();
        }
        this.dirty = false;
        if (rests && this.refined) {
            this.writeAddress();
            return false;
        }
        return true;
    }

    // Of frames that a device can keep up with, told by the coarsest.
    firstScale()
    {
        if (this.picture.remote)
            return 0;
        const coarsest = SCALES.length - 1;
        this.sharpMs = this.picture.timeOf(this.windowCamera(SCALES[coarsest])) / SCALES[coarsest] ** 2;
        const fits = SCALES.findIndex(scale => this.sharpMs * scale ** 2 < FRAME_LONG);
        return fits < 0 ? coarsest : fits;
    }

    // A sharp frame holds up what is loading. It waits as long as it takes for more to come.
    get refineAfter() { return Math.max(REFINE_AFTER, this.picture.complete ? 0 : this.sharpMs); }

    drawFrame(scale, passed)
    {
        const full = this.windowCamera(1), started = performance.now();
        const camera = scale ? this.windowCamera(SCALES[scale]) : full;
        this.picture.points = this.notes.points;
        this.picture.draw(full, camera, this.layer);
        this.refined = scale === 0;
        if (!this.picture.remote) { // else frames tell when they come
            this.adapt(passed, performance.now() - started);
            this.onFrame?.();
        }
        this.showState();
    }

    // While moving, frames follow one another as fast as they are drawn.
    adapt(passed, own)
    {
        if (passed > 0 && passed < 2000)
            this.frames = [...this.frames, Math.max(passed, own)].slice(-8);
        if (this.frames.length < 4)
            return;
        const mean = this.frameMs = this.frames.reduce((a, b) => a + b) / this.frames.length;
        const [long, short] = this.picture.remote ? [LIVE_LONG, LIVE_SHORT] : [FRAME_LONG, FRAME_SHORT];
        const step = mean > long ? 1 : mean < short ? -1 : 0;
        const next = clamp(this.scale + step, Math.min(this.finest, this.scale), SCALES.length - 1);
        if (next !== this.scale)
            this.frames = [];
        if (next > this.scale)
            this.finest = next; // else it would go back and forth
        this.scale = next;
    }

    // --- what is said about it ---

    showState()
    {
        const nav = this.navigator;
        this.tools.update();
        this.map.draw();
        const camera = cameraOf(nav.view, window.innerWidth, window.innerHeight);
        this.notes.update(camera);
        this.ruler.update(camera);
        this.thumbs.mark(nav.at);
        this.compare.update(nav.at, nav.view);
        byId("place").textContent = nav.at ? text.atPhoto(nav.at.number + 1, this.photos.length, nav.at.name) : "";
        showHint(this.picture.problem || (this.compare.on && !nav.at && !nav.flying ? text.standAtPhoto
                                          : nav.farOut ? text.farOut : ""));
        showProgress(this.picture.loadedShare);
        const poster = byId("poster").classList;
        if (this.shouldShowPicture() && !poster.contains("away")) {
            poster.add("away");
            requestAnimationFrame(() => this.scale = this.firstScale()); // once this frame is seen
        }
        if (!byId("panel").hidden)
            this.panel.show({frame: this.frameMs ? text.milliseconds(this.frameMs) : "–",
                             ...this.picture.figures()}, this.picture.details);
    }

    // The poster is the start view: it stays until the picture is as good, or the viewer moves on.
    shouldShowPicture()
    {
        const start = this.navigator.view === this.navigator.home, gone = byId("poster").classList.contains("away");
        return gone || !start || this.picture.presentable;
    }
}

async function start()
{
    // The animation is no part of a saved copy: one that does not start says so.
    byId("unstarted").getAnimations().forEach(appearing => appearing.cancel());
    // Of a copy that was saved while it ran.
    for (const made of document.querySelectorAll("#over > :is([role], nav, section), #right > section, #marks, #help, #problem"))
        made.replaceChildren();
    document.documentElement.lang = language;
    const page = document.documentElement, hold = () => page.classList.toggle("held", document.hasFocus());
    page.classList.toggle("framed", window.top !== window);
    for (const kind of ["focus", "blur"])
        window.addEventListener(kind, hold);
    hold();
    const fail = error => showProblem(text.failed(error?.message || error));
    window.addEventListener("error", event => fail(event.error || event));
    window.addEventListener("unhandledrejection", event => fail(event.reason));
    showProgress(0.02);
    const files = new Files(error => {
        console.error(error);
        fail(error);
    });
    if (files.embedded)
        byId("poster").src = await files.address("poster.jpg");
    const manifest = await files.json("manifest.json");
    const photos = makePhotos(manifest), walk = new Walk(files, manifest, photos);
    try {
        walk.begin(await Walk.open(walk, walk.canvas, files, manifest, photos));
        window.oriel = walk;
    } catch (error) {
        if (!(error instanceof NoDevice))
            throw error;
        window.oriel = new Album(files, manifest, photos, text.album(error.message));
    }
}

start().catch(error => {
    console.error(error);
    showProblem(text.failed(error.message), true);
});
