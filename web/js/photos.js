// Photographs: which of them a view can use best, and those that are on the graphics chip.
import {clamp, distance, dot, rotate, row, sub} from "./math.js";
import {NoDevice} from "./gl.js";
import {text} from "./strings.js";
import {forwardOf, poseOf, project, unproject} from "./view.js";

export function makePhotos(manifest)
{
    return manifest.photos.map((p, number) =>
        ({...p, ...poseOf(p.cam_from_world), number, slot: -1, asked: false, hasSoft: false, lastUse: 0}));
}

// Of a published photograph.
export const filesOf = photo => [photo.picture, photo.depth];

// The values of a file as they are, which may be depth.
export const decodePicture = bytes =>
    createImageBitmap(new Blob([bytes]), {colorSpaceConversion: "none", premultiplyAlpha: "none"});

// --- choice, as src/render/photos/select.c makes it ---

const ACROSS = 5, DEPTHS = [0.4, 1, 4], PER_SAMPLE = 8;

function samplePoints(camera, typical)
{
    const points = [];
    for (const depth of DEPTHS)
        for (let i = 0; i < ACROSS * ACROSS; i++) {
            const u = (i % ACROSS + 0.5) * camera.width / ACROSS;
            const v = (Math.floor(i / ACROSS) + 0.5) * camera.height / ACROSS;
            points.push(unproject(camera, u, v, depth * typical));
        }
    return points;
}

// Inverse of the penalty; 0 where the photograph does not see the point.
function score(photo, eye, point)
{
    if (!project(photo, point))
        return 0;
    const u = sub(eye, point), v = sub(photo.eye, point), uu = dot(u, u), vv = dot(v, v);
    const angle = Math.acos(clamp(dot(u, v) / Math.sqrt(uu * vv), -1, 1));
    const coarser = Math.sqrt(vv / uu) - 1;
    return 1 / (angle + 0.1 * Math.max(coarser, 0) + 0.005);
}

// Marks the best few of one sample point.
function nameBest(candidates, scores)
{
    const best = []; // indices, best first
    scores.forEach((value, i) => {
        candidates[i].score += value;
        if (!(value > 0) || (best.length === PER_SAMPLE && !(value > scores[best[PER_SAMPLE - 1]])))
            return;
        let at = best.length;
        while (at > 0 && value > scores[best[at - 1]])
            at--;
        best.splice(at, 0, i);
        best.length = Math.min(best.length, PER_SAMPLE);
    });
    best.forEach(i => candidates[i].named = true);
}

// All photographs, the most useful first.
export function rankPhotos(photos, camera, typical)
{
    const candidates = photos.map(photo => ({photo, score: 0, named: false}));
    const scores = new Float64Array(photos.length);
    for (const point of samplePoints(camera, typical)) {
        photos.forEach((photo, i) => scores[i] = score(photo, camera.eye, point));
        nameBest(candidates, scores);
    }
    candidates.sort((a, b) => b.named - a.named || b.score - a.score || a.photo.number - b.photo.number);
    return candidates.map(c => c.photo);
}

export function nearestPhoto(photos, view)
{
    const forward = forwardOf(view);
    // A photograph that looks elsewhere counts as farther away.
    const apart = p => distance(p.eye, view.eye);
    const most = Math.max(...photos.map(apart), 1e-9);
    const cost = p => apart(p) / most + 0.5 * Math.acos(clamp(dot(forward, forwardOf(p)), -1, 1));
    return photos.reduce((best, p) => cost(p) < cost(best) ? p : best, photos[0]);
}

// --- on the graphics chip ---

const ROW_TEXELS = 9;
const NEAREST = 2 ** -8; // what a half float keeps a photograph's nearest depth as: files hold up to nine million times it

export class PhotoStore {
    // perFrame: photographs that one frame paints from; radiance: {peak, mu}, of photographs that are radiance;
    // undefined: they are sRGB
    constructor(device, programs, photos, perFrame, budgetBytes, radiance)
    {
        const gl = device.gl, largest = key => Math.max(...photos.map(p => key(p)));
        Object.assign(this, {device, programs, photos, perFrame, radiance});
        this.width = largest(p => p.width);
        this.height = largest(p => p.height);
        if (Math.max(this.width, this.height) > gl.getParameter(gl.MAX_TEXTURE_SIZE))
            throw new NoDevice(text.largePhotos);
        this.levels = 1 + Math.floor(Math.log2(Math.max(this.width, this.height)));
        const depthWidth = largest(p => p.depth.width), depthHeight = largest(p => p.depth.height);
        this.format = radiance ? "RGBA16F" : "RGBA8";
        const each = this.width * this.height * (radiance ? 8 : 4) * 4 / 3 + depthWidth * depthHeight * 2;
        const layers = gl.getParameter(gl.MAX_ARRAY_TEXTURE_LAYERS);
        this.slots = clamp(Math.floor(budgetBytes / each), 2, Math.min(photos.length, layers));
        this.color = device.texture(this.format, this.width, this.height,
                                    {levels: this.levels, layers: this.slots});
        this.depth = device.texture("R16F", depthWidth, depthHeight, {layers: this.slots});
        this.rows = device.texture("RGBA32F", ROW_TEXELS, perFrame);
        this.rowData = new Float32Array(4 * ROW_TEXELS * perFrame);
        this.fbo = gl.createFramebuffer();
        this.clock = 0;
    }

    get ready() { return this.photos.filter(p => p.slot >= 0); }

    freeSlot()
    {
        const {ready} = this;
        if (ready.length < this.slots) {
            const taken = new Set(ready.map(p => p.slot));
            return [...Array(this.slots).keys()].find(slot => !taken.has(slot));
        }
        const oldest = ready.reduce((a, b) => b.lastUse < a.lastUse ? b : a), {slot} = oldest;
        Object.assign(oldest, {slot: -1, asked: false});
        return slot;
    }

    // Both pictures are decoded: ImageBitmaps, closed here.
    add(photo, picture, depth)
    {
        const slot = photo.slot < 0 ? this.freeSlot() : photo.slot;
        this.writeColor(picture, slot);
        this.writeDepth(photo, depth, slot);
        picture.close();
        depth.close();
        photo.lastUse = ++this.clock;
        photo.slot = slot;
        photo.hasSoft = false;
    }

    // What soft splats show in a photograph, a decoded picture, closed here, becomes its alpha.
    addSoft(photo, picture)
    {
        const gl = this.device.gl;
        if (photo.slot >= 0) {
            const shown = this.device.texture("RGBA8", this.width, this.height, {levels: this.levels});
            this.device.write(shown, picture);
            this.device.makeLevels(shown);
            gl.colorMask(false, false, false, true);
            this.keepLevels(this.programs.keepLuma(), shown, photo.slot);
            gl.colorMask(true, true, true, true);
            this.device.release(shown);
            photo.hasSoft = true;
        }
        picture.close();
    }

    // Draws all levels of a texture into a photograph's layer.
    keepLevels(program, shown, slot)
    {
        const gl = this.device.gl;
        for (let level = 0; level < this.levels; level++) {
            gl.bindFramebuffer(gl.FRAMEBUFFER, this.fbo);
            gl.framebufferTextureLayer(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, this.color.id, level, slot);
            this.device.pass(program, {fbo: this.fbo, width: Math.max(this.width >> level, 1),
                                       height: Math.max(this.height >> level, 1)}, {shown, level});
        }
    }

    // A time step of these photographs, no more than there are slots, takes the place of all that is there. pictures: of
    // each, as add() takes them; entries: of all photographs in the manifest, which tell their depth
    replace(photos, entries, pictures)
    {
        for (const photo of this.ready)
            photo.slot = photos.includes(photo) ? photo.slot : -1;
        photos.forEach((photo, i) => {
            photo.depth = entries[photo.number].depth;
            this.add(photo, ...pictures[i]);
        });
    }

    // Mip levels are made in a texture of its own: of the array they would be made for all layers. Those of sRGB are
    // the means of light.
    writeColor(picture, slot)
    {
        const one = this.device.texture(this.radiance ? this.format : "SRGB8_ALPHA8", this.width, this.height,
                                        {levels: this.levels});
        if (this.radiance)
            this.unpackRadiance(picture, one);
        else
            this.device.write(one, picture);
        this.device.makeLevels(one);
        this.keepLevels(this.radiance ? this.programs.keep() : this.programs.keepSrgb(), one, slot);
        this.device.release(one);
    }

    unpackRadiance(picture, to)
    {
        const {device} = this, packed = device.texture("RGBA8", picture.width, picture.height);
        const target = device.target(picture.width, picture.height, [to]);
        device.write(packed, picture);
        device.pass(this.programs.radianceUnpack(), target, {packed_radiance: packed, ...this.radiance});
        device.releaseTarget(target);
        device.release(packed);
    }

    writeDepth(photo, depth, slot)
    {
        const gl = this.device.gl;
        const packed = this.device.texture("RGBA8", depth.width, depth.height);
        this.device.write(packed, depth);
        gl.bindFramebuffer(gl.FRAMEBUFFER, this.fbo);
        gl.framebufferTextureLayer(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, this.depth.id, 0, slot);
        this.device.pass(this.programs.depthUnpack, {fbo: this.fbo, width: depth.width, height: depth.height},
                         {packed_depth: packed, steps_per_fold: photo.depth.steps_per_fold, nearest: NEAREST});
        this.device.release(packed);
    }

    // What the gather passes are told of the photographs that this view is painted from, which it returns.
    describe(camera, typical)
    {
        const {ready, perFrame} = this;
        const chosen = ready.length <= perFrame ? ready
            : rankPhotos(ready, camera, typical).slice(0, perFrame).sort((a, b) => a.number - b.number);
        chosen.forEach((photo, i) => {
            photo.lastUse = ++this.clock;
            this.rowData.set(describePhoto(photo, camera), 4 * ROW_TEXELS * i);
        });
        this.device.write(this.rows, this.rowData);
        return chosen;
    }
}

// As struct photo of shaders/gather/photo.glsl.
function describePhoto(photo, camera)
{
    const {width, height, depth} = photo, offset = rotate(photo.r, sub(camera.eye, photo.eye));
    return [...[0, 1, 2].flatMap(i => [...rotate(camera.r, row(photo.r, i)), offset[i]]),
            ...rotate(camera.r, sub(photo.eye, camera.eye)), photo.slot,
            photo.fx, photo.fy, photo.cx, photo.cy,
            width, height, depth.width, depth.height,
            ...photo.gain, 0,
            ...photo.vignette, 4 / (width * width + height * height),
            photo.number, depth.nearest / NEAREST, 0, 0];
}
