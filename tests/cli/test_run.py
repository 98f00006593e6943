"""What a run leaves behind: finished, overwritten, diverged, stopped and killed."""

import json
import os
import platform
import pty
import signal
import subprocess

import h5py
import numpy
import pytest
from weft_program import CORES, LONG, SHEET, WEFT, expect_error, start_weft, wait_for_frames, weft
from weft_program import weft_json


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "scene.toml").write_text(SHEET)
    return tmp_path


def run(folder, *arguments, **options):
    return weft("run", "scene.toml", "--device", "cpu/1", *arguments, cwd=folder, **options)


def geometry_steps(path):
    with h5py.File(path) as file:
        count = int(file["VTKHDF/Steps"].attrs["NSteps"])
        vertices = int(file["VTKHDF/NumberOfPoints"][0])
        return file["VTKHDF/Points"][: count * vertices].reshape(count, vertices, 3)


def test_all_files(folder):
    result = run(folder)
    assert result.returncode == 0, result.stderr
    out = folder / "out/sheet"
    names = {"trace.h5", "frames.vtkhdf", "frames.xdmf", "summary.json"}
    assert {path.name for path in out.iterdir()} == names

    summary = json.loads((out / "summary.json").read_text())
    assert summary["finished"] and summary["frames"] == 3
    assert f"state hash       {summary['state_hash']}" in result.stdout
    for path in summary["files"].values():
        assert (folder / path).exists()
    with h5py.File(out / "trace.h5") as trace:
        assert trace.attrs["finished"] and trace.attrs["state_hash"] == summary["state_hash"]
        assert list(trace["frames"]["frame"]) == [0, 1, 2]
        assert "run scene.toml --device cpu/1" in trace["run"].attrs["command"]
        assert trace["run/scene"].asstr()[()] == SHEET
    positions = geometry_steps(out / "frames.vtkhdf")
    assert positions.shape == (4, 144, 3)  # the initial state, and each frame
    fallen = 0.5 * 9.81 * (3 * 0.02) ** 2
    assert positions[-1, :, 1] == pytest.approx(-fallen, rel=0.2)


@pytest.mark.skipif(CORES < 2, reason="needs two devices")
@pytest.mark.parametrize("devices, arguments, why", [
    ("cpu/1", [], "one device"),
    ("cpu/1+cpu/1", ["--solver", "newton"], "newton has no asynchronous form"),
    ("cpu/1+cpu/1", ["--set", "contact.thickness=0.004", "--solver", "vbd"], "would take"),
    ("cpu/1+cpu/1", ["--strips", "1,1"], "it is said who does what"),
    ("cpu/1+cpu/1", [], "would take"),
])
def test_auto_says_why_it_is_not_asynchronous(folder, devices, arguments, why):
    result = weft("run", "scene.toml", "--device", devices, "--async", "", *arguments, cwd=folder)
    assert result.returncode == 0, result.stderr
    assert "weft: not async: " in result.stderr and why in result.stderr
    with h5py.File(folder / "out/sheet/trace.h5") as trace:
        assert why in trace["run/settings"].attrs["async_choice"]


def test_outputs_can_be_left_out(folder):
    result = run(folder, "--no-trace", "--no-geometry")
    assert result.returncode == 0
    assert [path.name for path in (folder / "out/sheet").iterdir()] == ["summary.json"]


def test_json_is_all_of_stdout_and_quiet_is_quiet(folder):
    result = run(folder, "--json", "--quiet")
    assert result.stderr == ""
    assert json.loads(result.stdout) == json.loads((folder / "out/sheet/summary.json").read_text())


@pytest.mark.parametrize("every, steps", [(1, 8), (2, 4), (3, 3), (7, 2), (100, 1)])
def test_every_nth_frame_is_written(folder, every, steps):
    assert run(folder, "--frames", "7", "--set", f"output.every={every}", "--set",
               "output.compression=small").returncode == 0
    assert run(folder, "--frames", "7", "--out", "out/all").returncode == 0
    chosen = geometry_steps(folder / "out/sheet/frames.vtkhdf")
    assert len(chosen) == steps
    assert numpy.array_equal(chosen, geometry_steps(folder / "out/all/frames.vtkhdf")[::every])
    with h5py.File(folder / "out/sheet/frames.vtkhdf") as file:
        times = file["VTKHDF/Steps/Values"][:]
    assert times == pytest.approx(0.02 * every * numpy.arange(steps))
    with h5py.File(folder / "out/sheet/trace.h5") as trace:
        assert len(trace["frames"]) == 7  # the trace has all of them


@pytest.mark.parametrize("value, said", [("every=0", "at least 1"), ("every=1.5", "an integer"),
                                         ("compression=gzip", "none, fast, small")])
def test_what_output_cannot_be(folder, value, said):
    expect_error(run(folder, "--set", f"output.{value}"), 2, "output." + value.split("=")[0], said)


def test_records_explain_themselves(folder):
    summary = weft_json("run", "scene.toml", "--device", "cpu/1", "--solver", "vbd", "--set",
                        "cloth.density=0.5", "--substeps", "10", cwd=folder)
    assert " run scene.toml --device cpu/1" in summary["command"]
    assert summary["settings"]["method"] == "vbd" and summary["settings"]["devices"] == "cpu/1"
    assert summary["settings"]["set"].splitlines() == ["cloth.density=0.5", "solver.method=vbd", "scene.substeps=10"]
    assert summary["host"]["name"] == platform.node() and summary["host"]["cpu"]
    assert int(summary["host"]["cores"]) == CORES
    assert {"weft", "compiler", "tbb", "hdf5", "eigen", "fmt"} <= set(summary["versions"])
    assert summary["warnings"] == []
    with h5py.File(folder / "out/sheet/trace.h5") as trace:
        for group in ["settings", "host", "versions"]:
            assert dict(trace["run"][group].attrs) == summary[group]
        assert trace["run"].attrs["command"] == summary["command"]
        assert (trace["frames"]["pace"] > 0).all()


def test_warnings_stand_in_the_summary(folder):
    (folder / "two.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 0 1\nv 5 5 5\nf 1 3 2\n")
    (folder / "scene.toml").write_text(SHEET.replace(
        "grid = { size = [1.0, 1.0], resolution = [12, 12] }", 'mesh = "two.obj"'))
    result = run(folder, "--json")
    said = [line.removeprefix("weft: warning: ") for line in result.stderr.splitlines()
            if line.startswith("weft: warning: ")]
    assert said and json.loads(result.stdout)["warnings"] == said


PARTS = ["place_time", "plan_time", "execute_time", "check_time", "learn_time", "measure_time",
         "output_time"]


def test_clocks_tell_the_whole_time(folder):
    """Frames follow each other without a gap, and their parts leave nothing out."""
    summary = weft_json("run", "scene.toml", "--device", "cpu/1", "--frames", "9", cwd=folder)
    with h5py.File(folder / "out/sheet/trace.h5") as trace:
        frames = trace["frames"][:]
        executions = trace["executions"][:]
    wall = frames["end"] - frames["start"]
    assert (frames["start"][1:] == frames["end"][:-1]).all()
    assert sum(frames[part] for part in PARTS) == pytest.approx(wall, abs=1e-9)
    assert all((frames[part] > 0).all() for part in PARTS)
    assert (frames["measured_makespan"] <= frames["execute_time"]).all()
    for frame in frames:
        own = executions[executions["frame"] == frame["frame"]]
        assert frame["start"] < own["start"].min() and own["end"].max() < frame["end"]
    assert summary["ms_per_frame"] == pytest.approx(1e3 * sorted(wall)[4])
    assert summary["wall_s"] == pytest.approx(wall.sum())
    assert summary["measured_ms"] < summary["ms_per_frame"]
    assert list(summary["parts_ms"]) == ["placing", "planning", "executing", "checking", "learning",
                                         "measuring", "output"]


def test_leaving_out_the_trace_leaves_out_what_only_it_needs(folder):
    whole = weft_json("run", "scene.toml", "--device", "cpu/1", cwd=folder)
    bare = weft_json("run", "scene.toml", "--device", "cpu/1", "--no-trace", "--force", cwd=folder)
    for key in ["energy", "energies", "state_hash", "frames", "simulated_s"]:
        assert bare[key] == whole[key]


def test_schema_needs_no_scene():
    schema = json.loads(weft("run", "--print-schema").stdout)
    assert "cloth" in schema["properties"]


def test_overrides_stand_in_the_trace(folder):
    assert run(folder, "--frames", "2", "--set", "cloth.density=0.5").returncode == 0
    with h5py.File(folder / "out/sheet/trace.h5") as trace:
        settings = trace["run/settings"].attrs
        assert settings["set"].splitlines() == ["cloth.density=0.5", "scene.frames=2"]
        assert settings["frames"] == "2" and settings["math"] == "strict"


def test_finished_run_is_kept_without_force(folder):
    assert run(folder).returncode == 0
    before = (folder / "out/sheet/trace.h5").read_bytes()
    expect_error(run(folder), 2, "out/sheet", "finished run", "--force")
    assert (folder / "out/sheet/trace.h5").read_bytes() == before
    assert run(folder, "--force", "--no-geometry").returncode == 0
    assert not (folder / "out/sheet/frames.vtkhdf").exists()  # not the old one beside a new trace


# At rest, until a pin runs away.
DIVERGING = SHEET.replace("frames = 3", "frames = 6") + """
[cloth.pins]
corners = ["x-z-"]
motion.keyframes = [{ time = 0.04 }, { time = 0.05, translate = [1.0e6, 0.0, 0.0] }]
"""


def test_diverging_run_keeps_the_frames_before(folder):
    (folder / "scene.toml").write_text(DIVERGING)
    expect_error(run(folder), 1, "frame 2", "substep 0", "task '", "vertex", "cloth 'sheet'")
    out = folder / "out/sheet"
    assert not (out / "summary.json").exists()
    with h5py.File(out / "trace.h5") as trace:
        assert list(trace["frames"]["frame"]) == [0, 1] and not trace.attrs["finished"]
    positions = geometry_steps(out / "frames.vtkhdf")
    assert len(positions) == 3 and numpy.isfinite(positions).all()

    (folder / "scene.toml").write_text(SHEET)
    again = run(folder)  # what did not finish needs no --force
    assert again.returncode == 0 and "replacing a run that did not finish" in again.stderr


def test_exploding_run_names_the_guard(folder):
    (folder / "scene.toml").write_text(SHEET + "\n[guard]\nmax_speed = 0.3\n")
    expect_error(run(folder), 1, "frame 1", "substep", "vertex", "guard.max_speed = 0.3")


def test_what_was_tried_is_said_before_a_frame_ends_the_run(folder):
    (folder / "scene.toml").write_text(SHEET + "\n[guard]\nmax_speed = 0.3\n")
    result = run(folder, "--on-trouble", "halve")
    expect_error(result, 1, "frame 1", "halve has given up")
    assert result.stderr.count("done again, and all that follows") == 4


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_signal_ends_a_run_in_good_order(folder, number):
    (folder / "scene.toml").write_text(LONG)
    process = start_weft("run", "scene.toml", "--device", "cpu/1", cwd=folder)
    wait_for_frames(folder / "out/sheet/trace.h5", 5, process)
    process.send_signal(number)
    stdout, stderr = process.communicate(timeout=30)
    assert process.returncode == 128 + number, stderr
    assert f"stopped by {number.name}" in stderr
    summary = json.loads((folder / "out/sheet/summary.json").read_text())
    assert not summary["finished"] and summary["state_hash"] in stdout
    with h5py.File(folder / "out/sheet/trace.h5") as trace:  # plainly: it was closed
        assert len(trace["frames"]) == summary["frames"] >= 5
    assert len(geometry_steps(folder / "out/sheet/frames.vtkhdf")) == summary["frames"] + 1


def test_killed_run_leaves_all_complete_frames(folder):
    (folder / "scene.toml").write_text(LONG)
    process = start_weft("run", "scene.toml", "--device", "cpu/1", cwd=folder)
    wait_for_frames(folder / "out/sheet/trace.h5", 20, process)
    process.kill()
    process.communicate()
    with h5py.File(folder / "out/sheet/trace.h5", swmr=True) as trace:
        frames = trace["frames"]["frame"]
        assert list(frames) == list(range(len(frames))) and len(frames) >= 20
        tasks = numpy.bincount(trace["plan"]["frame"])[: len(frames)]
        executed = numpy.bincount(trace["executions"]["frame"])[: len(frames)]
        assert (executed == 200 * tasks).all()  # each task in each substep
    steps = geometry_steps(folder / "out/sheet/frames.vtkhdf")
    assert abs(len(steps) - 1 - len(frames)) <= 1
    result = weft("trace", "summary", "out/sheet/trace.h5", cwd=folder)
    assert result.returncode == 0 and "not finished" in result.stdout


def test_folder_belongs_to_one_run_at_a_time(folder):
    (folder / "scene.toml").write_text(LONG)
    process = start_weft("run", "scene.toml", "--device", "cpu/1", cwd=folder)
    try:
        wait_for_frames(folder / "out/sheet/trace.h5", 1, process)
        expect_error(run(folder), 2, "out/sheet", "another run")
    finally:
        process.kill()
        process.communicate()


def test_progress_is_a_bar_on_a_terminal(folder):
    reader, writer = pty.openpty()
    command = [WEFT, "run", "scene.toml", "--device", "cpu/1", "--frames", "400", "--no-geometry"]
    process = subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, stderr=writer)
    os.close(writer)
    talk = b""
    try:
        while block := os.read(reader, 4096):
            talk += block
    except OSError:
        pass  # how Linux says that the other end is closed
    process.communicate()
    os.close(reader)
    assert process.returncode == 0
    assert b"left" in talk and b"/400 [" in talk
    assert talk.endswith(b"\r\x1b[K")  # the bar is gone at the end


def test_fast_math_runs(folder):
    summary = weft_json("run", "scene.toml", "--math", "fast", "--device", "cpu/1", cwd=folder)
    assert summary["finished"]


@pytest.fixture
def too_long(folder):
    """A scene of steps that are far too long."""
    (folder / "scene.toml").write_text("""
[scene]
frames = 12
dt = 0.016666667
substeps = 1
[solver]
iterations = 2
[[cloth]]
grid = { size = [1.0, 1.0], resolution = [40, 40] }
density = 0.2
stretch = { stiffness = 1.0e5 }
pins = { corners = ["x-z-", "x+z-"] }
""")
    return folder


def test_energy_from_nowhere_stops_a_run(too_long):
    result = run(too_long)
    assert result.returncode == 1
    assert "energy from nowhere" in result.stderr and "substep 0" in result.stderr
    assert result.stderr.count("weft: error:") == 1
    with h5py.File(too_long / "out/scene/trace.h5", swmr=True) as trace:
        assert 0 < len(trace["frames"]) < 12  # those before are there


def test_energy_from_nowhere_is_reported(too_long):
    result = run(too_long, "--on-trouble", "report", "--json")
    assert result.returncode == 0 and "warning: frame " in result.stderr
    summary = json.loads(result.stdout)
    assert any("energy from nowhere" in text for text in summary["warnings"])
    assert summary["strain_rms"] > 0.05 and summary["strain_max"] >= summary["strain_rms"]


def test_a_frame_with_energy_from_nowhere_is_done_again(too_long):
    result = run(too_long, "--on-trouble", "halve", "--json")
    assert result.returncode == 0
    warnings = json.loads(result.stdout)["warnings"]
    assert any("done again, and all that follows, with 2 substeps" in text for text in warnings)
    trace = too_long / "out/scene/trace.h5"
    with h5py.File(trace) as file:
        substeps = list(file["frames"]["substeps"])
        executions = file["executions"][:]
    assert substeps == sorted(substeps) and substeps[0] == 1 and 1 < substeps[-1] <= 16
    last = executions[executions["frame"] == 11]
    assert max(last["substep"]) + 1 == substeps[-1]
    replayed = weft("replay", str(trace), "--device", "cpu/1", cwd=too_long)
    assert replayed.returncode == 0, replayed.stderr


def test_believable_runs_raise_no_alarm(too_long):
    text = (too_long / "scene.toml").read_text().replace("substeps = 1\n", "")
    (too_long / "scene.toml").write_text(text)
    summary = weft_json("run", "scene.toml", "--device", "cpu/1", "--no-geometry", cwd=too_long)
    assert summary["warnings"] == []
    assert summary["strain_rms"] < 0.05


@pytest.fixture
def crossing(folder):
    """An upright sheet through a lying one."""
    upright = SHEET[SHEET.index("[[cloth]]"):].replace('"sheet"', '"upright"')
    scene = SHEET.replace('"xpbd"', '"vbd"') + upright
    scene += "rotate = [0, 0, 1, 90]\ntranslate = [0.03, 0.02, 0.01]\n\n[contact]\n"
    (folder / "scene.toml").write_text(scene)
    return folder


def test_bodies_that_cross_at_the_start_are_refused(crossing):
    expect_error(run(crossing, "--quiet"), 2, "scene.toml: bodies cross at the start",
                 "cloth 'sheet' triangle ", "and cloth 'upright' triangle ", "--on-crossing warn")
    assert not (crossing / "out").exists()


def test_a_run_may_go_on_with_bodies_that_cross(crossing):
    result = run(crossing, "--on-crossing", "warn", "--json")
    assert result.returncode == 0, result.stderr
    assert any("triangles cross" in text for text in json.loads(result.stdout)["warnings"])
    replayed = weft("replay", "out/sheet/trace.h5", "--device", "cpu/1", cwd=crossing)
    assert replayed.returncode == 0, replayed.stderr
