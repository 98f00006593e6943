"""Runs of a sweep that are stopped, killed or crash, and how they go on."""

import json
import os
import signal
import subprocess
import time

import pytest
from sweeps import LONG, SWEEP, batch, hash_of, long_folder, make, run_folder, states
from sweeps import wait_for_checkpoint, whole_hash
from weft_program import start_weft


def test_of_many_processes_one_runs(long_folder):
    make(long_folder)
    processes = [start_weft("batch", "sweep.toml", "--index", "0", cwd=long_folder)
                 for _ in range(8)]
    codes = sorted(process.wait(timeout=120) for process in processes)
    said = [process.communicate()[1] for process in processes]
    # Whoever came after the end has found it done.
    assert codes[0] == 0 and set(codes) <= {0, 75} and codes.count(75) >= 1
    assert sum("another process is at it" in text for text in said) == codes.count(75)
    status = json.loads((run_folder(long_folder, 0) / "status.json").read_text())
    assert status["attempts"] == 1 and states(long_folder)[0] == "finished"


@pytest.mark.parametrize("signals", [["SIGTERM"], ["SIGTERM", "SIGTERM"], ["SIGUSR1"], ["SIGHUP"],
                                     ["SIGINT"]], ids="+".join)
def test_stops_in_good_order_and_goes_on(long_folder, signals):
    make(long_folder)
    process = start_weft("batch", "sweep.toml", "--index", "0,1", cwd=long_folder)
    wait_for_checkpoint(long_folder, 0)
    for name in signals:
        process.send_signal(getattr(signal, name))
        time.sleep(0.02)
    assert process.wait(timeout=60) == 75
    assert "goes on" in process.communicate()[1]
    assert list(states(long_folder).values())[:2] == ["stopped", "waiting"]
    assert batch(long_folder, "sweep.toml", "--index", "0").returncode == 0
    status = json.loads((run_folder(long_folder, 0) / "status.json").read_text())
    assert status["attempts"] == 2 and status["state"] == "finished"
    assert hash_of(long_folder, 0) == whole_hash(long_folder)


def test_signals_to_the_whole_group(long_folder):
    """As srun and a terminal send them: to the driver and to the run at once, and again."""
    make(long_folder)
    process = start_weft("batch", "sweep.toml", "--index", "0", cwd=long_folder,
                         start_new_session=True)
    wait_for_checkpoint(long_folder, 0)
    for _ in range(2):
        os.killpg(process.pid, signal.SIGTERM)
        time.sleep(0.02)
    assert process.wait(timeout=60) == 75
    process.communicate()
    assert (run_folder(long_folder, 0) / "checkpoint").exists()
    assert states(long_folder)[0] == "stopped"


def test_a_killed_run_is_lost_and_goes_on(long_folder):
    make(long_folder)
    process = start_weft("batch", "sweep.toml", "--index", "0", cwd=long_folder)
    wait_for_checkpoint(long_folder, 0)
    assert states(long_folder)[0] == "running"
    process.kill()
    process.communicate()
    end = time.monotonic() + 30
    while states(long_folder)[0] == "running" and time.monotonic() < end:
        time.sleep(0.05)  # the run itself, which is told to stop when its driver dies
    ranges = batch(long_folder, "sweep.toml", "--list", "--state", "lost", "--ranges").stdout
    assert ranges == "0\n"
    assert batch(long_folder, "sweep.toml", "--index", ranges.strip()).returncode == 0
    assert hash_of(long_folder, 0) == whole_hash(long_folder)


def kill_run(process, number):
    """Kills not the driver, but the run that it waits for."""
    child = subprocess.run(["ps", "-o", "pid=", "--ppid", str(process.pid)], text=True,
                           stdout=subprocess.PIPE).stdout.split()
    os.kill(int(child[0]), number)


def test_a_crash_takes_only_its_run(long_folder):
    make(long_folder)
    # Sanitizers leave the crash alone, which is not theirs to report.
    process = start_weft("batch", "sweep.toml", "--index", "0,2", cwd=long_folder,
                         env=dict(os.environ, ASAN_OPTIONS="handle_segv=0"))
    wait_for_checkpoint(long_folder, 0)
    kill_run(process, signal.SIGSEGV)
    assert process.wait(timeout=120) == 1
    assert "killed by signal 11" in process.communicate()[1]
    assert [states(long_folder)[index] for index in (0, 2)] == ["failed", "finished"]


@pytest.fixture
def killed(long_folder):
    """A sweep whose run 0 was killed, as for want of memory, after its first checkpoint."""
    make(long_folder)
    process = start_weft("batch", "sweep.toml", "--index", "0", cwd=long_folder)
    wait_for_checkpoint(long_folder, 0)
    kill_run(process, signal.SIGKILL)
    assert process.wait(timeout=120) == 1 and "out of memory" in process.communicate()[1]
    return long_folder


def frames_done_before(folder, index):
    """By the run that went on, as its log tells."""
    return [line for line in (run_folder(folder, index) / "log.txt").read_text().splitlines()
            if "going on after" in line]


def test_a_killed_run_goes_on_when_it_is_done_again(killed):
    said = batch(killed, "sweep.toml", "--index", "0")
    assert said.returncode == 1 and "--again goes on from its checkpoint" in said.stderr
    assert batch(killed, "sweep.toml", "--index", "0", "--again").returncode == 0
    assert frames_done_before(killed, 0)
    assert hash_of(killed, 0) == whole_hash(killed)


@pytest.mark.parametrize("spoil", [lambda file: file.unlink(), lambda file: file.write_text("x")],
                         ids=["missing", "damaged"])
def test_a_killed_run_without_a_usable_checkpoint_starts_anew(killed, spoil):
    spoil(run_folder(killed, 0) / "checkpoint")
    assert batch(killed, "sweep.toml", "--index", "0", "--again").returncode == 0
    assert not frames_done_before(killed, 0)


def test_stops_before_the_time_limit(long_folder):
    (long_folder / "scene.toml").write_text(LONG.replace("frames = 60", "frames = 5000"))
    make(long_folder, SWEEP.replace("checkpoint = 0", 'checkpoint = 0, time_limit = "3s"'))
    begin = time.monotonic()
    assert batch(long_folder, "sweep.toml", "--index", "0-3").returncode == 75
    assert time.monotonic() - begin < 20
    assert list(states(long_folder).values()) == ["stopped"] + ["waiting"] * 3
