"""The program as its users call it, and the scenes that the tests of this folder give it."""

import json
import os
import pathlib
import subprocess
import time

import h5py
import pytest

WEFT = os.environ["WEFT"]
SCENES = pathlib.Path(os.environ["WEFT_ROOT"]) / "scenes"
CORES = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()

# A sheet comes down on another one, which hangs at two sides, a little askew.
TOUCHING = """
[scene]
name = "touching"
frames = 8
dt = 0.01
substeps = 4
[solver]
method = "vbd"
iterations = 20
[contact]
thickness = 0.02
[[cloth]]
name = "low"
grid = { size = [0.5, 0.5], resolution = [9, 9] }
density = 0.2
stretch = { stiffness = 300.0 }
pins = { edges = ["x-", "x+"] }
[[cloth]]
name = "high"
grid = { size = [0.3, 0.3], resolution = [7, 7] }
rotate = [0, 1, 0, 20]
translate = [0.01, 0.021, 0.02]
density = 0.2
stretch = { stiffness = 300.0 }
"""

SHEET = """
[scene]
name = "sheet"
frames = 3
dt = 0.02
substeps = 2

[solver]
method = "xpbd"
iterations = 2

[[cloth]]
name = "sheet"
grid = { size = [1.0, 1.0], resolution = [12, 12] }
density = 0.2
stretch = { stiffness = 1.0e4 }
"""

# Far more frames than there is time for: for runs that are stopped on their way.
LONG = SHEET.replace("frames = 3", "frames = 3000").replace("substeps = 2", "substeps = 200")


def weft(*arguments, cwd=None, stdout=subprocess.PIPE, launcher=(), **options):
    """Runs weft to its end, by way of a launcher if given; text of both streams is captured."""
    command = [*launcher, WEFT, *map(str, arguments)]
    return subprocess.run(command, cwd=cwd, stdout=stdout, stderr=subprocess.PIPE, text=True,
                          timeout=600, **options)


def weft_json(*arguments, **options):
    """Runs weft with --json --quiet, which must succeed and say nothing else."""
    result = weft(*arguments, "--json", **options)
    assert result.returncode == 0, result.stderr
    return json.loads(result.stdout)


def start_weft(*arguments, cwd, **options):
    command = [WEFT, *map(str, arguments)]
    return subprocess.Popen(command, cwd=cwd, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                            text=True, **options)


def expect_error(result, code, *parts):
    """One line on stderr that holds all parts, nothing on stdout."""
    errors = [line for line in result.stderr.splitlines() if line.startswith("weft: error: ")]
    assert result.returncode == code, result.stderr
    assert len(errors) == 1 and result.stderr.endswith(errors[0] + "\n"), result.stderr
    assert result.stdout == ""
    for part in parts:
        assert part in errors[0]


def wait_until(condition, process, complaint, limit=60.0):
    """Returns when the condition holds while a program is running."""
    end = time.monotonic() + limit
    while time.monotonic() < end:
        assert process.poll() is None, process.stderr.read()
        if condition():
            return
        time.sleep(0.005)
    process.kill()
    pytest.fail(complaint)


def wait_for_frames(trace, count, process):
    """Returns when the trace of a running program has so many frames."""
    def has_frames():
        try:
            with h5py.File(trace, swmr=True) as file:
                return len(file["frames"]) >= count
        except (OSError, KeyError):
            return False  # not there yet, or not ready for readers
    wait_until(has_frames, process, "the run wrote no frames")


def wait_for_checkpoints(checkpoint, count, process):
    """Returns when a running program has been seen to write so many, one after the other."""
    seen = set()

    def has_written():
        if checkpoint.exists():
            seen.add(checkpoint.stat().st_mtime_ns)
        return len(seen) >= count
    wait_until(has_written, process, "the run wrote no checkpoints")


def opencl_devices():
    """OpenCL devices as --device takes them; none where there is no platform."""
    return [d["device"] for d in weft_json("devices")["devices"] if d["device"] != "cpu"]
