"""A scene 10 km from its origin: everything that goes out is in the scene's own coordinates, and as
exact as near the origin, or as single precision is there."""

import json

import h5py
import numpy
import pytest
from weft_program import expect_error, start_weft, wait_for_frames, weft, weft_json

FRAMES = 20
BY = [10000.0, -10000.0, 10000.0]


def scene_at(by):
    def place(x, y, z):
        return str([x + by[0], y + by[1], z + by[2]])
    return f"""
[scene]
name = "sheet"
frames = {FRAMES}
dt = 0.02
substeps = 100

[solver]
method = "vbd"
iterations = 4

[[cloth]]
name = "sheet"
grid = {{ size = [1.0, 1.0], resolution = [17, 17] }}
translate = {place(0.0, 0.0, 0.0)}
density = 0.2
stretch = {{ stiffness = 1.0e3 }}
[[cloth.pins]]
box = [{place(-0.51, -0.01, -0.51)}, {place(-0.4, 0.01, -0.4)}]

[[obstacle]]
shape = "sphere"
center = {place(0.0, -0.25, 0.0)}
radius = 0.125
friction = 0.25
motion = {{ velocity = [0.0, 0.5, 0.0] }}
"""


def run(folder, name, *arguments, told="nothing is told"):
    """told: what its warnings have to say, if it has any."""
    result = weft("run", "scene.toml", "--device", "cpu/1", "--quiet", "--out", name, *arguments,
                  cwd=folder)
    assert result.returncode == 0, result.stderr
    warnings = [line for line in result.stderr.splitlines() if "warning" in line]
    assert all(told in line for line in warnings), result.stderr
    return json.loads((folder / name / "summary.json").read_text())


def positions(folder, name):
    with h5py.File(folder / name / "frames.vtkhdf") as file:
        return file["VTKHDF/Points"][:].astype(float).reshape(FRAMES + 1, -1, 3)


def frames(folder, name):
    with h5py.File(folder / name / "trace.h5") as file:
        return file["frames"][:], file["energies"][:]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("far")
    (folder / "scene.toml").write_text(scene_at([0.0, 0.0, 0.0]))
    run(folder, "near")
    (folder / "near.toml").write_text(scene_at([0.0, 0.0, 0.0]))
    (folder / "scene.toml").write_text(scene_at(BY))
    run(folder, "whole")
    return folder


def test_geometry_is_where_the_scene_is(folder):
    near, far = positions(folder, "near"), positions(folder, "whole")
    assert abs(near[-1] - near[0]).max() > 0.2
    assert (far == (near + numpy.array(BY)).astype(numpy.float32)).all()


def test_energies_are_those_of_the_scene(folder):
    near, far = (frames(folder, name) for name in ("near", "whole"))
    for column in ("strain_rms", "strain_max"):
        assert (near[0][column] == far[0][column]).all()
    assert far[0]["work"] == pytest.approx(near[0]["work"], abs=1e-6)
    assert far[0]["dissipated"] == pytest.approx(near[0]["dissipated"], abs=1e-6)
    assert (near[1]["kinetic"] == far[1]["kinetic"]).all()
    lifted = far[1]["gravity"] - near[1]["gravity"]
    assert lifted == pytest.approx(lifted[0], rel=1e-9) and lifted[0] < -1e4


def test_settings_say_what_positions_count_from(folder):
    summaries = [json.loads((folder / name / "summary.json").read_text())
                 for name in ("near", "whole")]
    assert "origin" not in summaries[0]["settings"]
    assert summaries[1]["settings"]["origin"] == "10000 -10000 10000"
    assert summaries[0]["state_hash"] != summaries[1]["state_hash"]
    inspection = weft_json("inspect", "scene.toml", cwd=folder)
    assert inspection["origin"] == BY
    assert "origin" not in weft_json("inspect", "near.toml", cwd=folder)
    assert "count from (10000, -10000, 10000)" in weft("inspect", "scene.toml", cwd=folder).stdout


def test_killed_run_goes_on_to_the_same_end(folder):
    process = start_weft("run", "scene.toml", "--device", "cpu/1", "--checkpoint", "0", "--out",
                         "killed", "--set", "scene.substeps=1000", cwd=folder)
    wait_for_frames(folder / "killed/trace.h5", 4, process)
    process.kill()
    process.communicate()
    more, told = ["--set", "scene.substeps=1000"], "steps of 2e-05 s are so short"
    resumed = run(folder, "killed", "--resume", *more, told=told)
    assert resumed["frames"] == FRAMES
    assert resumed["state_hash"] == run(folder, "at_once", *more, told=told)["state_hash"]
    assert (positions(folder, "killed") == positions(folder, "at_once")).all()


def test_replay_ends_in_the_recorded_hash(folder):
    assert weft_json("replay", folder / "whole/trace.h5", "--quiet")["equal"]


def test_studies_begin_with_all_digits(folder):
    def study(scene, *arguments):
        return weft_json("error", scene, "--out", "out", "--devices", "cpu/1", "--solvers", "vbd",
                         "--max-iterations", "2", *arguments, cwd=folder)
    run(folder, "begun", "--frames", "4", "--keep-checkpoint")
    near = study("near.toml", "--frame", "4")
    for far in (study("scene.toml", "--frame", "4"),
                study("scene.toml", "--start", folder / "begun/checkpoint")):
        assert far["start_energy"] == pytest.approx(near["start_energy"], rel=1e-9)
        assert far["reference_energy"] == pytest.approx(near["reference_energy"], rel=1e-6)
    moved = weft("error", "near.toml", "--start", folder / "begun/checkpoint", cwd=folder)
    expect_error(moved, 2, "checkpoint of another scene")
