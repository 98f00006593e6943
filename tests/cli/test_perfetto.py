"""`weft trace perfetto`: held to the Trace Event Format, and to the trace that it was made from."""

import collections
import json
import numbers
import os

import h5py
import pytest
from recorded import divided, expect_unreadable_traces_refused, made_up, old, record
from recorded import record_killed
from weft_program import expect_error, weft

# What each type of event must have, and may have besides. M: metadata, X: a slice, C: a counter,
# s and f: the ends of an arrow.
COMMON = {"ph": str, "name": str, "pid": int, "tid": int}
REQUIRED = {
    "M": {"args": dict},
    "X": {"cat": str, "ts": numbers.Real, "dur": numbers.Real, "args": dict},
    "C": {"ts": numbers.Real, "args": dict},
    "s": {"cat": str, "id": int, "ts": numbers.Real},
    "f": {"cat": str, "id": int, "ts": numbers.Real, "bp": str},
}
METADATA = {"process_name": "name", "thread_name": "name", "thread_sort_index": "sort_index"}


def strict_json(text):
    def refuse(word):
        raise AssertionError(f"{word} is not JSON")
    return json.loads(text, parse_constant=refuse)


def ns(event, length=0):
    """Whole nanoseconds, without the rounding of a difference of doubles."""
    return round(1000 * event["ts"]) + round(1000 * length)


def validate(document):
    """Raises unless Perfetto and Chrome can read all of it; returns the events by type."""
    assert set(document) == {"displayTimeUnit", "otherData", "traceEvents"}
    assert document["displayTimeUnit"] in ("ms", "ns") and isinstance(document["otherData"], dict)
    by_type = collections.defaultdict(list)
    named, last = set(), 0
    for event in document["traceEvents"]:
        fields = {**COMMON, **REQUIRED[event["ph"]]}
        assert set(event) == set(fields), event
        for key, kind in fields.items():
            assert isinstance(event[key], kind) and not isinstance(event[key], bool), event
        by_type[event["ph"]].append(event)
        if event["ph"] == "M":
            assert set(event["args"]) == {METADATA[event["name"]]}
            if event["name"] == "thread_name":
                assert (event["pid"], event["tid"]) not in named
                named.add((event["pid"], event["tid"]))
            continue
        assert event["ts"] >= last, "events are not in order of time"
        last = event["ts"]
        assert (event["pid"], event["tid"]) in named, "a track without a name"
        if event["ph"] == "C":
            assert event["args"] and all(isinstance(v, numbers.Real) for v in event["args"].values())
        if event["ph"] == "f":
            assert event["bp"] == "e"
    tracks = check_nesting(by_type["X"])
    check_arrows(by_type["s"], by_type["f"], tracks)
    return by_type


def check_nesting(slices):
    """On one track, slices lie beside or inside each other. Returns them by track."""
    tracks = collections.defaultdict(list)
    for event in slices:
        assert event["dur"] >= 0
        tracks[event["pid"], event["tid"]].append((ns(event), ns(event, event["dur"])))
    for track in tracks.values():
        open_ends = []
        for start, end in track:
            while open_ends and open_ends[-1] <= start:
                open_ends.pop()
            assert not open_ends or end <= open_ends[-1], "slices of one track overlap"
            open_ends.append(end)
    return tracks


def check_arrows(starts, ends, tracks):
    """Every arrow has two ends, runs forward in time, and both ends lie on slices."""
    ids = [event["id"] for event in starts]
    assert len(set(ids)) == len(ids) and sorted(ids) == sorted(event["id"] for event in ends)
    by_id = {event["id"]: event for event in starts}
    slices = {track: set(spans) for track, spans in tracks.items()}
    begins = {track: {start for start, _ in spans} for track, spans in slices.items()}
    for end in ends:
        start = by_id[end["id"]]
        assert start["ts"] <= end["ts"]
        assert (start["name"], start["cat"]) == (end["name"], end["cat"])
        assert (start["pid"], start["tid"]) != (end["pid"], end["tid"])
        assert ns(end) in begins[end["pid"], end["tid"]], "an arrow arrives nowhere"
        spans = tracks[start["pid"], start["tid"]]
        assert any(a <= ns(start) < b for a, b in spans), "an arrow leaves from nowhere"


def nanoseconds(time):
    return round(1e9 * time)


def export(trace, folder, *arguments):
    result = weft("trace", "perfetto", trace, "--out", folder / "out.json", *arguments)
    assert result.returncode == 0, result.stderr
    assert result.stdout == f"{folder / 'out.json'}\n"
    return validate(strict_json((folder / "out.json").read_text()))


def expect_same_as_trace(events, path, frames=None):
    with h5py.File(path) as trace:
        kinds = trace["run/kinds"].asstr()[:]
        tables = {name: trace[name][:] for name in trace if name != "run"}
        devices = len(trace["run/devices"])
    if frames is not None:
        tables["frames"] = tables["frames"][frames]
        numbers_ = tables["frames"]["frame"]
        for name in ["executions", "plan", "transfers"]:
            if name in tables:
                tables[name] = tables[name][[f in numbers_ for f in tables[name]["frame"]]]
    plan = {(row["frame"], row["task"]): row for row in tables["plan"]}
    tasks = {(e["args"]["frame"], e["args"]["substep"], e["args"]["task"]): e
             for e in events["X"] if e["cat"] == "task"}
    assert len(tasks) == len(tables["executions"])
    for row in tables["executions"]:
        event = tasks[row["frame"], row["substep"], row["task"]]
        planned = plan[row["frame"], row["task"]]
        assert event["tid"] == 1 + row["device"] and event["name"] == kinds[planned["kind"]]
        assert event["args"]["items"] == row["items"]
        assert event["args"]["planned_us"] == pytest.approx(1e6 * (planned["end"] - planned["start"]))
        assert event["ts"] == pytest.approx(1e6 * row["start"], abs=0.01)
        assert event["dur"] == pytest.approx(1e6 * (row["end"] - row["start"]), abs=0.01)
    counters = [e["args"] for e in events["C"]]
    assert [c["planned_ms"] for c in counters] == list(1e3 * tables["frames"]["planned_makespan"])
    assert [c["measured_ms"] for c in counters] == list(1e3 * tables["frames"]["measured_makespan"])
    frames_seen = [e for e in events["X"] if e["cat"] == "frame"]
    assert [e["args"]["frame"] for e in frames_seen] == list(tables["frames"]["frame"])
    parts = collections.defaultdict(list)
    for event in events["X"]:
        if event["cat"] == "part":
            parts[event["args"]["frame"]].append(event)
    for event in frames_seen:
        own = parts[event["args"]["frame"]]
        seen = [e["name"] for e in own]
        assert seen == [part for part in ["placing", "planning", "executing", "checking",
                                          "learning", "measuring", "output"] if part in seen]
        assert sum(e["dur"] for e in own) == pytest.approx(event["dur"], abs=0.1)
    names = {e["tid"]: e["args"]["name"] for e in events["M"] if e["name"] == "thread_name"}
    assert names[0] == "frames" and all(names[1 + d].startswith(f"{d} ") for d in range(devices))
    copies = [e for e in events["X"] if e["cat"] == "transfer"]
    assert len(copies) == len(tables.get("transfers", []))
    assert all(names[e["tid"]] == "copies" for e in copies)
    return tables


def test_one_device(tmp_path):
    trace = record(tmp_path, "--device", "cpu/1")
    events = export(trace, tmp_path)
    expect_same_as_trace(events, trace)
    assert not events["s"]


@pytest.mark.parametrize("more", [[], ["--memory", "discrete"]], ids=["shared", "discrete"])
def test_mixture(tmp_path, more):
    trace = divided(tmp_path, *more)
    events = export(trace, tmp_path)
    tables = expect_same_as_trace(events, trace)
    with h5py.File(trace) as file:
        dependencies = file["dependencies"][:]
    between, fitting = 0, 0
    for frame in tables["frames"]:
        own = tables["executions"][tables["executions"]["frame"] == frame["frame"]]
        done = {(row["substep"], row["task"]): row for row in own}
        for d in dependencies[dependencies["graph"] == frame["graph"]]:
            for substep in range(d["carried"], 2):  # of 2 substeps, one has one before it
                first, then = done[substep - d["carried"], d["from"]], done[substep, d["to"]]
                if first["device"] != then["device"]:
                    between += 1
                    fitting += nanoseconds(then["start"]) >= nanoseconds(first["start"])
    arrows = collections.Counter(e["name"] for e in events["s"])
    # Clocks of two devices agree to some microseconds: where the end of an arrow would lie before
    # its start, there is none.
    assert arrows["dependency"] == fitting and fitting > 0.5 * between
    assert (arrows["transfer"] > 0) == bool(more)


def test_transfers_that_overlap_have_tracks_of_their_own(tmp_path):
    path = made_up(tmp_path)
    with h5py.File(path, "r+") as file:
        transfers = file["transfers"][:]
        transfers["start"] -= 20e-6  # longer than the pauses between them
        transfers["end"] += 20e-6
        file["transfers"][:] = transfers
    events = export(path, tmp_path)
    expect_same_as_trace(events, path)


def test_frames(tmp_path):
    path = made_up(tmp_path, frames=8)
    for text, wanted in {"2:4": slice(2, 5), "3": slice(3, 4), "6:": slice(6, 8),
                         ":1": slice(0, 2)}.items():
        expect_same_as_trace(export(path, tmp_path, "--frames", text), path, wanted)


def test_default_name(tmp_path):
    path = made_up(tmp_path)
    result = weft("trace", "perfetto", path.name, cwd=tmp_path)
    assert result.stdout == "made_up.perfetto.json\n"
    validate(strict_json((tmp_path / "made_up.perfetto.json").read_text()))


def test_killed_run(tmp_path):
    events = export(record_killed(tmp_path), tmp_path, "--frames", "0:3")
    assert len([e for e in events["X"] if e["cat"] == "frame"]) == 4


def test_old_trace_has_no_arrows_but_for_transfers(tmp_path):
    events = export(old(tmp_path), tmp_path)
    assert {e["name"] for e in events["s"]} == {"transfer"}


def test_bad_traces(tmp_path):
    expect_unreadable_traces_refused(tmp_path, "trace", "perfetto")


@pytest.mark.parametrize("frames, part", [
    ("9", "no frame 9; it has 0 to 5"), ("2:9", "no frame 9"), ("4:2", "--frames 4:2"),
    ("a", "--frames a"), ("1:2:3", "--frames 1:2:3"), (":", "--frames :"), ("1-2", "--frames 1-2"),
])
def test_bad_frames(tmp_path, frames, part):
    result = weft("trace", "perfetto", made_up(tmp_path), "--frames", frames)
    expect_error(result, 2, part)
    assert [p.name for p in tmp_path.iterdir()] == ["made_up.h5"]


def test_bad_places(tmp_path):
    path = made_up(tmp_path)
    for place in ["none/out.json", "."]:
        result = weft("trace", "perfetto", path.name, "--out", place, cwd=tmp_path)
        expect_error(result, 2, f"{place}: cannot write")


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs /dev/full")
def test_full_disk(tmp_path):
    path = made_up(tmp_path)
    result = weft("trace", "perfetto", path, "--out", "/dev/full")
    expect_error(result, 1, "/dev/full: cannot write: No space left")
    limit = ["bash", "-c", 'ulimit -f 8; exec "$@"', "bash"]
    result = weft("trace", "perfetto", path, "--out", tmp_path / "o.json", launcher=limit)
    expect_error(result, 1, "o.json: cannot write: File too large")
    assert [p.name for p in tmp_path.iterdir()] == ["made_up.h5"]  # nothing that looks whole
