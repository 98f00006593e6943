"""The paper's figures 4 and 7 for a scene of one's own: runs `weft error` and `weft run`, and draws what they measure."""

import csv
import pathlib
import subprocess
import tempfile

import h5py
import numpy
from matplotlib import pyplot

from .pictures import COLOURS, STYLE

_KINDS = "async:tasks=kinds+wait=0.2"
_MEANS = {"displacements": "merge=mean", "positions": "merge=position"}

# title, solvers, with obstacles, and the plan of each curve
CURVES = [
    ("4 (a) Gauss-Seidel rank", "xpbd", False,
     {"synchronous": "single", "with the rank": _KINDS, "without": _KINDS + "+rank=off"}),
    ("4 (b) what may overlap, with obstacles", "xpbd", True,
     {"synchronous": "single", "both, obstacles last": _KINDS + "+settle=0",
      "obstacles when they come": _KINDS + "+settle=0+order=free",
      "within an iteration": _KINDS + "+settle=0+order=within",
      "across iterations": _KINDS + "+settle=0+order=across"}),
    ("4 (c) how motions are merged", "xpbd", False,
     {"motions in full": _KINDS, "mean of displacements": _KINDS + "+merge=mean",
      "mean of positions": _KINDS + "+merge=position",
      "displacements, dropping": _KINDS + "+merge=mean+dropping=on",
      "positions, dropping": _KINDS + "+merge=position+dropping=on"}),
    ("4 (d) all solvers, by strips", "xpbd,vbd,sosd,jpgd", False,
     {"synchronous": "single", "asynchronous": "async"}),
]

# The depth to which obstacles are entered, over the frames of a run.
DEPTHS = {f"means of {what}, obstacles {when}": f"tasks=kinds,wait=0.2,settle=0,{merge}{order}"
          for what, merge in _MEANS.items()
          for when, order in (("when they come", ",order=free"), ("last", ""))}


def convergence(weft, scene, devices, iterations, tell=print):
    """The picture. tell is given a line for each curve."""
    with tempfile.TemporaryDirectory() as folder, pyplot.rc_context(STYLE):
        figure, axes = pyplot.subplots(2, 3, layout="constrained", figsize=(14, 8))
        for axis, (title, solvers, obstacles, plans) in zip(axes.flat, CURVES):
            rows = _errors(weft, scene, devices, iterations, solvers, plans.values(), obstacles,
                           folder)
            _draw_errors(axis, title, rows, plans, tell)
        _draw_depths(axes.flat[len(CURVES)], weft, scene, devices, pathlib.Path(folder), tell)
        axes.flat[-1].set_visible(False)
        figure.suptitle(f"{pathlib.Path(scene).stem}: asynchronous iterations", fontsize=11)
    return figure


def _call(weft, *arguments):
    result = subprocess.run([weft, *map(str, arguments)], capture_output=True, text=True,
                            check=False)
    if result.returncode != 0:
        raise ValueError(result.stderr.strip() or f"{weft} ended with {result.returncode}")


def _errors(weft, scene, devices, iterations, solvers, plans, obstacles, folder):
    """Of each solver and plan: iterations and relative errors."""
    _call(weft, "error", scene, "--solvers", solvers, "--devices", devices, "--plans",
          ",".join(plans), "--max-iterations", iterations, "--time", 60, "--out", folder, "--quiet",
          *(["--obstacles"] if obstacles else []))
    curves = {}
    with open(pathlib.Path(folder) / "error.csv", newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            point = int(row["iteration"]), float(row["relative_error"])
            curves.setdefault((row["solver"], row["plan"]), []).append(point)
    return curves


def _draw_errors(axis, title, curves, plans, tell):
    names = {plan: name for name, plan in plans.items()}
    several = len({solver for solver, _ in curves}) > 1
    for number, ((solver, plan), points) in enumerate(curves.items()):
        x, y = zip(*points)
        label = f"{solver}, {names[plan]}" if several else names[plan]
        colour = number // len(plans) if several else number
        dashed = several and number % len(plans) > 0
        axis.plot(x, y, label=label, color=COLOURS[colour], linewidth=1.4,
                  linestyle="--" if dashed else "-")
        tell(f"{title}: {label}: {y[-1]:.3g} after {x[-1]} iterations")
    axis.set_yscale("log")
    axis.set_title(title, loc="left")
    axis.set_xlabel("iterations")
    axis.set_ylabel("relative error")
    axis.legend(fontsize=7)


def _draw_depths(axis, weft, scene, devices, folder, tell):
    import tomllib  # of Python 3.11; the other pictures need none
    with open(scene, "rb") as file:
        balls = [o for o in tomllib.load(file).get("obstacle", []) if o["shape"] == "sphere"]
    if not balls:
        raise ValueError(f"{scene}: figure 7 needs an obstacle with shape = \"sphere\"")
    for number, (label, settings) in enumerate(DEPTHS.items()):
        out = folder / f"run{number}"
        _call(weft, "run", scene, "--device", devices, "--plan", "async", "--async", settings,
              "--no-trace", "--quiet", "--out", out)
        depths = 1e3 * _depths(out / "frames.vtkhdf", balls)
        axis.plot(depths, label=label, color=COLOURS[number // 2], linewidth=1.4,
                  linestyle="--" if number % 2 else "-")
        tell(f"7: {label}: {depths.max():.3g} mm at the most")
    axis.set_title("7 how deep the ball is entered", loc="left")
    axis.set_xlabel("frame")
    axis.set_ylabel("deepest vertex [mm]")
    axis.set_ylim(top=1.4 * axis.get_ylim()[1])  # room for the legend
    axis.legend(fontsize=7, loc="upper left")


def _depths(geometry, balls):
    """[frames] how deep the deepest vertex is [m]; 0: none is inside."""
    with h5py.File(geometry, "r") as file:
        root = file["VTKHDF"]
        steps = int(root["Steps"].attrs["NSteps"])
        count = int(root["NumberOfPoints"][0])
        points = root["Points"][:steps * count].reshape(steps, count, 3).astype(float)
    depth = numpy.zeros(steps)
    for ball in balls:
        distance = numpy.linalg.norm(points - numpy.array(ball["center"]), axis=2)
        depth = numpy.maximum(depth, (ball["radius"] - distance).max(axis=1))
    return depth
