"""Draws exported splats with the PlayCanvas engine, which SuperSplat's viewer is made of, in a
headless Chromium, at the held-out cameras of an exported transforms.json.

    splat_pictures.py MODULES SPLATS.ply|.glb NERFSTUDIO_DIR OUT [all]

MODULES is the node_modules folder that has playcanvas. OUT/NAME.png is the picture of each
held-out photograph, or of all photographs."""
import base64
import json
import os
import shutil
import sys
import tempfile

from browser import Browser, Server

PAGE = """<!doctype html><meta charset="utf-8"><style>body{margin:0}canvas{display:block}</style>
<canvas id="canvas"></canvas><script type="module">
import * as pc from './playcanvas.mjs';
const canvas = document.getElementById('canvas');
const app = new pc.Application(canvas, {graphicsDeviceOptions: {antialias: false,
    preserveDrawingBuffer: true}});
app.setCanvasFillMode(pc.FILLMODE_NONE);
app.autoRender = false; // frames are slow without a graphics chip
const camera = new pc.Entity();
camera.addComponent('camera', {clearColor: new pc.Color(0, 0, 0), nearClip: 0.01, farClip: 1e4,
    toneMapping: pc.TONEMAP_NONE, gammaCorrection: pc.GAMMA_SRGB});
app.root.addChild(camera);
app.start();
const name = SPLATS;
const asset = new pc.Asset(name, name.endsWith('.ply') ? 'gsplat' : 'container', {url: name});
app.assets.add(asset);
app.assets.load(asset);
asset.on('error', e => { window.failed = String(e); });
asset.ready(() => {
    let entity;
    if (name.endsWith('.ply')) {
        entity = new pc.Entity();
        entity.addComponent('gsplat', {asset: asset});
    } else {
        entity = asset.resource.instantiateRenderEntity();
        // A picture of the scene's own world is asked for, not of the upright one.
        entity.setLocalRotation(0, 0, 0, 1);
        entity.children.forEach(child => child.setLocalRotation(0, 0, 0, 1));
    }
    app.root.addChild(entity);
    window.loaded = true;
});
// A frame asks a worker for the order by depth, which frames after the answer have.
const frames = async count => {
    for (; count > 0; count--)
        await new Promise(done => {
            app.once('frameend', done);
            app.renderNextFrame = true;
        });
};
const order = async () => {
    const sorted = new Promise(done => {
        app.scene.once('gsplat:sorted', done);
        setTimeout(done, 5000); // the same direction as before needs no other order
    });
    await frames(2);
    await sorted;
    await frames(2);
    window.shown = true;
};
window.draw = frame => {
    canvas.width = frame.w;
    canvas.height = frame.h;
    app.graphicsDevice.setResolution(frame.w, frame.h);
    const near = 0.01, far = 1e4, {w, h, fl_x, fl_y, cx, cy} = frame;
    camera.camera.calculateProjection = m => m.set([
        2 * fl_x / w, 0, 0, 0,  0, 2 * fl_y / h, 0, 0,
        1 - 2 * cx / w, 2 * cy / h - 1, -(far + near) / (far - near), -1,
        0, 0, -2 * far * near / (far - near), 0]);
    // The field of view decides what is culled and how large a Gaussian is.
    camera.camera.fov = 2 * Math.atan(h / 2 / fl_y) * 180 / Math.PI;
    const m = new pc.Mat4().set(frame.transform_matrix[0].map(
        (_, i) => frame.transform_matrix.map(row => row[i])).flat());
    camera.setPosition(m.getTranslation());
    camera.setRotation(new pc.Quat().setFromMat4(m));
    window.shown = false;
    order();
};
</script>"""


def main():
    modules, splats, scene, out = sys.argv[1:5]
    with open(os.path.join(scene, "transforms.json"), encoding="utf-8") as stream:
        root = json.load(stream)
    wanted = {f["file_path"] for f in root["frames"]} if sys.argv[5:] else set(root["test_filenames"])
    frames = [f for f in root["frames"] if f["file_path"] in wanted]
    with tempfile.TemporaryDirectory() as folder:
        name = "splats" + os.path.splitext(splats)[1]
        shutil.copy(splats, os.path.join(folder, name))
        shutil.copy(os.path.join(modules, "playcanvas/build/playcanvas.mjs"), folder)
        with open(os.path.join(folder, "index.html"), "w", encoding="utf-8") as stream:
            stream.write(PAGE.replace("SPLATS", json.dumps(name)))
        server = Server(folder)
        browser = Browser(max(f["w"] for f in frames), max(f["h"] for f in frames))
        browser.driver.get(server.address + "/index.html")
        browser.wait("if (window.failed) throw window.failed; return !!window.loaded")
        os.makedirs(out, exist_ok=True)
        for frame in frames:
            browser.js("draw(arguments[0])", frame)
            browser.wait("return window.shown")
            data = browser.js("return document.getElementById('canvas').toDataURL('image/png')")
            stem = os.path.splitext(os.path.basename(frame["file_path"]))[0]
            with open(os.path.join(out, stem + ".png"), "wb") as stream:
                stream.write(base64.b64decode(data.split(",")[1]))
        browser.driver.quit()
        server.close()


main()
