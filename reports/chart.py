"""oriel chart: accuracy on held-out photographs against time and memory, every method and its
settings, over one or several scenes (docs/reference/chart.md)."""

import math
import pathlib
import shutil
import tempfile

import report
from report import FIGURES, Failure, fixed, mean, spread

# What trades accuracy for speed where a method chooses a few photographs for each pixel.
SETTINGS = [*(f"photos_per_pixel={count}" for count in (1, 2, 3, 4)), "sampling=bilinear"]
RENDERERS = {"photographs at 1/2": ["--photo-divide", 2], "photographs at 1/4": ["--photo-divide", 4],
             "textures ycc": ["--textures", "ycc"],
             "textures bc1": ["--textures", "bc1"]}
PICTURES, PICTURE_SIDE = 2, 1440


def settings_of(run, values):
    """Names and arguments of what is measured of a method besides the method as it is."""
    key, _, varied = run.options.get("vary", "").partition("=")
    found = {f"{key}={value}": ["--set", f"{key}={value}"]
             for value in varied.split(",") if varied and key in values}
    if run.options.get("quick") or "photos_per_pixel" not in values or \
            float(values.get("reconstructions", 1)) > 1:
        return found
    for setting in SETTINGS:
        key, value = setting.split("=")
        if key in values and values[key] != value:
            found.setdefault(setting, ["--set", setting])
    return {**found, **RENDERERS}


def keep_pictures(run, scene, name, drawn):
    """Photograph, rendering and their difference of the first views, small enough for a page."""
    from PIL import Image
    folder, kept = run.out / "pictures" / scene, []
    folder.mkdir(parents=True, exist_ok=True)
    for path in sorted(pathlib.Path(drawn).glob("*.diff.png"))[:PICTURES]:
        with Image.open(path) as panels:
            panels.thumbnail((PICTURE_SIDE, PICTURE_SIDE))
            file = folder / f"{report.file_name(name)}.{path.name.split('.')[0]}.jpg"
            panels.convert("RGB").save(file, quality=82)
            kept.append(str(file.relative_to(run.out)))
    return kept


def measure(run, scene, name, methods, words):
    """Rows of a scene: the method as it is, and of a paper's method on the proxy of oriel."""
    drawn = tempfile.mkdtemp()
    views = 2 if run.options.get("quick") else run.options["views"]
    accuracy = ["--views", views, "--images", drawn,
                *(["--divide", 2] if run.options.get("quick") else [])]
    walk = ["--walk", 6, "--divide", 4] if run.options.get("quick") else ["--walk", 12, "--divide", 2]
    try:
        rows = (run.measure(scene["dir"], methods, words, accuracy, walk) if methods else
                report.as_list(run.needs("eval", scene["dir"], *words, *accuracy, "--json", "-")))
        pictures = keep_pictures(run, scene["name"], name, drawn)
    finally:
        shutil.rmtree(drawn)
    for row in rows or []:
        row.update(scene=scene["name"], pictures=pictures, peer=not methods, sd={
            f: spread([view[f] for view in row["views"]]) for f in FIGURES})
        row.setdefault("setting", "")
        pictures = []  # of the method as it is
    return rows


def rows_of(run, scene, methods):
    limits = ["--max-vram", run.options["max-vram"]] if "max-vram" in run.options else []
    provenance = {"scene": report.state_of(pathlib.Path(scene["dir"])), "limits": limits,
                  "views": run.options["views"], "quick": run.options.get("quick", False)}
    rows = []
    for method, values in methods.items():
        paired = not run.list_of("method") or "paired" in run.list_of("method")
        which = [method, "paired"] if paired else [method]
        for setting, words in {"": [], **settings_of(run, values)}.items():
            name = f"{method}.{setting}" if setting else method
            found = run.kept(scene["name"], name, provenance, lambda: measure(
                run, scene, name, [method] if setting else which, [*words, *limits]))
            for row in found or []:
                rows.append({**row, "setting": setting or row["setting"]})
    return rows


def peers(run, scene):
    """Rows of other programs' pictures, NAME=DIR followed by ms=.. and MIB=.. of the same."""
    found = []
    for word in run.list_of("peer"):
        key, _, value = word.partition("=")
        if not key or not value or (key in ("ms", "MIB") and (not found or not number(value))):
            raise Failure(f"--peer {word}: must be NAME=DIR, with ms and MIB above 0 after it")
        if key in ("ms", "MIB"):
            found[-1][key] = number(value)
        else:
            found.append({"name": key, "dir": pathlib.Path(value)})
    rows = []
    for peer in found:
        own = peer["dir"] / scene["name"]
        own = own if own.is_dir() else peer["dir"]
        if not any(own.iterdir()) if own.is_dir() else True:
            run.say(f"{peer['name']}: no picture of {scene['name']} in {own}")
            continue
        row = measure(run, scene, peer["name"], [], ["--pictures", own])[0]
        rows.append({**row, "method": peer["name"], "frame_ms": peer.get("ms"), "cpu_ms": None,
                     "flicker": None, "device_bytes": peer["MIB"] * 2 ** 20 if "MIB" in peer else None})
    return rows


def number(text):
    try:
        return float(text) if float(text) > 0 else None
    except ValueError:
        return None


# --- the front, means over scenes ---

def find_front(rows):
    """A row is on the front when no other is both as fast and as good, one of them being better."""
    timed = [row for row in rows if row["frame_ms"] is not None]
    for row in rows:
        better = [other for other in timed if row["frame_ms"] is not None
                  and other["frame_ms"] <= row["frame_ms"]
                  and other["mean"]["psnr_db"] >= row["mean"]["psnr_db"]
                  and (other["frame_ms"], other["mean"]["psnr_db"])
                  != (row["frame_ms"], row["mean"]["psnr_db"])]
        best = max(better, key=lambda other: other["mean"]["psnr_db"], default=None)
        row["on_front"] = row["frame_ms"] is not None and best is None
        row["dominated_by"] = best and {"method": best["method"], "setting": best["setting"]}


def overall(rows, scenes):
    """One row for each method and setting that every scene has."""
    alike = {}
    for row in rows:
        alike.setdefault((row["method"], row["setting"]), []).append(row)
    found = []
    for (method, setting), same in alike.items():
        if len(same) < scenes:
            continue
        one = {"method": method, "setting": setting, "peer": same[0]["peer"], "scenes": scenes}
        one["mean"] = {f: mean([row["mean"][f] for row in same]) for f in FIGURES}
        one["sd"] = {f: spread([row["mean"][f] for row in same]) for f in FIGURES}
        for key in ("flicker", "device_bytes"):
            one[key] = mean([row[key] for row in same])
        for key in ("frame_ms", "cpu_ms"):  # ratios count, so the geometric mean
            times = [row[key] for row in same]
            one[key] = None if None in times else math.exp(mean([math.log(max(t, 1e-9)) for t in times]))
        found.append(one)
    return found


# --- the report ---

def place_names(axis, dots):
    """Names beside dots (x, y, name, colour), one above the other where they would overlap."""
    size, taken = 7, []  # in points
    axis.autoscale_view()
    scale = 72 / axis.figure.dpi
    at = [(*scale * axis.transData.transform((x, y)), x, y, name, color) for x, y, name, color in dots]
    for left, bottom, x, y, name, color in sorted(at, key=lambda dot: dot[1]):
        right, up = left + 0.6 * size * len(name), 4
        while any(left < there[1] and there[0] < right and abs(bottom + up - there[2]) < size for there in taken):
            up += 1
        taken.append((left, right, bottom + up))
        axis.annotate(name, (x, y), fontsize=size, color=color, textcoords="offset points", xytext=(4, up))


def draw(rows, title, path):
    """Four figures against the time of a frame."""
    plot = report.pyplot()
    figure, axes = plot.subplots(2, 2, figsize=(12, 9))
    figure.suptitle(title, y=0.92)
    timed = [row for row in rows if row["frame_ms"]]
    shown = [("PSNR of whole pictures, dB", lambda row: row["mean"]["psnr_db"]),
             ("SSIM", lambda row: row["mean"]["ssim"]), ("FLIP", lambda row: row["mean"]["flip"]),
             ("flicker", lambda row: row["flicker"])]
    for axis, (label, value) in zip(axes.flat, shown):
        report.log_x(axis, "milliseconds a frame")
        axis.set(ylabel=label, xmargin=0.12)  # room for names
        named = []
        for n, method in enumerate(dict.fromkeys(row["method"] for row in timed)):
            dots = [row for row in timed if row["method"] == method and value(row) is not None]
            color = f"C{n % 10}"
            axis.plot([row["frame_ms"] for row in dots], [value(row) for row in dots], "os^"[n // 10 % 3],
                      color=color, label=method, alpha=0.8)
            named += [(row["frame_ms"], value(row), method, color) for row in dots if not row["setting"]]
        place_names(axis, named)
    front = sorted((row for row in timed if row["on_front"]), key=lambda row: row["frame_ms"])
    axes[0, 0].plot([row["frame_ms"] for row in front], [row["mean"]["psnr_db"] for row in front],
                    color="grey", linewidth=1, zorder=0, label="the front")
    axes[0, 0].legend(fontsize=7)
    report.save(figure, path)


COLUMNS = [("frame ms", 9, lambda r: fixed(r["frame_ms"], 2)),
           ("CPU ms", 9, lambda r: fixed(r["cpu_ms"], 2)),
           ("PSNR dB", 9, lambda r: fixed(r["mean"]["psnr_db"], 2)),
           ("SSIM", 7, lambda r: fixed(r["mean"]["ssim"], 4)),
           ("FLIP", 7, lambda r: fixed(r["mean"]["flip"], 4)),
           ("crumbs", 7, lambda r: fixed(r["mean"]["crumbs"], 1)),
           ("flicker", 7, lambda r: fixed(r["flicker"], 2)),
           ("MiB", 9, lambda r: fixed(r["device_bytes"], 1, 2 ** -20))]


def print_rows(name, rows):
    print(f"{'method':14} {'setting':22}", *(f"{title:>{width}}" for title, width, _ in COLUMNS),
          f" ({name})")
    for row in rows:
        print(f"{row['method']:14} {row['setting']:22}",
              *(f"{cell(row):>{width}}" for _, width, cell in COLUMNS),
              *([" front"] if row["on_front"] else []))
    print()


def section(name, figure, rows):
    def by(row):
        return f"{row['method']} {row['setting']}".strip()
    head = ["method", "setting", *(title for title, _, _ in COLUMNS), "front, or what is better and faster"]
    cells = [[row["method"], row["setting"], *(cell(row) for _, _, cell in COLUMNS),
              "front" if row["on_front"] else by(row["dominated_by"]) if row["dominated_by"] else ""]
             for row in rows]
    return [f"<h2>{report.html.escape(name)}</h2>", report.picture(figure, ""),
            report.table(head, cells),
            *(report.picture(file, f"{by(row)}: photograph, rendering, 4 times their difference")
              for row in rows for file in row.get("pictures", []))]


def make(run):
    methods, scenes, rows = run.methods(), [], []
    key, _, varied = run.options.get("vary", "=").partition("=")
    if "vary" in run.options and not (varied and any(key in v for v in methods.values())):
        raise Failure(f"--vary {run.options['vary']}: must be KEY=A,B,.., an option that a method reads")
    for folder in run.inputs:
        folder = pathlib.Path(folder).resolve()
        try:
            manifest = report.json.loads((folder / "scene.json").read_text())
        except OSError as error:
            raise Failure(f"{folder}: {error.strerror}: no scene") from error
        splits = [photo["split"] for photo in manifest["photographs"]]
        if folder.name in [scene["name"] for scene in scenes]:
            raise Failure(f"two scenes are named {folder.name}")
        if "test" not in splits:
            raise Failure(f"{folder}: no photograph is held out to compare with; prepare the scene "
                          "with --test-every N, --test-list A,B or --test-block A:B")
        scenes.append({"name": folder.name, "dir": str(folder), "photographs": splits.count("train"),
                       "held_out": splits.count("test"),
                       "points": manifest.get("counts", {}).get("points"),
                       "prepare_s": sum(s.get("wall_s", 0) for s in manifest.get("stages", {}).values()) or None})
    run.make_folder()
    for scene in scenes:
        rows += rows_of(run, scene, methods)
        if "part" not in run.options:
            rows += peers(run, scene)
    if "part" not in run.options:
        if not rows:
            raise Failure("no method could be measured")
        write(run, scenes, rows)
    print(f"{run.measured} rows measured, {run.reused} used again, {run.left_out} left out: "
          f"{run.out}/{'rows' if 'part' in run.options else 'chart.html'}")


def write(run, scenes, rows):
    groups = {scene["name"]: [row for row in rows if row["scene"] == scene["name"]] for scene in scenes}
    means = overall(rows, len(scenes))
    parts = []
    for name, group in [*groups.items(), ("all scenes", means)]:
        find_front(group)
        print_rows(name, group)
        figure = "chart.svg" if group is means else f"chart.{name}.svg"
        draw(group, name, run.out / figure)
        parts += section(name, figure, group)
    device = next((row["device"] for row in rows if not row["peer"]), None)
    report.write_json(run.out / "chart.json", {
        "version": 2, "device": device, "quick": run.options.get("quick", False), "scenes": scenes,
        "rows": rows, "overall": means})
    report.write_page(run.out / "chart.html", "Accuracy against time and memory",
                      [f"<p>{report.html.escape(str(device))}</p>", *parts])


report.run(make)
