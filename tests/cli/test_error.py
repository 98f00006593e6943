"""`weft error`: the step, its minimum, and the curves of all solvers and devices."""

import csv

import h5py
import pytest
from weft_program import SHEET, expect_error, weft, weft_json

HANGING = SHEET.replace("frames = 3", "frames = 6") + """
bend = { stiffness = 1.0e-4 }
pins = { corners = ["x-z-", "x+z-"] }
"""


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "scene.toml").write_text(HANGING)
    return tmp_path


def read_curves(path):
    curves = {}
    with open(path) as file:
        for row in csv.DictReader(file):
            curves.setdefault((row["solver"], row["device"], row["plan"]), []).append(row)
    return curves


def test_curves_start_at_one_and_stay_above_the_minimum(folder):
    result = weft("error", "scene.toml", "--out", "out", "--devices", "cpu/1,cpu/2",
                  "--plans", "auto,single", "--max-iterations", "200", cwd=folder)
    assert result.returncode == 0, result.stderr
    assert "to 1e-3" in result.stdout
    curves = read_curves(folder / "out" / "error.csv")
    assert {key[1:] for key in curves} == {(device, plan) for device in ("cpu/1", "cpu/2")
                                           for plan in ("auto", "single")}
    for curve in curves.values():
        errors = [float(row["relative_error"]) for row in curve]
        iterations = [int(row["iteration"]) for row in curve]
        times = [float(row["time_s"]) for row in curve]
        assert iterations[:4] == [0, 1, 2, 3] and iterations[-1] == 200
        assert errors[0] == 1.0 and times[0] == 0.0
        assert min(errors) > 0.0, "no solver is below the minimum"
        assert errors[-1] < 0.05
        assert all(time > 0.0 for time in times[1:])
    energies = {key: [row["energy"] for row in curve] for key, curve in curves.items()}
    for solver in {key[0] for key in curves}:
        own = [value for key, value in energies.items() if key[0] == solver]
        assert all(value == own[0] for value in own), "the same bits on every device and plan"


def test_file_holds_the_same_as_the_table(folder):
    study = weft_json("error", "scene.toml", "--out", "out", "--devices", "cpu/1", "--solvers",
                      "xpbd", "--frame", "2", "--max-iterations", "20", cwd=folder)
    curve = read_curves(folder / "out" / "error.csv")[("xpbd", "cpu/1", "auto")]
    with h5py.File(folder / "out" / "error.h5") as file:
        assert file.attrs["format"] == "weft-error"
        assert file["reference/energy"][0] == study["reference_energy"]
        group = file["curves/000"]
        assert group.attrs["solver"] == "xpbd"
        for name in ("iteration", "time_s", "energy", "relative_error"):
            assert [float(row[name]) for row in curve] == list(map(float, group[name]))
    assert study["frame"] == 2
    assert study["certificate"]["relative_gap"] < 1e-9
    assert study["reference_energy"] < study["start_energy"]
    assert 0.0 < study["rounding_floor"] < 1e-2
    assert study["curves"][0]["iterations"] == 20
    for goal, reached in study["curves"][0]["to"].items():
        rows = [row for row in curve if float(row["relative_error"]) <= float(goal)]
        assert reached == ({"time_s": float(rows[0]["time_s"]),
                            "iterations": int(rows[0]["iteration"])} if rows else None)


def test_second_time_takes_the_minimum_from_the_cache(folder):
    arguments = ["error", "scene.toml", "--out", "out", "--devices", "cpu/1", "--max-iterations",
                 "1"]
    environment = {"WEFT_CACHE_DIR": str(folder / "cache"), "PATH": "/usr/bin:/bin"}
    first = weft(*arguments, cwd=folder, env=environment)
    second = weft(*arguments, cwd=folder, env=environment)
    assert "reference: 1 iterations" in first.stderr
    assert "reference:" not in second.stderr
    assert first.stdout.splitlines()[1] == second.stdout.splitlines()[1]
    # Damaged, it is computed again.
    (cached,) = (folder / "cache").glob("minimum-*.bin")
    data = bytearray(cached.read_bytes())
    data[60] ^= 1
    cached.write_bytes(data)
    third = weft(*arguments, cwd=folder, env=environment)
    assert "reference: 1 iterations" in third.stderr
    assert first.stdout.splitlines()[1] == third.stdout.splitlines()[1]


def test_obstacles_are_left_out_and_said_so(folder):
    (folder / "scene.toml").write_text(HANGING + """
[[obstacle]]
shape = "plane"
point = [0.0, -0.02, 0.0]
""")
    study = weft_json("error", "scene.toml", "--out", "out", "--devices", "cpu/1",
                      "--max-iterations", "3", cwd=folder)
    assert any("obstacles" in note for note in study["notes"])


@pytest.mark.parametrize("arguments, parts", [
    (["--frame", "6"], ["--frame 6", "frames 0 to 5"]),
    (["--frame", "-1"], ["--frame -1"]),
    (["--solvers", "xpdb"], ["xpdb", "xpbd"]),
    (["--plans", "exakt"], ["exakt"]),
    (["--devices", "gpu/1"], ["gpu/1"]),
    (["--max-iterations", "0"], ["--max-iterations 0"]),
])
def test_wrong_requests(folder, arguments, parts):
    expect_error(weft("error", "scene.toml", "--out", "out", "--quiet", *arguments, cwd=folder), 2,
                 *parts)


def test_free_fall_has_nothing_to_solve(folder):
    (folder / "scene.toml").write_text(SHEET)
    expect_error(weft("error", "scene.toml", "--out", "out", "--devices", "cpu/1", "--frame", "0",
                      "--quiet", cwd=folder), 2, "nothing to solve", "--frame")
