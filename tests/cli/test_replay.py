"""`weft replay`: recorded plans again, on the recorded devices and on others, in the same bits."""

import json
import os
import shutil

import h5py
import numpy
import pytest
from recorded import WIDE, divided, expect_unreadable_traces_refused, made_up, old, record
from recorded import record_killed, two_devices
from weft_program import expect_error, weft, weft_json


@pytest.fixture(scope="module")
def single(tmp_path_factory):
    return record(tmp_path_factory.mktemp("single"), "--device", "cpu/1")


def expect_equal(trace, *arguments, **options):
    replayed = weft_json("replay", trace, "--quiet", *arguments, **options)
    with h5py.File(trace) as file:
        count = len(file["frames"])
        assert replayed["recorded_hash"] == file.attrs["state_hash"] == replayed["state_hash"]
    assert replayed["equal"] and replayed["finished"] and replayed["first_wrong_frame"] is None
    assert replayed["frames"] == replayed["compared"] == count
    return replayed


def test_same_device(single):
    expect_equal(single)
    text = weft("replay", single)
    assert text.returncode == 0 and "yes, after every frame and at the end" in text.stdout
    assert "replaying sheet on" in text.stderr


@pytest.mark.parametrize("more", [[], ["--memory", "discrete"], ["--memory", "mapped"]],
                         ids=["shared", "discrete", "mapped"])
def test_mixture_on_its_own_and_other_devices(tmp_path, more):
    trace = divided(tmp_path, *more)
    assert len(expect_equal(trace)["devices"]) == 2
    assert len(expect_equal(trace, "--device", "cpu/1")["devices"]) == 1
    expect_equal(trace, "--device", "opencl:0/1")
    expect_equal(trace, "--device", "opencl:0/1+cpu/1")
    expect_equal(trace, "--device", "cpu/1+opencl:0/1", "--memory", "discrete")


def test_one_device_on_two(single):
    expect_equal(single, "--device", two_devices()[1])


def test_planner_that_changes_its_mind(tmp_path):
    """--plan auto may use the mixture in some frames and one device in others."""
    trace = record(tmp_path, *two_devices()[:2], "--frames", 20)
    expect_equal(trace, "--device", "cpu/1")
    expect_equal(trace)


@pytest.mark.parametrize("memory", ["host", "discrete"])
def test_tasks_placed_one_by_one(single, tmp_path, memory):
    trace = record(tmp_path, *two_devices()[:2], "--plan", "placed", "--memory", memory)
    with h5py.File(trace) as file, h5py.File(single) as other:
        assert file.attrs["state_hash"] == other.attrs["state_hash"]
        parts = file["divisions"]["strips"][file["divisions"]["graph"] == 0]
        assert len(parts) >= 2 and sum(parts) == weft_json("inspect", "scene.toml",
                                                           cwd=tmp_path)["strips"]
        assert (file["plan"]["home"] == file["plan"]["device"]).all()
    expect_equal(trace)
    expect_equal(trace, "--device", "cpu/1")
    assert weft("trace", "gantt", trace, "--frame", "2", "--out",
                tmp_path / "schedule.svg").returncode == 0
    assert weft_json("plan", trace, "--frame", "2", "--pinned", "--algorithm",
                     "in-order")["makespan"] > 0


def test_command_line_counts(tmp_path):
    trace = record(tmp_path, "--device", "cpu/1", "--frames", 4, "--substeps", 3, "--iterations", 5,
                   "--set", "cloth.density=0.5", "--set", "scene.size=900")
    (tmp_path / "scene.toml").unlink()  # its text is in the trace
    assert expect_equal(trace)["frames"] == 4


def test_fast_math(tmp_path):
    trace = record(tmp_path, "--device", "cpu/1", "--math", "fast")
    expect_equal(trace)


@pytest.mark.parametrize("solver", ["xpbd", "vbd"])
def test_solvers(tmp_path, solver):
    trace = divided(tmp_path, scene_options=["--solver", solver])
    expect_equal(trace)
    expect_equal(trace, "--device", "cpu/1")


def test_some_frames(single):
    replayed = weft_json("replay", single, "--frames", 3, "--quiet")
    assert replayed["frames"] == replayed["compared"] == 3 and replayed["equal"]


def test_killed_run(tmp_path):
    trace = record_killed(tmp_path)
    replayed = weft_json("replay", trace, "--quiet")
    assert replayed["equal"] and not replayed["finished"]
    assert replayed["compared"] == replayed["frames"] >= 5
    text = weft("replay", trace).stdout
    assert "the run did not finish" in text and "every frame that was replayed" in text


def forge(trace, path, change):
    shutil.copy(trace, path)
    with h5py.File(path, "r+") as file:
        change(file)
    return path


def test_difference_is_found_and_named(single, tmp_path):
    def wrong_hash(file):
        frames = file["frames"][:]
        frames["state_hash"][5] = b"0" * 32
        file["frames"][:] = frames
    result = weft("replay", forge(single, tmp_path / "t.h5", wrong_hash), "--json", "--quiet")
    assert result.returncode == 1
    found = json.loads(result.stdout)
    assert not found["equal"] and found["first_wrong_frame"] == 5
    assert "differs from the run, first after frame 5" in result.stderr

    def wrong_end(file):
        file.attrs["state_hash"] = "0" * 32
    result = weft("replay", forge(single, tmp_path / "t.h5", wrong_end))
    assert result.returncode == 1 and "first after frame 7" in result.stderr


def test_another_density_is_another_state(single, tmp_path):
    """The replay computes: it does not repeat what the trace says."""
    def denser(file):
        text = file["run/scene"].asstr()[()]
        assert "corners" in text
        file["run/scene"][()] = text.replace('"x-z-", "x+z-"', '"x-z-"')
    result = weft("replay", forge(single, tmp_path / "t.h5", denser))
    assert result.returncode == 1 and "first after frame 0" in result.stderr


def test_records_that_do_not_fit_the_scene(single, tmp_path):
    def more_items(file):
        plan = file["plan"][:]
        plan["items"] += 1
        file["plan"][:] = plan
    expect_error(weft("replay", forge(single, tmp_path / "t.h5", more_items), "--quiet"), 2,
                 "t.h5: frame 0 cannot be replayed", "another version")

    def more_strips(file):
        divisions = file["divisions"][:]
        divisions["strips"] += 1
        file["divisions"][:] = divisions
    expect_error(weft("replay", forge(single, tmp_path / "t.h5", more_strips), "--quiet"), 2,
                 "strips", "here")

    def first_frame_lost(file):
        frames = file["frames"][1:]
        del file["frames"]
        file["frames"] = frames
    expect_error(weft("replay", forge(single, tmp_path / "t.h5", first_frame_lost), "--quiet"), 2,
                 "frame 0 is not in the trace")


def test_devices_that_are_not_here(tmp_path):
    trace = record(tmp_path, *two_devices())
    nothing = dict(os.environ, OCL_ICD_VENDORS="/nonexistent")
    expect_error(weft("replay", trace, env=nothing), 2, "trace.h5: was recorded on", "opencl",
                 "--device LIST")
    expect_equal(trace, "--device", "cpu/1", env=nothing)
    expect_error(weft("replay", trace, "--device", "gpx"), 2, "'gpx'")


def test_name_that_stands_for_other_devices_here(tmp_path):
    two_devices()
    trace = record(tmp_path)  # hybrid
    nothing = dict(os.environ, OCL_ICD_VENDORS="/nonexistent")
    expect_error(weft("replay", trace, env=nothing), 2, "'hybrid' is", "here", "--device LIST")


MESH = """
v 0 0 0
v 1 0 0
v 1 0 1
v 0 0 1
f 1 2 3
f 1 3 4
"""


def test_mesh_file(tmp_path):
    run, elsewhere = tmp_path / "run", tmp_path / "elsewhere"
    run.mkdir()
    elsewhere.mkdir()
    (run / "part.obj").write_text(MESH)
    scene = WIDE.replace('grid = { size = [1.0, 1.0], resolution = [12, 120] }',
                         'mesh = "part.obj"').replace('corners = ["x-z-", "x+z-"]', "vertices = [0]")
    trace = record(run, "--device", "cpu/1", scene=scene)
    expect_equal(trace, cwd=elsewhere)

    shutil.move(run / "part.obj", elsewhere)
    expect_error(weft("replay", trace), 2, "part.obj", "cloth.sheet", "not there any more")
    expect_equal(trace, "--scene", elsewhere / "scene.toml")

    (run / "part.obj").write_text(MESH.replace("v 1 0 1", "v 1.5 0 1"))
    expect_error(weft("replay", trace), 2, "part.obj", "has changed since the run")


BELT = WIDE + """
[contact]
[[obstacle]]
name = "belt"
shape = "mesh"
mesh = "belt_0.obj"
translate = [0.0, -1.0, 0.0]
motion = { frames = "belt_*.obj" }
"""


def expect_plannable(trace, folder):
    """Also for other machines, which takes the scene, too."""
    planned = weft("plan", trace, "--machines", "--out", folder, "--device-counts", "2", "--waits",
                   "1e-5", "--ratios", "1")
    assert planned.returncode == 0, planned.stderr


def test_sequence_of_mesh_files(tmp_path):
    """One hash stands for all of them, so a change of any is seen."""
    for number in range(3):
        (tmp_path / f"belt_{number}.obj").write_text(MESH.replace("v 1 0 1", f"v 1.{number} 0 1"))
    trace = record(tmp_path, "--device", "cpu/1", scene=BELT)
    expect_equal(trace)
    expect_plannable(trace, tmp_path)

    (tmp_path / "belt_1.obj").write_text(MESH)
    expect_error(weft("replay", trace), 2, "belt_*.obj", "obstacle.belt.frames",
                 "has changed since the run, or is not one of these 3")
    (tmp_path / "belt_1.obj").unlink()
    expect_error(weft("replay", trace), 2, "is not one of these 2")


def test_sequence_in_one_file(tmp_path):
    run, elsewhere = tmp_path / "run", tmp_path / "elsewhere"
    run.mkdir()
    elsewhere.mkdir()
    start = numpy.array([[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1]])
    (run / "belt_0.obj").write_text(MESH)
    with h5py.File(run / "belt.h5", "w") as file:
        file["belt/points"] = numpy.stack([start + [0.1 * i, 0, 0] for i in range(3)])
    trace = record(run, "--device", "cpu/1",
                   scene=BELT.replace("belt_*.obj", "belt.h5:/belt/points"))
    with h5py.File(trace) as file:
        assert set(file["run/meshes"].attrs) == {"obstacle.belt", "obstacle.belt.frames"}
    expect_equal(trace, cwd=elsewhere)
    expect_plannable(trace, tmp_path)

    for name in ["belt_0.obj", "belt.h5"]:
        shutil.move(run / name, elsewhere)
    expect_error(weft("replay", trace, "--scene", run / "scene.toml"), 2, "not there any more")
    expect_equal(trace, "--scene", elsewhere / "scene.toml")
    shutil.copy(elsewhere / "belt_0.obj", run)
    expect_error(weft("replay", trace), 2, "belt.h5", "obstacle.belt.frames", "not there any more")

    shutil.copy(elsewhere / "belt.h5", run)
    with h5py.File(run / "belt.h5", "r+") as file:
        file["belt/points"][1, 2, 0] += 0.01
    expect_error(weft("replay", trace), 2, "belt.h5", "obstacle.belt.frames",
                 "has changed since the run: its hash was")


def test_bad_traces(tmp_path):
    expect_unreadable_traces_refused(tmp_path, "replay")
    expect_error(weft("replay", old(tmp_path)), 2, "made_up.h5", "older weft")
    # Its scene was never a scene.
    assert weft("replay", made_up(tmp_path)).returncode == 2


def test_nothing_is_written(single, tmp_path):
    before = sorted(single.parent.iterdir())
    expect_equal(single, cwd=tmp_path)
    assert not list(tmp_path.iterdir()) and sorted(single.parent.iterdir()) == before


def test_hash_per_frame_is_that_of_a_shorter_run(single, tmp_path):
    with h5py.File(single) as file:
        hashes = file["frames"]["state_hash"]
    assert len(numpy.unique(hashes)) == len(hashes)
    shorter = record(tmp_path, "--device", "cpu/1", "--frames", 3)
    with h5py.File(shorter) as file:
        assert file.attrs["state_hash"].encode() == hashes[2] == file["frames"]["state_hash"][-1]
