// The walk in a headset, by WebXR: a frame for each eye, from where its wearer stands in the scene.
import {add, clamp, cross, rotate, rotateBack, rotation, scale, sub} from "./math.js";
import {levelAxes} from "./view.js";

const EYE_M = 1.6;        // above the ground
const SCENE_M = 5;        // from photographs to what they show, where nothing tells a size
const SPEED_M = 1.5;      // a second, by a stick
const TURN = Math.PI / 6; // at once by the other stick, since many feel sick where a view turns smoothly
const DEAD = 0.15, FAR = 0.7; // of a stick's way: means nothing, turns
const EYE_MS = 5;         // that the frame of an eye may take
const SHARE_MIN = 0.3;    // of the headset's own resolution, to each side

export async function hasHeadset()
{
    const policy = document.featurePolicy; // of the page around this one; asking against it is an error
    return Boolean(navigator.xr) && (!policy || policy.allowsFeature("xr-spatial-tracking")) &&
           navigator.xr.isSessionSupported("immersive-vr").catch(() => false);
}

// Scene units of a metre: told by the maker, by the height of who photographed, or guessed.
function unitsPerMetre({walk, ground, distance})
{
    return walk.unit_m ? 1 / walk.unit_m : ground ? ground.height / EYE_M : distance / SCENE_M;
}

// Of the camera of an eye, pixels.
function lensOf({projectionMatrix: p}, {width, height})
{
    return {width, height, fx: width * p[0] / 2, fy: height * p[5] / 2,
            cx: width / 2 * (1 - p[8]), cy: height / 2 * (1 + p[9])};
}

export class Headset {
    // picture: drawn by this browser; up: of the scene; onEnd({eye, r}): where its wearer stood; null: nowhere yet
    constructor(picture, manifest, up, onEnd)
    {
        Object.assign(this, {picture, up, onEnd, units: unitsPerMetre(manifest), session: null});
    }

    // view: where to stand, with a level horizon; layer: of LAYERS; sharpMs: that a frame of the window takes
    async enter(view, layer, sharpMs)
    {
        const {gl} = this.picture.device, session = await navigator.xr.requestSession("immersive-vr");
        Object.assign(this, {session, layer, last: 0, turned: false, stood: null, base: view.eye});
        const [, up, ahead] = levelAxes(view, this.up);
        this.axes = [...cross(ahead, up), ...up, ...scale(ahead, -1)]; // of the headset's space, in the scene
        session.addEventListener("end", () => {
            this.session = null;
            this.onEnd(this.stood);
        });
        try {
            await this.begin(gl, session, sharpMs);
        } catch (error) {
            await session.end(); // the walk goes on without
            throw error;
        }
    }

    async begin(gl, session, sharpMs)
    {
        await gl.makeXRCompatible();
        this.target = new XRWebGLLayer(session, gl, {
            alpha: false, antialias: false, depth: false,
            framebufferScaleFactor: clamp(Math.sqrt(EYE_MS / Math.max(sharpMs, 1)), SHARE_MIN, 1)});
        session.updateRenderState({baseLayer: this.target});
        this.space = await session.requestReferenceSpace("local");
        session.requestAnimationFrame((time, frame) => this.tick(time, frame));
    }

    get on() { return this.session !== null; }

    leave() { this.session.end(); }

    // Place and rotation in the scene.
    inScene({position, matrix: m})
    {
        const axes = [[m[0], m[1], m[2]], [-m[4], -m[5], -m[6]], [-m[8], -m[9], -m[10]]];
        return {eye: this.placeOf(position), r: axes.flatMap(axis => rotateBack(this.axes, axis))};
    }

    placeOf({x, y, z}) { return add(this.base, scale(rotateBack(this.axes, [x, y, z]), this.units)); }

    tick(time, frame)
    {
        this.session.requestAnimationFrame((next, other) => this.tick(next, other));
        const pose = frame.getViewerPose(this.space);
        if (!pose)
            return; // where the headset is is not known
        this.move(pose, this.last ? Math.min(time - this.last, 100) / 1000 : 0);
        this.last = time;
        this.stood = this.inScene(pose.transform);
        for (const view of pose.views) {
            const {x, y, width, height} = this.target.getViewport(view), part = {x, y, width, height};
            this.picture.drawEye({...this.inScene(view.transform), ...lensOf(view, part)}, this.layer,
                                 {fbo: this.target.framebuffer, ...part});
        }
    }

    // By the sticks: the left one moves to where the wearer looks, the right one turns around the wearer.
    move({transform}, seconds)
    {
        const live = x => Math.abs(x) > DEAD ? x : 0, m = transform.matrix;
        for (const {gamepad, handedness} of this.session.inputSources) {
            if (!gamepad || gamepad.axes.length < 4)
                continue;
            const [x, y] = gamepad.axes.slice(2).map(live);
            if (handedness === "right") {
                if (Math.abs(x) > FAR && !this.turned)
                    this.turn(transform.position, -Math.sign(x) * TURN);
                this.turned = Math.abs(x) > FAR;
            } else {
                const size = Math.hypot(m[8], m[10]) || 1, [ax, az] = [m[8] / size, m[10] / size];
                const way = [x * az + y * ax, 0, y * az - x * ax];
                this.base = add(this.base, scale(rotateBack(this.axes, way), SPEED_M * seconds * this.units));
            }
        }
    }

    turn(position, angle)
    {
        const here = this.placeOf(position), about = rotation(this.up, angle);
        this.axes = [0, 3, 6].flatMap(i => rotate(about, this.axes.slice(i, i + 3)));
        this.base = add(this.base, sub(here, this.placeOf(position)));
    }
}
