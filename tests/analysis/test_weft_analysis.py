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
        assert list(trace.table("contacts", frame=7)["pairs"]) == [1007]
        assert len(trace.table("no such table")) == 0


def test_tables_by_graph(finished):
    with weft_analysis.Trace(finished) as trace:
        for name in ("divisions", "dependencies"):
            every = trace.table(name)
            assert sorted(set(every["graph"])) == [0, 1, 2]
            for frame in (0, 7):
                one = trace.table(name, frame)
                assert numpy.array_equal(one, every[every["graph"] == frame % 3])
        strips = trace.table("divisions", 7)
        assert list(strips["device"]) == [0, 1]
        plan, edges = trace.table("plan", 7), trace.table("dependencies", 7)
        assert set(edges["to"]) <= set(plan["task"])
        assert len(trace.table("divisions", 99)) == 0


def test_killed_run_is_readable_up_to_its_last_complete_frame(killed):
    with weft_analysis.Trace(killed) as trace:
        assert not trace.finished
        assert len(trace.frames) >= 9
        assert trace.table("executions")["frame"].max() == trace.frames["frame"][-1]


@pytest.mark.parametrize("command", ["makespan", "energy"])
@pytest.mark.parametrize("run", ["finished", "killed"])
def test_pictures(command, run, request, tmp_path):
    output = tmp_path / "picture.png"
    assert draw(command, request.getfixturevalue(run), "-o", output) == 0
    picture = matplotlib.image.imread(output)
    assert picture.shape[1] == 1500
    colours = {tuple(pixel) for pixel in numpy.round(picture[::7, ::7, :3], 1).reshape(-1, 3)}
    assert len(colours) > 5


def test_module_is_a_command(finished, tmp_path):
    subprocess.run([sys.executable, "-m", "weft_analysis", "makespan", finished,
                    "-o", tmp_path / "a.svg"], check=True,
                   cwd=ROOT / "analysis", env={**os.environ, "PYTHONDONTWRITEBYTECODE": "1"})
    assert "<svg" in (tmp_path / "a.svg").read_text()


def test_wrong_file_is_one_message(tmp_path, capsys):
    (tmp_path / "scene.toml").write_text("[scene]\n")
    for path in (tmp_path / "scene.toml", tmp_path / "missing.h5"):
        assert draw("makespan", path, "-o", tmp_path / "a.png") == 2
        errors = capsys.readouterr().err
        assert errors.count("\n") == 1 and str(path) in errors


RESULTS = """index,solver.method,run.repeat,k,state,ms_per_frame
0,xpbd,1,1e3,finished,2.0
1,xpbd,2,1e3,finished,4.0
2,xpbd,1,1e5,finished,3.0
3,vbd,1,1e3,finished,5.0
4,vbd,1,1e5,failed,
"""


def test_sweep_panels_hold_the_finished_runs(tmp_path):
    from weft_analysis import sweep

    path = tmp_path / "results.csv"
    path.write_text(RESULTS)
    figure = sweep.plot(sweep.read(path), "k", "ms_per_frame", None, "solver.method")
    xpbd, vbd = [axis for axis in figure.axes if axis.get_visible()]
    # The upper of two repeats counts as their median; the points are there, too.
    assert [list(line.get_ydata()) for line in xpbd.lines] == [[4.0, 3.0]]
    assert len(xpbd.collections[0].get_offsets()) == 3
    assert [list(line.get_ydata()) for line in vbd.lines] == [[5.0]]
    assert xpbd.get_xscale() == "log" and xpbd.get_yscale() == "linear"


def test_sweep_is_a_command(tmp_path, capsys):
    path = tmp_path / "results.csv"
    path.write_text(RESULTS)
    picture = tmp_path / "sweep.png"
    arguments = ["sweep", str(path), "--x", "k", "--colour", "solver.method", "-o", str(picture)]
    assert weft_analysis.__main__.main([*arguments, "--y", "ms_per_frame"]) == 0
    assert matplotlib.image.imread(picture).std() > 0.02
    assert weft_analysis.__main__.main([*arguments, "--y", "ms"]) == 2
    assert "there is no column 'ms'" in capsys.readouterr().err
    path.write_text(RESULTS.replace("finished", "waiting"))
    assert weft_analysis.__main__.main([*arguments, "--y", "ms_per_frame"]) == 2
    assert "no run is finished" in capsys.readouterr().err
