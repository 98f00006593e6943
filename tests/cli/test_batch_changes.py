"""What is wrong in a sweep, and what has changed since it was made."""

import json

import h5py
import pytest
from sweeps import SHEET, SWEEP, batch, folder, make, run_folder, states
from weft_program import expect_error


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
