"""`weft compare`: what it says beside times."""

import json
import os
import subprocess

import pytest
from weft_program import CORES, SHEET, WEFT, weft, weft_json

# Far too stiff for one substep of that length: a run stops in frame 2.
EXPLODES = ["--set", "scene.dt=0.08", "--substeps", "1", "--solver", "xpbd", "--iterations", "5",
            "--set", "cloth[0].stretch.stiffness=1e6", "--frames", "4"]


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "falls.toml").write_text(SHEET)
    (tmp_path / "hangs.toml").write_text(SHEET + 'pins = { corners = ["x-z-", "x+z-"] }\n')
    return tmp_path


def test_what_stops_a_run_is_told(folder):
    stopped = weft("run", "hangs.toml", "--device", "cpu/1", *EXPLODES, cwd=folder)
    assert stopped.returncode == 1 and "energy from nowhere" in stopped.stderr
    compared = weft("compare", "hangs.toml", "--devices", "cpu/1,cpu/2", "--quiet", *EXPLODES,
                    cwd=folder)
    assert compared.returncode == 0
    told = [line for line in compared.stderr.splitlines() if "energy from nowhere" in line]
    assert told[0].startswith("weft: warning: frame ")
    assert len(told) == len(set(told)), "once, however many lists there are"


def test_warnings_are_in_the_file(folder):
    compared = weft_json("compare", "hangs.toml", "--devices", "cpu/1", *EXPLODES, cwd=folder)
    assert any("energy from nowhere" in warning for warning in compared["warnings"])


def test_what_runs_well_is_not_warned_of(folder):
    compared = weft_json("compare", "falls.toml", "--devices", "cpu/1,cpu/2", "--frames", "3",
                         cwd=folder)
    assert compared["warnings"] == []
    assert len({row["state_hash"] for row in compared["rows"]}) == 1


@pytest.mark.skipif(CORES < 2, reason="needs two devices")
def test_asynchronous_states_are_not_compared(folder):
    """They depend on the cuts, by design."""
    compared = weft("compare", "hangs.toml", "--devices", "cpu/1+cpu/1,cpu/1", "--plan", "async",
                    "--json", cwd=folder)
    rows = json.loads(compared.stdout)["rows"]
    assert rows[0]["state_hash"] != rows[1]["state_hash"]
    assert "another state" not in compared.stderr


def test_warnings_may_hold_any_bytes(folder):
    """Paths are whatever bytes they are, and workers hand warnings on as JSON."""
    place = os.fsencode(folder) + b"/\xff"
    try:
        os.mkdir(place)
    except OSError:
        pytest.skip("this file system wants UTF-8")
    with open(place + b"/sheet.obj", "w") as file:
        file.write("odd\nv 0 0 0\nv 1 0 0\nv 0 0 1\nv 1 0 1\nf 1 3 2\nf 2 3 4\n")
    scene = SHEET.replace("grid = { size = [1.0, 1.0], resolution = [12, 12] }",
                          'mesh = "sheet.obj"')
    with open(place + b"/scene.toml", "w") as file:
        file.write(scene)
    compared = subprocess.run([WEFT, "compare", place + b"/scene.toml", "--devices", "cpu/1",
                               "--quiet"], capture_output=True, cwd=folder)
    assert compared.returncode == 0, compared.stderr
    assert b"unknown keywords" in compared.stderr
