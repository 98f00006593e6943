"""A sweep by GNU parallel: stopped in the middle, and gone on with."""

import json
import os
import pathlib
import shutil
import signal
import subprocess
import time

import pytest
from weft_program import SHEET, WEFT, weft, weft_json

pytestmark = pytest.mark.skipif(shutil.which("parallel") is None, reason="not installed: parallel")

SWEEP = """
sweep = { name = "s", scene = "scene.toml" }
run = { device = "cpu/1", geometry = false, checkpoint = 0 }
[[axis]]
key = "run.repeat"
range = { from = 1, to = 4, count = 4 }
"""
LONG = SHEET.replace("frames = 3", "frames = 100").replace("substeps = 2", "substeps = 200")


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", f"{pathlib.Path(WEFT).parent}:{os.environ['PATH']}")
    (tmp_path / "scene.toml").write_text(LONG)
    (tmp_path / "sweep.toml").write_text(SWEEP)
    result = weft("batch", "sweep.toml", cwd=tmp_path)
    assert result.returncode == 0, result.stderr
    return tmp_path


def listed(folder):
    return weft_json("batch", "out/s", "--list", cwd=folder)


def hashes(folder):
    return {json.loads(path.read_text())["state_hash"]
            for path in folder.glob("out/s/runs/*/summary.json")}


def test_stopped_and_gone_on_with(folder):
    command = ["parallel", "-j2", "--joblog", "log", "--termseq", "TERM,60000,KILL,25",
               "weft batch out/s --index {}", ":::", "0", "1", "2", "3"]
    process = subprocess.Popen(command, cwd=folder, stderr=subprocess.PIPE, text=True)
    end = time.monotonic() + 60
    while len(list(folder.glob("out/s/runs/*/checkpoint"))) < 2:
        assert time.monotonic() < end
        time.sleep(0.05)
    for _ in range(2):  # the first one only keeps parallel from starting more
        process.send_signal(signal.SIGTERM)
        time.sleep(0.1)
    process.communicate(timeout=90)
    assert [run["state"] for run in listed(folder)][2:] == ["waiting", "waiting"]
    assert {run["state"] for run in listed(folder)[:2]} <= {"stopped", "finished"}
    again = subprocess.run([*command[:3], "log", "--resume-failed", *command[4:]], cwd=folder)
    assert again.returncode == 0
    assert {run["state"] for run in listed(folder)} == {"finished"}
    assert len(hashes(folder)) == 1


def test_the_script_that_is_printed(folder):
    script = weft("batch", "sweep.toml", "--script", "parallel", cwd=folder).stdout
    assert subprocess.run(["bash", "-c", script], cwd=folder).returncode == 0
    assert {run["state"] for run in listed(folder)} == {"finished"}
    assert len(hashes(folder)) == 1
    assert (folder / "out/s/results.csv").exists()
