#!/usr/bin/env python3
"""A processing node of WebODM that makes Oriel scenes: NodeODM's REST contract (API version 2.2.1).

    oriel_node.py [--port 3000] [--host 127.0.0.1] [--data DIR] [--oriel PROGRAM] [--token TOKEN]

Photographs go in, and all.zip comes out with the published walk, the points as PLY, and as LAZ
where PDAL is there, and splats. One task runs at a time. Needs python3-flask."""
import argparse
import json
import os
import queue
import shutil
import signal
import subprocess
import threading
import time
import uuid as uuids

from flask import Flask, Response, jsonify, request, send_file
from werkzeug.utils import secure_filename

VERSION = "2.2.1"
QUEUED, RUNNING, FAILED, COMPLETED, CANCELED = 10, 20, 30, 40, 50
# name, type, default, domain, help
OPTIONS = [
    ("quality", "enum", "standard", ["draft", "standard", "high"], "Detail of the stereo and its time"),
    ("max-size", "int", "1600", "64 to 16384", "Larger side of photographs in pixels"),
    ("test-every", "int", "0", "0, or 2 or more", "Hold out every n-th photograph"),
    ("sh", "int", "1", "0 to 2", "Degree of the splats' spherical harmonics"),
]
STAGES = ["collect", "calibrate", "undistort", "densify", "fuse", "radii", "ground", "backdrop", "sky",
          "expose", "occluders"]


class Bad(Exception):
    """What the client asked for is not possible."""


def parse_options(text):
    """The options as a list of names and values; those that are not known are refused."""
    known = {o[0]: o for o in OPTIONS}
    try:
        given = json.loads(text or "[]")
        pairs = [(str(o["name"]), str(o["value"])) for o in given]
    except (ValueError, TypeError, KeyError):
        raise Bad("options: must be an array of {name, value}") from None
    for name, value in pairs:
        if name not in known:
            raise Bad(f"Invalid option: {name}")
        _, kind, _, domain, _ = known[name]
        if (kind == "enum" and value not in domain) or (kind == "int" and not value.isdigit()):
            raise Bad(f"Invalid value of {name}: {value}")
    return [{"name": n, "value": v} for n, v in pairs]


class Task:
    def __init__(self, node, uuid, name, options, created):
        self.node, self.uuid, self.name, self.options = node, uuid, name, options
        self.dir = os.path.join(node.data, uuid)
        self.images = os.path.join(self.dir, "images")
        self.created = created or int(time.time() * 1000)
        self.status, self.error, self.output, self.progress = QUEUED, None, [], 0
        self.started = self.ended = None
        self.committed, self.process = False, None
        self.lock = threading.Lock()

    def info(self):
        spent = (self.ended or time.time()) - self.started if self.started else -0.001
        status = {"code": self.status}
        if self.error:
            status["errorMessage"] = self.error
        return {"uuid": self.uuid, "name": self.name, "dateCreated": self.created,
                "processingTime": int(1000 * spent), "status": status, "options": self.options,
                "imagesCount": len(os.listdir(self.images)) if os.path.isdir(self.images) else 0,
                "progress": self.progress}

    def option(self, name):
        default = next(o[2] for o in OPTIONS if o[0] == name)
        return next((o["value"] for o in self.options if o["name"] == name), default)

    def run(self, *command):
        """Runs a program, whose lines are the task's output. False: it failed."""
        self.output.append("$ " + " ".join(command))
        with self.lock:
            if self.status == CANCELED:
                return False
            # A group of its own, so that cancelling ends COLMAP as well.
            self.process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True,
                                            stderr=subprocess.STDOUT, start_new_session=True)
        for line in self.process.stdout:
            self.output.append(line.rstrip("\n"))
            step = line.split(" ")[0]
            if step in STAGES and " done" in line:
                self.progress = max(self.progress, 90 * (STAGES.index(step) + 1) // len(STAGES))
        return self.process.wait() == 0

    def make(self):
        """The whole job. False: a step failed."""
        oriel, out = self.node.oriel, os.path.join(self.dir, "assets")
        scene = os.path.join(self.dir, "scene")
        shutil.rmtree(out, ignore_errors=True)
        os.makedirs(os.path.join(out, "oriel"))
        held_out = self.option("test-every")
        prepare = [oriel, "prepare", self.images, "--out", scene, "--resume", "--quality",
                   self.option("quality"), "--max-size", self.option("max-size")]
        if held_out != "0":
            prepare += ["--test-every", held_out]
        points = os.path.join(out, "oriel", "points.ply")
        good = (self.run(*prepare) and
                self.run(oriel, "publish", scene, "--out", os.path.join(out, "oriel", "walk")) and
                self.run(oriel, "export", scene, "--as", "ply", "--out", points) and
                self.run(oriel, "export", scene, "--as", "splats", "--thin", "--sh",
                         self.option("sh"), "--out", os.path.join(out, "oriel", "splats.ply")))
        if good and shutil.which("pdal"):  # where WebODM looks for the cloud
            folder = os.path.join(out, "odm_georeferencing")
            os.makedirs(folder)
            good = self.run("pdal", "translate", points,
                            os.path.join(folder, "odm_georeferenced_model.laz"))
        if good:
            self.progress = 95
            shutil.make_archive(os.path.join(self.dir, "all"), "zip", out)
        return good

    def work(self):
        with self.lock:
            if self.status != QUEUED:
                return
            self.status, self.started = RUNNING, time.time()
        try:
            good, error = self.make(), "oriel failed: see the task's output"
        except OSError as problem:
            good, error = False, str(problem)
        with self.lock:
            self.ended = time.time()
            if self.status == CANCELED:
                return
            self.status = COMPLETED if good else FAILED
            self.error = None if good else error
            self.progress = 100 if good else self.progress

    def cancel(self):
        with self.lock:
            if self.status not in (QUEUED, RUNNING):
                return
            self.status = CANCELED
            if self.process and self.process.poll() is None:
                os.killpg(self.process.pid, signal.SIGTERM)


class Node:
    def __init__(self, data, oriel):
        self.data, self.oriel, self.tasks, self.queue = data, oriel, {}, queue.Queue()
        os.makedirs(data, exist_ok=True)
        version = subprocess.run([oriel, "version"], capture_output=True, text=True, check=True)
        self.engine_version = version.stdout.split()[-1]
        threading.Thread(target=self.serve, daemon=True).start()

    def serve(self):
        while True:
            self.queue.get().work()

    def new(self, form, headers):
        uuid = headers.get("set-uuid") or str(uuids.uuid4())
        try:
            uuid = str(uuids.UUID(uuid))
        except ValueError:
            raise Bad("set-uuid: not a UUID") from None
        if uuid in self.tasks:
            raise Bad("set-uuid: there is such a task")
        created = form.get("dateCreated", "")
        task = Task(self, uuid, form.get("name") or "Task of " + time.strftime("%Y-%m-%d %H:%M"),
                    parse_options(form.get("options")), int(created) if created.isdigit() else 0)
        os.makedirs(task.images)
        self.tasks[uuid] = task
        return task

    def find(self, uuid):
        if uuid not in self.tasks:
            raise Bad(f"{uuid} not found")
        return self.tasks[uuid]

    def commit(self, task):
        if task.committed:
            raise Bad("the task is committed already")
        if not os.listdir(task.images):
            raise Bad("Not enough images")
        task.committed = True
        self.queue.put(task)

    def restart(self, task, options):
        with task.lock:
            if task.status in (QUEUED, RUNNING):
                raise Bad("the task has not ended")
            if options is not None:
                task.options = parse_options(options)
            task.status, task.error, task.output, task.progress = QUEUED, None, [], 0
        self.queue.put(task)

    def remove(self, task):
        task.cancel()
        del self.tasks[task.uuid]
        shutil.rmtree(task.dir, ignore_errors=True)


def store(task, files):
    for file in files:
        name = secure_filename(file.filename or "")
        if name:
            file.save(os.path.join(task.images, name))


def body(name):
    """A value of a request whose body is a form or JSON."""
    source = request.get_json(silent=True) if request.is_json else request.form
    return (source or {}).get(name)


def make_app(node, token):
    app = Flask(__name__)

    @app.before_request
    def check_token():
        if token and request.args.get("token") != token and request.path != "/auth/info":
            return jsonify(error="Invalid authentication token."), 401
        return None

    @app.errorhandler(Bad)
    def refuse(problem):
        return jsonify(error=str(problem))

    @app.get("/auth/info")
    def auth_info():
        return jsonify(message="Ask whoever runs this node for its token." if token else
                       "Authentication is not required.", loginUrl=None, registerUrl=None)

    @app.get("/info")
    def info():
        memory = os.sysconf("SC_PAGE_SIZE")
        waiting = [t for t in node.tasks.values() if t.committed and t.status in (QUEUED, RUNNING)]
        return jsonify(version=VERSION, taskQueueCount=len(waiting), maxImages=None,
                       maxParallelTasks=1, engine="oriel", engineVersion=node.engine_version,
                       cpuCores=os.cpu_count(),
                       totalMemory=memory * os.sysconf("SC_PHYS_PAGES"),
                       availableMemory=memory * os.sysconf("SC_AVPHYS_PAGES"))

    @app.get("/options")
    def options():
        return jsonify([dict(zip(("name", "type", "value", "domain", "help"), o)) for o in OPTIONS])

    @app.post("/task/new")
    def task_new():
        if request.form.get("zipurl"):
            raise Bad("zipurl: this node takes uploaded images alone")
        task = node.new(request.form, request.headers)
        store(task, request.files.getlist("images"))
        try:
            node.commit(task)
        except Bad:
            node.remove(task)
            raise
        return jsonify(uuid=task.uuid)

    @app.post("/task/new/init")
    def task_init():
        return jsonify(uuid=node.new(request.form, request.headers).uuid)

    @app.post("/task/new/upload/<uuid>")
    def task_upload(uuid):
        task = node.find(uuid)
        if task.committed:
            raise Bad("the task is committed already")
        store(task, request.files.getlist("images"))
        return jsonify(success=True)

    @app.post("/task/new/commit/<uuid>")
    def task_commit(uuid):
        node.commit(node.find(uuid))
        return jsonify(uuid=uuid)

    @app.get("/task/list")
    def task_list():
        return jsonify([{"uuid": uuid} for uuid in list(node.tasks)])

    @app.get("/task/<uuid>/info")
    def task_info(uuid):
        task = node.find(uuid)
        told = task.info()
        line = request.args.get("with_output", type=int)
        if line is not None:
            told["output"] = task.output[line:]
        return jsonify(told)

    @app.get("/task/<uuid>/output")
    def task_output(uuid):
        return jsonify(node.find(uuid).output[request.args.get("line", 0, int):])

    @app.get("/task/<uuid>/download/<asset>")
    def task_download(uuid, asset):
        task = node.find(uuid)
        path = os.path.join(task.dir, "all.zip")
        if asset != "all.zip" or task.status != COMPLETED:
            raise Bad("Asset not available")
        return send_file(path, mimetype="application/zip", as_attachment=True)

    @app.post("/task/<action>")
    def task_action(action):
        actions = {"cancel": Task.cancel, "remove": node.remove,
                   "restart": lambda task: node.restart(task, body("options"))}
        if action not in actions:
            return Response(status=404)
        try:
            actions[action](node.find(body("uuid")))
        except Bad as problem:
            return jsonify(success=False, error=str(problem))
        return jsonify(success=True)

    return app


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--port", type=int, default=3000)
    parser.add_argument("--host", default="127.0.0.1")
    parser.add_argument("--data", default="oriel-node-data", help="where tasks are kept")
    parser.add_argument("--oriel", default="oriel")
    parser.add_argument("--token", help="asked of every request")
    args = parser.parse_args()
    node = Node(os.path.abspath(args.data), args.oriel)
    make_app(node, args.token).run(args.host, args.port, threaded=True)


if __name__ == "__main__":
    main()
