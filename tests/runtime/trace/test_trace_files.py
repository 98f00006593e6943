"""Traces as h5py sees them: finished, growing, and after kill -9."""

import os
import pathlib
import re
import signal
import subprocess

import h5py
import numpy
import pytest

FIXTURE = pathlib.Path(os.environ["WEFT_BIN"]) / "trace_fixture"
ROOT = pathlib.Path(os.environ["WEFT_ROOT"])
WEFT = os.environ["WEFT"]
TABLES = ["contacts", "costs", "dependencies", "divisions", "energies", "executions", "frames",
          "links", "plan", "transfers", "warnings"]


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    path = tmp_path_factory.mktemp("trace") / "trace.h5"
    subprocess.run([FIXTURE, path, "12"], check=True)
    return path


def start_run(path, frames, pause_ms, seen):
    """Starts a run, and returns when it has handed over `seen` frames."""
    process = subprocess.Popen([FIXTURE, path, str(frames), str(pause_ms)], stdout=subprocess.PIPE)
    for _ in range(seen):
        process.stdout.readline()
    return process


def complete_frames(file):
    """Numbers of the complete frames; checks that all tables hold all of them."""
    frames = file["frames"]["frame"]
    assert numpy.array_equal(frames, numpy.arange(len(frames)))
    for name in ("plan", "executions", "costs", "energies", "links", "transfers"):
        assert set(frames) <= set(file[name]["frame"]), name
    graphs = set(file["frames"]["graph"])
    assert graphs <= set(file["divisions"]["graph"]) and graphs <= set(file["dependencies"]["graph"])
    last = file["executions"][:]
    last = last[last["frame"] == frames[-1]]
    first = file["executions"][:]
    first = first[first["frame"] == 0]
    assert len(last) == len(first)
    return len(frames)


def test_finished_trace_opens_plainly(finished):
    with h5py.File(finished) as file:
        assert file.attrs["format"] == "weft-trace"
        assert file.attrs["format_version"] == 1
        assert file.attrs["finished"]
        assert file.attrs["state_hash"] == "00112233445566778899aabbccddeeff"
        assert sorted(file) == sorted(TABLES + ["run"])
        assert complete_frames(file) == 12
        run = file["run"]
        assert run.attrs["command"].startswith("weft run")
        assert run["scene"].asstr()[()].startswith("[scene]")
        assert list(run["kinds"].asstr()[:3]) == ["predict", "spring", "spring seam"]
        assert run["devices"]["driver"][1] == b"PoCL 3.1"
        assert run["settings"].attrs["plan"] == "exact"


def test_tables_hold_what_they_say(finished):
    with h5py.File(finished) as file:
        frames = file["frames"][:]
        assert numpy.all(frames["end"] > frames["start"])
        executions = file["executions"][:]
        first = executions[executions["frame"] == 0]
        busy = [numpy.sum((first["end"] - first["start"])[first["device"] == d]) for d in (0, 1)]
        assert numpy.allclose(busy, [frames["busy_0"][0], frames["busy_1"][0]])
        energies = file["energies"][:]
        parts = sum(energies[name] for name in energies.dtype.names[1:-1])
        assert numpy.allclose(energies["total"], parts)
        assert file["executions"].compression == "gzip"


def test_every_column_is_documented(finished):
    text = (ROOT / "docs" / "trace-format.md").read_text()
    with h5py.File(finished) as file:
        for table in TABLES:
            section = text.split(f"### `{table}`")[1].split("\n##")[0]
            for column in file[table].dtype.names:
                generic = "busy_0" if column.startswith("busy_") else column
                generic = "ENERGY" if column in file["run/energies"].asstr()[:] else generic
                assert f"| `{generic}`" in section, f"{table}.{column}"


def test_units_are_those_of_the_documents(finished):
    text = (ROOT / "docs" / "trace-format.md").read_text()
    with h5py.File(finished) as file:
        for table in TABLES:
            section = text.split(f"### `{table}`")[1].split("\n##")[0]
            rows = [line.split("|") for line in section.splitlines() if line.startswith("| `")]
            units = {name: row[2].strip() for row in rows for name in re.findall("`(\\w+)`", row[1])}
            assert len(file[table].attrs["units"]) == len(file[table].dtype.names)
            for column, unit in zip(file[table].dtype.names, file[table].attrs["units"]):
                generic = "ENERGY" if column in file["run/energies"].asstr()[:] else column
                assert unit == units[generic], f"{table}.{column}"


def test_running_trace_can_be_followed(tmp_path):
    process = start_run(tmp_path / "trace.h5", 400, 5, seen=20)
    try:
        with h5py.File(tmp_path / "trace.h5", swmr=True) as file:
            before = len(file["frames"])
            assert before >= 20 - 2
            for _ in range(20):
                process.stdout.readline()
            file["frames"].id.refresh()
            assert len(file["frames"]) > before
    finally:
        process.kill()
        process.wait()


@pytest.mark.parametrize("seen", range(3, 43, 4))
def test_killed_run_loses_at_most_the_last_frame(tmp_path, seen):
    """Killed at ten different moments, at full speed and in the middle of writing."""
    path = tmp_path / "trace.h5"
    process = start_run(path, 100000, 3, seen)
    process.send_signal(signal.SIGKILL)
    process.wait()
    handed_over = seen + len(process.stdout.read().splitlines())
    with h5py.File(path, swmr=True) as file:
        assert not file.attrs["finished"]
        assert complete_frames(file) >= handed_over - 1


def test_killed_run_has_a_summary(tmp_path):
    process = start_run(tmp_path / "trace.h5", 100000, 3, seen=10)
    process.kill()
    process.wait()
    result = subprocess.run([WEFT, "trace", "summary", tmp_path / "trace.h5"],
                            capture_output=True, text=True)
    assert result.returncode == 0, result.stderr
    assert "not finished" in result.stdout
    assert "AMD EPYC (tbb, 1 unit)" in result.stdout


def test_summary_of_no_trace_is_a_wrong_request(tmp_path):
    (tmp_path / "scene.toml").write_text("[scene]\n")
    for path in (tmp_path / "scene.toml", tmp_path / "missing.h5", tmp_path):
        result = subprocess.run([WEFT, "trace", "summary", path], capture_output=True, text=True)
        assert result.returncode == 2
        assert str(path) in result.stderr
        assert result.stdout == ""
