"""The Python package that reads and draws traces."""

import os
import pathlib
import subprocess
import sys

import matplotlib.image
import numpy
import pytest

ROOT = pathlib.Path(os.environ["WEFT_ROOT"])
FIXTURE = pathlib.Path(os.environ["WEFT_BIN"]) / "trace_fixture"
sys.path.insert(0, str(ROOT / "analysis"))

import weft_analysis.__main__  # noqa: E402  (found by the line before)


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    path = tmp_path_factory.mktemp("trace") / "trace.h5"
    subprocess.run([FIXTURE, path, "30"], check=True)
    return path


@pytest.fixture(scope="module")
def killed(tmp_path_factory):
    path = tmp_path_factory.mktemp("killed") / "trace.h5"
    process = subprocess.Popen([FIXTURE, path, "100000", "3"], stdout=subprocess.PIPE)
    for _ in range(10):
        process.stdout.readline()
    process.kill()
    process.wait()
    return path


def draw(*arguments):
    return weft_analysis.__main__.main([str(argument) for argument in arguments])


def test_trace_knows_its_run(finished):
    with weft_analysis.Trace(finished) as trace:
        assert trace.finished
        assert trace.scene_name == "synthetic"
        assert trace.kinds[1] == "spring"
        assert trace.energies == ["spring", "bending"]
        assert trace.devices[1]["driver"] == "PoCL 3.1"
        assert trace.settings["plan"] == "exact"
        assert len(trace.frames) == 30


def test_tables_by_frame(finished):
    with weft_analysis.Trace(finished) as trace:
        every = trace.table("executions")
        one = trace.table("executions", frame=7)
        assert numpy.array_equal(one, every[every["frame"] == 7])
        assert len(one) == 4 * len(trace.table("plan", frame=7))
        assert len(trace.table("no such table")) == 0


def test_killed_run_is_readable_up_to_its_last_complete_frame(killed):
    with weft_analysis.Trace(killed) as trace:
        assert not trace.finished
        assert len(trace.frames) >= 9
        assert trace.table("executions")["frame"].max() == trace.frames["frame"][-1]


@pytest.mark.parametrize("command", ["schedule", "makespan", "energy"])
@pytest.mark.parametrize("run", ["finished", "killed"])
def test_pictures(command, run, request, tmp_path):
    output = tmp_path / "picture.png"
    assert draw(command, request.getfixturevalue(run), "-o", output) == 0
    picture = matplotlib.image.imread(output)
    assert picture.shape[1] == 1500
    colours = {tuple(pixel) for pixel in numpy.round(picture[::7, ::7, :3], 1).reshape(-1, 3)}
    assert len(colours) > 5


def test_module_is_a_command(finished, tmp_path):
    subprocess.run([sys.executable, "-m", "weft_analysis", "schedule", finished, "--frame", "3",
                    "--substep", "2", "-o", tmp_path / "a.svg"], check=True,
                   cwd=ROOT / "analysis", env={**os.environ, "PYTHONDONTWRITEBYTECODE": "1"})
    assert "<svg" in (tmp_path / "a.svg").read_text()


@pytest.mark.parametrize("arguments, message", [
    (["--frame", "99"], "no frame 99; it has 0 to 29"),
    (["--substep", "4"], "frame 29 has no substep 4"),
])
def test_wrong_frame_is_one_message(finished, tmp_path, capsys, arguments, message):
    assert draw("schedule", finished, *arguments, "-o", tmp_path / "a.png") == 2
    errors = capsys.readouterr().err
    assert errors.count("\n") == 1 and message in errors


def test_wrong_file_is_one_message(tmp_path, capsys):
    (tmp_path / "scene.toml").write_text("[scene]\n")
    for path in (tmp_path / "scene.toml", tmp_path / "missing.h5"):
        assert draw("makespan", path, "-o", tmp_path / "a.png") == 2
        errors = capsys.readouterr().err
        assert errors.count("\n") == 1 and str(path) in errors
