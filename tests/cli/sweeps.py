"""Sweeps for the tests of `weft batch`, which import the fixtures, too: of a sheet that is done at
once, and of one that takes some seconds."""

import csv
import json
import time

import pytest
from weft_program import SHEET as FREE_SHEET
from weft_program import weft, weft_json

# Held at a corner, so that its stiffness matters.
SHEET = FREE_SHEET + 'pins = { corners = ["x-z-"] }\n'

SWEEP = """
sweep = { name = "s", scene = "scene.toml" }
run = { device = "cpu/1", geometry = false, checkpoint = 0 }
[[axis]]
key = "cloth[0].stretch.stiffness"
values = [1e3, 1e4]
[[axis]]
key = "run.plan"
values = ["auto", "single"]
"""
# A run that takes some seconds, in frames of some 20 ms.
LONG = SHEET.replace("frames = 3", "frames = 60").replace("substeps = 2", "substeps = 200")


def written(folder, scene):
    """The folder, with a sweep of the scene in it."""
    (folder / "scene.toml").write_text(scene)
    (folder / "sweep.toml").write_text(SWEEP)
    return folder


@pytest.fixture
def folder(tmp_path):
    return written(tmp_path, SHEET)


@pytest.fixture
def long_folder(tmp_path):
    return written(tmp_path, LONG)


def batch(folder, *arguments, **options):
    return weft("batch", *arguments, cwd=folder, **options)


def make(folder, text=None):
    if text is not None:
        (folder / "sweep.toml").write_text(text)
    result = batch(folder, "sweep.toml", "--json")
    assert result.returncode == 0, result.stderr
    return json.loads(result.stdout)


def states(folder, *arguments):
    runs = weft_json("batch", "out/s", "--list", *arguments, cwd=folder)
    return {run["index"]: run["state"] for run in runs}


def run_folder(folder, index):
    lines = (folder / "out/s/manifest.jsonl").read_text().splitlines()[1:]
    return folder / "out/s/runs" / json.loads(lines[index])["id"]


def hash_of(folder, index):
    return json.loads((run_folder(folder, index) / "summary.json").read_text())["state_hash"]


def wait_for_checkpoint(folder, index, limit=60.0):
    end = time.monotonic() + limit
    while not (run_folder(folder, index) / "checkpoint").exists():
        assert time.monotonic() < end
        time.sleep(0.01)


def whole_hash(folder):
    """Of run 0 as one that was never stopped."""
    result = weft("run", "scene.toml", "--device", "cpu/1", "--quiet", "--set",
                  "cloth[0].stretch.stiffness=1000.0", "--out", "whole", cwd=folder)
    assert result.returncode == 0, result.stderr
    return json.loads((folder / "whole/summary.json").read_text())["state_hash"]


def results(folder):
    with open(folder / "out/s/results.csv", newline="") as file:
        return list(csv.DictReader(file))
