"""Traces for the tests of the commands that read them, and traces that cannot be read."""

import os
import pathlib
import subprocess

import h5py
import pytest
from weft_program import CORES, LONG, SHEET, expect_error, opencl_devices, start_weft
from weft_program import wait_for_frames, weft, weft_json

FIXTURE = pathlib.Path(os.environ["WEFT_BIN"]) / "trace_fixture"

# Wide enough for several strips, with every kind of task that planning has to place.
WIDE = SHEET.replace("[12, 12]", "[12, 120]").replace("frames = 3", "frames = 8") + """
bend = { stiffness = 1.0e-4 }
pins = { corners = ["x-z-", "x+z-"] }
"""


def record(folder, *arguments, scene=WIDE):
    """The trace of a finished run."""
    (folder / "scene.toml").write_text(scene)
    result = weft("run", "scene.toml", "--no-geometry", "--quiet", "--force", *arguments, cwd=folder)
    assert result.returncode == 0, result.stderr
    return folder / "out/sheet/trace.h5"


def two_devices(*more):
    """Arguments for a run on two devices, of which one is OpenCL's."""
    if CORES < 2 or not opencl_devices():
        pytest.skip("a mixture needs two cores and OpenCL")
    return ["--device", "cpu/1+opencl:0/1", "--plan", "exact", *more]


def divided(folder, *more, scene_options=()):
    """The trace of a run in which both devices have half of the strips, whatever planning thinks."""
    arguments = two_devices(*more)[:2]
    (folder / "scene.toml").write_text(WIDE)
    count = weft_json("inspect", "scene.toml", *scene_options, cwd=folder)["strips"]
    strips = f"{count // 2},{count - count // 2}"
    return record(folder, *arguments, "--strips", strips, *more, *scene_options)


def record_killed(folder):
    """The trace of a run that was killed."""
    (folder / "scene.toml").write_text(LONG.replace("substeps = 200", "substeps = 40"))
    process = start_weft("run", "scene.toml", "--device", "cpu/1", "--no-geometry", cwd=folder)
    trace = folder / "out/sheet/trace.h5"
    wait_for_frames(trace, 5, process)
    process.kill()
    process.communicate()
    return trace


def made_up(folder, frames=6):
    """A trace of the synthetic run of tests/runtime/trace: two devices, discrete memory."""
    path = folder / "made_up.h5"
    subprocess.run([FIXTURE, path, str(frames)], check=True)
    return path


def old(folder):
    """As an older weft would have written it: without graphs, links and hashes."""
    path = made_up(folder)
    with h5py.File(path, "r+") as file:
        for name in ["divisions", "dependencies", "links"]:
            del file[name]
        frames = file["frames"][:]
        names = [n for n in frames.dtype.names if n not in ("graph", "planner", "state_hash")]
        del file["frames"]
        file["frames"] = frames[names]
        del file["run"].attrs["scene_path"]
    return path


def expect_unreadable_traces_refused(folder, *command):
    """What every command that reads a trace says to what is none."""
    def refused(name, *parts):
        expect_error(weft(*command, name, cwd=folder), 2, name, *parts)

    refused("missing.h5", "no such trace")
    (folder / "folder.h5").mkdir()
    refused("folder.h5", "is a folder")
    (folder / "text.h5").write_text("[scene]\n")
    refused("text.h5", "not a trace", "not an HDF5 file, or was cut off")
    with h5py.File(folder / "foreign.h5", "w") as file:
        file["positions"] = [1.0, 2.0]
    refused("foreign.h5", "not a trace of Weft")
    whole = made_up(folder).read_bytes()
    for part in [0.01, 0.3, 0.8]:
        (folder / "cut.h5").write_bytes(whole[:int(part * len(whole))])
        refused("cut.h5")
    with h5py.File(made_up(folder), "r+") as file:
        file.attrs["format_version"] = 99
    refused("made_up.h5", "format version 99", "this Weft reads version 1")
    empty = made_up(folder, frames=0)
    refused(empty.name, "no complete frame")
