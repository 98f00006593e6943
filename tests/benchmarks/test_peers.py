"""`./dev peers` without any peer installed: Weft alone, requests that are wrong, sheets that do
nothing, packages that are missing or fail."""

import json
import os
import pathlib
import subprocess
import sys

import numpy
import pytest

PEERS = pathlib.Path(os.environ["WEFT_ROOT"]) / "benchmarks/peers"
sys.path.insert(0, str(PEERS))

import sheet as problem  # noqa: E402  (found by the line above)
import stack as pile  # noqa: E402
import systems  # noqa: E402


def peers(*arguments, **options):
    command = [sys.executable, PEERS, "--weft", os.environ["WEFT"], *map(str, arguments)]
    environment = dict(os.environ, PYTHONDONTWRITEBYTECODE="1", **options)
    return subprocess.run(command, capture_output=True, text=True, env=environment, timeout=250)


SMALL = ["--resolution", 20, "--rounds", 1, "--frames", 10]


@pytest.fixture(scope="module")
def of_weft():
    result = peers("--only", "weft", *SMALL, "--json", "--quiet")
    assert result.returncode == 0, result.stderr
    assert result.stderr == ""
    return json.loads(result.stdout)


def test_json(of_weft):
    rows = {row["system"]: row for row in of_weft["systems"]}
    assert list(rows) == ["weft-xpbd", "weft-xpbd-bend", "weft-vbd", "weft-vbd-bend"]
    springs, hinges = 1121, 1121 - 4 * 19
    sweeps = 10 * 8
    assert rows["weft-xpbd"]["units_per_frame"] == springs * sweeps
    assert rows["weft-xpbd-bend"]["units_per_frame"] == (springs + hinges) * sweeps
    assert rows["weft-vbd"]["units_per_frame"] == (400 - 2) * sweeps
    for row in rows.values():
        assert 0 < row["ms_lowest"] <= row["ms_per_frame"] <= row["ms_highest"]
        nanoseconds = 1e6 * row["ms_per_frame"] / row["units_per_frame"]
        assert row["ns_per_unit"] == pytest.approx(nanoseconds)
        assert "ratio" not in row  # to itself
        assert row["complaint"] == "" and row["mean_height"] < -0.05
    assert of_weft["missing"] == of_weft["failed"] == []


def test_table():
    result = peers("--only", "weft-vbd-bend", *SMALL)
    assert result.returncode == 0, result.stderr
    (row,) = [line for line in result.stdout.splitlines() if line.startswith("weft-")]
    assert row.startswith("weft-vbd-bend ") and "vertex update" in row
    assert "round 1 of 1" in result.stderr


@pytest.mark.parametrize("arguments, parts", [
    (["--only", "weft,newtom"], ["'newtom'", "newton-vbd-bend"]),
    (["--resolution", "3"], ["--resolution", "3 is less than 4"]),
    (["--stack", "1"], ["--stack", "1 is less than 2"]),
    (["--stack", "3", "--only", "pypbd"], ["'pypbd'", "newton-vbd-stack"]),
    (["--rounds", "many"], ["--rounds", "'many'"]),
    (["--weft", "/nowhere/weft"], ["/nowhere/weft", "./dev"]),
])
def test_wrong_requests(arguments, parts):
    result = peers(*arguments)
    assert result.returncode == 2 and result.stdout == ""
    assert result.stderr.startswith("peers: error: ") and result.stderr.count("\n") == 1
    for part in parts:
        assert part in result.stderr


def test_help_has_an_example():
    result = peers("--help")
    assert result.returncode == 0 and "./dev peers --resolution" in result.stdout


def test_missing_package_is_named_and_left_out(tmp_path):
    (tmp_path / "newton.py").write_text("raise ImportError('none on this machine')\n")
    result = peers("--only", "weft-vbd,newton-vbd", *SMALL, PYTHONPATH=str(tmp_path))
    assert result.returncode == 0
    assert "left out newton-vbd: Newton cannot be imported (none on this machine)" in result.stderr
    assert "weft-vbd" in result.stdout and "newton-vbd" not in result.stdout


def test_failing_peer_fails_the_run_but_not_the_others(tmp_path):
    # Throws in the middle of being set up.
    (tmp_path / "pypbd.py").write_text("class Simulation: pass\n")
    result = peers("--only", "weft-xpbd,pypbd-xpbd", *SMALL, "--json", PYTHONPATH=str(tmp_path))
    assert result.returncode == 1
    assert "peers: error: pypbd-xpbd: " in result.stderr
    document = json.loads(result.stdout)
    assert [row["system"] for row in document["systems"]] == ["weft-xpbd"]
    assert [entry["system"] for entry in document["failed"]] == ["pypbd-xpbd"]


def test_weft_that_fails_is_reported():
    result = peers("--only", "weft-xpbd", *SMALL, "--weft", "/bin/false")
    assert result.returncode == 1
    assert "peers: error: weft-xpbd: " in result.stderr


SHEET = problem.Sheet(resolution=20, substeps=10, iterations=8)
FRAMES = 15


def free_fall():
    time = FRAMES * problem.FRAME
    return 0.5 * problem.GRAVITY * time**2


def standing_still(positions):
    return positions


def exploded(positions):
    return positions * 1.0e3


def not_finite(positions):
    return positions * numpy.nan


def falling_without_pins(positions):
    return positions - [0.0, free_fall(), 0.0]


def falling_without_springs(positions):
    fallen = falling_without_pins(positions)
    fallen[SHEET.pins] = positions[SHEET.pins]
    return fallen


def falling_too_fast(positions):
    fallen = positions - [0.0, 2.0 * free_fall(), 0.0]
    fallen[SHEET.pins] = positions[SHEET.pins]
    return fallen


@pytest.mark.parametrize("wrong, complaint", [
    (standing_still, "has not fallen"),
    (exploded, "pinned corner has moved"),
    (not_finite, "no finite positions"),
    (falling_without_pins, "pinned corner has moved"),
    (falling_without_springs, "times as long"),
    (falling_too_fast, "faster than a stone"),
])
def test_sheets_that_are_no_cloth(wrong, complaint):
    assert complaint in problem.look_at(SHEET, wrong(SHEET.positions()), FRAMES).complaint


def test_hanging_sheet_is_one():
    # As a stiff plate that turns about its pinned side.
    positions = SHEET.positions()
    angle = 0.5
    along = positions[:, 2] + 0.5
    positions[:, 1] = -numpy.sin(angle) * along
    positions[:, 2] = -0.5 + numpy.cos(angle) * along
    shape = problem.look_at(SHEET, positions, FRAMES)
    assert shape.complaint == ""
    assert shape.mean_height == pytest.approx(-0.5 * numpy.sin(angle))
    assert shape.longest_edge == pytest.approx(1.0)


def test_counts_are_those_of_a_grid():
    cells = SHEET.resolution - 1
    assert SHEET.edge_count() == 2 * cells * SHEET.resolution + cells**2
    corners = numpy.sort(SHEET.triangles()[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    _, triangles = numpy.unique(corners, axis=0, return_counts=True)
    assert SHEET.hinge_count() == (triangles == 2).sum()


def test_names():
    assert systems.named([]) == systems.ALL
    assert [d.name for d in systems.named(["pypbd", "weft-vbd"])] == [
        "weft-vbd", "pypbd-xpbd", "pypbd-xpbd-bend"]
    everyone = systems.ALL + systems.STACKED
    names = [d.name for d in everyone]
    for description in everyone:
        counterpart = everyone[names.index(description.counterpart)]
        assert counterpart.family == "weft" and counterpart.unit == description.unit


def test_a_stack_of_wefts_sheets():
    result = peers("--stack", 3, "--only", "weft", "--resolution", 12, "--json", "--quiet")
    assert result.returncode == 0, result.stderr
    document = json.loads(result.stdout)
    assert document["sheet"]["sheets"] == 3 and document["frames_per_turn"] == 15
    (row,) = document["systems"]
    assert row["system"] == "weft-vbd-stack" and row["complaint"] == ""
    assert row["units_per_frame"] == 80 * (3 * 144 - 4)
    assert row["ms_per_frame"] > 0 and row["mean_height"] < -0.01
    assert row["crossings"] == (None if pile.find_self_intersections is None else 0)


STACK = pile.Stack(resolution=12, substeps=10, iterations=8, sheets=3)


def landed(gap):
    """Each sheet so far above the one below it."""
    positions = STACK.positions()
    layers = positions[:, 1].reshape(STACK.sheets, -1)
    layers[:] = gap * numpy.arange(STACK.sheets)[:, None]
    positions[:, 1] = layers.ravel()
    return positions


def test_a_stack_that_has_landed_is_one():
    assert problem.look_at(STACK, landed(0.009), FRAMES).complaint == ""


@pytest.mark.parametrize("positions, complaint", [
    (STACK.positions(), "has not come down"),
    (landed(-0.001), "sheet 1 has got below"),
    (numpy.nan * STACK.positions(), "no finite positions"),
    (STACK.positions() + 0.01, "pinned corner has moved"),
])
def test_stacks_that_are_none(positions, complaint):
    assert complaint in problem.look_at(STACK, positions, FRAMES).complaint


@pytest.mark.skipif(pile.find_self_intersections is None, reason="needs libigl from PyPI")
def test_crossings_of_a_stack_are_counted():
    assert STACK.crossings(STACK.positions()) == 0
    sunk = landed(0.009)
    sunk[-78, 1] -= 0.02  # the middle of the uppermost one, through both others
    assert STACK.crossings(sunk) > 0


def test_all_sheets_of_a_stack_turn_about_their_middle():
    positions = STACK.positions().reshape(STACK.sheets, -1, 3)
    assert numpy.allclose(positions.mean(axis=1)[:, [0, 2]], 0.0)
    assert numpy.allclose(numpy.linalg.norm(positions[:, 0, [0, 2]], axis=1), numpy.sqrt(0.5))
