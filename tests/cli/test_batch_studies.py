"""Studies whose parts are the runs of a sweep."""

import csv

import pytest
from sweeps import batch, folder
from weft_program import expect_error, weft


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
