"""`weft plan TRACE.h5`: a recorded frame planned again, as it was and on other machines."""

import csv
import json
import xml.etree.ElementTree as xml

import h5py
import pytest
from recorded import divided, expect_unreadable_traces_refused, made_up, old, record
from recorded import record_killed, two_devices
from weft_program import expect_error, weft, weft_json


@pytest.fixture(scope="module")
def single(tmp_path_factory):
    return record(tmp_path_factory.mktemp("single"), "--device", "cpu/1")


@pytest.fixture(scope="module")
def halved(tmp_path_factory):
    return divided(tmp_path_factory.mktemp("halved"))


@pytest.fixture(scope="module")
def mixed(tmp_path_factory):
    return record(tmp_path_factory.mktemp("mixed"), *two_devices())


def expect_reproduced(path):
    """Each frame's planner, with the recorded costs, plans it as the run did."""
    with h5py.File(path) as trace:
        frames, plan = trace["frames"][:], trace["plan"][:]
        names = trace["run/devices"].len()
    for frame in frames:
        again = weft_json("plan", path, "--frame", frame["frame"], "--pinned", "--algorithm",
                          frame["planner"].decode())
        assert again["recorded"]["planner"] == frame["planner"].decode()
        own = plan[plan["frame"] == frame["frame"]]
        assert again["makespan"] == own["end"].max() == again["recorded"]["makespan"]
        recorded = {row["task"]: row for row in own}
        for number, task in enumerate(again["tasks"]):
            assert int(task["name"].split()[0]) == number
            assert int(task["processor"].split()[0]) == recorded[number]["device"] < names
            assert (task["start"], task["end"]) == (recorded[number]["start"],
                                                    recorded[number]["end"])
        assert again["lower_bound"] <= again["makespan"]


def test_plans_of_one_device(single):
    expect_reproduced(single)


def test_plans_of_a_mixture(mixed):
    expect_reproduced(mixed)


def test_plans_of_a_given_division(halved):
    expect_reproduced(halved)
    with h5py.File(halved) as trace:
        assert set(trace["plan"]["device"]) == {0, 1}
        assert len(set(trace["frames"]["graph"])) == 1


def test_last_frame_is_the_default(single):
    assert weft_json("plan", single)["frame"] == 7
    assert weft_json("plan", single, "--frame", 3)["frame"] == 3


def test_printed_costs_are_the_recorded_ones(mixed, tmp_path):
    costs = weft("plan", mixed, "--frame", 4, "--print-costs").stdout
    (tmp_path / "costs.json").write_text(costs)
    for more in [["--pinned"], []]:
        common = ["--frame", 4, "--algorithm", "heft", *more]
        own = weft_json("plan", mixed, *common)
        same = weft_json("plan", mixed, *common, "--costs", tmp_path / "costs.json")
        assert {**own, "plan_us": 0} == {**same, "plan_us": 0}


def test_another_machine(mixed, tmp_path):
    """Twice as fast in everything: half the makespan. With a third device: never longer."""
    costs = json.loads(weft("plan", mixed, "--frame", 4, "--print-costs").stdout)
    own = weft_json("plan", mixed, "--frame", 4, "--algorithm", "heft")

    def planned(costs):
        (tmp_path / "costs.json").write_text(json.dumps(costs))
        return weft_json("plan", mixed, "--frame", 4, "--algorithm", "heft", "--costs",
                         tmp_path / "costs.json")

    halved = json.loads(json.dumps(costs))
    for kind in halved["costs"].values():
        for cost in kind:
            cost["fixed"] /= 2
            cost["per_item"] /= 2
    halved["latency"] = [[value / 2 for value in row] for row in costs["latency"]]
    assert planned(halved)["makespan"] == pytest.approx(own["makespan"] / 2, rel=1e-12)

    alone = {"devices": ["slow", "fast"], "costs": {}, "latency": 1e-6, "bandwidth": 1e9}
    for name, kind in costs["costs"].items():
        alone["costs"][name] = [None, kind[0]]
    result = planned(alone)
    assert {task["processor"] for task in result["tasks"]} == {"fast"}
    assert result["makespan"] == pytest.approx(
        sum(task["end"] - task["start"] for task in result["tasks"]))


def test_strips_divided_as_they_were(halved):
    """Made anew from the scene, the graph of a division is the recorded one."""
    own = weft_json("plan", halved, "--frame", 4, "--algorithm", "heft", "--pinned")
    strips = ",".join(map(str, own["strips"]))
    again = weft_json("plan", halved, "--frame", 4, "--algorithm", "heft", "--pinned", "--strips",
                      strips)
    assert len(own["strips"]) == 2 and {**own, "plan_us": 0} == {**again, "plan_us": 0}


def test_best_division(single, tmp_path):
    """A recorded run of one device, on machines of two."""
    count = sum(weft_json("plan", single)["strips"])
    kinds = json.loads(weft("plan", single, "--print-costs").stdout)["costs"]

    def planned(factor, latency, strips="auto"):
        cost = {"fixed": 1e-7, "per_item": 1e-8}
        second = factor and {key: factor * value for key, value in cost.items()}
        two = {"devices": ["a", "b"], "latency": latency,
               "costs": {kind: [cost, second] for kind in kinds}}
        (tmp_path / "two.json").write_text(json.dumps(two))
        return weft_json("plan", single, "--costs", tmp_path / "two.json", "--strips", strips,
                         "--algorithm", "in-order", "--pinned")

    alike = planned(1.0, 0.0)
    assert sum(alike["strips"]) == count and abs(alike["strips"][0] - alike["strips"][1]) <= 2
    assert alike["makespan"] < 0.75 * planned(1.0, 0.0, f"{count},0")["makespan"]
    slower = planned(4.0, 0.0)
    assert slower["strips"][0] > slower["strips"][1] > 0
    assert planned(1.0, 1.0)["strips"] in ([count, 0], [0, count])  # a second for each wait
    assert planned(None, 0.0)["strips"] == [count, 0]  # b cannot run anything
    best = min(planned(2.0, 1e-6, f"{n},{count - n}")["makespan"] for n in range(count + 1))
    assert planned(2.0, 1e-6)["makespan"] <= 1.02 * best


def test_compare_and_text(mixed):
    compared = weft_json("plan", mixed, "--compare", "--time-limit", 0.5)
    assert [row["algorithm"] for row in compared["rows"]][:2] == ["heft", "peft"]
    assert all(row["makespan"] >= compared["lower_bound"] * (1 - 1e-9) for row in compared["rows"])
    assert compared["recorded"]["measured"] > 0
    text = weft("plan", mixed, "--frame", 2, "--algorithm", "heft").stdout
    assert "frame 2: one of its 2 substeps" in text and "recorded     planned" in text
    assert "start [us]" in text and "makespan" in text


def test_killed_run(tmp_path):
    trace = record_killed(tmp_path)
    assert weft_json("plan", trace, "--frame", 2)["makespan"] > 0


def test_bad_traces(tmp_path):
    expect_unreadable_traces_refused(tmp_path, "plan")


def test_bad_requests(single, tmp_path):
    expect_error(weft("plan", single, "--frame", 8), 2, "trace.h5: no frame 8; it has 0 to 7")
    expect_error(weft("plan", single, "--frame", -1), 2, "--frame")
    expect_error(weft("plan", old(tmp_path)), 2, "made_up.h5: frame 5", "older weft")
    for strips in ["", "x", "1,", "-1,1", "1.5"]:
        expect_error(weft("plan", single, "--strips", strips), 2, "--strips")
    expect_error(weft("plan", single, "--strips", "3"), 2, "--strips 3: expected a number for each "
                 "of 1 devices")
    (tmp_path / "graph.json").write_text(
        '{"processors": ["p"], "tasks": [{"name": "a", "cost": [1]}]}')
    for option in [["--frame", 1], ["--costs", "x.json"], ["--pinned"],
                   ["--strips", "auto"], ["--print-costs"]]:
        expect_error(weft("plan", "graph.json", *option, cwd=tmp_path), 2, option[0],
                     "is for traces")


COST = {"fixed": 1e-6, "per_item": 1e-9}
BAD_COSTS = {
    "no_object": ([1], ["expected one object"]),
    "no_devices": ({"costs": {}}, ["devices: is missing"]),
    "empty_devices": ({"devices": [], "costs": {}}, ["devices: at least one"]),
    "twice": ({"devices": ["a", "a"], "costs": {}}, ["devices[1]: duplicate device 'a'"]),
    "slip": ({"devices": ["a"], "cost": {}}, ["cost: unknown key; did you mean 'costs'?"]),
    "missing_kind": ({"predict": [COST]}, ["costs.spring: is missing"]),
    "unknown_kind": ({"sprin": [COST]}, ["costs.sprin", "did you mean 'spring'?"]),
    "wrong_count": ({"predict": [COST, COST]}, ["costs.predict: 2 costs for 1 devices"]),
    "no_cost": ({"predict": [3]}, ["costs.predict[0]: expected", "fixed"]),
    "no_fixed": ({"predict": [{"per_item": 1}]}, ["costs.predict[0].fixed: is missing"]),
    "negative": ({"predict": [{"fixed": -1, "per_item": 1}]},
                 ["costs.predict[0].fixed: expected seconds >= 0, not -1"]),
    "text": ({"predict": [{"fixed": 1, "per_item": "1"}]}, ["costs.predict[0].per_item", '"1"']),
}


@pytest.mark.parametrize("name", BAD_COSTS)
def test_bad_costs(name, tmp_path):
    content, parts = BAD_COSTS[name]
    whole = isinstance(content, list) or "costs" in content or "devices" in content
    (tmp_path / "costs.json").write_text(
        json.dumps(content if whole else {"devices": ["a"], "costs": content}))
    result = weft("plan", made_up(tmp_path), "--costs", "costs.json", cwd=tmp_path)
    expect_error(result, 2, "costs.json: ", *parts)


def test_more_bad_costs(tmp_path):
    trace = made_up(tmp_path)
    costs = json.loads(weft("plan", trace, "--print-costs").stdout)

    def refused(change, *parts, options=()):
        (tmp_path / "costs.json").write_text(json.dumps({**costs, **change}))
        expect_error(weft("plan", trace, "--costs", "costs.json", *options, cwd=tmp_path), 2, *parts)

    refused({"latency": [1]}, "latency: expected a number or 2 rows")
    refused({"bandwidth": 0}, "bandwidth: expected a number > 0, not 0")
    nobody = {name: [None, None] for name in costs["costs"]}
    refused({"costs": nobody}, "no device can run task '0 predict.0 ")
    second = {name: [None, COST] for name in costs["costs"]}
    refused({"costs": second}, "no device can run task", "pinned to device 0",
            options=["--pinned"])
    (tmp_path / "costs.json").write_text("{")
    expect_error(weft("plan", trace, "--costs", "costs.json", cwd=tmp_path), 2,
                 "costs.json:1:2: not JSON")
    expect_error(weft("plan", trace, "--costs", "none.json", cwd=tmp_path), 2, "none.json: No such")


@pytest.fixture(scope="module")
def known(tmp_path_factory):
    """A run's trace with costs that are the same every day: 20 ns per item, and 0.2 us."""
    trace = record(tmp_path_factory.mktemp("known"), "--device", "cpu/1")
    with h5py.File(trace, "r+") as file:
        costs = file["costs"][:]
        costs["per_item"], costs["fixed"] = 2e-8, 2e-7
        file["costs"][:] = costs
    return trace


def machines(trace, folder, *more):
    study = weft_json("plan", trace, "--frame", 4, "--machines", "--out", folder, "--device-counts",
                      "2,3", "--waits", "1e-6,1e-4,1e-3", "--ratios", "1,8", *more)
    return study, {(r["faster_at"], r["devices"], r["ratio"], r["wait_s"]): r for r in study["rows"]}


def test_machines_that_are_not_there(known, tmp_path):
    study, rows = machines(known, tmp_path / "map")
    assert len(rows) == 2 * 2 * 2 * 3
    for (faster, devices, ratio, wait), row in rows.items():
        times = [row[f"{plan}_s"] for plan in ("single", "exact", "placed", "async")]
        best = min(time for time in times if time is not None)
        assert row[row["winner"] + "_s"] <= 1.01 * best
        assert row["async_more_iterations"] > 0.5 and row["async_window"] in (2, 3, 5)
        # One device does not wait for anybody, and is the faster one.
        assert row["single_s"] == rows[faster, 2, ratio, 1e-6]["single_s"]
        assert row["single_s"] <= rows[faster, devices, 1.0, wait]["single_s"] * (1 + 1e-9)
        # Longer waits never help.
        if wait > 1e-6:
            assert row["exact_s"] >= rows[faster, devices, ratio, 1e-6]["exact_s"] * (1 - 1e-9)
    # Two alike that need not wait share the work; waits of a millisecond leave it to one.
    alike = rows["everything", 2, 1.0, 1e-6]
    assert alike["exact_s"] < 0.8 * alike["single_s"]
    assert rows["everything", 2, 1.0, 1e-3]["exact_s"] > rows["everything", 2, 1.0, 1e-3]["single_s"]
    assert study["fast_kind"] in ("seams", "strips")


TOUCHING = """[scene]
name = "sheet"
frames = 6
dt = 0.02
substeps = 4
[contact]
thickness = 0.02
""" + "".join(f"""
[[cloth]]
name = "{name}"
grid = {{ size = [0.5, 0.5], resolution = [12, 12] }}
translate = [{height}, {height}, 0.0]
density = 0.2
stretch = {{ stiffness = 300.0 }}
pins = {{ edges = ["{edge}"] }}
""" for name, height, edge in [("low", 0.0, "x-"), ("high", 0.016, "z-")])


def test_machines_know_contact(tmp_path):
    """What an asynchronous plan loses where sheets press each other is measured, too."""
    trace = record(tmp_path, "--device", "cpu/1", "--solver", "vbd", scene=TOUCHING)
    _, rows = machines(trace, tmp_path / "map")
    assert {row["async_more_iterations"] for row in rows.values()} != {1.0}
    for row in rows.values():
        assert row["single_s"] > 0.0 and row["async_more_iterations"] > 0.5


def test_the_map_as_table_and_picture(single, tmp_path):
    result = weft("plan", single, "--frame", 4, "--machines", "--out", tmp_path, "--device-counts",
                  "2", "--waits", "1e-5,1e-4", "--ratios", "1,4,16")
    assert result.returncode == 0, result.stderr
    assert "wait [us]" in result.stdout and "machines.csv, machines.svg" in result.stdout
    with open(tmp_path / "machines.csv") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 2 * 3 * 2
    picture = xml.parse(tmp_path / "machines.svg").getroot()
    notes = [title.text for title in picture.iter("{http://www.w3.org/2000/svg}title")]
    assert len(notes) == len(rows)
    labels = [text.text for text in picture.iter("{http://www.w3.org/2000/svg}text")]
    assert {"10", "100"} <= set(labels) and "1e+02" not in labels
    letters = [line.split()[2:] for line in result.stdout.splitlines() if " x " in line]
    assert sum(map(len, letters)) == len(rows)
    assert [row["winner"][0].upper() for row in rows] == [c for line in letters for c in line]


@pytest.mark.parametrize("arguments, part", [
    (["--machines", "--waits", "-1"], "--waits"),
    (["--machines", "--device-counts", "1"], "--device-counts"),
    (["--machines", "--ratios", "0.5"], "--ratios"),
    (["--machines", "--pinned"], "--pinned"),
    (["--waits", "1e-6"], "--machines"),
])
def test_machines_that_cannot_be(single, arguments, part):
    expect_error(weft("plan", single, *arguments), 2, part)


def test_machines_need_a_trace(tmp_path):
    (tmp_path / "graph.json").write_text('{"processors": ["a"], "tasks": [{"name": "t", "cost": [1]}]}')
    expect_error(weft("plan", "graph.json", "--machines", cwd=tmp_path), 2, "--machines", "traces")
