"""The suite of stiff and extreme cases in its short form, and the advice for a scene."""

import csv

import pytest
from weft_program import SHEET, expect_error, weft, weft_json


def suite(folder, *arguments):
    result = weft("stability", "--quiet", "--out", "out", *arguments, cwd=folder)
    with open(folder / "out/stability.csv", newline="") as file:
        rows = {(row["group"], row["case"], row["solver"]): row for row in csv.DictReader(file)}
    return result, rows


@pytest.fixture(scope="module")
def short(tmp_path_factory):
    folder = tmp_path_factory.mktemp("short")
    result, rows = suite(folder, "--short", "--device", "cpu/1")
    return folder, result, rows


def test_nothing_is_wrong_without_a_word(short):
    folder, result, rows = short
    assert result.returncode == 0, result.stdout
    verdicts = {row["verdict"] for row in rows.values()}
    assert verdicts <= {"stable", "dissipated", "unconverged", "exploded", "stopped"}
    for row in rows.values():
        assert row["verdict"] in ("stable", "dissipated") or row["reported"] == "yes", row
        assert row["verdict"] == "stable" or row["why"] or row["said"], row
    assert (folder / "out/stability.svg").stat().st_size > 10000


def test_what_held_holds(short):
    """Regressions: what is usual has to be stable by every solver, what is lost stays told."""
    rows = short[2]
    solvers = {key[2] for key in rows}
    assert {"xpbd", "vbd", "sosd", "jpgd"} <= solvers
    for solver in solvers:
        for group, case in [("stiffness", "k = 1e+02 N/m, h = 1.04 ms"),
                            ("stiffness", "k = 1e+04 N/m, h = 1.04 ms"),
                            ("Poisson's ratio", "nu = -0.5, h = 4.17 ms"),
                            ("contact", "upper : lower = 1e+00, h = 4.17 ms"),
                            ("touching", "sheets meet at 10 m/s"),
                            ("extreme", "a stiff sheet falls freely for 4 s"),
                            ("extreme", "a sheet of 1000 m")]:
            assert rows[group, case, solver]["verdict"] == "stable", (group, case, solver)
    # These sag by up to seven times what newton's do, and their runs say so.
    hanging = rows["mass ratio", "hanging : carrying = 1e+00, h = 4.17 ms", "xpbd"]
    assert hanging["verdict"] == "unconverged"
    for solver in ("xpbd", "vbd", "sosd", "jpgd"):
        beam = rows["Poisson's ratio", "nu = 0.495, h = 4.17 ms", solver]
        assert beam["verdict"] == ("unconverged" if solver == "xpbd" else "stable"), solver
    # It gets through nobody's sheet. Three solvers let the sheet be torn along on the way, more
    # than they have solved for, and their runs say so.
    case = "a ball of 0.3 m hits a sheet at 1000 m/s"
    hit = {solver: rows["extreme", case, solver] for solver in solvers}
    torn = dict.fromkeys(["vbd", "sosd", "jpgd"], "unconverged")
    assert {solver: row["verdict"] for solver, row in hit.items()} == {
        solver: torn.get(solver, "stable") for solver in solvers}
    assert all(row["why"] == "" for row in hit.values())
    for solver in ("vbd", "sosd"):
        for start in ("at random on a sphere", "inverted"):
            case = f"a block that starts {start}"
            assert rows["extreme", case, solver]["verdict"] == "stable", (case, solver)


def test_other_devices_and_fast_arithmetic_come_to_the_same(short):
    folder, _, rows = short
    chosen = ["--short", "--only", "iterations: k = 1e+06"]
    result, mixed = suite(folder, *chosen, "--device", "cpu/1+opencl:0/1")
    assert result.returncode == 0, result.stdout
    assert len(mixed) > 8
    for key, row in mixed.items():
        for column in ("verdict", "frame", "strain_rms", "strain_max"):
            assert row[column] == rows[key][column], key
    result, fast = suite(folder, *chosen, "--device", "cpu/1", "--math", "fast")
    assert result.returncode == 0, result.stdout
    assert {key: row["verdict"] for key, row in fast.items()} == {
        key: rows[key]["verdict"] for key in fast}


def test_advice_holds(tmp_path):
    (tmp_path / "scene.toml").write_text(SHEET + 'pins = { corners = ["x-z-"] }\n')
    arguments = ["scene.toml", "--frames", "10", "--device", "cpu/1"]
    advice = weft_json("stability", *arguments, "--solvers", "xpbd,vbd", "--time", "600",
                       cwd=tmp_path)
    best = advice["recommended"]
    holding = [trial for trial in advice["trials"] if trial["holds"]]
    assert best in holding
    assert best["ms_per_frame"] == min(trial["ms_per_frame"] for trial in holding)
    assert any(not trial["holds"] for trial in advice["trials"])
    summary = weft_json("run", *arguments, "--solver", best["solver"],
                        "--substeps", str(best["substeps"]),
                        "--iterations", str(best["iterations"]), cwd=tmp_path)
    assert summary["warnings"] == []
    assert summary["strain_rms"] <= advice["strain_wanted"]


def test_what_did_not_run_shows_no_numbers(tmp_path):
    """There is time to begin with a setting, and for no frame of it."""
    (tmp_path / "scene.toml").write_text(SHEET)
    result = weft("stability", "scene.toml", "--device", "cpu/1", "--solvers", "xpbd", "--time",
                  "0.002", cwd=tmp_path)
    assert result.returncode == 1
    trials = [line.split(maxsplit=5) for line in result.stdout.splitlines() if "--time)" in line]
    assert trials == [["xpbd", "1", "1", "-", "-", "no time was left (--time)"]]


def test_wrong_requests():
    expect_error(weft("stability", "--solvers", "vdb"), 2, "vdb", "did you mean 'vbd'")
    expect_error(weft("stability", "--only", "no such case"), 2, "no such case")
    expect_error(weft("stability", "missing.toml"), 2, "missing.toml")
