"""`method = "auto"`: the solver is measured once, and is the run's own from then on."""

import json
import signal

import pytest
from weft_program import SHEET, expect_error, start_weft, wait_for_frames, weft, weft_json

METHODS = {"xpbd", "vbd", "sosd", "jpgd", "newton"}
HELD = SHEET.replace("frames = 3", "frames = 6") + 'pins = { corners = ["x-z-", "x+z-"] }\n'
AUTO = HELD.replace('"xpbd"\niterations = 2', '"auto"')


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "scene.toml").write_text(AUTO)
    return tmp_path


def run(folder, *arguments):
    return weft_json("run", "scene.toml", "--device", "cpu/1", *arguments, cwd=folder)


def test_says_what_it_took_and_why(folder):
    result = weft("run", "scene.toml", "--device", "cpu/1", "--json", cwd=folder)
    assert result.returncode == 0, result.stderr
    settings = json.loads(result.stdout)["settings"]
    assert settings["method"] in METHODS and 1 <= int(settings["iterations"]) <= 64
    why = settings["solver_choice"]
    assert all(name in why for name in METHODS) and " ms to " in why
    assert why.index(settings["method"]) == min(why.index(name) for name in METHODS), "best first"
    assert f"solver {settings['method']}: {why}" in result.stderr


def test_the_run_can_be_repeated(folder):
    summary = run(folder)
    trace = folder / "out/sheet/trace.h5"
    replayed = weft_json("replay", trace, cwd=folder)
    assert replayed["equal"] and replayed["state_hash"] == summary["state_hash"]
    # What was chosen is what does it by its name, too.
    settings = summary["settings"]
    named = run(folder, "--solver", settings["method"], "--iterations", settings["iterations"],
                "--force")
    assert named["state_hash"] == summary["state_hash"]
    assert "solver_choice" not in named["settings"]


def test_a_run_goes_on_with_the_solver_that_it_began_with(folder):
    (folder / "scene.toml").write_text(AUTO.replace("frames = 6", "frames = 40")
                                       .replace("substeps = 2", "substeps = 200"))
    process = start_weft("run", "scene.toml", "--device", "cpu/1", "--checkpoint", "0", cwd=folder)
    wait_for_frames(folder / "out/sheet/trace.h5", 5, process)
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=60)
    first = json.loads((folder / "out/sheet/summary.json").read_text())["settings"]
    result = weft("run", "scene.toml", "--device", "cpu/1", "--resume", cwd=folder)
    assert result.returncode == 0, result.stderr
    assert "measuring" not in result.stderr
    whole = json.loads((folder / "out/sheet/summary.json").read_text())
    for name in ("method", "iterations", "solver_choice"):
        assert whole["settings"][name] == first[name]
    assert weft_json("replay", folder / "out/sheet/trace.h5", cwd=folder)["equal"]


def test_iterations_are_the_most_that_it_may_take(folder):
    settings = run(folder, "--iterations", "2")["settings"]
    assert int(settings["iterations"]) <= 2
    settings = run(folder, "--set", "solver.tolerance=0.5", "--force")["settings"]
    assert int(settings["iterations"]) <= 64


def test_only_what_knows_contact_is_considered(folder):
    settings = run(folder, "--set", "contact.self=true")["settings"]
    assert settings["method"] == "vbd" and "[contact]" in settings["solver_choice"]


def test_where_there_is_nothing_to_solve(folder):
    (folder / "scene.toml").write_text(AUTO.replace("pins", "#"))
    summary = run(folder)
    assert "nothing is to be solved" in summary["settings"]["solver_choice"]


def test_comparison_measures_one_solver(folder):
    comparison = weft_json("compare", "scene.toml", "--devices", "cpu/1,cpu/2", cwd=folder)
    assert len({row["state_hash"] for row in comparison["rows"]}) == 1


def test_other_commands(folder):
    result = weft("inspect", "scene.toml", cwd=folder)
    assert result.returncode == 0 and "measured when the scene runs" in result.stderr
    weft_json("error", "scene.toml", "--devices", "cpu/1", "--solvers", "vbd",
              "--max-iterations", "2", cwd=folder)
    expect_error(weft("run", "scene.toml", "--solver", "automatic", cwd=folder), 2, "automatic",
                 "auto")
