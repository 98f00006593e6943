"""A sweep on one machine: what is checked before, what is done, what is left, what is collected."""

import csv
import json
import os
import signal
import subprocess
import time

import h5py
import pytest
from weft_program import SHEET as FREE_SHEET
from weft_program import TOUCHING, WEFT, expect_error, start_weft, weft, weft_json

# Held at a corner, so that its stiffness matters.
SHEET = FREE_SHEET + 'pins = { corners = ["x-z-"] }\n'

SWEEP = """
sweep = { name = "s", scene = "scene.toml" }
run = { device = "cpu/1", geometry = false, checkpoint = 0 }
[[axis]]
key = "cloth[0].stretch.stiffness"
values = [1e3, 1e4]
[[axis]]
key = "run.plan"
values = ["auto", "single"]
"""
# A run that takes some seconds, in frames of some 20 ms.
LONG = SHEET.replace("frames = 3", "frames = 60").replace("substeps = 2", "substeps = 200")


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "scene.toml").write_text(SHEET)
    (tmp_path / "sweep.toml").write_text(SWEEP)
    return tmp_path


@pytest.fixture
def long_folder(folder):
    (folder / "scene.toml").write_text(LONG)
    return folder


def batch(folder, *arguments, **options):
    return weft("batch", *arguments, cwd=folder, **options)


def make(folder, text=None):
    if text is not None:
        (folder / "sweep.toml").write_text(text)
    result = batch(folder, "sweep.toml", "--json")
    assert result.returncode == 0, result.stderr
    return json.loads(result.stdout)


def states(folder, *arguments):
    runs = weft_json("batch", "out/s", "--list", *arguments, cwd=folder)
    return {run["index"]: run["state"] for run in runs}


def run_folder(folder, index):
    lines = (folder / "out/s/manifest.jsonl").read_text().splitlines()[1:]
    return folder / "out/s/runs" / json.loads(lines[index])["id"]


def hash_of(folder, index):
    return json.loads((run_folder(folder, index) / "summary.json").read_text())["state_hash"]


def wait_for_checkpoint(folder, index, limit=60.0):
    end = time.monotonic() + limit
    while not (run_folder(folder, index) / "checkpoint").exists():
        assert time.monotonic() < end
        time.sleep(0.01)


def whole_hash(folder):
    """Of run 0 as one that was never stopped."""
    result = weft("run", "scene.toml", "--device", "cpu/1", "--quiet", "--set",
                  "cloth[0].stretch.stiffness=1000.0", "--out", "whole", cwd=folder)
    assert result.returncode == 0, result.stderr
    return json.loads((folder / "whole/summary.json").read_text())["state_hash"]


def results(folder):
    with open(folder / "out/s/results.csv", newline="") as file:
        return list(csv.DictReader(file))


def test_from_a_sweep_to_its_results(folder):
    assert make(folder) == {"name": "s", "folder": "out/s", "runs": 4, "new": 4, "dropped": 0}
    assert set(states(folder).values()) == {"waiting"}
    assert batch(folder, "sweep.toml", "--index", "0-2", "--quiet").returncode == 0
    assert list(states(folder).values()) == ["finished"] * 3 + ["waiting"]
    ranges = batch(folder, "sweep.toml", "--list", "--state", "waiting,lost", "--ranges")
    assert ranges.stdout == "3\n"
    commands = batch(folder, "sweep.toml", "--list", "--state", "finished", "--commands").stdout
    assert commands.splitlines()[1] == "weft batch out/s --index 1"

    assert batch(folder, "out/s", "--collect").returncode == 0
    rows = results(folder)
    assert [row["state"] for row in rows] == ["finished"] * 3 + ["waiting"]
    assert [row["run.plan"] for row in rows] == ["auto", "single"] * 2
    assert rows[0]["state_hash"] == rows[1]["state_hash"] != rows[2]["state_hash"]
    assert rows[3]["state_hash"] == "" and int(rows[0]["frames"]) == 3
    with h5py.File(folder / "out/s/results.h5") as file:
        assert file["runs/state"].asstr()[2] == "finished"
        assert list(file["runs/index"]) == [0, 1, 2, 3]
        assert len(file["traces/2/frames"]) == 3 and set(file["traces"]) == {"0", "1", "2"}


def test_quiet_says_what_was_made_and_no_more(folder):
    assert batch(folder, "sweep.toml", "--quiet").stdout == "s: 4 runs in out/s\n"
    made = weft("error", "scene.toml", "--devices", "cpu/1", "--as-sweep", "--quiet", cwd=folder)
    assert made.returncode == 0 and "runs in" in made.stdout and "next:" not in made.stdout


def test_warnings_are_seen_wherever_a_sweep_is_looked_at(folder):
    """Too few iterations for the mesh are warned of by the run that has them."""
    make(folder, SWEEP.replace("cloth[0].stretch.stiffness", "solver.iterations")
         .replace("[1e3, 1e4]", "[1, 200]").replace('["auto", "single"]', '["auto"]'))
    said = batch(folder, "sweep.toml", "--index", "all")
    assert said.returncode == 0 and said.stderr.count("warnings: 1") == 1
    listed = batch(folder, "sweep.toml", "--list").stdout
    assert "2 finished (1 warned)" in listed and listed.count("warning: 'sheet' is too fine") == 1
    runs = weft_json("batch", "sweep.toml", "--list", cwd=folder)
    assert len(runs[0]["warnings"]) == 1 and "warnings" not in runs[1]
    assert "2 finished (1 warned)" in batch(folder, "sweep.toml", "--watch").stderr

    assert "2 finished (1 warned)" in batch(folder, "sweep.toml", "--collect").stdout
    assert weft_json("batch", "sweep.toml", "--collect", cwd=folder)["warned"] == 1
    rows = results(folder)
    assert [row["warnings"] for row in rows] == ["1", "0"]
    assert "too fine" in rows[0]["first_warning"] and rows[1]["first_warning"] == ""


def test_numbers_in_tables_of_the_summary_are_collected(folder):
    (folder / "scene.toml").write_text(TOUCHING)
    make(folder, """
sweep = { name = "s", scene = "scene.toml" }
run = { device = "cpu/1", geometry = false }
axis = [{ key = "scene.frames", values = [8] }]
""")
    assert batch(folder, "sweep.toml", "--index", "all").returncode == 0
    assert batch(folder, "sweep.toml", "--collect").returncode == 0
    summary = json.loads((run_folder(folder, 0) / "summary.json").read_text())
    with h5py.File(folder / "out/s/results.h5") as file:
        for table, key in [("relative_error_estimate", "median"), ("contact", "pairs"),
                           ("relative_error_estimate", "worst"), ("energies", "total")]:
            assert float(results(folder)[0][f"{table}.{key}"]) == summary[table][key]
            assert file[f"runs/{table}.{key}"][0] == summary[table][key]


def test_a_finished_run_is_done_at_once(folder):
    make(folder)
    assert batch(folder, "sweep.toml", "--index", "0").returncode == 0
    summary = run_folder(folder, 0) / "summary.json"
    before = summary.stat().st_mtime_ns
    assert batch(folder, "sweep.toml", "--index", "0").returncode == 0
    assert summary.stat().st_mtime_ns == before


def test_a_run_is_a_run_of_weft(folder):
    """The manifest's line, and the same typed by hand, give the same state."""
    make(folder)
    assert batch(folder, "sweep.toml", "--index", "3").returncode == 0
    line = json.loads((folder / "out/s/manifest.jsonl").read_text().splitlines()[4])
    result = weft("run", line["scene"], *line["args"], "--out", folder / "by-hand", "--quiet",
                  cwd=folder / "out/s")
    assert result.returncode == 0, result.stderr
    by_hand = json.loads((folder / "by-hand/summary.json").read_text())
    assert by_hand["state_hash"] == hash_of(folder, 3)


def test_sweeps_keep_the_costs_that_they_measure(folder):
    make(folder)
    (folder / "scene.toml").write_text(SHEET.replace("frames = 3", "frames = 40"))
    make(folder)
    cache = folder / "cache"
    environment = {**os.environ, "WEFT_CACHE_DIR": str(cache)}
    assert batch(folder, "sweep.toml", "--index", "4", env=environment).returncode == 0
    assert (folder / "out/s/costs.json").exists()
    assert not (cache / "costs.json").exists()


@pytest.mark.parametrize("change, parts", [
    (('"single"', '"sinlge"'), ["sweep.toml:9:", "single"]),
    (("stiffness", "stifness"), ["sweep.toml:6:", "stiffness"]),
    (("[1e3, 1e4]", "[1e3, -1]"), ["sweep.toml:6:16", "-1"]),
    (('device = "cpu/1"', 'device = "cpux"'), ["sweep.toml:3:9: ", "cpux"]),
    (('device = "cpu/1"', 'devcie = "cpu/1"'), ["sweep.toml:3:9", "run.device"]),
    (("geometry", "geometri"), ["sweep.toml:3:27", "run.geometri", "run.geometry"]),
    (("geometry", "foo"), ["sweep.toml:3:27", "run.foo"]),
    (("scene.toml", "scne.toml"), ["sweep.toml:2:31: scne.toml: no such scene"]),
    (("values = [1e3", "valeus = [1e3"), ["sweep.toml:6:1", "values"]),
])
def test_a_wrong_value_is_found_before_anything_runs(folder, change, parts):
    (folder / "sweep.toml").write_text(SWEEP.replace(*change, 1))
    expect_error(batch(folder, "sweep.toml"), 2, *parts)
    assert not (folder / "out").exists()


@pytest.mark.parametrize("arguments, parts", [
    (["sweep.toml", "--index", "4"], ["--index 4", "the last one is 3"]),
    (["sweep.toml", "--index", "x"], ["'x'"]),
    (["sweep.toml", "--list", "--state", "finishd"], ["finished"]),
    (["sweep.toml", "--list", "--collect"], ["one of them"]),
    (["sweep.toml", "--script", "slrum"], ["slurm"]),
    (["none.toml"], ["none.toml: no such sweep file"]),
    (["out/s"], ["is a folder"]),
])
def test_bad_requests(folder, arguments, parts):
    make(folder)
    expect_error(batch(folder, *arguments), 2, *parts)


def test_two_sweeps_of_one_name_do_not_share_a_folder(folder):
    make(folder)
    (folder / "other.toml").write_text(SWEEP.replace("1e3", "1e5"))
    for arguments in [], ["--list"], ["--index", "0"], ["--collect"], ["--script", "slurm"]:
        expect_error(batch(folder, "other.toml", *arguments), 2, "other.toml: ", "sweep.toml",
                     "'s'")
    assert len(states(folder, "--dropped")) == 4
    assert batch(folder, "other.toml", "--out", "out/other").returncode == 0
    # The same file, given another name, is the same sweep.
    (folder / "sweep.toml").rename(folder / "renamed.toml")
    assert batch(folder, "renamed.toml", "--list").returncode == 0


def test_a_damaged_manifest_says_where_and_what_to_do(folder):
    make(folder)
    manifest = folder / "out/s/manifest.jsonl"
    manifest.write_text(manifest.read_text().replace('"index":2', '"index":'))
    expect_error(batch(folder, "sweep.toml", "--list"), 2, "manifest.jsonl:4: ", "make the sweep")
    manifest.unlink()
    assert make(folder)["new"] == 4


def test_an_index_needs_a_manifest(folder):
    expect_error(batch(folder, "sweep.toml", "--index", "0"), 2, "manifest.jsonl", "weft batch")


def test_a_failed_run_fails_alone(folder):
    make(folder, SWEEP.replace("cloth[0].stretch.stiffness", "guard.max_speed")
         .replace("[1e3, 1e4]", "[1e3, 1e-6]"))
    result = batch(folder, "sweep.toml", "--index", "all")
    assert result.returncode == 1, result.stderr
    assert "and 1 more" in result.stderr.splitlines()[-1]
    assert list(states(folder).values()) == ["finished", "finished", "failed", "failed"]
    again = batch(folder, "sweep.toml", "--index", "2")
    assert again.returncode == 1 and "--again" in again.stderr
    status = json.loads((run_folder(folder, 2) / "status.json").read_text())
    assert status["attempts"] == 1 and status["exit_code"] == 1 and "speed" in status["why"]
    assert batch(folder, "sweep.toml", "--index", "2", "--again").returncode == 1
    status = json.loads((run_folder(folder, 2) / "status.json").read_text())
    assert status["attempts"] == 2


def test_an_edited_sweep_keeps_its_numbers(folder):
    make(folder)
    assert batch(folder, "sweep.toml", "--index", "2").returncode == 0
    edited = SWEEP.replace("[1e3, 1e4]", "[1e5, 1e4]")
    assert make(folder, edited) == {"name": "s", "folder": "out/s", "runs": 4, "new": 2,
                                    "dropped": 2}
    assert states(folder) == {2: "finished", 3: "waiting", 4: "waiting", 5: "waiting"}
    assert states(folder, "--dropped")[0] == "waiting"
    # A job that was submitted before runs what it was submitted for.
    assert batch(folder, "sweep.toml", "--index", "0").returncode == 0
    with h5py.File(run_folder(folder, 0) / "trace.h5") as trace:
        assert "stiffness=1000.0" in trace["run"].attrs["command"]


def test_all_runs_are_those_that_the_sweep_still_has(folder):
    make(folder)
    (folder / "scene.toml").write_text(SHEET.replace("iterations = 2", "iterations = 3"))
    make(folder, SWEEP.replace("[1e3, 1e4]", "[1e3, 1e5]"))
    said = batch(folder, "sweep.toml", "--index", "all")
    assert said.returncode == 0, said.stderr
    assert states(folder) == {index: "finished" for index in range(4, 8)}
    assert set(list(states(folder, "--dropped").values())[:4]) == {"waiting"}
    script = batch(folder, "sweep.toml", "--script", "snakemake").stdout
    assert "RUNS = [*range(4, 8)]\n" in script


def test_an_edited_scene_is_not_run_as_the_old_one(folder):
    make(folder)
    (folder / "scene.toml").write_text(SHEET.replace("iterations = 2", "iterations = 3"))
    expect_error(batch(folder, "sweep.toml", "--index", "0"), 2, "scene.toml", "changed")
    assert make(folder)["new"] == 4
    assert batch(folder, "sweep.toml", "--index", "4").returncode == 0


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


def test_collects_while_runs_go_on(long_folder):
    make(long_folder)
    process = start_weft("batch", "sweep.toml", "--index", "0", cwd=long_folder)
    wait_for_checkpoint(long_folder, 0)
    counts = weft_json("batch", "sweep.toml", "--collect", cwd=long_folder)["counts"]
    assert counts["running"] + counts["finished"] == 1 and counts["waiting"] == 3
    assert process.wait(timeout=120) == 0
    process.communicate()
    assert weft_json("batch", "sweep.toml", "--collect", cwd=long_folder)["counts"]["finished"] == 1


def test_says_where_hashes_differ(folder):
    make(folder)
    assert batch(folder, "sweep.toml", "--index", "0,1", "--quiet").returncode == 0
    collected = batch(folder, "sweep.toml", "--collect")
    assert "several results" not in collected.stderr
    summary = run_folder(folder, 1) / "summary.json"
    text = json.loads(summary.read_text())
    text["state_hash"] = "0" * 32
    summary.write_text(json.dumps(text))
    assert "several results" in batch(folder, "sweep.toml", "--collect").stderr


@pytest.mark.parametrize("engine, parts", [
    ("slurm", ["#SBATCH --array=0-3", "scontrol requeue"]),
    ("parallel", ["--termseq", "--commands"]),
    ("hyperqueue", ["hq submit", "--array 0-3"]),
    ("snakemake", ["rule run", "RUNS = [*range(0, 4)]"]),
])
def test_scripts(folder, engine, parts):
    make(folder)
    result = batch(folder, "sweep.toml", "--script", engine)
    assert result.returncode == 0
    for part in parts:
        assert part in result.stdout
    if engine != "snakemake":
        assert subprocess.run(["bash", "-n"], input=result.stdout, text=True).returncode == 0


def test_the_program_is_named(folder):
    """Commands of --list start with the program, wherever it is."""
    make(folder)
    line = batch(folder, "sweep.toml", "--list", "--commands").stdout.splitlines()[0]
    words = line.split()
    assert words[0] == "weft"
    assert subprocess.run([WEFT, *words[1:]], cwd=folder).returncode == 0


def test_watches_until_all_is_settled(folder):
    make(folder, SWEEP.replace("cloth[0].stretch.stiffness", "guard.max_speed")
         .replace("[1e3, 1e4]", "[1e3, 1e-6]"))
    process = start_weft("batch", "sweep.toml", "--watch", cwd=folder)
    assert batch(folder, "sweep.toml", "--index", "all", "--quiet").returncode == 1
    said = process.communicate(timeout=60)[1]
    assert process.returncode == 0
    assert said.count("failed: ") == 2 and "2 finished (2 warned), 2 failed" in said


@pytest.fixture
def study(folder):
    return ["scene.toml", "--solvers", "xpbd,vbd", "--devices", "cpu/1", "--frame", "1",
            "--max-iterations", "4"]


def columns(path):
    with open(path, newline="") as file:
        return [{key: row[key] for key in ("solver", "iteration", "energy", "relative_error")}
                for row in csv.DictReader(file)]


def test_a_study_as_a_sweep_finds_what_it_finds_alone(folder, study):
    assert weft("error", *study, "--out", "alone", "--quiet", cwd=folder).returncode == 0
    made = weft("error", *study, "--as-sweep", cwd=folder)
    assert made.returncode == 0 and "2 runs in out/sheet-error" in made.stdout
    assert batch(folder, "out/sheet-error", "--index", "0", "--quiet").returncode == 0
    assert batch(folder, "out/sheet-error/sweep.toml", "--out", "out/sheet-error", "--collect"
                 ).returncode == 0
    assert {row["solver"] for row in columns(folder / "out/sheet-error/error.csv")} == {"xpbd"}
    assert batch(folder, "out/sheet-error", "--index", "1", "--quiet").returncode == 0
    assert batch(folder, "out/sheet-error", "--collect").returncode == 0
    assert columns(folder / "out/sheet-error/error.csv") == columns(folder / "alone/error.csv")
    assert "<svg" in (folder / "out/sheet-error/error.svg").read_text()


def test_trajectories_as_a_sweep(folder):
    arguments = ["scene.toml", "--trajectory", "--solvers", "xpbd,vbd", "--devices", "cpu/1",
                 "--sweep-substeps", "1,2", "--sweep-iterations", "1,2", "--as-sweep"]
    assert weft("error", *arguments, cwd=folder).returncode == 0
    assert batch(folder, "out/sheet-trajectory", "--index", "all", "--quiet").returncode == 0
    assert batch(folder, "out/sheet-trajectory", "--collect").returncode == 0
    with open(folder / "out/sheet-trajectory/trajectory.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 8 and {row["solver"] for row in rows} == {"xpbd", "vbd"}
    # The front is that of all runs together: sorted by time, nearer and nearer.
    front = sorted((float(row["time_s"]), float(row["rms_m"])) for row in rows
                   if row["pareto"] == "1")
    assert front and all(a[1] > b[1] for a, b in zip(front, front[1:]))


def verdicts(path):
    with open(path, newline="") as file:
        return [{key: value for key, value in row.items() if key != "ms_per_frame"}
                for row in csv.DictReader(file)]


def test_the_suite_of_stability_as_a_sweep_finds_what_it_finds_alone(folder):
    chosen = ["--only", "iterations: k = 1e+06", "--solvers", "xpbd,vbd"]
    assert weft("stability", *chosen, "--out", "alone", "--quiet", cwd=folder).returncode == 0
    made = weft("stability", *chosen, "--as-sweep", cwd=folder)
    alone = verdicts(folder / "alone/stability.csv")
    assert made.returncode == 0 and f"{len(alone)} runs in out/stability" in made.stdout
    assert batch(folder, "out/stability", "--index", "1,0", "--quiet").returncode == 0
    assert batch(folder, "out/stability", "--collect").returncode == 0
    assert verdicts(folder / "out/stability/stability.csv") == alone[:2]
    assert batch(folder, "out/stability", "--index", "all", "--quiet").returncode == 0
    assert batch(folder, "out/stability", "--collect").returncode == 0
    assert verdicts(folder / "out/stability/stability.csv") == alone
    assert "<svg" in (folder / "out/stability/stability.svg").read_text()


def test_settings_for_a_scene_as_a_sweep(folder):
    arguments = ["scene.toml", "--frames", "3", "--time", "600", "--solvers", "xpbd,vbd"]
    made = weft("stability", *arguments, "--as-sweep", cwd=folder)
    assert made.returncode == 0 and "2 runs in out/sheet-settings" in made.stdout
    assert batch(folder, "out/sheet-settings", "--index", "all", "--quiet").returncode == 0
    collected = batch(folder, "out/sheet-settings", "--collect")
    assert collected.returncode == 0 and "the cheapest that holds, 3 frames" in collected.stdout
    with open(folder / "out/sheet-settings/settings.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    strains = [float(row["strain_rms"]) for row in rows if row["holds"] == "yes"]
    assert {row["solver"] for row in rows} == {"xpbd", "vbd"}
    # What holds is judged among all trials of all runs.
    assert strains and max(strains) <= max(1.5 * min(strains), min(strains) + 0.01)


def test_a_suite_has_no_scene_to_set_values_of(folder):
    (folder / "suite.toml").write_text(
        'sweep = { name = "suite", command = "stability" }\n'
        'run = { case = "no such case" }\n')
    expect_error(batch(folder, "suite.toml"), 2, "suite.toml:2", "no such case")
    (folder / "suite.toml").write_text(
        'sweep = { name = "suite", command = "stability" }\n'
        'axis = [{ key = "scene.frames", values = [3] }]\n')
    expect_error(batch(folder, "suite.toml"), 2, "suite.toml:2", "scene.frames")
    expect_error(weft("stability", "--set", "scene.frames=3", cwd=folder), 2, "--set")
    expect_error(weft("stability", "scene.toml", "--short", cwd=folder), 2, "--short")
    assert not (folder / "out").exists()


def test_a_study_with_wrong_names_makes_no_sweep(folder):
    expect_error(weft("error", "scene.toml", "--solvers", "xbpd", "--as-sweep", cwd=folder), 2,
                 "xpbd")
    (folder / "study.toml").write_text(
        'sweep = { name = "study", scene = "scene.toml", command = "error" }\n'
        'run = { solvers = "xbpd" }\n')
    expect_error(batch(folder, "study.toml"), 2, "study.toml:2", "xpbd")
    assert not (folder / "out").exists()
