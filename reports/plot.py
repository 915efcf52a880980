"""oriel plot: figures of what oriel bench --json or oriel trim --json has written."""

import pathlib

import report
from report import Failure

MIB = 2 ** 20


def bars(title, label, rows, path):
    """Horizontal bars of stacked parts. rows: (name, {part: value})."""
    figure, axis = report.pyplot().subplots(figsize=(9, 1.5 + 0.35 * len(rows)))
    left = [0.0] * len(rows)
    for part in dict.fromkeys(part for _, parts in rows for part in parts):
        widths = [parts.get(part, 0) for _, parts in rows]
        axis.barh(range(len(rows)), widths, left=left, label=part)
        left = [a + b for a, b in zip(left, widths)]
    axis.set_yticks(range(len(rows)), [name for name, _ in rows])
    axis.invert_yaxis()
    axis.set(title=title, xlabel=label)
    axis.legend(fontsize=7, loc="upper left", bbox_to_anchor=(1, 1))
    report.save(figure, path)


def curve(title, x_label, y_label, dots, path):
    """Dots (x, y) in the order of x, which is logarithmic."""
    figure, axis = report.pyplot().subplots(figsize=(9, 5))
    axis.plot(*zip(*sorted(dots)), "o-")
    axis.set(title=title, ylabel=y_label)
    report.log_x(axis, x_label)
    report.save(figure, path)


def plot_bench(bench, out):
    bars("Time of a frame by pass", "milliseconds, median of frames",
         [(f"{run['method']}, {run['size'][0]}x{run['size'][1]}", run["passes_ms"])
          for run in bench["sizes"]], out / "passes.svg")
    owners = {}
    for part in bench["memory"]:
        owners[part["owner"]] = owners.get(part["owner"], 0) + part["bytes"] / MIB
    bars("Memory by owner", "MiB", [("device", owners), ("host, at most", {
        "process": bench["host_peak_bytes"] / MIB})], out / "memory.svg")


def plot_trim(trim, out):
    taken = [step for step in trim["steps"] if step["taken"]]
    before = trim["before"]["point_bytes"] + trim["before"]["photo_bytes"]
    bars("The model after each step", "MiB on the device", [("whole scene", {"model": before / MIB})] + [
        (step["what"], {"model": step["bytes"] / MIB}) for step in taken], out / "waterfall.svg")
    curve("Loss against bytes", "MiB on the device", "dB lost, training photographs",
          [(before / MIB, 0)] + [(step["bytes"] / MIB, step["total_loss_db"]) for step in taken], out / "curve.svg")


def make(run):
    try:
        data = report.json.loads(pathlib.Path(run.inputs[0]).read_text())
    except (OSError, ValueError) as error:
        raise Failure(f"{run.inputs[0]}: {error}") from error
    kinds = {"sizes": plot_bench, "steps": plot_trim}
    found = [kinds[key] for key in kinds if isinstance(data, dict) and key in data]
    if not found:
        raise Failure(f"{run.inputs[0]}: neither of oriel bench --json nor of oriel trim --json")
    run.make_folder()
    found[0](data, run.out)


report.run(make)
