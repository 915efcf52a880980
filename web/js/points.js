// The point cloud: cells in one vertex buffer, coarse parts first, and what of it a view draws.
import {add, dot, rotate, row, scale, sub} from "./math.js";

const MAGIC = 0x504c524f, HEADER_BYTES = 16, CELL_WORDS = 11, POINT_BYTES = 12;

function readCells(data)
{
    const header = new Uint32Array(data, 0, 4);
    if (header[0] !== MAGIC || header[1] !== 3 || header[3] !== POINT_BYTES)
        throw new Error("points/coarse.bin: not what this page reads");
    const cells = [];
    let base = 0;
    for (let i = 0; i < header[2]; i++) {
        const at = HEADER_BYTES + 4 * CELL_WORDS * i;
        const f = new Float32Array(data, at, CELL_WORDS), u = new Uint32Array(data, at, CELL_WORDS);
        cells.push({low: [f[0], f[1], f[2]], step: f[3], size: [f[4], f[5], f[6]], count: u[7], loaded: 0,
                    coarse: u[8], file: u[9], first: u[10], base});
        base += u[7];
    }
    return {cells, points: base, coarseData: new Uint8Array(data, HEADER_BYTES + 4 * CELL_WORDS * header[2])};
}

export class Cloud {
    constructor(device, data)
    {
        const {gl} = device, read = readCells(data);
        this.bytes = read.points * POINT_BYTES;
        const rows = [[2, gl.UNSIGNED_INT, 0], [2, gl.BYTE, 6], [3, gl.UNSIGNED_BYTE, 8]];
        Object.assign(this, read, {gl}, device.vertices(this.bytes, gl.STATIC_DRAW, POINT_BYTES, rows));
        let at = 0;
        for (const cell of this.cells) {
            this.append(cell, this.coarseData, at, cell.coarse);
            at += cell.coarse * POINT_BYTES;
        }
    }

    release()
    {
        this.gl.deleteVertexArray(this.vertices);
        this.gl.deleteBuffer(this.buffer);
    }

    append(cell, bytes, at, count)
    {
        const gl = this.gl;
        gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
        gl.bufferSubData(gl.ARRAY_BUFFER, (cell.base + cell.loaded) * POINT_BYTES, bytes, at,
                         count * POINT_BYTES);
        cell.loaded += count;
    }

    // The rest of the cells of one file.
    addFile(number, data)
    {
        const bytes = new Uint8Array(data);
        for (const cell of this.cells)
            if (cell.file === number && cell.loaded < cell.count)
                this.append(cell, bytes, cell.first * POINT_BYTES, cell.count - cell.loaded);
    }

    get loaded() { return this.cells.reduce((sum, cell) => sum + cell.loaded, 0); }

    // Coarse points for a map: position and colour of each.
    forEachCoarse(visit)
    {
        const view = new DataView(this.coarseData.buffer, this.coarseData.byteOffset);
        let at = 0;
        for (const cell of this.cells) {
            for (let i = 0; i < cell.coarse; i++, at += POINT_BYTES) {
                // As shaders/proxy/point.glsl.
                const x = view.getUint32(at, true), y = view.getUint32(at + 4, true);
                const steps = [x & 0x1fff, x >>> 13 & 0x1fff, x >>> 26 | (y & 0x7f) << 6];
                visit(steps.map((n, k) => cell.low[k] + cell.step * n),
                      [view.getUint8(at + 8), view.getUint8(at + 9), view.getUint8(at + 10)]);
            }
        }
    }

    // Cells that the camera may see and of which points are there.
    visible(camera) { return this.cells.filter(cell => cell.loaded > 0 && inSight(cell, camera)); }
}

// As shaders/proxy/splat_cull.comp.
function inSight(cell, camera)
{
    const half = scale(cell.size, 0.5), middle = sub(add(cell.low, half), camera.eye);
    const m = rotate(camera.r, middle), {fx, fy, cx, cy, width, height} = camera;
    const e = [0, 1, 2].map(i => row(camera.r, i).reduce((s, x, k) => s + Math.abs(x) * half[k], 0));
    const outside = plane => dot(plane, m) + dot(plane.map(Math.abs), e) < 0;
    return m[2] + e[2] > 0 && !outside([fx, 0, cx]) && !outside([-fx, 0, width - cx]) &&
           !outside([0, fy, cy]) && !outside([0, -fy, height - cy]);
}
