"""`weft error`: the step, its minimum, and the curves of all solvers and devices."""

import csv
import struct
import xml.etree.ElementTree as xml

import h5py
import pytest
from recorded import two_devices
from weft_program import SCENES, SHEET, TOUCHING, expect_error, weft, weft_json

SVG = "{http://www.w3.org/2000/svg}"

HANGING = SHEET.replace("frames = 3", "frames = 6") + """
bend = { stiffness = 1.0e-4 }
pins = { corners = ["x-z-", "x+z-"] }
"""

# A sheet of elastic material with a soft block tied to it, on springs beside it and a ball below:
# everything that a scene can have.
EVERYTHING = """
[scene]
name = "everything"
frames = 8
dt = 0.02
substeps = 4
[[cloth]]
name = "film"
grid = { size = [0.6, 0.6], resolution = [9, 9] }
translate = [0.0, 1.0, 0.0]
density = 0.3
membrane = { young = 1.0e5, poisson = 0.3, thickness = 1.0e-3 }
bend = { stiffness = 1.0e-4 }
damping = 0.3
[[cloth.pins]]
corners = ["x-z-", "x+z-"]
[[cloth.pins]]
corners = ["x-z+", "x+z+"]
motion = { velocity = [0.3, 0.0, -0.3] }
[[cloth]]
name = "net"
grid = { size = [0.4, 0.4], resolution = [6, 6] }
translate = [0.7, 1.0, 0.0]
density = 0.2
stretch = { stiffness = 1.0e3 }
pins = { corners = ["x-z-", "x+z-"] }
[[solid]]
name = "block"
grid = { size = [0.3, 0.15, 0.3], resolution = [5, 3, 5] }
translate = [0.0, 0.92, 0.0]
density = 200.0
young = 2.0e4
poisson = 0.4
[[attachment]]
a = "block"
b = "film"
faces = ["y+"]
stiffness = 1.0e3
[[obstacle]]
shape = "sphere"
center = [0.7, 0.85, 0.1]
radius = 0.1
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
    for (solver, _, _), curve in curves.items():
        errors = [float(row["relative_error"]) for row in curve]
        iterations = [int(row["iteration"]) for row in curve]
        times = [float(row["time_s"]) for row in curve]
        last = 100 if solver == "newton" else 200  # 4000 / solver.cg_steps
        assert iterations[:4] == [0, 1, 2, 3] and iterations[-1] == last
        assert errors[0] == 1.0 and times[0] == 0.0
        assert min(errors) > 0.0, "no solver is below the minimum"
        assert errors[-1] < 0.05
        assert all(time > 0.0 for time in times[1:])
        assert times == sorted(times), "no curve runs back in time"
    energies = {key: [row["energy"] for row in curve] for key, curve in curves.items()}
    for solver in {key[0] for key in curves}:
        own = [value for key, value in energies.items() if key[0] == solver]
        assert all(value == own[0] for value in own), "the same bits on every device and plan"


def test_estimates_of_runs_are_near_the_errors(folder):
    result = weft("error", "scene.toml", "--out", "out", "--devices", "cpu/1",
                  "--max-iterations", "30", cwd=folder)
    assert result.returncode == 0, result.stderr
    compared = 0
    for curve in read_curves(folder / "out" / "error.csv").values():
        assert curve[0]["relative_error_estimate"] == "", "the start is no run's"
        for row in curve[1:]:
            error, estimate = (float(row[name]) for name in ("relative_error",
                                                             "relative_error_estimate"))
            if error < 1e-3:
                continue
            assert error / 3 < estimate < 3 * error
            compared += 1
    assert compared > 30


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


def reference_line(result):
    (line,) = [line for line in result.stdout.splitlines() if line.startswith("reference: E0")]
    return line


def test_second_time_takes_the_minimum_from_the_cache(folder):
    arguments = ["error", "scene.toml", "--out", "out", "--devices", "cpu/1", "--max-iterations",
                 "1"]
    environment = {"WEFT_CACHE_DIR": str(folder / "cache"), "PATH": "/usr/bin:/bin"}
    first = weft(*arguments, cwd=folder, env=environment)
    second = weft(*arguments, cwd=folder, env=environment)
    assert "reference: 1 iterations" in first.stderr
    assert "reference:" not in second.stderr
    assert reference_line(first) == reference_line(second)
    # Damaged, it is computed again.
    (cached,) = (folder / "cache").glob("minimum-*.bin")
    data = bytearray(cached.read_bytes())
    data[60] ^= 1
    cached.write_bytes(data)
    third = weft(*arguments, cwd=folder, env=environment)
    assert "reference: 1 iterations" in third.stderr
    assert reference_line(first) == reference_line(third)


def test_everything_that_a_scene_can_have(folder):
    (folder / "scene.toml").write_text(EVERYTHING)
    study = weft_json("error", "scene.toml", "--out", "out", "--devices", "cpu/1",
                      "--max-iterations", "300", "--time", "60", cwd=folder)
    assert study["energies"] == ["inertia", "springs", "attachments", "membranes", "tetrahedra",
                                 "bending"]
    assert any("obstacles are no part of E" in note for note in study["notes"])
    assert any("damping is no part of E" in note for note in study["notes"])
    curves = read_curves(folder / "out" / "error.csv")
    for (solver, _, _), curve in curves.items():
        errors = [float(row["relative_error"]) for row in curve]
        assert errors[0] == 1.0 and min(errors) > 0.0 and len(errors) > 20
        if solver != "xpbd":  # which does not end at the minimum: docs/solvers.md
            assert errors[-1] < 1e-5, solver


@pytest.mark.parametrize("name", ["flag", "beams", "hammock"])
def test_methods_that_descend_reach_a_thousandth(tmp_path, name):
    study = weft_json("error", SCENES / f"{name}.toml", "--set", "scene.size=150",
                      "--devices", "cpu/1", "--max-iterations", "200", "--time", "60",
                      "--out", "out", cwd=tmp_path)
    assert study["frame"] == 30
    for curve in study["curves"]:
        if curve["solver"] != "xpbd":
            assert curve["to"]["0.001"], curve["solver"]


def test_picture_shows_every_point(folder):
    result = weft("error", "scene.toml", "--out", "out", "--devices", "cpu/1,cpu/2",
                  "--max-iterations", "20", cwd=folder)
    assert result.returncode == 0, result.stderr
    curves = read_curves(folder / "out" / "error.csv")
    picture = xml.parse(folder / "out" / "error.svg").getroot()
    width, height = float(picture.get("width")), float(picture.get("height"))
    notes = [title.text for title in picture.iter(f"{SVG}title")]
    assert len(notes) == sum(len(curve) - 1 for curve in curves.values())
    for (solver, device, plan), curve in curves.items():
        for row in curve[1:]:
            start = f"{solver} on {device}, {plan}: {row['iteration']} iterations, "
            assert sum(note.startswith(start) for note in notes) == 1
    places = [(float(mark.get("x")), float(mark.get("y"))) for mark in picture.iter(f"{SVG}rect")
              if mark.find(f"{SVG}title") is not None]
    assert all(0.0 < x < width and 0.0 < y < height for x, y in places)
    texts = [text.text for text in picture.iter(f"{SVG}text")]
    for solver, device, plan in curves:
        assert f"{solver}, {plan}" in texts and device in texts

    png = folder / "out" / "error.png"
    if "built without cairo" in result.stdout:
        assert not png.exists()
        return
    data = png.read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    # Twice as many pixels, rounded up.
    for size, pixels in zip((width, height), struct.unpack(">2I", data[16:24])):
        assert 2 * size <= pixels < 2 * size + 2


def test_plans_beside_each_other(folder):
    """Exact, asynchronous with two settings, and single on one picture, in time and in iterations."""
    plans = ["exact", "async", "async:window=3+dropping=on", "single"]
    (folder / "scene.toml").write_text(HANGING.replace("[12, 12]", "[12, 60]"))
    result = weft("error", "scene.toml", "--out", "out", "--solvers", "vbd", "--devices",
                  two_devices()[1], "--plans", ",".join(plans), "--max-iterations", "40", cwd=folder)
    assert result.returncode == 0, result.stderr
    curves = {key[2]: value for key, value in read_curves(folder / "out" / "error.csv").items()}
    assert list(curves) == plans
    energies = {plan: [row["energy"] for row in curve] for plan, curve in curves.items()}
    assert energies["exact"] == energies["single"]
    assert energies["async"] != energies["exact"]
    assert energies["async"] != energies["async:window=3+dropping=on"]
    picture = xml.parse(folder / "out" / "error.svg").getroot()
    said = [text.text for text in picture.iter(f"{SVG}text")]
    assert "run time of the step [s]" in said and "iterations" in said
    assert {f"vbd, {plan}" for plan in plans} <= set(said)
    # Every point has a mark in either plot, of which the one in time says what it is.
    points = sum(len(curve) - 1 for curve in curves.values())
    marks = [mark for mark in picture.iter(f"{SVG}rect") if float(mark.get("width")) <= 5.0]
    assert len(marks) == 2 * points + len(plans)  # those of the legend


def test_obstacles_in_the_step(folder):
    """Errors are distances: they vanish, and nobody is asked for a minimum."""
    (folder / "scene.toml").write_text(HANGING + """
[[obstacle]]
shape = "sphere"
center = [0.0, 0.75, 0.0]
radius = 0.2
""")
    study = weft_json("error", "scene.toml", "--out", "out", "--devices", "cpu/1", "--solvers",
                      "xpbd", "--frame", "4", "--obstacles", "--max-iterations", "300", cwd=folder)
    assert any("obstacles are in the step" in note for note in study["notes"])
    assert study["reference_energy"] == 0.0
    (curve,) = read_curves(folder / "out" / "error.csv").values()
    errors = [float(row["relative_error"]) for row in curve]
    assert errors[0] == 1.0 and 0.0 <= errors[-1] < 0.1
    assert all(row["relative_error_estimate"] == "" for row in curve)


@pytest.mark.parametrize("friction", [0.0, 0.4])
def test_contacts_are_in_the_energy(folder, friction):
    """All solvers that can do the scene go to one minimum, and estimates of runs see the same."""
    text = TOUCHING
    if friction:
        text = text.replace("[contact]", f"[contact]\nfriction = {friction}")
    (folder / "scene.toml").write_text(text)
    study = weft_json("error", "scene.toml", "--out", "out", "--devices", "cpu/1", "--frame", "4",
                      "--max-iterations", "400", "--time", "60", cwd=folder)
    assert study["energies"] == ["inertia", "springs", "contact"] + ["friction"] * (friction > 0)
    solvers = {"xpbd", "vbd", "sosd", "jpgd", "newton"}
    curves = {key[0]: curve for key, curve in read_curves(folder / "out" / "error.csv").items()}
    assert set(curves) == solvers
    (note,) = [note for note in study["notes"] if "contacts, as they are where it begins" in note]
    assert int(note.split()[3]) > 50
    compared = 0
    for solver, curve in curves.items():
        errors = [float(row["relative_error"]) for row in curve]
        assert errors[0] == 1.0 and min(errors) > -1e-9
        assert errors[-1] < (1e-3 if solver == "xpbd" else 1e-4), solver
        for row in curve[1:]:
            error, estimate = (float(row[name]) for name in ("relative_error",
                                                             "relative_error_estimate"))
            if error < 1e-3:
                continue
            assert error / 3 < estimate < 3 * error, (solver, row["iteration"])
            compared += 1
    assert compared > 20


def test_planes_in_the_way_are_told(folder):
    """What planes hold back counts as error, and is no silence."""
    text = TOUCHING.replace('translate = [0.01, 0.021, 0.02]', 'translate = [0.01, 0.004, 0.02]')
    (folder / "scene.toml").write_text(text.replace("dt = 0.01", "dt = 0.05"))
    arguments = ["error", "scene.toml", "--out", "out", "--devices", "cpu/1", "--solvers", "vbd",
                 "--frame", "0", "--max-iterations", "400"]
    free = weft_json(*arguments, cwd=folder)["curves"][0]
    study = weft_json(*arguments, "--planes", cwd=folder)
    assert free["truncated"] == 0 and free["relative_error"] < 1e-4
    assert study["curves"][0]["relative_error"] > 10 * free["relative_error"]
    (curve,) = read_curves(folder / "out" / "error.csv").values()
    held = int(curve[-1]["truncated"])
    assert held > 0 and study["curves"][0]["truncated"] == held
    (note,) = [note for note in study["notes"] if "where these curves end" in note]
    assert f"vbd on cpu/1 (auto): {held}" in note


@pytest.mark.parametrize("arguments, parts", [
    (["--plans", "async:window=0"], ["--async window=0"]),
    (["--plans", "exact:window=2"], ["--plans exact:window=2", "only async"]),
    (["--plans", "async:tasks=kinds", "--solvers", "vbd"], ["tasks=kinds", "xpbd"]),
    (["--frame", "6"], ["--frame 6", "frames 0 to 5"]),
    (["--frame", "-1"], ["--frame -1"]),
    (["--solvers", "xpdb"], ["xpdb", "xpbd"]),
    (["--plans", "exakt"], ["exakt"]),
    (["--devices", "gpx/1"], ["gpx/1"]),
    (["--max-iterations", "0"], ["--max-iterations 0"]),
])
def test_wrong_requests(folder, arguments, parts):
    expect_error(weft("error", "scene.toml", "--out", "out", "--quiet", *arguments, cwd=folder), 2,
                 *parts)


def test_free_fall_has_nothing_to_solve(folder):
    (folder / "scene.toml").write_text(SHEET)
    expect_error(weft("error", "scene.toml", "--out", "out", "--devices", "cpu/1", "--frame", "0",
                      "--quiet", cwd=folder), 2, "nothing to solve", "--frame")


def study_of(folder, *arguments):
    return weft_json("error", "scene.toml", "--out", "out", "--devices", "cpu/1", "--solvers",
                     "vbd", "--max-iterations", "2", *arguments, cwd=folder)


@pytest.mark.parametrize("solver", ["xpbd", "vbd"])
def test_start_from_a_kept_checkpoint(folder, solver):
    """The same step as after a run up to there, whatever solver's order its state is in."""
    (folder / "scene.toml").write_text(HANGING.replace('"xpbd"', f'"{solver}"'))
    summary = weft_json("run", "scene.toml", "--frames", "4", "--keep-checkpoint", "--device",
                        "cpu/1", cwd=folder)
    checkpoint = folder / "out/sheet/checkpoint"
    assert summary["files"]["checkpoint"] and checkpoint.exists()
    by_run = study_of(folder, "--frame", "4")
    (folder / "scene.toml").write_text(HANGING)
    by_file = study_of(folder, "--start", checkpoint)
    for key in ("frame", "start_energy", "reference_energy"):
        assert by_file[key] == by_run[key], key
    expect_error(weft("error", "scene.toml", "--start", checkpoint, "--frame", "2", cwd=folder), 2,
                 "frame 4", "--frame")


def test_start_from_a_frame_of_a_geometry(folder):
    """Its velocities are those between two frames, so the step is nearly the same."""
    weft_json("run", "scene.toml", "--frames", "5", "--device", "cpu/1", cwd=folder)
    geometry = folder / "out/sheet/frames.vtkhdf"
    assert not (folder / "out/sheet/checkpoint").exists()
    assert study_of(folder, "--start", geometry)["frame"] == 5
    near = study_of(folder, "--start", geometry, "--frame", "3")
    exact = study_of(folder, "--frame", "3")
    assert near["frame"] == 3
    assert near["start_energy"] != exact["start_energy"]
    assert near["reference_energy"] == pytest.approx(exact["reference_energy"], rel=0.5)
    expect_error(weft("error", "scene.toml", "--start", geometry, "--frame", "17", cwd=folder), 2,
                 "frames.vtkhdf", "no state at the start of frame 17")


def test_start_from_what_is_no_state_of_the_scene(folder):
    weft_json("run", "scene.toml", "--frames", "2", "--keep-checkpoint", "--device", "cpu/1",
              cwd=folder)
    (folder / "other.toml").write_text(HANGING.replace("[12, 12]", "[13, 12]"))
    (folder / "heavy.toml").write_text(HANGING.replace("density = 0.2", "density = 0.3"))
    for name, scene in [("checkpoint", "other.toml"), ("checkpoint", "heavy.toml"),
                        ("frames.vtkhdf", "other.toml"), ("summary.json", "scene.toml"),
                        ("trace.h5", "scene.toml"), ("missing", "scene.toml")]:
        result = weft("error", scene, "--start", folder / "out/sheet" / name, cwd=folder)
        expect_error(result, 2)
