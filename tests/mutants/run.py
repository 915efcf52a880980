#!/usr/bin/env python3
"""Makes small wrong changes, one at a time, and runs the tests that should notice.

usage: tests/mutants/run.py BUILD [--changed COMMIT] [--minutes N] [--jobs N] [--table FILE] [NAME...]
       tests/mutants/run.py --texts LIST

BUILD is a build folder (Ninja) whose tests are built. A change of list.json to a C file, or to a script that the
program carries, is made in a copy, which is compiled and linked into the test ahead of the library; one to a shader in a copy of
all shaders, which the test reads (ORIEL_TEST_SHADERS); one to a file of a published site in a copy of
that, on which the named tests of tests/web/test_page.py run in a browser (page/CLASS.TEST). Neither the
source nor BUILD is touched.
Named changes alone are tried, with --changed those of files that differ from COMMIT, and with
--minutes only as many as begin within that time: what is left is told, and is no failure. Their order
is then that of a shuffle which depends on the commit that is checked out, so that runs at different
commits begin with different changes.

A change that no test notices fails the run, unless its entry says why none can ("survives"). So does
an entry whose text is not in its file exactly once, and a test that fails without any change. --texts
looks for the texts alone.
"""
import argparse
import concurrent.futures
import json
import os
import random
import resource
import shlex
import shutil
import subprocess
import sys
import tempfile
import threading
import time

HERE = os.path.dirname(os.path.abspath(__file__))
SOURCE = os.path.dirname(os.path.dirname(HERE))
PAGE = "page/"  # of tests in a browser
# Scripts that the program carries as arrays of bytes, and the C files of the build folder that are made of them.
EMBEDDED = {"src/scene/known_cameras.py": "src/scene/orl_known_script.c"}
# Of a test. A change that makes it endless is noticed; a busy machine must not look like one.
CPU_LIMIT_S, WAIT_S = 100, 3600


class Broken(Exception):
    """An entry, or a test, that says nothing about the change."""


def run(command, **more):
    return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          errors="replace", **more)


class Build:
    def __init__(self, folder):
        self.folder = folder
        found = run(["ninja", "-C", folder, "-t", "compdb"], check=True).stdout
        self.compile = {os.path.realpath(os.path.join(c["directory"], c["file"])): c["command"]
                        for c in json.loads(found[found.index("["):]) if "-c " in c["command"]}
        self.sound, self.locks, self.lock = {}, {}, threading.Lock()
        self.said = {}  # the last lines of each program
        self.pages = None  # a folder with a scene and its site, when a test needs it

    def object_of(self, path, text, work):
        """Compiles a changed C file."""
        if path not in self.compile:
            raise Broken("nothing compiles it")
        changed, out = os.path.join(work, os.path.basename(path)), os.path.join(work, "changed.o")
        with open(changed, "w") as file:
            file.write(text)
        words, command = shlex.split(self.compile[path]), []
        while words:
            word = words.pop(0)
            if word in ("-o", "-c", "-MF", "-MT"):
                words.pop(0)
            elif word not in ("-MD", "-g") and not word.startswith("-Werror"):  # may leave something unused
                command.append(word)
        command += ["-iquote", os.path.dirname(path), "-c", changed, "-o", out]
        made = run(command, cwd=self.folder)
        if made.returncode:
            raise Broken("does not compile:\n" + made.stdout[-2000:])
        return out

    def program(self, test, changed, work):
        """Links a test with the changed file ahead of the library."""
        name = "tests/" + test.replace("/", "_")
        found = run(["ninja", "-C", self.folder, "-t", "commands", name]).stdout.strip().split("\n")
        own, out = "-o %s " % name, os.path.join(work, os.path.basename(name))
        if own not in found[-1]:
            raise Broken("no test " + test)
        made = run(["sh", "-c", found[-1].replace(own, "-o %s %s " % (shlex.quote(out), shlex.quote(changed)))],
                   cwd=self.folder)
        if made.returncode:
            raise Broken("does not link:\n" + made.stdout[-2000:])
        return out

    def page_folder(self):
        """Holds made/, a scene, and served/path/site, which is it published, as tests/e2e/publish.sh has it."""
        with self.lock:
            if not self.pages:
                self.pages = tempfile.TemporaryDirectory()
                oriel = os.path.join(self.folder, "oriel")
                for command in ([oriel, "synth", "monument", "--out", "photos", "--size", "240x160", "--count", "8"],
                                [os.path.join(self.folder, "tests/bench_truth_scene"), "photos", "photos-truth",
                                 "made", "2", "4"],
                                [oriel, "publish", "made", "--out", "served/path/site"]):
                    made = run(command, cwd=self.pages.name)
                    if made.returncode:
                        raise Broken("no site:\n" + made.stdout[-2000:])
            return self.pages.name

    def page_passes(self, test, site):
        if not shutil.which("chromedriver"):
            return None
        return self.passes("/usr/bin/python3", "-B", os.path.join(SOURCE, "tests/web/test_page.py"),
                           os.path.join(self.folder, "oriel"), os.path.join(self.folder, "tests/bench_web_pictures"),
                           os.path.join(self.page_folder(), "made"), site, "no-single-file", test[len(PAGE):])

    def passes(self, *program, shaders=None):
        """None: it is skipped. Ends the program at its first failure."""
        environment = dict(os.environ, **({"ORIEL_TEST_SHADERS": shaders} if shaders else {}))
        limit = lambda: resource.setrlimit(resource.RLIMIT_CPU, (CPU_LIMIT_S, CPU_LIMIT_S))
        error, said = None, []
        with subprocess.Popen(program, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                              errors="replace", env=environment, preexec_fn=limit,
                              cwd=os.path.join(self.folder, "tests")) as process:
            timer = threading.Timer(WAIT_S, process.kill)
            timer.start()
            for line in process.stdout:
                said.append(line)
                error = error or (line.strip() if shaders and "does not compile" in line else None)
                if "[  FAILED  ]" in line or error:
                    process.kill()
            timer.cancel()
        if error:
            raise Broken(error)
        self.said[program[0]] = "".join(said[-20:])
        return None if process.returncode == 77 else process.returncode == 0

    def own_program(self, test):
        return os.path.join(self.folder, "tests", test.replace("/", "_"))

    def own_passes(self, test):
        return (self.page_passes(test, os.path.join(self.page_folder(), "served/path/site"))
                if test.startswith(PAGE) else self.passes(self.own_program(test)))

    def check_sound(self, test):
        """A test that fails without a change, which is said, is tried once more: its verdicts would be lost."""
        with self.lock:
            own = self.locks.setdefault(test, threading.Lock())
        with own:
            if test not in self.sound:
                self.sound[test] = self.own_passes(test)
                if self.sound[test] is False:
                    print("%s failed without a change:\n%s" % (test, self.said.get(self.own_program(test), "")), flush=True)
                    self.sound[test] = self.own_passes(test)
            if self.sound[test] is False:
                raise Broken(test + " fails without a change")


def changed_text(entry):
    with open(os.path.join(SOURCE, entry["file"])) as file:
        text = file.read()
    count = text.count(entry["old"])
    if count != 1:
        raise Broken("its text is %d times in %s" % (count, entry["file"]))
    return text.replace(entry["old"], entry["new"])


def put_into_site(site, name, text):
    if name.startswith("shaders/"):
        with open(os.path.join(site, "shaders.json")) as file:
            shaders = json.load(file)
        shaders[name.removeprefix("shaders/")] = text
        name, text = "shaders.json", json.dumps(shaders)
    with open(os.path.join(site, name), "w") as file:
        file.write(text)


def prepare(build, entry, work):
    """What runs a test with the change."""
    path, text = os.path.realpath(os.path.join(SOURCE, entry["file"])), changed_text(entry)
    if entry["tests"][0].startswith(PAGE):
        site = os.path.join(work, "served/path/site")
        shutil.copytree(os.path.join(build.page_folder(), "served/path/site"), site)
        put_into_site(site, entry["file"].removeprefix("web/"), text)
        return lambda test: build.page_passes(test, site)
    if entry["file"].startswith("shaders/"):
        shaders = os.path.join(work, "shaders")
        shutil.copytree(os.path.join(SOURCE, "shaders"), shaders)
        with open(os.path.join(work, entry["file"]), "w") as file:
            file.write(text)
        return lambda test: build.passes(build.own_program(test), shaders=shaders)
    if entry["file"] in EMBEDDED:
        path = os.path.realpath(os.path.join(build.folder, EMBEDDED[entry["file"]]))
        with open(path) as file:
            head = file.read().partition("{")[0]
        text = head + "{" + ",".join(map(str, text.encode() + b"\0")) + "};\n"
    changed = build.object_of(path, text, work)
    return lambda test: build.passes(build.program(test, changed, work))


def attempt(build, entry):
    """What became of a change - killed, survived, skipped, broken - and by which test or why."""
    try:
        with tempfile.TemporaryDirectory() as work:
            passes, results = prepare(build, entry, work), []
            for test in entry["tests"]:
                build.check_sound(test)
                results.append(passes(test))
                if results[-1] is False:
                    return "killed", test
            return "skipped" if None in results else "survived", ", ".join(entry["tests"])
    except Broken as problem:
        return "broken", str(problem)


def judge(build, entries, minutes, jobs):
    start, found = time.monotonic(), []

    def within_time(entry):
        if minutes and time.monotonic() - start > 60 * minutes:
            return None
        what, why = attempt(build, entry)
        accepted = entry.get("survives")
        bad = (what == "broken" or (what == "survived" and not accepted) or
               (what == "killed" and accepted is not None))
        if what == "killed" and accepted:
            why += ", although its entry says that none can"
        why = accepted if what == "survived" and accepted else why
        print("%-9s %-44s %s%s" % (what, entry["name"], why, "   <-- FAILED" if bad else ""), flush=True)
        return entry, what, why, bad

    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        found = list(pool.map(within_time, entries))
    late = found.count(None)
    if late:
        print("%d changes are not tried within %g minutes" % (late, minutes))
    return [f for f in found if f]


def git(*words):
    said = run(["git", "-C", SOURCE, *words])
    if said.returncode:
        sys.exit(said.stdout)
    return said.stdout


def shuffled(entries):
    entries = list(entries)
    random.Random(git("rev-parse", "HEAD")).shuffle(entries)
    return entries


def write_table(path, found):
    """How many there are of each folder, and below the survivors with their reasons."""
    folders = sorted({os.path.dirname(f[0]["file"]) for f in found})
    survivors = [f for f in found if f[1] != "killed"]
    with open(path, "w") as file:
        file.write("| folder | changes | noticed |\n|---|---|---|\n")
        for folder in folders:
            of = [f for f in found if os.path.dirname(f[0]["file"]) == folder]
            file.write("| `%s` | %d | %d |\n" % (folder, len(of), sum(f[1] == "killed" for f in of)))
        file.write("| all | %d | %d |\n" % (len(found), len(found) - len(survivors)))
        for entry, what, why, _ in survivors:
            file.write("\n`%s` in `%s` is %s: %s\n" % (entry["name"], entry["file"], what, why))


def check_texts(path):
    bad = 0
    with open(path) as file:
        for entry in json.load(file):
            try:
                changed_text(entry)
            except (Broken, OSError) as problem:
                bad += 1
                print("%s: %s" % (entry["name"], problem))
    return 1 if bad else 0


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("build", nargs="?")
    parser.add_argument("--texts", metavar="LIST")
    parser.add_argument("--changed")
    parser.add_argument("--minutes", type=float)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--table")
    parser.add_argument("names", nargs="*")
    asked = parser.parse_intermixed_args()
    if asked.texts:
        return check_texts(asked.texts)
    if not asked.build:
        parser.error("no build folder")
    with open(os.path.join(HERE, "list.json")) as file:
        entries = json.load(file)
    if asked.changed:
        changed = git("diff", "--name-only", asked.changed).split("\n")
        entries = [entry for entry in entries if entry["file"] in changed]
    if asked.names:
        entries = [entry for entry in entries if entry["name"] in asked.names]
    if asked.minutes:
        entries = shuffled(entries)
    if not entries:
        print("no change of the list concerns what is asked for")
        return 0
    found = judge(Build(os.path.abspath(asked.build)), entries, asked.minutes, asked.jobs)
    if asked.table:
        write_table(asked.table, found)
    count = {what: sum(f[1] == what for f in found) for what in ("killed", "survived", "skipped", "broken")}
    print("%(killed)d killed, %(survived)d survived, %(skipped)d skipped, %(broken)d broken" % count)
    return 1 if any(f[3] for f in found) else 0


if __name__ == "__main__":
    sys.exit(main())
