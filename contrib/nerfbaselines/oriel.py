"""Oriel as a method of NerfBaselines (https://nerfbaselines.github.io): known cameras go in, the
scene is made in one iteration, and nothing is trained. See README.md."""
import json
import os
import shutil
import subprocess
import tempfile

import numpy
from PIL import Image

ORIEL = os.environ.get("ORIEL", "oriel")


def run(*arguments):
    done = subprocess.run([ORIEL, *arguments, "--quiet"], capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(f"oriel {arguments[0]} failed: {done.stderr[-2000:]}")


def camera_from_world(pose):
    """Rotation and translation of a camera with x right, y down, z forward."""
    rotation = numpy.asarray(pose)[:3, :3].astype(float).T
    return rotation, -rotation @ numpy.asarray(pose)[:3, 3].astype(float)


def quaternion(r):
    """w x y z of a rotation matrix (Bar-Itzhack 2000: an eigenvector)."""
    k = numpy.array([[r[0, 0] - r[1, 1] - r[2, 2], 0, 0, 0],
                     [r[1, 0] + r[0, 1], r[1, 1] - r[0, 0] - r[2, 2], 0, 0],
                     [r[2, 0] + r[0, 2], r[2, 1] + r[1, 2], r[2, 2] - r[0, 0] - r[1, 1], 0],
                     [r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1], numpy.trace(r)]])
    values, vectors = numpy.linalg.eigh(k)  # reads the lower half
    return vectors[[3, 0, 1, 2], numpy.argmax(values)]


def over_white(image):
    if image.dtype != numpy.uint8:
        image = (numpy.clip(image, 0, 1) * 255 + 0.5).astype(numpy.uint8)
    if image.shape[2] == 3:
        return image
    alpha = image[..., 3:].astype(float) / 255
    return (image[..., :3] * alpha + 255 * (1 - alpha) + 0.5).astype(numpy.uint8)


class Oriel:
    def __init__(self, *, checkpoint=None, train_dataset=None, config_overrides=None):
        self.options = {"quality": "standard", "method": "oriel", **(config_overrides or {})}
        self.dataset, self.checkpoint = train_dataset, checkpoint
        self.work = tempfile.TemporaryDirectory(prefix="oriel-")
        self.scene = os.path.join(checkpoint or self.work.name, "scene")

    @classmethod
    def get_method_info(cls):
        return {"method_id": "oriel", "required_features": frozenset(("color",)),
                "supported_camera_models": frozenset(("pinhole",)),
                "supported_outputs": ("color",)}

    def get_info(self):
        return {**self.get_method_info(), "num_iterations": 1, "hparams": self.options,
                "loaded_step": 1 if self.checkpoint else None, "loaded_checkpoint": self.checkpoint}

    def get_train_embedding(self, index):
        return None

    def optimize_embedding(self, dataset, *, embedding=None):
        raise NotImplementedError("Oriel has no embeddings")

    def train_iteration(self, step):
        """Makes the scene: stereo with the given cameras."""
        images = os.path.join(self.work.name, "images")
        os.makedirs(images)
        cameras = []
        for i, camera in enumerate(self.dataset["cameras"]):
            name = f"{i:05d}.png"
            width, height = (int(v) for v in camera.image_sizes)
            Image.fromarray(over_white(self.dataset["images"][i][:height, :width])).save(
                os.path.join(images, name))
            r, t = camera_from_world(camera.poses)
            fx, fy, cx, cy = (float(v) for v in camera.intrinsics)
            # The centre of the first pixel is 0 in cameras.json.
            cameras.append({"name": name, "width": width, "height": height, "R": r.tolist(),
                            "t": t.tolist(), "K": [[fx, 0, cx - 0.5], [0, fy, cy - 0.5], [0, 0, 1]]})
        file = os.path.join(self.work.name, "cameras.json")
        with open(file, "w", encoding="utf-8") as stream:
            json.dump({"cameras": cameras}, stream)
        run("import", file, "--images", images, "--out", self.scene, "--points", "densify",
            "--quality", self.options["quality"])
        return {}

    def render(self, camera, *, options=None):
        camera = camera.item()
        width, height = (int(v) for v in camera.image_sizes)
        r, t = camera_from_world(camera.poses)
        with tempfile.TemporaryDirectory() as folder:
            k = " ".join(repr(float(v)) for v in camera.intrinsics)
            pose = " ".join(repr(float(v)) for v in (*quaternion(r), *t))
            with open(os.path.join(folder, "cameras.txt"), "w", encoding="utf-8") as stream:
                stream.write(f"1 PINHOLE {width} {height} {k}\n")
            with open(os.path.join(folder, "images.txt"), "w", encoding="utf-8") as stream:
                stream.write(f"1 {pose} 1 view\n\n")
            picture = os.path.join(folder, "view.png")
            run("render", self.scene, "--camera", os.path.join(folder, "images.txt"), "--out",
                picture, "--method", self.options["method"])
            return {"color": numpy.asarray(Image.open(picture), numpy.float32) / 255}

    def save(self, path):
        shutil.copytree(self.scene, os.path.join(path, "scene"))
