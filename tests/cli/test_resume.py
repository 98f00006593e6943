"""A run that was stopped or killed goes on, and ends as if nothing had happened."""

import json
import signal

import h5py
import numpy
import pytest
from recorded import two_devices
from weft_program import SHEET, expect_error, start_weft, wait_for_frames, wait_for_checkpoints, weft

FRAMES = 40
SCENE = SHEET.replace("frames = 3", f"frames = {FRAMES}").replace("substeps = 2", "substeps = 400")


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "scene.toml").write_text(SCENE)
    return tmp_path


def run(folder, *arguments, device="cpu/1"):
    return weft("run", "scene.toml", "--device", device, "--quiet", *arguments, cwd=folder)


def interrupt(folder, number, frames, *arguments):
    """A run that ends early, by a signal."""
    process = start_weft("run", "scene.toml", "--device", "cpu/1", "--checkpoint", "0", *arguments,
                         cwd=folder)
    if "--no-trace" in arguments:
        wait_for_checkpoints(folder / "out/sheet/checkpoint", frames, process)
    else:
        wait_for_frames(folder / "out/sheet/trace.h5", frames, process)
    process.send_signal(number)
    process.communicate(timeout=30)


def summary_of(folder, name="sheet"):
    return json.loads((folder / "out" / name / "summary.json").read_text())


def positions(path):
    with h5py.File(path) as file:
        steps = file["VTKHDF/Steps"].attrs["NSteps"]
        vertices = file["VTKHDF/NumberOfPoints"][0]
        return file["VTKHDF/Points"][: steps * vertices], file["VTKHDF/Steps/Values"][:steps]


def expect_whole_run(folder):
    """The resumed run in out/sheet against one that was never interrupted."""
    assert run(folder, "--out", "out/whole").returncode == 0
    whole, resumed = summary_of(folder, "whole"), summary_of(folder)
    assert resumed["finished"] and resumed["frames"] == FRAMES
    assert resumed["state_hash"] == whole["state_hash"]
    for a, b in zip(positions(folder / "out/whole/frames.vtkhdf"),
                    positions(folder / "out/sheet/frames.vtkhdf")):
        assert numpy.array_equal(a, b)
    with h5py.File(folder / "out/sheet/trace.h5") as trace:
        frames = trace["frames"][:]
        assert list(frames["frame"]) == list(range(FRAMES))
        assert (numpy.diff(frames["start"]) > 0).all()
        assert (frames["end"][:-1] <= frames["start"][1:] + 1e-3).all()
        assert set(trace["executions"]["frame"]) == set(range(FRAMES))
    left = {path.name for path in (folder / "out/sheet").iterdir()}
    assert left == {"trace.h5", "frames.vtkhdf", "frames.xdmf", "summary.json"}


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGKILL], ids=lambda n: n.name)
def test_goes_on_where_it_ended(folder, number):
    interrupt(folder, number, 6)
    result = weft("run", "scene.toml", "--device", "cpu/1", "--resume", cwd=folder)
    assert result.returncode == 0, result.stderr
    assert "going on after" in result.stderr
    expect_whole_run(folder)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGKILL], ids=lambda n: n.name)
@pytest.mark.parametrize("name", ["sheet", "other"])
def test_replacing_the_run_of_another_scene_is_told(folder, number, name):
    interrupt(folder, number, 3)
    result = weft("run", "scene.toml", "--device", "cpu/1", "--frames", "2", "--set",
                  f"scene.name={name}", "--out", "out/sheet", "--force", cwd=folder)
    assert result.returncode == 0, result.stderr
    text = "out/sheet: this replaces a run of another scene, 'sheet', that did not finish"
    warnings = summary_of(folder)["warnings"]
    assert [text in warning for warning in warnings] == ([True] if name == "other" else [])
    assert (f"weft: warning: {text}" in result.stderr) == (name == "other")
    assert "replacing a run that did not finish" in result.stderr


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGKILL], ids=lambda n: n.name)
def test_what_can_go_on_is_not_replaced(folder, number):
    interrupt(folder, number, 3)
    before = {path: path.read_bytes() for path in (folder / "out/sheet").iterdir()}
    expect_error(run(folder), 2, "out/sheet", "a run that did not finish is there", "--resume",
                 "--force")
    assert {path: path.read_bytes() for path in (folder / "out/sheet").iterdir()} == before
    assert run(folder, "--force", "--frames", "2").returncode == 0


def test_what_still_runs_is_not_called_unfinished(folder):
    process = start_weft("run", "scene.toml", "--device", "cpu/1", "--checkpoint", "0", "--frames",
                         "4000", cwd=folder)
    wait_for_checkpoints(folder / "out/sheet/checkpoint", 2, process)
    expect_error(run(folder), 2, "out/sheet", "another run is writing there")
    process.kill()
    process.communicate()


def test_what_has_no_checkpoint_is_replaced(folder):
    interrupt(folder, signal.SIGKILL, 3)
    (folder / "out/sheet/checkpoint").unlink()
    assert run(folder, "--frames", "2").returncode == 0


# Two sheets, of which the upper one starts within the thickness and slides.
RUBBING = SCENE.replace("substeps = 400", "substeps = 20\ngravity = [1.5, -9.81, 0.0]") + """
pins = { edges = ["x-", "x+", "z-", "z+"] }
[[cloth]]
name = "upper"
grid = { size = [0.5, 0.5], resolution = [7, 7] }
translate = [0.01, 0.015, 0.02]
density = 0.2
stretch = { stiffness = 1.0e2 }
[contact]
thickness = 0.02
friction = 0.3
"""


def test_what_friction_holds_is_held_when_a_run_goes_on(folder):
    (folder / "scene.toml").write_text(RUBBING)
    interrupt(folder, signal.SIGKILL, 6)
    assert run(folder, "--resume").returncode == 0
    expect_whole_run(folder)


def test_killed_again_and_again(folder):
    interrupt(folder, signal.SIGKILL, 4)
    process = start_weft("run", "scene.toml", "--device", "cpu/1", "--checkpoint", "0", "--resume",
                         cwd=folder)
    wait_for_frames(folder / "out/sheet/trace.h5", 12, process)
    process.kill()
    process.communicate()
    assert run(folder, "--resume").returncode == 0
    expect_whole_run(folder)


def test_killed_while_it_takes_over(folder):
    """As it is found then: the old files aside, new ones begun."""
    interrupt(folder, signal.SIGKILL, 6)
    out = folder / "out/sheet"
    for name in ["trace.h5", "frames.vtkhdf"]:
        (out / name).rename(out / f"{name}.before")
        (out / name).write_bytes(b"half")
    (out / "checkpoint.part").write_bytes(b"half")
    assert run(folder, "--resume").returncode == 0
    expect_whole_run(folder)


def test_begins_at_the_beginning_where_nothing_is(folder):
    assert run(folder, "--resume").returncode == 0
    expect_whole_run(folder)


def test_other_devices_may_go_on_without_a_trace(folder):
    interrupt(folder, signal.SIGINT, 6)
    expect_error(run(folder, "--resume", device="cpu/2"), 2, "trace.h5",
                 "--resume needs the devices")
    (folder / "out/sheet/trace.h5").unlink()
    assert run(folder, "--resume", "--no-trace", device="cpu/2").returncode == 0
    assert run(folder, "--out", "out/whole").returncode == 0
    assert summary_of(folder)["state_hash"] == summary_of(folder, "whole")["state_hash"]


def test_every_third_frame_goes_on(folder):
    (folder / "scene.toml").write_text(SCENE + "\n[output]\nevery = 3\n")
    interrupt(folder, signal.SIGKILL, 8)
    assert run(folder, "--resume").returncode == 0
    assert run(folder, "--out", "out/whole").returncode == 0
    for a, b in zip(positions(folder / "out/whole/frames.vtkhdf"),
                    positions(folder / "out/sheet/frames.vtkhdf")):
        assert numpy.array_equal(a, b)


@pytest.mark.parametrize("device, rows", [("cpu/1", 1), ("cpu/2", 2)])
def test_without_a_trace_the_summary_is_of_the_whole_run(folder, device, rows):
    interrupt(folder, signal.SIGINT, 6)
    before = summary_of(folder)
    assert run(folder, "--resume", "--no-trace", device=device).returncode == 0
    whole = summary_of(folder)
    assert whole["frames"] == FRAMES
    assert whole["simulated_s"] == pytest.approx(FRAMES * 0.02)
    assert whole["wall_s"] > before["wall_s"]
    assert len(whole["devices"]) == rows  # the one that was left has one, too
    assert (sum(d["busy_s"] for d in whole["devices"]) >
            sum(d["busy_s"] for d in before["devices"]) > 0)


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGKILL], ids=lambda n: n.name)
def test_a_run_that_began_without_outputs_goes_on_with_them(folder, number):
    """They begin where it went on, and go on from there themselves."""
    interrupt(folder, number, 2, "--no-trace", "--no-geometry")
    interrupt(folder, number, 4, "--resume")
    assert run(folder, "--resume").returncode == 0
    assert run(folder, "--out", "out/whole").returncode == 0
    assert summary_of(folder)["state_hash"] == summary_of(folder, "whole")["state_hash"]
    assert summary_of(folder)["warnings"] == []  # the second time, they went on
    with h5py.File(folder / "out/sheet/trace.h5") as trace:
        frames = list(trace["frames"]["frame"])
        assert 0 < frames[0] < FRAMES
        assert frames == list(range(frames[0], FRAMES))
        assert set(trace["executions"]["frame"]) == set(frames)
    points, times = positions(folder / "out/sheet/frames.vtkhdf")
    all_points, all_times = positions(folder / "out/whole/frames.vtkhdf")
    assert 0 < len(times) < len(all_times)
    assert numpy.array_equal(times, all_times[-len(times):])
    assert numpy.array_equal(points, all_points[-len(points):])


def test_a_trace_without_a_frame_goes_on(folder):
    """As it is left by a run that goes on with one, and is killed before its first frame."""
    (folder / "scene.toml").write_text(SCENE.replace("substeps = 400", "substeps = 4"))
    assert run(folder, "--frames", "1", "--out", "out/empty").returncode == 0
    with h5py.File(folder / "out/empty/trace.h5", "r+") as trace:
        for name in trace:
            if isinstance(trace[name], h5py.Dataset):
                trace[name].resize(0, axis=0)
    (folder / "scene.toml").write_text(SCENE)
    interrupt(folder, signal.SIGTERM, 2, "--no-trace")
    (folder / "out/empty/trace.h5").rename(folder / "out/sheet/trace.h5")
    assert run(folder, "--resume").returncode == 0
    assert run(folder, "--out", "out/whole").returncode == 0
    assert summary_of(folder)["state_hash"] == summary_of(folder, "whole")["state_hash"]
    assert any("trace.h5" in warning for warning in summary_of(folder)["warnings"])


def test_stopped_before_the_first_frame(folder):
    interrupt(folder, signal.SIGTERM, 0)  # in its first frame, or before it
    assert run(folder, "--resume").returncode == 0
    expect_whole_run(folder)
    assert summary_of(folder)["warnings"] == []


def test_what_is_gone_is_warned_of(folder):
    interrupt(folder, signal.SIGTERM, 4)
    for name in ["trace.h5", "frames.vtkhdf"]:
        (folder / "out/sheet" / name).unlink()
    result = weft("run", "scene.toml", "--device", "cpu/1", "--resume", cwd=folder)
    assert result.returncode == 0, result.stderr
    for name in ["trace.h5", "frames.vtkhdf"]:
        assert f"{name}: nothing of it is there from before frame" in result.stderr
        assert any(name in warning for warning in summary_of(folder)["warnings"])


def test_outputs_that_a_run_goes_on_without_are_left(folder):
    interrupt(folder, signal.SIGTERM, 6)
    trace, geometry = (folder / "out/sheet" / name for name in ["trace.h5", "frames.vtkhdf"])
    before = trace.read_bytes(), geometry.read_bytes()
    interrupt(folder, signal.SIGTERM, 2, "--resume", "--no-trace", "--no-geometry")
    assert (trace.read_bytes(), geometry.read_bytes()) == before
    expect_error(run(folder, "--resume"), 2, "trace.h5", "--resume needs", "--no-trace goes on")
    expect_error(run(folder, "--resume", "--no-trace"), 2, "frames.vtkhdf",
                 "--no-geometry goes on")
    assert run(folder, "--resume", "--no-trace", "--no-geometry").returncode == 0
    assert (trace.read_bytes(), geometry.read_bytes()) == before
    assert summary_of(folder)["frames"] == FRAMES
    assert set(summary_of(folder)["files"]) == {"summary"}


def test_another_scene_cannot_go_on(folder):
    interrupt(folder, signal.SIGINT, 6)
    refused = "checkpoint: the run there differs from this one in: "
    expect_error(run(folder, "--resume", "--set", "scene.gravity=[0, -1, 0]", "--iterations", "3",
                     "--frames", "90"), 2, refused + "scene.gravity, solver.iterations; --force")
    expect_error(run(folder, "--resume", "--math", "fast"), 2, refused + "--math; --force")
    (folder / "scene.toml").write_text(SCENE.replace("1.0e4", "2.0e4"))
    expect_error(run(folder, "--resume"), 2, refused + "text of the scene file; --force")


def test_checkpoint_of_an_earlier_version_cannot_go_on(folder):
    """Which had a hash of everything where names and values are now."""
    interrupt(folder, signal.SIGINT, 3)
    checkpoint = folder / "out/sheet/checkpoint"
    lines = checkpoint.read_bytes().split(b"\n", 2)
    checkpoint.write_bytes(b"\n".join([lines[0], b"0123456789abcdef", lines[2]]))
    expect_error(run(folder, "--resume"), 2, "in: version of weft; --force")


def test_other_order_of_settings_cannot_go_on(folder):
    settings = [["--set", "cloth.density=0.3"], ["--set", "cloth[0].density=0.4"]]
    interrupt(folder, signal.SIGINT, 3, *settings[0], *settings[1])
    expect_error(run(folder, "--resume", *settings[1], *settings[0]), 2, "the order of what is set")
    expect_error(run(folder, "--resume", *settings[0]), 2, "in: cloth[0].density; --force")
    assert run(folder, "--resume", *settings[0], *settings[1]).returncode == 0


def test_other_mesh_cannot_go_on(folder):
    (folder / "part.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 3 2\n")
    (folder / "scene.toml").write_text(
        SCENE.replace('grid = { size = [1.0, 1.0], resolution = [12, 12] }', 'mesh = "part.obj"'))
    interrupt(folder, signal.SIGINT, 3)
    (folder / "part.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 0 2\nf 1 3 2\n")
    expect_error(run(folder, "--resume"), 2, "in: mesh of cloth.sheet; --force")


def test_other_frames_of_an_obstacle_cannot_go_on(folder):
    points = numpy.array([[0, 0, 0], [1, 0, 0], [0, 0, 1]]) - [0, 9, 0]
    (folder / "part.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 3 2\n")
    (folder / "scene.toml").write_text(SCENE + """
[contact]
[[obstacle]]
name = "body"
shape = "mesh"
mesh = "part.obj"
motion = { frames = "part.h5" }
""")
    with h5py.File(folder / "part.h5", "w") as file:
        file["points"] = numpy.stack([points + [0, 0, 0.01 * i] for i in range(FRAMES)])
    interrupt(folder, signal.SIGINT, 3)
    before = (folder / "part.h5").read_bytes()
    with h5py.File(folder / "part.h5", "r+") as file:
        file["points"][FRAMES - 1] += 1
    expect_error(run(folder, "--resume"), 2, "in: mesh of obstacle.body.frames; --force")
    (folder / "part.h5").write_bytes(before)
    assert run(folder, "--resume").returncode == 0
    expect_whole_run(folder)


def test_finished_run_is_left_as_it_is(folder):
    assert run(folder, "--frames", "2", "--no-geometry").returncode == 0
    files = sorted((folder / "out/sheet").iterdir())
    before = [(file.read_bytes(), file.stat().st_mtime_ns) for file in files]
    again = weft("run", "scene.toml", "--device", "cpu/1", "--frames", "2", "--no-geometry",
                 "--resume", "--json", cwd=folder)
    assert again.returncode == 0
    assert "out/sheet: the run there is done" in again.stderr
    assert json.loads(again.stdout) == summary_of(folder)
    for other in (["--frames", "3", "--no-geometry"], ["--frames", "2"],
                  ["--frames", "2", "--no-geometry", "--iterations", "3"]):
        expect_error(run(folder, "--resume", *other), 2, "out/sheet", "finished run", "--force")
    assert sorted((folder / "out/sheet").iterdir()) == files
    assert [(file.read_bytes(), file.stat().st_mtime_ns) for file in files] == before


def test_damaged_checkpoint(folder):
    interrupt(folder, signal.SIGINT, 6)
    checkpoint = folder / "out/sheet/checkpoint"
    checkpoint.write_bytes(checkpoint.read_bytes()[:-10])
    expect_error(run(folder, "--resume"), 2, "checkpoint", "cannot be read", "--force")


def test_asynchronous_run_goes_on_by_the_same_map_only(folder):
    """Other settings or cuts would give other results from there on."""
    (folder / "scene.toml").write_text(SCENE.replace("[12, 12]", "[12, 60]"))
    devices = ["--device", two_devices()[1], "--plan", "async"]
    process = start_weft("run", "scene.toml", *devices, "--checkpoint", "0", cwd=folder)
    wait_for_frames(folder / "out/sheet/trace.h5", 3, process)
    process.send_signal(signal.SIGTERM)
    process.communicate(timeout=30)
    for other in [["--plan", "async", "--async", "window=3"], ["--plan", "exact"]]:
        result = weft("run", "scene.toml", *devices[:2], *other, "--resume", "--quiet", cwd=folder)
        expect_error(result, 2, "out/sheet", "differs from this one in: --async")
    assert weft("run", "scene.toml", *devices, "--resume", "--quiet", cwd=folder).returncode == 0
    assert weft("run", "scene.toml", *devices, "--out", "out/whole", "--quiet", cwd=folder).returncode == 0
    assert summary_of(folder)["state_hash"] == summary_of(folder, "whole")["state_hash"]
