"""What the reports of oriel chart and oriel stress share: calls of oriel, rows that are kept
between runs, figures and pages. `oriel NAME` runs NAME.py with options that it has checked."""

import html
import importlib.util
import json
import math
import os
import pathlib
import subprocess
import sys

FIGURES = ["psnr_db", "psnr_cc_db", "psnr_covered_db", "ssim", "flip", "crumbs", "coverage",
           "completeness"]
MORE_METHODS = {"paired", "refined"}  # among methods: others made of them

for module in ("matplotlib", "numpy", "PIL"):
    if not importlib.util.find_spec(module):
        sys.exit(f"oriel: error: {sys.executable} has no {module}: reports need numpy, Pillow and "
                 "Matplotlib (Debian: python3-numpy, python3-pil, python3-matplotlib)")


class Failure(Exception):
    """What the user can mend: the program prints it and exits with 2."""


class Report:
    """One run: its options, its folder, and how many rows it measured."""

    def __init__(self, words):
        self.oriel, *words = words
        at = words.index("--")
        self.inputs, self.options = words[at + 1:], {}
        given = words[:at]
        while given:
            name = given.pop(0)[2:]
            valued = given and not given[0].startswith("--")
            self.options[name] = given.pop(0) if valued else True
        self.out = pathlib.Path(self.options["out"])
        self.measured = self.reused = self.left_out = 0
        program = os.stat(self.oriel)
        self.program = f"{program.st_size} {program.st_mtime_ns}"
        # Parts K/N of the rows are kept for a run of all of them, which writes the report.
        self.part = [int(n) for n in self.options.get("part", "1/1").split("/")]
        self.rows_seen = 0

    def make_folder(self):
        try:
            self.out.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise Failure(f"{self.out}: cannot make this folder: {error.strerror}") from error
        if not os.access(self.out, os.W_OK):
            raise Failure(f"{self.out}: cannot write into this folder")

    def list_of(self, name):
        return self.options[name].split(",") if name in self.options else []

    def say(self, text):
        if not self.options.get("quiet"):
            print(text, file=sys.stderr)

    def call(self, *words, quiet=False):
        """Runs oriel and returns what it prints; None: it failed, and has said why."""
        more = ["--shader-dir", self.options["shader-dir"]] if "shader-dir" in self.options else []
        done = subprocess.run([self.oriel, *map(str, words), "--quiet", *more],
                              stdout=subprocess.PIPE, text=True, check=False,
                              stderr=subprocess.DEVNULL if quiet else None)
        if done.returncode == 130:
            raise KeyboardInterrupt
        return done.stdout if done.returncode == 0 else None

    def needs(self, *words):
        """The same; a failure ends the report."""
        text = self.call(*words)
        if text is None:
            raise Failure(f"oriel {words[0]} failed")
        return text

    def methods(self):
        """Name and options of each method that is asked for, with its values of them."""
        names = [name for name in self.list_of("method") if name not in MORE_METHODS] or [
            line.split()[0] for line in self.needs("methods").splitlines()
            if line[:1].islower() and "  " in line]
        found = {}
        for name in names:
            table = self.needs("methods", name).split("\noption ", 1)[1].splitlines()[1:]
            found[name] = {line.split()[0]: line.split()[1] for line in table if line.strip()}
        return found

    def measure(self, scene, methods, how=(), accuracy=(), walk=()):
        """Rows of the methods on a scene's held-out photographs, with their flicker along a walk."""
        words = ["eval", scene, "--method", ",".join(methods), *how, "--json", "-"]
        rows = self.call(*words, *accuracy)
        if rows is None:
            return None
        walks = self.call(*words, *walk)
        rows, walks = as_list(rows), as_list(walks) if walks else []
        for at, row in enumerate(rows):
            # 0: no block shows one surface in both frames.
            row["flicker"] = walks[at]["all"]["block_mean"] or None if at < len(walks) else None
            row["frame_ms"], row["cpu_ms"] = row["mean"]["render_ms"], row["mean"]["cpu_ms"]
            row["device_bytes_by_owner"] = row["device_bytes"]
            row["device_bytes"] = sum(row["device_bytes"].values())
        return rows

    def kept(self, group, name, provenance, make):
        """Rows that an earlier run made of the same things, or those that make() returns. None: they
        are another part's, or there are none."""
        self.rows_seen += 1
        if self.rows_seen % self.part[1] != self.part[0] % self.part[1]:
            return None
        path = self.out / "rows" / group / (file_name(name) + ".json")
        provenance = {"program": self.program, **provenance}
        try:
            kept = json.loads(path.read_text())
            if kept["provenance"] == provenance:
                self.reused += 1
                return kept["rows"]
        except (OSError, ValueError, KeyError):
            pass
        self.say(f"{group}: {name}")
        rows = make()
        if rows is None:
            self.left_out += 1
            print(f"{group}: {name} is left out", file=sys.stderr)
            return None
        self.measured += 1
        write_json(path, {"provenance": provenance, "rows": rows})
        return rows


def as_list(text):
    found = json.loads(text)
    return found if isinstance(found, list) else [found]


def file_name(name):
    return "".join(c if c.isalnum() or c in "-_." else "-" for c in name)


def write_json(path, value):
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_suffix(".part")
    part.write_text(json.dumps(value, indent=1))
    part.replace(path)


def mean(values):
    values = [v for v in values if v is not None]
    return sum(values) / len(values) if values else None


def spread(values):
    middle = mean(values)
    return math.sqrt(mean([(v - middle) ** 2 for v in values]))


def state_of(folder):
    """Sizes and times of the files that a scene's renderings depend on."""
    files = [folder / "scene.json", folder / "points.ply", folder / "points.lod",
             *sorted((folder / "sparse").rglob("*")), *sorted((folder / "images").rglob("*"))]
    return [[str(f.relative_to(folder)), f.stat().st_size, f.stat().st_mtime_ns]
            for f in files if f.is_file()]


# --- figures and pages ---

def pyplot():
    """matplotlib, drawing into files that are the same for the same figures."""
    import matplotlib
    matplotlib.use("svg")
    matplotlib.rcParams.update({"svg.hashsalt": "oriel", "svg.fonttype": "none",
                                "axes.grid": True, "grid.alpha": 0.3, "font.size": 9})
    import matplotlib.pyplot
    return matplotlib.pyplot


def log_x(axis, label):
    """Makes the x axis logarithmic, with plain numbers."""
    axis.set(xscale="log", xlabel=label)
    axis.xaxis.set_major_locator(pyplot().LogLocator(subs=(1, 2, 5)))
    axis.xaxis.set_major_formatter("{x:g}")
    axis.xaxis.set_minor_locator(pyplot().NullLocator())


def save(figure, path):
    figure.savefig(path, metadata={"Date": None}, bbox_inches="tight")
    pyplot().close(figure)


def table(head, rows):
    """HTML of a table; a cell is a text, or HTML in a tuple of one."""
    def cells(row, tag):
        return "".join(f"<{tag}>{c[0] if isinstance(c, tuple) else html.escape(str(c))}</{tag}>"
                       for c in row)
    return (f"<table><tr>{cells(head, 'th')}</tr>"
            + "".join(f"<tr>{cells(row, 'td')}</tr>" for row in rows) + "</table>")


def picture(name, title):
    name, title = html.escape(name), html.escape(title)
    return f'<figure><img loading="lazy" src="{name}" alt=""><figcaption>{title}</figcaption></figure>'


def fixed(value, digits, scale=1):
    return "-" if value is None else f"{value * scale:.{digits}f}"


def write_page(path, title, parts):
    path.write_text(
        f"<!doctype html><meta charset=utf-8><title>{html.escape(title)}</title><style>"
        "body{font:15px sans-serif;margin:2em auto;max-width:75em;padding:0 1em}"
        "table{border-collapse:collapse;font-variant-numeric:tabular-nums;margin:1em 0}"
        "td,th{padding:.2em .6em;border-bottom:1px solid #ccc;text-align:left}"
        "img{max-width:100%}figure{margin:1em 0}</style>"
        f"<h1>{html.escape(title)}</h1>" + "\n".join(parts) + "\n")


def run(make):
    """Runs make(report) and exits as oriel does."""
    try:
        make(Report(sys.argv[1:]))
    except KeyboardInterrupt:
        sys.exit(130)
    except Failure as failure:
        print(f"oriel: error: {failure}", file=sys.stderr)
        sys.exit(2)
