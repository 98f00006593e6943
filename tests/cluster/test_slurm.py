"""A sweep as job arrays of a real Slurm, which the tests start on this machine alone."""

import json
import os
import pathlib
import shutil
import signal
import subprocess
import time

import pytest
from weft_program import CORES, SHEET, WEFT, weft, weft_json

HERE = pathlib.Path(__file__).parent
PROGRAMS = ["slurmctld", "slurmd", "sbatch", "munged"]
MISSING = [name for name in PROGRAMS if shutil.which(name, path=os.environ["PATH"] + ":/usr/sbin")
           is None]
pytestmark = pytest.mark.skipif(bool(MISSING), reason=f"not installed: {', '.join(MISSING)}")

SWEEP = """
sweep = {{ name = "s", scene = "scene.toml" }}
run = {{ device = "{device}", geometry = false, checkpoint = 0 }}
[[axis]]
key = "{key}"
values = {values}
"""
LONG = SHEET.replace("frames = 3", "frames = 150").replace("substeps = 2", "substeps = 200")
ENDLESS = LONG.replace("frames = 150", "frames = 100000")
JOB = """#!/bin/bash
#SBATCH --cpus-per-task=1 --requeue --open-mode=append --output=%x-%a.log
exec weft batch out/s --index "$SLURM_ARRAY_TASK_ID"
"""


@pytest.fixture(scope="module")
def slurm(tmp_path_factory):
    folder = tmp_path_factory.mktemp("slurm")
    before = dict(os.environ)
    os.environ["PATH"] = f"{pathlib.Path(WEFT).parent}:{before['PATH']}:/usr/sbin"
    os.environ["SLURM_CONF"] = str(folder / "slurm.conf")
    subprocess.run(["bash", HERE / "slurm.sh", "up", folder, str(CORES)], check=True, timeout=60)
    yield folder
    subprocess.run(["scancel", "--me"])
    subprocess.run(["bash", HERE / "slurm.sh", "down", folder], timeout=60)
    os.environ.clear()
    os.environ.update(before)


@pytest.fixture
def folder(tmp_path, slurm):
    (tmp_path / "job.sh").write_text(JOB)
    return tmp_path


def make(folder, scene, key, values, device="cpu/1"):
    (folder / "scene.toml").write_text(scene)
    text = SWEEP.format(key=key, values=values, device=device)
    (folder / "sweep.toml").write_text(text)
    result = weft("batch", "sweep.toml", cwd=folder)
    assert result.returncode == 0, result.stderr


def submit(folder, *arguments):
    """The number of a job."""
    result = subprocess.run(["sbatch", "--parsable", *arguments], cwd=folder, text=True,
                            stdout=subprocess.PIPE, check=True)
    return result.stdout.strip()


def states(folder):
    return [run["state"] for run in weft_json("batch", "out/s", "--list", cwd=folder)]


def status(folder, index):
    lines = (folder / "out/s/manifest.jsonl").read_text().splitlines()[1:]
    run = folder / "out/s/runs" / json.loads(lines[index])["id"]
    return json.loads((run / "status.json").read_text()), run


def wait_until(condition, limit=60.0, why=lambda: ""):
    end = time.monotonic() + limit
    while not condition():
        assert time.monotonic() < end, f"it did not come to it in time\n{why()}"
        time.sleep(0.1)


def hash_of(folder, index):
    return json.loads((status(folder, index)[1] / "summary.json").read_text())["state_hash"]


def has_checkpoint(folder, index):
    try:
        return (status(folder, index)[1] / "checkpoint").exists()
    except FileNotFoundError:
        return False


def whole_hash(folder):
    result = weft("run", "scene.toml", "--device", "cpu/1", "--quiet", "--out", "whole", cwd=folder)
    assert result.returncode == 0, result.stderr
    return json.loads((folder / "whole/summary.json").read_text())["state_hash"]


def test_array_with_a_member_that_diverges(folder):
    make(folder, SHEET, "guard.max_speed", "[1e3, 1e-6, 1e4, 1e5]")
    result = subprocess.run(["sbatch", "--wait", "--array=0-3", "job.sh"], cwd=folder)
    assert result.returncode == 1
    assert states(folder) == ["finished", "failed", "finished", "finished"]
    failed = weft("batch", "sweep.toml", "--list", "--state", "failed", "--ranges", cwd=folder)
    assert failed.stdout == "1\n"
    assert status(folder, 0)[0]["engine"] == "slurm"


def what_slurm_says(slurm, job):
    shown = subprocess.run(["scontrol", "show", "job", job], text=True, stdout=subprocess.PIPE).stdout
    logs = [(slurm / name).read_text()[-2000:] for name in ("slurmctld.log", "slurmd.log")]
    return "\n".join([shown, *logs])


def test_stopped_before_the_limit_and_requeued(slurm, folder):
    """The script that weft prints; Slurm's own wait of two minutes is cut short."""
    make(folder, LONG, "scene.substeps", "[200]")
    script = weft("batch", "sweep.toml", "--script", "slurm", cwd=folder).stdout
    (folder / "printed.sh").write_text(script)
    job = submit(folder, "printed.sh")
    wait_until(lambda: has_checkpoint(folder, 0))
    subprocess.run(["scancel", "--batch", "--signal=USR1", job], check=True)
    wait_until(lambda: states(folder) == ["stopped"])
    assert status(folder, 0)[0]["exit_code"] == 75

    asked = time.monotonic()

    def begun_again():
        nonlocal asked
        # Refused while the job is completing; and slurmd, which counts whole seconds, takes a job
        # that begins again in the second of its end for the killed one, and kills it for good.
        if time.monotonic() > asked + 2.0:
            asked = time.monotonic()
            subprocess.run(["scontrol", "update", f"JobId={job}", "StartTime=now"],
                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        return status(folder, 0)[0]["attempts"] == 2

    # Long enough for Slurm's own wait, should it take none of these words.
    wait_until(begun_again, 200, lambda: what_slurm_says(slurm, job))
    wait_until(lambda: states(folder) == ["finished"])
    assert hash_of(folder, 0) == whole_hash(folder)


def test_two_sigterm_20_ms_apart(folder):
    make(folder, LONG, "scene.substeps", "[200]")
    (folder / "job.sh").write_text(JOB.replace("exec weft", "exec srun weft"))
    job = submit(folder, "--array=0", "job.sh")
    wait_until(lambda: has_checkpoint(folder, 0))
    for _ in range(2):
        subprocess.run(["scancel", "--signal=TERM", job], check=True)
        time.sleep(0.02)
    wait_until(lambda: states(folder) == ["stopped"])
    assert has_checkpoint(folder, 0)
    subprocess.run(["scancel", job])
    assert weft("batch", "sweep.toml", "--index", "0", cwd=folder).returncode == 0
    assert hash_of(folder, 0) == whole_hash(folder)


def kill_all_in(folder):
    """As a machine that goes down: Slurm's own KILL cancels a job, with a TERM before."""
    for process in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            if (process / "cwd").readlink() == folder and b"weft" in (process / "cmdline").read_bytes():
                os.kill(int(process.name), signal.SIGKILL)
        except OSError:
            pass  # it has ended meanwhile


def test_killed_ones_are_found_and_finished(folder):
    make(folder, LONG, "scene.substeps", "[200, 100]")
    submit(folder, "--array=0", "job.sh")
    wait_until(lambda: has_checkpoint(folder, 0))
    kill_all_in(folder)
    wait_until(lambda: states(folder)[0] == "lost")
    ranges = weft("batch", "sweep.toml", "--list", "--state", "lost,waiting", "--ranges",
                  cwd=folder).stdout.strip()
    assert ranges == "0-1"
    subprocess.run(["sbatch", "--wait", f"--array={ranges}", "job.sh"], cwd=folder, check=True)
    assert states(folder) == ["finished", "finished"]
    assert hash_of(folder, 0) == whole_hash(folder)


def threads_of_runs():
    """Cores that each thread of each run of weft may use."""
    sets = {}
    for process in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            words = (process / "cmdline").read_bytes().split(b"\0")
            parent = int((process / "stat").read_text().rsplit(")", 1)[1].split()[1])
            if pathlib.Path(os.fsdecode(words[0])).name != "weft" or b"batch" not in words:
                continue
            if b"weft" not in pathlib.Path(f"/proc/{parent}/cmdline").read_bytes():
                continue  # the driver itself
            sets[process.name] = [
                os.sched_getaffinity(int(task.name)) for task in (process / "task").iterdir()]
        except (OSError, ValueError):
            pass  # it has ended meanwhile
    return sets


@pytest.mark.skipif(CORES < 2, reason="needs two cores")
def test_tasks_keep_to_their_cores(slurm, folder):
    devices = [d["device"] for d in weft_json("devices")["devices"]]
    if "opencl:0" not in devices:
        pytest.skip("no OpenCL device")
    # Of two that end, the first may be through before the second has begun.
    make(folder, ENDLESS, "scene.substeps", "[200, 201]", device="opencl:0/1")
    job = submit(folder, "--array=0-1", "job.sh")
    wait_until(lambda: has_checkpoint(folder, 0) and has_checkpoint(folder, 1), 240,
               lambda: what_slurm_says(slurm, job))
    runs = threads_of_runs()
    subprocess.run(["scancel", job])
    assert len(runs) == 2, runs
    used = [set.union(*threads) for threads in runs.values()]
    assert all(len(cores) == 1 for cores in used), runs
    assert used[0] != used[1]


def test_a_sweep_edited_while_it_is_queued(folder):
    make(folder, SHEET, "cloth[0].density", "[0.2, 0.3]")
    job = submit(folder, "--hold", "--array=0-1", "job.sh")
    make(folder, SHEET, "cloth[0].density", "[0.3, 0.4]")
    subprocess.run(["scontrol", "release", job], check=True)
    wait_until(lambda: [run["state"] for run in weft_json(
        "batch", "out/s", "--list", "--dropped", cwd=folder)] == ["finished"] * 2 + ["waiting"])
    log = (status(folder, 0)[1] / "trace.h5").exists()
    assert log and "dropped" in weft("batch", "out/s", "--list", "--dropped", cwd=folder).stdout
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
