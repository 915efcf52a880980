// A frame: depth from points, then colour from photographs. What each pass does is said in its
// shader; the same passes, by compute shaders, make Oriel's own frames (src/render).
import {distance, dot, rotate, scale, sub} from "./math.js";
import {PhotoStore} from "./photos.js";
import {coarseLevel, Soft} from "./soft.js";
import {unproject} from "./view.js";

const TILE = 16;           // pixels that share a list of photographs
const OWN_PLACE = 0.1;     // of the scene's distance, around a photograph's place
const LEVELS_MAX = 9;     // of the surfel pyramid
export const LAYERS = ["color", "depth", "normal", "coverage", "source", "points"];
export const TONES = ["srgb", "reinhard", "filmic"]; // as show.frag numbers them
const POINTS_LAYER = LAYERS.indexOf("points");

// planes: depths that are tried where the depth is guessed
function makePrograms(device, sources, manifest, planes)
{
    const screen = (file, defines) => device.program(sources, "screen.vert", file, defines);
    const late = (file, defines, vertex = "screen.vert") => { // the first picture does without
        let made = null;
        return () => made ||= device.program(sources, vertex, file, defines);
    };
    const reads = manifest.radiance && {RADIANCE: 1};
    const asks = {TILE, KEPT: Math.round(manifest.options.photos_per_pixel), ...reads,
                  ...(manifest.backdrop === "rests" && {RESTS: 1})};
    const tries = {TILE, ...reads, PLANES: planes, TEXELS: costTexels(planes)};
    return {
        splats: device.program(sources, "points.vert", "splats.frag"),
        layer: device.program(sources, "points.vert", "layer.frag", {LAYER: 1}),
        pullFinest: screen("pull.frag", {FINEST: 1}), pull: screen("pull.frag"),
        push: screen("push.frag"), pushLast: screen("push.frag", {LAST: 1}), support: screen("support.frag"),
        seedDepth: screen("fill_seed_depth.frag"),
        fillPull: screen("fill_pull.frag"), fillPush: screen("fill_push.frag"), fillDepth: screen("fill_depth.frag"),
        depthUnpack: screen("depth_unpack.frag"),
        choose: screen("choose.frag", asks), gather: screen("gather.frag", asks),
        seedColor: screen("seed_color.frag"), compose: screen("compose.frag"),
        show: screen("show.frag", {FLIP: 1}), capture: late("show.frag"), radianceUnpack: late("radiance_unpack.frag"),
        gatherSharp: late("gather.frag", {...asks, BICUBIC: 1, ...(manifest.soft && {SOFT: 1})}),
        soft: late("soft.frag", {}, "soft.vert"), keep: late("keep.frag"),
        keepSrgb: late("keep.frag", {SRGB: 1}), keepLuma: late("keep.frag", {LUMA: 1}),
        specks: late("specks.frag"), softCompare: late("soft_compare.frag"), softMix: late("soft_mix.frag"),
        guessCost: late("guess_cost.frag", tries), guessPick: late("guess_pick.frag", tries),
        guessApply: late("guess_apply.frag"),
    };
}

// The numbers of shaders/shared/constants.h, by name.
const constants = sources => Object.fromEntries(
    [...sources["shared/constants.h"].matchAll(/^#define (\w+) ([\d.]+)/gm)].map(found => [found[1], Number(found[2])]));
const half = side => (side + 1) >> 1;
const costTexels = planes => Math.ceil(planes / 4); // of a cell

// Pixels of a cell's side, as src/render/paint/guess.c has it. cells: along the longer side, at least
function cellSide(width, height, cells)
{
    let side = 2;
    while (2 * cells * side <= Math.max(width, height))
        side *= 2;
    return side;
}

// Everything that depends on the frame's size.
class Frame {
    // cells: of guesses, as cellSide has it
    constructor(device, width, height, planes, cells)
    {
        Object.assign(this, {device, width, height, targets: [], mipmapped: []});
        this.level0 = this.make(width, height, ["RGBA32F", "R32UI", "RGBA8"], {depth: true});
        this.layer = this.make(width, height, ["RG16F"]);
        const surfels = this.pyramid(["RGBA32F", "RG32UI"], LEVELS_MAX - 1); // above level0
        this.pulled = [null, ...surfels.pulled];
        this.pushed = [null, ...surfels.pushed];
        this.pushedLast = this.make(width, height, ["R32F", "RGBA8"]); // before outliers are dropped
        this.surface = this.make(width, height, ["R32F", "RGBA8"]);
        this.depth = this.make(width, height, ["R32F"]);
        this.fillDepth = this.pyramid(["RGBA32F"]); // floats: sums of a whole picture exceed what half floats hold
        this.fillColor = this.pyramid(["RGBA32F"]);
        this.tiles = this.make(Math.ceil(width / TILE), Math.ceil(height / TILE), ["RG32UI"]);
        if (planes > 1) {
            this.cell = cellSide(width, height, cells);
            const across = Math.ceil(width / this.cell), down = Math.ceil(height / this.cell);
            this.costs = this.make(across * costTexels(planes), down, ["RGBA32F"]);
            this.picked = this.make(across, down, ["R32F"]);
            this.moved = this.make(width, height, ["R32F"]);
        }
        this.painted = this.make(width, height, ["RGBA16F", "RGBA8"]);
        const w = half(width), h = half(height);
        this.guesses = this.withLevels("RGBA16F", w, h);
        this.seeds = this.make(w, h, [this.fillColor.pulled[0].textures[0], this.guesses]);
        this.composed = this.make(width, height, ["RGBA16F"]);
    }

    // A target that is released with the frame.
    make(...args)
    {
        this.targets.push(this.device.target(...args));
        return this.targets.at(-1);
    }

    // The picture without specks, for views at rest.
    get kept() { return this.keptTarget ||= this.make(this.width, this.height, ["RGBA16F"]); }

    withLevels(format, width, height)
    {
        const levels = 1 + Math.floor(Math.log2(Math.max(width, height)));
        this.mipmapped.push(this.device.texture(format, width, height, {levels}));
        return this.mipmapped.at(-1);
    }

    // For soft splats: what they show, how far that differs from photographs, and the corrected picture, which takes the
    // place of what was painted.
    get soft()
    {
        if (!this.softTargets) {
            const make = texture => this.make(this.width, this.height, [texture]);
            this.softTargets = {blended: make(this.withLevels("RGBA16F", this.width, this.height)),
                                differs: make(this.withLevels("R16F", this.width, this.height)),
                                mixed: make(this.painted.textures[0])};
        }
        return this.softTargets;
    }

    // From half the frame's size to a single pixel, or for so many levels.
    pyramid(formats, levels = Infinity)
    {
        const pulled = [], pushed = [];
        for (let w = half(this.width), h = half(this.height); pulled.length < levels; w = half(w), h = half(h)) {
            pulled.push(this.make(w, h, formats));
            pushed.push(this.make(w, h, formats));
            if (w === 1 && h === 1)
                break;
        }
        return {pulled, pushed};
    }

    release()
    {
        this.targets.forEach(target => this.device.releaseTarget(target));
        this.device.release(...this.mipmapped);
    }
}

export class Renderer {
    constructor(device, sources, manifest, photos, cloud, photoBytes)
    {
        Object.assign(this, {device, manifest});
        this.clouds = [cloud]; // and what moves, where something does
        this.planes = manifest.radiance ? 0 : Math.round(manifest.options.guess_depths);
        this.shared = constants(sources);
        this.programs = makePrograms(device, sources, manifest, this.planes);
        this.focal = photos.reduce((sum, photo) => sum + photo.fx, 0) / photos.length;
        this.photos = new PhotoStore(device, this.programs, photos, this.shared.ORL_PHOTOS_PER_FRAME, photoBytes,
                                     manifest.radiance);
        this.soft = null; // splats, once they are loaded
        this.frame = null;
        this.exposure = 1; // factor on light
        this.tone = 0; // of TONES
        this.used = 0; // photographs of the last frame
        this.drawn = 0; // points
    }

    resize(width, height)
    {
        if (this.frame?.width === width && this.frame.height === height)
            return;
        this.frame?.release();
        this.frame = new Frame(this.device, width, height, this.planes, this.shared.ORL_GUESS_CELLS);
    }

    // Everything but showing it. `layer`: one of LAYERS; whole: as show() has it
    draw(camera, layer, whole)
    {
        this.resize(camera.width, camera.height);
        const o = this.manifest.options, f = this.frame;
        this.camera = camera;
        this.values = {footprint: Math.max(this.focal / camera.fx, 1), // as orl_frame_footprint
                       view_focal: [camera.fx, camera.fy, camera.cx, camera.cy],
                       front_layer: o.front_layer, typical: this.manifest.distance,
                       near: this.manifest.near || 0,
                       min_inverse: 1 / (this.shared.ORL_GUESS_FARTHEST * this.manifest.distance),
                       ground: this.groundAlongRays(camera)};
        this.splat(camera, o);
        this.pullPush();
        const pointsOnly = layer === POINTS_LAYER || this.photos.ready.length === 0;
        this.fillIn(f.fillDepth, this.programs.seedDepth, {...this.values, known: f.surface.textures[0], normals: f.surface.textures[1]},
                    f.fillDepth.pulled[0], true);
        this.device.pass(this.programs.fillDepth, f.depth,
                         {...this.values, known: f.surface.textures[0], far: true,
                          filled: f.fillDepth.pushed[0].textures[0]});
        this.depth = f.depth;
        const photos = pointsOnly ? [] : this.gather(camera, o, whole);
        this.used = photos.length;
        this.compose(pointsOnly);
        if (whole && this.soft && photos.length && photos.every(photo => photo.hasSoft))
            this.correct(camera, o, photos);
        if (whole && photos.length && !this.manifest.radiance)
            this.removeSpecks();
    }

    addSoft(data) { this.soft = new Soft(this.device, data, this.manifest.soft.pixel); }

    groundAlongRays(camera)
    {
        const ground = this.manifest.ground;
        if (!ground)
            return [0, 0, 0, 0];
        const normal = ground.plane.slice(0, 3), height = dot(normal, camera.eye) + ground.plane[3];
        if (!(height > 0))
            return [0, 0, 0, 0];
        return [...scale(rotate(camera.r, normal), -1 / height), 1 / (this.shared.ORL_GROUND_REACH * ground.height)];
    }

    splat(camera, options)
    {
        const gl = this.device.gl, f = this.frame;
        const lists = this.clouds.map(cloud => ({cloud, list: cloud.visible(camera)}));
        this.drawn = lists.reduce((sum, {list}) => list.reduce((part, cell) => part + cell.loaded, sum), 0);
        const common = {...this.values, rotation: camera.r, size: [camera.width, camera.height],
                        cell_low: [0, 0, 0], cell_step: 1, radius_scale: 1};
        gl.enable(gl.DEPTH_TEST);
        gl.depthFunc(gl.LESS);
        this.device.clear(f.level0);
        this.drawCells(this.programs.splats, f.level0, common, lists, options.splat_scale);
        gl.disable(gl.DEPTH_TEST);
        gl.enable(gl.BLEND);
        gl.blendFunc(gl.ONE, gl.ONE);
        this.device.clear(f.layer);
        this.drawCells(this.programs.layer, f.layer, {...common, nearest: f.level0.textures[0]}, lists,
                       options.splat_scale);
        gl.disable(gl.BLEND);
    }

    drawCells(program, target, common, lists, radiusScale)
    {
        const gl = this.device.gl, places = name => program.uniforms.get(name);
        this.device.begin(target);
        program.use(common);
        for (const {cloud, list} of lists) {
            gl.bindVertexArray(cloud.vertices);
            for (const cell of list) {
                program.set(places("cell_low"), sub(cell.low, this.camera.eye));
                program.set(places("cell_step"), cell.step);
                if (places("radius_scale"))
                    // Points that are there stand for those that are still loading.
                    program.set(places("radius_scale"), radiusScale * Math.sqrt(cell.count / cell.loaded));
                gl.drawArrays(gl.POINTS, cell.base, cell.loaded);
            }
        }
    }

    pullPush()
    {
        const {device, programs, frame: f, values} = this, top = f.pulled.length - 1;
        const level0 = {...values, splats: f.level0.textures[0], splat_normals: f.level0.textures[1],
                        layers: f.layer.textures[0]};
        const fine = t => ({fine_a: t.textures[0], fine_b: t.textures[1]});
        const coarse = t => ({coarse_a: t.textures[0], coarse_b: t.textures[1]});
        device.pass(programs.pullFinest, f.pulled[1], {...level0, level: 1});
        for (let i = 2; i <= top; i++)
            device.pass(programs.pull, f.pulled[i], {...level0, ...fine(f.pulled[i - 1]), level: i});
        let above = f.pulled[top];
        for (let i = top - 1; i >= 1; i--) {
            device.pass(programs.push, f.pushed[i],
                        {...level0, ...fine(f.pulled[i]), ...coarse(above), level: i});
            above = f.pushed[i];
        }
        const drops = this.values.front_layer > 0;
        device.pass(programs.pushLast, drops ? f.pushedLast : f.surface, {...level0, ...coarse(above)});
        if (drops) {
            const [pushed_depth, pushed_normal] = f.pushedLast.textures;
            device.pass(programs.support, f.surface, {pushed_depth, pushed_normal});
        }
    }

    // Gortler's pull and push from seeds: pyramid.pushed[0] is filled everywhere if anything is known.
    // far: as fill_finer.glsl has it
    fillIn(pyramid, seed, values, seeds, far)
    {
        const {device, programs} = this, {pulled, pushed} = pyramid, top = pulled.length - 1;
        device.pass(seed, seeds, values);
        for (let i = 1; i <= top; i++)
            device.pass(programs.fillPull, pulled[i], {far, fine: pulled[i - 1].textures[0]});
        let above = pulled[top].textures[0];
        for (let i = top - 1; i >= 0; i--) {
            device.pass(programs.fillPush, pushed[i], {far, fine: pulled[i].textures[0], coarse: above});
            above = pushed[i].textures[0];
        }
        if (top === 0)
            pyramid.pushed[0] = pulled[0];
    }

    // Photographs of radiance are merged of all, so that passing the place of one makes nothing flash up.
    awayFromPhotos(eye)
    {
        const near = Math.min(...this.photos.ready.map(photo => distance(photo.eye, eye)));
        return this.manifest.radiance ? Math.min(near / (OWN_PLACE * this.manifest.distance), 1) : 1;
    }

    gather(camera, o, whole)
    {
        const f = this.frame, store = this.photos, photos = store.describe(camera, this.values.typical);
        const values = {...this.values, photo_rows: store.rows, photo_color: store.color,
                        photo_depth: store.depth, slot_size: [store.width, store.height],
                        last_mip: store.levels - 1, border_px: this.shared.ORL_BORDER_PX, photos: photos.length,
                        blur_per_radian: o.guess_blur, away: this.awayFromPhotos(camera.eye),
                        outlier_severity: o.outliers > 0 ? 1 / (o.outliers * o.outliers) : 0,
                        view_depth: f.depth.textures[0], tiles: f.tiles.textures[0]};
        for (const [key, value] of Object.entries(o))
            values[`opt.${key}`] = value;
        this.device.pass(this.programs.choose, f.tiles, values);
        if (whole && this.planes > 1)
            this.moveGuesses(values);
        this.device.pass(whole ? this.programs.gatherSharp() : this.programs.gather, f.painted, values);
        return photos;
    }

    // Moves guesses to where photographs do not see past them, as src/render/paint/guess.c does.
    // values: of the gather, which then have the depth that is moved
    moveGuesses(values)
    {
        const {device, programs, frame: f} = this;
        values.CELL = f.cell;
        device.pass(programs.guessCost(), f.costs, values);
        device.pass(programs.guessPick(), f.picked, {costs: f.costs.textures[0]});
        device.pass(programs.guessApply(), f.moved, {...values, picked: f.picked.textures[0]});
        this.depth = f.moved;
        values.view_depth = f.moved.textures[0];
    }

    compose(pointsOnly)
    {
        const f = this.frame;
        const colors = {painted: f.painted.textures[0], splat_color: f.level0.textures[2],
                        normals: f.surface.textures[1], points_only: pointsOnly,
                        loading: this.photos.ready.length < this.photos.slots};
        this.fillIn(f.fillColor, this.programs.seedColor, colors, f.seeds, false);
        this.device.makeLevels(f.guesses);
        this.device.pass(this.programs.compose, f.composed,
                         {...colors, far: false, filled: f.fillColor.pushed[0].textures[0], guesses: f.guesses});
        this.finished = f.composed.textures[0];
    }

    removeSpecks()
    {
        const f = this.frame;
        this.device.pass(this.programs.specks(), f.kept, {composed: this.finished, source: f.painted.textures[1]});
        this.finished = f.kept.textures[0];
    }

    // By soft splats, as src/render/paint/soft_layer.c does.
    correct(camera, o, photos)
    {
        const f = this.frame, {blended, differs, mixed} = f.soft;
        const values = {mean_level: coarseLevel(camera, photos, this.shared.ORL_SOFT_COARSE),
                        correct_share: o.soft, mix_share: o.soft_mix,
                        blended: blended.textures[0], differs: differs.textures[0], source: f.painted.textures[1],
                        composed: this.finished};
        this.soft.draw(this.programs.soft(), blended, camera);
        this.device.makeLevels(values.blended);
        this.device.pass(this.programs.softCompare(), differs, values);
        this.device.makeLevels(values.differs);
        this.device.pass(this.programs.softMix(), mixed, values);
        this.finished = mixed.textures[0];
    }

    // The last frame onto a place of its size: the canvas, or {fbo, x, y, width, height}, whose first row is the lowest.
    // whole: with all that moving frames go without
    show(layer, whole, place = null, program = this.programs.show)
    {
        const f = this.frame;
        this.device.pass(program, place,
                         {corner: [place?.x || 0, place?.y || 0], composed: this.finished,
                          depth: this.depth.textures[0], normals: f.surface.textures[1], source: f.painted.textures[1],
                          layer: layer === POINTS_LAYER ? 0 : layer, typical: this.values.typical,
                          exposure: this.exposure, tone: this.tone,
                          footprint: this.values.footprint, antialiases: whole && !this.manifest.radiance});
    }

    // A frame of its own as RGBA bytes, top row first.
    capture(camera, layer)
    {
        const gl = this.device.gl, {width, height} = camera;
        this.draw(camera, layer, true);
        const target = this.device.target(width, height, ["RGBA8"]);
        this.show(layer, true, target, this.programs.capture());
        const bytes = new Uint8ClampedArray(4 * width * height);
        gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
        this.device.releaseTarget(target);
        return new ImageData(bytes, width, height);
    }

    // Depth of the last frame under a pixel of it, guesses too; 0: none.
    depthAt(x, y)
    {
        const gl = this.device.gl, f = this.frame, pixel = new Float32Array(4);
        if (!f || x < 0 || y < 0 || x >= f.width || y >= f.height)
            return 0;
        this.device.begin(this.depth);
        gl.readPixels(Math.floor(x), Math.floor(y), 1, 1, gl.RGBA, gl.FLOAT, pixel);
        return Math.abs(pixel[0]);
    }

    // What that pixel shows, in the world, no deeper than `most`; null: nothing.
    pointAt(x, y, most = Infinity)
    {
        const depth = Math.min(this.depthAt(x, y), most);
        return depth > 0 ? unproject(this.camera, x, y, depth) : null;
    }
}
