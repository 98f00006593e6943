"""`weft error --trajectory`: whole runs against one with far smaller steps."""

import csv
import xml.etree.ElementTree as xml

import h5py
import pytest
from weft_program import SHEET, TOUCHING, expect_error, weft, weft_json

SVG = "{http://www.w3.org/2000/svg}"
SWINGING = SHEET.replace("frames = 3", "frames = 5").replace("1.0e4", "1.0e3") + """
bend = { stiffness = 1.0e-4 }
pins = { corners = ["x-z-", "x+z-"] }
"""
SWEEP = ["--sweep-substeps", "1,2,8", "--sweep-iterations", "1,4,16", "--max-work", "32"]


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "scene.toml").write_text(SWINGING)
    return tmp_path


def trajectories(folder, *arguments):
    study = weft_json("error", "scene.toml", "--trajectory", "--out", "out", *arguments, cwd=folder)
    with open(folder / "out" / "trajectory.csv") as file:
        return study, list(csv.DictReader(file))


def beats(a, b):
    time, distance = float(a["time_s"]), float(a["rms_m"])
    return (time <= float(b["time_s"]) and distance <= float(b["rms_m"])
            and (time, distance) != (float(b["time_s"]), float(b["rms_m"])))


def test_whole_runs(folder):
    study, rows = trajectories(folder, "--devices", "cpu/1,cpu/2", *SWEEP)
    pairs = {(s, i) for s in (1, 2, 8) for i in (1, 4, 16) if s * i <= 32}
    solvers = {row["solver"] for row in rows}
    assert {"xpbd", "vbd", "jpgd"} <= solvers
    assert len(rows) == len(solvers) * 2 * len(pairs)
    assert study["reference"]["by"] == "explicit steps in double precision"
    assert study["reference"]["substeps"] >= 64 and study["frames"] == 5

    distances = {}
    for row in rows:
        assert (int(row["substeps"]), int(row["iterations"])) in pairs
        assert float(row["time_s"]) > 0.0 and row["unfinished"] == ""
        key = row["solver"], int(row["substeps"]), int(row["iterations"])
        assert distances.setdefault(key, row["rms_m"]) == row["rms_m"], "any device, the same bits"
    for solver in ("xpbd", "vbd"):
        coarse, fine = (float(distances[solver, *pair]) for pair in ((1, 16), (8, 4)))
        assert fine < 0.5 * coarse, "smaller steps are nearer"
    doubt = study["reference"]["doubt_m"]
    assert 0.0 < doubt < min(float(row["rms_m"]) for row in rows)

    for row in rows:
        assert int(row["pareto"]) == (not any(beats(other, row) for other in rows))


def test_runs_with_contact(folder):
    """The reference is a solver's; all solvers tend to where it is."""
    (folder / "scene.toml").write_text(TOUCHING)
    study, rows = trajectories(folder, "--devices", "cpu/1", "--solvers", "xpbd,newton", *SWEEP)
    reference = study["reference"]
    assert reference["by"] == "newton with 12 iterations" and reference["substeps"] == 16
    distances = {(row["solver"], int(row["substeps"]), int(row["iterations"])): float(row["rms_m"])
                 for row in rows}
    for solver in ("xpbd", "newton"):
        coarse, middle, fine = (distances[solver, substeps, 4] for substeps in (1, 2, 8))
        assert fine < 0.3 * coarse and middle < coarse, "smaller steps are nearer"
    assert 0.0 < reference["doubt_m"] < 0.3 * distances["newton", 1, 4]
    expect_error(weft("error", "scene.toml", "--trajectory", "--quiet", *SWEEP,
                      "--reference-substeps", "15", cwd=folder), 2, "15", "16", "twice")


def test_files_and_picture(folder):
    study, rows = trajectories(folder, "--devices", "cpu/1", "--solvers", "xpbd,vbd", *SWEEP)
    with h5py.File(folder / "out" / "trajectory.h5") as file:
        assert file.attrs["format"] == "weft-trajectory"
        assert file["reference/doubt_m"][0] == study["reference"]["doubt_m"]
        assert file["reference"].attrs["by"] == study["reference"]["by"]
        for curve, solver in zip(file["curves"].values(), ("xpbd", "vbd")):
            assert curve.attrs["solver"] == solver and curve.attrs["unfinished"] == ""
            own = [row for row in rows if row["solver"] == solver]
            for name in ("substeps", "iterations", "time_s", "rms_m", "last_rms_m", "pareto"):
                assert [float(row[name]) for row in own] == list(map(float, curve[name]))
    picture = xml.parse(folder / "out" / "trajectory.svg").getroot()
    notes = [title.text for title in picture.iter(f"{SVG}title")]
    assert len(notes) == len(rows)
    texts = [text.text for text in picture.iter(f"{SVG}text")]
    for row in rows:
        if row["pareto"] == "1":
            assert f"{row['substeps']}x{row['iterations']}" in texts


def test_runs_without_an_end_are_told(folder):
    _, rows = trajectories(folder, "--devices", "cpu/1", "--solvers", "vbd", "--time", "0", *SWEEP)
    assert rows and all(row["rms_m"] == "" and row["time_s"] == "" for row in rows[1:])
    assert all("--time 0" in row["unfinished"] for row in rows[1:])
    # A run that goes wrong is told, too; the reference has no guard.
    (folder / "scene.toml").write_text(SWINGING + "\n[guard]\nmax_speed = 1.0e-3\n")
    _, rows = trajectories(folder, "--devices", "cpu/1", "--solvers", "vbd", *SWEEP)
    assert rows and all("diverged" in row["unfinished"] for row in rows)


@pytest.mark.parametrize("arguments, parts", [
    (["--frame", "2"], ["--frame"]),
    (["--substeps", "2"], ["--substeps"]),
    (["--sweep-substeps", "0,1"], ["--sweep-substeps 0"]),
    (["--max-work", "0"], ["--max-work 0"]),
    (["--reference-substeps", "200", "--sweep-substeps", "128"], ["200", "256", "twice"]),
    (["--reference-substeps", "3", "--sweep-substeps", "1"], ["3", "stable"]),
    (["--solvers", "xpdb"], ["xpdb", "xpbd"]),
])
def test_wrong_requests(folder, arguments, parts):
    expect_error(weft("error", "scene.toml", "--trajectory", "--quiet", *arguments, cwd=folder), 2,
                 *parts)
