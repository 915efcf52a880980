// WebGL2: programs from shader files, textures, targets, and one call that runs a pass.
import {text} from "./strings.js";

const PRELUDE = `#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
precision highp sampler2DArray;
`;

// Format and type of the pixels that fill it, and bytes of a pixel.
const FORMATS = {
    R16F: ["RED", "HALF_FLOAT", 2], R32F: ["RED", "FLOAT", 4], RG16F: ["RG", "HALF_FLOAT", 4],
    RGBA8: ["RGBA", "UNSIGNED_BYTE", 4], SRGB8_ALPHA8: ["RGBA", "UNSIGNED_BYTE", 4],
    RGBA16F: ["RGBA", "HALF_FLOAT", 8], RGBA32F: ["RGBA", "FLOAT", 16],
    R32UI: ["RED_INTEGER", "UNSIGNED_INT", 4], RG32UI: ["RG_INTEGER", "UNSIGNED_INT", 8],
};
// How uniforms are set that are neither samplers nor matrices.
const SETTERS = {FLOAT: "uniform1f", INT: "uniform1i", BOOL: "uniform1i",
                 FLOAT_VEC2: "uniform2fv", FLOAT_VEC3: "uniform3fv", FLOAT_VEC4: "uniform4fv"};
const FILTERED = new Set(["R16F", "RGBA8", "SRGB8_ALPHA8", "RGBA16F"]);

// Why this browser draws no walk.
export class NoDevice extends Error {}

// Whether screen and browser show what is brighter than white.
function showsBright()
{
    return matchMedia("(dynamic-range: high)").matches &&
           Boolean(window.WebGL2RenderingContext?.prototype.drawingBufferToneMapping);
}

export class Device {
    // bright: what it draws may be brighter than white
    constructor(canvas, bright = false)
    {
        const wide = bright && showsBright(); // of floats, which there are with alpha alone
        const gl = canvas.getContext("webgl2", {alpha: wide, antialias: false, depth: false,
                                                powerPreference: "high-performance"});
        if (!gl)
            throw new NoDevice(text.noWebgl);
        if (!gl.getExtension("EXT_color_buffer_float"))
            throw new NoDevice(text.noFloats);
        if (wide) {
            gl.drawingBufferStorage(gl.RGBA16F, canvas.width, canvas.height);
            gl.drawingBufferToneMapping({mode: "extended"});
        }
        this.gl = gl;
        this.bytes = 0;
        this.nothing = gl.createVertexArray();
        const info = gl.getExtension("WEBGL_debug_renderer_info");
        this.name = info ? gl.getParameter(info.UNMASKED_RENDERER_WEBGL) : gl.getParameter(gl.RENDERER);
        gl.disable(gl.DITHER);
        gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
        gl.pixelStorei(gl.UNPACK_COLORSPACE_CONVERSION_WEBGL, gl.NONE);
    }

    // `sources`: text of every shader file, by name. The browser compiles programs side by side until they are used.
    program(sources, vertex, fragment, defines = {})
    {
        const gl = this.gl, program = gl.createProgram();
        const head = PRELUDE + Object.entries(defines).map(([k, v]) => `#define ${k} ${v}\n`).join("");
        const shaders = [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]].map(([kind, file]) => {
            const shader = gl.createShader(kind);
            gl.shaderSource(shader, head + expand(sources, file, new Set()));
            gl.compileShader(shader);
            gl.attachShader(program, shader);
            return [file, shader];
        });
        gl.linkProgram(program);
        return new Program(gl, program, `${vertex} ${fragment}`, shaders);
    }

    // A buffer of so many bytes and how shaders read its records, as normalized numbers.
    // rows: [count, type, offset] of each attribute; divisor: instances that share a record, 0: one vertex has it
    vertices(bytes, usage, stride, rows, divisor = 0)
    {
        const gl = this.gl, vertices = gl.createVertexArray(), buffer = gl.createBuffer();
        gl.bindVertexArray(vertices);
        gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
        gl.bufferData(gl.ARRAY_BUFFER, bytes, usage);
        rows.forEach(([count, type, at], i) => {
            gl.enableVertexAttribArray(i);
            if (type === gl.UNSIGNED_INT)
                gl.vertexAttribIPointer(i, count, type, stride, at);
            else
                gl.vertexAttribPointer(i, count, type, true, stride, at);
            gl.vertexAttribDivisor(i, divisor);
        });
        gl.bindVertexArray(null);
        return {vertices, buffer};
    }

    texture(format, width, height, {levels = 1, layers = 0} = {})
    {
        const gl = this.gl, kind = layers ? gl.TEXTURE_2D_ARRAY : gl.TEXTURE_2D;
        const id = gl.createTexture(), filter = FILTERED.has(format) ? gl.LINEAR : gl.NEAREST;
        gl.bindTexture(kind, id);
        if (layers)
            gl.texStorage3D(kind, levels, gl[format], width, height, layers);
        else
            gl.texStorage2D(kind, levels, gl[format], width, height);
        gl.texParameteri(kind, gl.TEXTURE_MAG_FILTER, filter);
        // Photographs, in layers, are read at one level, as in the renderer.
        const mipmapped = layers ? gl.LINEAR_MIPMAP_NEAREST : gl.LINEAR_MIPMAP_LINEAR;
        gl.texParameteri(kind, gl.TEXTURE_MIN_FILTER, levels > 1 ? mipmapped : filter);
        gl.texParameteri(kind, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
        gl.texParameteri(kind, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
        const bytes = FORMATS[format][2] * width * height * Math.max(layers, 1) * (levels > 1 ? 4 / 3 : 1);
        this.bytes += bytes;
        return {id, kind, format, width, height, bytes};
    }

    write(texture, data)
    {
        const gl = this.gl, [format, type] = FORMATS[texture.format];
        gl.bindTexture(gl.TEXTURE_2D, texture.id);
        if (ArrayBuffer.isView(data))
            gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, texture.width, texture.height, gl[format], gl[type], data);
        else
            gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, gl[format], gl[type], data);
    }

    // Fills the coarser mip levels of a texture from its first.
    makeLevels(texture)
    {
        this.gl.bindTexture(texture.kind, texture.id);
        this.gl.generateMipmap(texture.kind);
    }

    release(...textures)
    {
        for (const texture of textures) {
            this.gl.deleteTexture(texture.id);
            this.bytes -= texture.bytes;
        }
    }

    // What passes draw into: textures that exist, or formats of new ones.
    target(width, height, attachments, {depth = false} = {})
    {
        const gl = this.gl, fbo = gl.createFramebuffer();
        const textures = attachments.map(a => typeof a === "string" ? this.texture(a, width, height) : a);
        const own = textures.filter((t, i) => typeof attachments[i] === "string");
        gl.bindFramebuffer(gl.FRAMEBUFFER, fbo);
        textures.forEach((t, i) => gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0 + i,
                                                           gl.TEXTURE_2D, t.id, 0));
        gl.drawBuffers(textures.map((t, i) => gl.COLOR_ATTACHMENT0 + i));
        let buffer = null;
        if (depth) {
            buffer = gl.createRenderbuffer();
            gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
            gl.renderbufferStorage(gl.RENDERBUFFER, gl.DEPTH_COMPONENT32F, width, height);
            gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.RENDERBUFFER, buffer);
        }
        return {fbo, width, height, textures, own, buffer};
    }

    releaseTarget(target)
    {
        this.gl.deleteFramebuffer(target.fbo);
        this.gl.deleteRenderbuffer(target.buffer);
        this.release(...target.own);
    }

    begin(target)
    {
        const gl = this.gl, {fbo, x = 0, y = 0, width, height} = target || {
            fbo: null, width: gl.drawingBufferWidth, height: gl.drawingBufferHeight};
        gl.bindFramebuffer(gl.FRAMEBUFFER, fbo);
        gl.viewport(x, y, width, height);
    }

    clear(target)
    {
        const gl = this.gl;
        this.begin(target);
        target.textures.forEach((t, i) => {
            if (t.format.endsWith("UI"))
                gl.clearBufferuiv(gl.COLOR, i, [0, 0, 0, 0]);
            else
                gl.clearBufferfv(gl.COLOR, i, [0, 0, 0, 0]);
        });
        if (target.buffer)
            gl.clearBufferfv(gl.DEPTH, 0, [1]);
    }

    // Every pixel of the target (null: the canvas) by one program.
    pass(program, target, values)
    {
        this.begin(target);
        program.use(values);
        this.gl.bindVertexArray(this.nothing);
        this.gl.drawArrays(this.gl.TRIANGLES, 0, 3);
    }
}

function expand(sources, file, done)
{
    if (done.has(file))
        return "";
    done.add(file);
    if (!(file in sources))
        throw new Error(text.missing(file));
    return sources[file].replace(/^#include "(.*)"$/gm, (line, name) => expand(sources, name, done));
}

class Program {
    // shaders: name and object of each, which are not waited for
    constructor(gl, id, name, shaders)
    {
        Object.assign(this, {gl, id, name, shaders, linked: null});
    }

    // Its uniforms by name, once it is linked.
    get uniforms() { return this.linked ||= this.finish(); }

    finish()
    {
        const {gl, id, shaders} = this, uniforms = new Map();
        if (!gl.getProgramParameter(id, gl.LINK_STATUS)) {
            const logs = shaders.map(([file, shader]) => `${file}: ${gl.getShaderInfoLog(shader) || ""}`);
            throw new Error(`${logs.join("\n")}\n${gl.getProgramInfoLog(id)}`);
        }
        shaders.forEach(([, shader]) => gl.deleteShader(shader));
        const count = gl.getProgramParameter(id, gl.ACTIVE_UNIFORMS);
        for (let i = 0, unit = 0; i < count; i++) {
            const {name: key, type} = gl.getActiveUniform(id, i);
            const samples = type === gl.SAMPLER_2D || type === gl.SAMPLER_2D_ARRAY ||
                            type === gl.UNSIGNED_INT_SAMPLER_2D;
            const setter = SETTERS[Object.keys(SETTERS).find(kind => gl[kind] === type)];
            uniforms.set(key, {type, setter, place: gl.getUniformLocation(id, key), unit: samples ? unit++ : -1});
        }
        return uniforms;
    }

    // `values`: textures and numbers by uniform name; what the program does not read is ignored, what
    // it lacks is an error.
    use(values)
    {
        const gl = this.gl;
        gl.useProgram(this.id);
        for (const [key, uniform] of this.uniforms) {
            if (values[key] === undefined)
                throw new Error(`${this.name}: ${key} is not given`);
            this.set(uniform, values[key]);
        }
    }

    set({type, setter, place, unit}, value)
    {
        const gl = this.gl;
        if (unit >= 0) {
            gl.activeTexture(gl.TEXTURE0 + unit);
            gl.bindTexture(value.kind, value.id);
            gl.uniform1i(place, unit);
        } else if (type === gl.FLOAT_MAT3) {
            gl.uniformMatrix3fv(place, true, value); // rows
        } else if (setter) {
            gl[setter](place, value);
        } else {
            throw new Error(`${this.name}: a uniform of an unknown type`);
        }
    }
}
