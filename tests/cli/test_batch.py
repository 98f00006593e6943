"""A sweep on one machine: what is made, what is done, what is collected."""

import ast
import json
import os
import shlex
import shutil
import subprocess

import h5py
import pytest
from sweeps import SHEET, SWEEP, batch, folder, hash_of, long_folder, make, results, run_folder
from sweeps import states, wait_for_checkpoint
from weft_program import CORES, TOUCHING, WEFT, start_weft, weft, weft_json


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


@pytest.mark.skipif(CORES < 2, reason="needs two devices")
def test_asynchronous_results_are_no_differences(folder):
    """They depend on the cuts, by design."""
    make(folder, SWEEP.replace('"cpu/1"', '"cpu/1+cpu/1"').replace("[1e3, 1e4]", "[1e4]")
         .replace('"auto", "single"', '"exact", "async"'))
    assert batch(folder, "sweep.toml", "--index", "all", "--quiet").returncode == 0
    assert hash_of(folder, 0) != hash_of(folder, 1)
    assert "several results" not in batch(folder, "sweep.toml", "--collect").stderr


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


@pytest.mark.parametrize("name", ["my sweep", "my 'sweep'", 'a "b" $c'])
def test_scripts_name_any_folder(folder, name):
    """The shell's words stay out of Python's strings, and Python's out of the shell's."""
    made = batch(folder, "sweep.toml", "--out", f"out/{name}")
    assert made.returncode == 0, made.stderr
    snakefile = batch(folder, f"out/{name}", "--script", "snakemake").stdout
    named = [line for line in snakefile.splitlines() if line.startswith("FOLDER = ")]
    assert [ast.literal_eval(line.partition(" = ")[2]) for line in named] == [f"out/{name}"]
    assert f"out/{name}/" not in snakefile and snakefile.count("{FOLDER:q}") == 2

    queue = batch(folder, f"out/{name}", "--script", "hyperqueue").stdout
    command = shlex.split(queue.replace("\\\n", ""), comments=True)
    assert command[-3:-1] == ["bash", "-c"]
    assert shlex.split(command[-1])[:4] == ["exec", "weft", "batch", f"out/{name}"]


@pytest.mark.skipif(shutil.which("snakemake") is None, reason="needs snakemake")
def test_snakemake_runs_a_folder_with_blanks(folder):
    assert batch(folder, "sweep.toml", "--out", "out/my 'sweep'").returncode == 0
    script = batch(folder, "out/my 'sweep'", "--script", "snakemake").stdout
    (folder / "Snakefile").write_text(script)
    path = f"{os.path.dirname(WEFT)}:{os.environ['PATH']}"
    ran = subprocess.run(["snakemake", "--cores", "1"], cwd=folder, capture_output=True, text=True,
                         env={**os.environ, "PATH": path})
    assert ran.returncode == 0, ran.stderr
    assert (folder / "out/my 'sweep'/results.csv").exists()


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
