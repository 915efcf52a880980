// Soft splats, which correct the picture of a view at rest: drawn as shaders/soft draws them, but by blending, the
// farthest first.
import {dot} from "./math.js";

const BYTES = 28, WORDS = BYTES / 4; // of a splat, as src/walk/site_soft.c packs it
const SPLATS_MAX = 2 ** 24;          // a double holds a number below it beside 29 bits of a depth
const NEAR = 1e-3;                   // as shaders/soft/seen.glsl

// The mip level of a view that is as coarse as the coarse part of photographs, a mean over 1 / `parts` of their
// longer sides, on average.
export function coarseLevel(camera, photos, parts)
{
    const share = photos.reduce((sum, p) => sum + Math.max(p.width, p.height) / parts / p.fx, 0) / photos.length;
    return Math.max(Math.log2(share * camera.fx), 0);
}

export class Soft {
    // pixelRange: of the manifest
    constructor(device, data, pixelRange)
    {
        const {gl} = device;
        this.words = new Uint32Array(data);
        this.numbers = new Float32Array(data);
        this.count = this.words.length / WORDS;
        this.sorted = new Uint32Array(this.words.length);
        const rows = [[3, gl.FLOAT, 0], [3, gl.UNSIGNED_SHORT, 12], [2, gl.UNSIGNED_BYTE, 18], [4, gl.BYTE, 20],
                      [3, gl.BYTE, 24]];
        Object.assign(this, {device, pixelRange}, device.vertices(data.byteLength, gl.DYNAMIC_DRAW, BYTES, rows, 1));
    }

    // Puts those before the camera into the buffer, the farthest first. Returns how many they are.
    sort({r, eye})
    {
        const {numbers, words, sorted} = this, forward = r.slice(6), behind = dot(forward, eye);
        const depth = new Float32Array(1), bits = new Uint32Array(depth.buffer), keys = new Float64Array(this.count);
        let count = 0;
        for (let i = 0, at = 0; i < this.count; i++, at += WORDS) {
            depth[0] = forward[0] * numbers[at] + forward[1] * numbers[at + 1] + forward[2] * numbers[at + 2] - behind;
            if (depth[0] > NEAR) // the bits of floats above 0 have their order
                keys[count++] = -(bits[0] >>> 2) * SPLATS_MAX - i;
        }
        keys.subarray(0, count).sort().forEach((key, place) => {
            const from = WORDS * (-key % SPLATS_MAX);
            for (let k = 0; k < WORDS; k++)
                sorted[WORDS * place + k] = words[from + k];
        });
        const gl = this.device.gl;
        gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
        gl.bufferSubData(gl.ARRAY_BUFFER, 0, sorted, 0, WORDS * count);
        return count;
    }

    // Into a target: sRGB colour, and what passes all of them.
    draw(program, target, camera)
    {
        const gl = this.device.gl, count = this.sort(camera);
        this.device.begin(target);
        gl.clearBufferfv(gl.COLOR, 0, [0, 0, 0, 1]);
        program.use({rotation: camera.r, eye: camera.eye, focal: [camera.fx, camera.fy, camera.cx, camera.cy],
                     size: [camera.width, camera.height], pixel_range: this.pixelRange});
        gl.enable(gl.BLEND);
        gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ZERO, gl.ONE_MINUS_SRC_ALPHA);
        gl.bindVertexArray(this.vertices);
        gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, count);
        gl.disable(gl.BLEND);
    }
}
