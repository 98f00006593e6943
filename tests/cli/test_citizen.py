"""A process among others: it keeps to its cores, stops when asked, and however often."""

import contextlib
import json
import os
import pathlib
import signal
import time

import pytest
from weft_program import (CORES, LONG, SHEET, expect_error, opencl_devices, start_weft,
                          wait_for_frames, weft)

needs_linux = pytest.mark.skipif(not hasattr(os, "sched_getaffinity"), reason="no affinity here")
TERM, HUP, USR1 = signal.SIGTERM, signal.SIGHUP, signal.SIGUSR1


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "scene.toml").write_text(LONG)
    return tmp_path


def need_opencl():
    if not opencl_devices():
        pytest.skip("no OpenCL device here")


@contextlib.contextmanager
def running(folder, device, **options):
    """A run that has done its first frames."""
    process = start_weft("run", "scene.toml", "--device", device, "--quiet", cwd=folder, **options)
    try:
        wait_for_frames(folder / "out/sheet/trace.h5", 2, process)
        yield process
    finally:
        process.kill()
        process.communicate()


def cores_of_threads(process):
    """For each of its threads, the cores that it may use."""
    return [os.sched_getaffinity(int(task.name))
            for task in pathlib.Path(f"/proc/{process.pid}/task").iterdir()]


def one_core():
    """The last that this process may use: not the machine's first, where there is a choice."""
    return max(os.sched_getaffinity(0))


@needs_linux
@pytest.mark.parametrize("device", ["hybrid", "cpu", "opencl:0", "opencl:0/1"])
def test_threads_keep_to_the_cores_they_were_given(folder, device):
    if device.startswith("opencl"):
        need_opencl()
    core = one_core()
    with running(folder, device, preexec_fn=lambda: os.sched_setaffinity(0, {core})) as process:
        assert set().union(*cores_of_threads(process)) == {core}


@needs_linux
@pytest.mark.skipif(CORES < 2, reason="one core only")
def test_devices_have_cores_of_their_own(folder):
    need_opencl()
    first, *rest = sorted(os.sched_getaffinity(0))
    with running(folder, "cpu/1+opencl:0/1") as process:
        cores = cores_of_threads(process)
        assert {first} in cores  # the driver's thread
        assert {rest[0]} in cores  # TBB's


@needs_linux
def test_runs_in_a_cpuset(folder):
    """Where threads cannot be bound to other cores even by name."""
    need_opencl()
    parent = pathlib.Path("/sys/fs/cgroup/cpuset")
    if not (parent / "cpuset.cpus").exists() or os.geteuid() != 0:
        pytest.skip("cpusets cannot be made here")
    cpuset = parent / f"weft_test_{os.getpid()}"
    cpuset.mkdir()
    try:
        (cpuset / "cpuset.cpus").write_text(str(one_core()))
        (cpuset / "cpuset.mems").write_text((parent / "cpuset.mems").read_text())
        (folder / "scene.toml").write_text(SHEET)
        result = weft("run", "scene.toml", "--device", "opencl:0", "--quiet", cwd=folder,
                      preexec_fn=lambda: (cpuset / "tasks").write_text(str(os.getpid())))
        assert result.returncode == 0, result.stderr
    finally:
        cpuset.rmdir()


@needs_linux
def test_more_units_than_there_are_is_refused_in_words(folder):
    need_opencl()
    result = weft("run", "scene.toml", "--device", f"opencl:0/{CORES + 1}", "--quiet", cwd=folder)
    expect_error(result, 2, f"'opencl:0/{CORES + 1}'", f"{CORES} compute unit")
    result = weft("run", "scene.toml", "--device", "opencl:0/2", "--quiet", cwd=folder,
                  preexec_fn=lambda: os.sched_setaffinity(0, {one_core()}))
    expect_error(result, 2, "'opencl:0/2'", "1 compute unit that this process may use")


def send_until_it_ends(process, signals):
    """As srun and GNU parallel do, only more of them."""
    end = time.monotonic() + 60
    while process.poll() is None and time.monotonic() < end:
        process.send_signal(signals[0])
        signals = [*signals[1:], signals[0]]
        time.sleep(0.02)
    return process.communicate(timeout=1)


def expect_stopped(folder, process, number, stderr):
    assert process.returncode == 128 + number, stderr
    assert f"stopped by {number.name}" in stderr
    assert not json.loads((folder / "out/sheet/summary.json").read_text())["finished"]
    assert (folder / "out/sheet/checkpoint").exists()


def hear_all():
    for number in [TERM, HUP, USR1]:
        signal.signal(number, signal.SIG_DFL)  # nohup, for one, hands them on ignored


@pytest.mark.parametrize("signals", [[TERM], [HUP], [USR1], [USR1, TERM, HUP]],
                         ids=lambda s: "+".join(n.name for n in s))
def test_many_signals_stop_a_run_once(folder, signals):
    process = start_weft("run", "scene.toml", "--device", "cpu/1", cwd=folder, preexec_fn=hear_all)
    wait_for_frames(folder / "out/sheet/trace.h5", 2, process)
    _, stderr = send_until_it_ends(process, signals)
    expect_stopped(folder, process, signals[0], stderr)


def test_signals_while_it_sets_up(folder):
    process = start_weft("run", "scene.toml", "--device", "cpu/1", cwd=folder, preexec_fn=hear_all)
    assert "setting up" in process.stderr.readline()
    _, stderr = send_until_it_ends(process, [TERM])
    expect_stopped(folder, process, TERM, stderr)


def test_a_second_interrupt_ends_it_at_once(folder):
    process = start_weft("run", "scene.toml", "--device", "cpu/1", "--iterations", "800", cwd=folder)
    assert "setting up" in process.stderr.readline()
    assert "frames on" in process.stderr.readline()
    send_until_it_ends(process, [signal.SIGINT])
    assert process.returncode == -signal.SIGINT


def test_comparison_draws_no_bar_where_there_is_no_terminal(folder):
    """A line every few seconds, which three frames do not take."""
    result = weft("compare", "scene.toml", "--devices", "cpu/1", "--frames", "3", "--substeps", "1",
                  cwd=folder)
    assert result.returncode == 0
    assert result.stderr == ""
