"""`weft trace gantt`: what is in the picture, as SVG that says what it shows, and as PNG."""

import collections
import os
import struct
import xml.etree.ElementTree as xml
import zlib

import h5py
import pytest
from recorded import divided, expect_unreadable_traces_refused, made_up, old, record
from recorded import record_killed, two_devices
from weft_program import expect_error, weft

SVG = "{http://www.w3.org/2000/svg}"


def draw(trace, folder, *arguments):
    out = folder / "picture.svg"
    result = weft("trace", "gantt", trace, "--out", out, *arguments)
    assert result.returncode == 0, result.stderr
    assert result.stdout == f"{out}\n"
    return xml.parse(out).getroot()


def bars(picture):
    """The tasks: [(name, x, y, width)], planned ones first."""
    found = []
    for rectangle in picture.iter(f"{SVG}rect"):
        title = rectangle.find(f"{SVG}title")
        if title is not None:
            x, y, width = (float(rectangle.get(key)) for key in ("x", "y", "width"))
            found.append((title.text.split(":")[0], x, y, width))
    return found


def texts(picture):
    return [element.text for element in picture.iter(f"{SVG}text")]


def arrows(picture):
    return collections.Counter(p.get("fill") for p in picture.iter(f"{SVG}polygon"))


def inside(picture):
    """Everything lies on the picture."""
    width, height = float(picture.get("width")), float(picture.get("height"))
    for element in picture.iter():
        for key, limit in [("x", width), ("x1", width), ("x2", width), ("y", height),
                           ("y1", height), ("y2", height)]:
            if element.get(key) is not None:
                assert 0 <= float(element.get(key)) <= limit
    return True


def scale_of(panels):
    """Pixels per second, from the longer panel's first start and last end: the longest span that
    the picture shows, so that a pixel more or less there is nothing."""
    spans = [(table["end"].max() - table["start"].min(),
              max(x + width for _, x, _, width in panel) - min(x for _, x, _, _ in panel))
             for panel, table in panels]
    seconds, pixels = max(spans)
    return pixels / seconds


@pytest.mark.parametrize("more", [[], ["--memory", "discrete"]], ids=["shared", "discrete"])
def test_mixture(tmp_path, more):
    trace = divided(tmp_path, *more)
    picture = draw(trace, tmp_path, "--frame", 4, "--substep", 1)
    assert inside(picture)
    with h5py.File(trace) as file:
        plan = file["plan"][:]
        plan = plan[plan["frame"] == 4]
        frame = file["frames"][4]
        graph = file["dependencies"][:]
        graph = graph[(graph["graph"] == frame["graph"]) & (graph["carried"] == 0)]
        runs = file["executions"][:]
        runs = runs[(runs["frame"] == 4) & (runs["substep"] == 1)]
        copies = 0
        if more:
            transfers = file["transfers"][:]
            copies = ((transfers["frame"] == 4) & (transfers["substep"] == 1)).sum()
    found = bars(picture)
    assert len(found) == 2 * len(plan)  # as planned, and as it ran
    rows = sorted({y for _, _, y, _ in found})
    assert len(rows) == 4  # two devices in each panel

    planned, measured = found[:len(plan)], found[len(plan):]
    device = {int(row["task"]): int(row["device"]) for row in plan}
    for panel, first in [(planned, 0), (measured, 2)]:
        for name, _, y, _ in panel:
            assert rows.index(y) == first + device[int(name.split()[0])]
    # Lengths are times, on one scale for both panels.
    plan["start"] *= frame["pace"]
    plan["end"] *= frame["pace"]
    scale = scale_of([(planned, plan), (measured, runs)])
    for panel, table in [(planned, plan), (measured, runs)]:
        times = {int(row["task"]): row["end"] - row["start"] for row in table}
        for name, _, _, width in panel:
            assert width == pytest.approx(scale * times[int(name.split()[0])], abs=2.0)

    crossing = collections.Counter(device[d["to"]] for d in graph if device[d["from"]] != device[d["to"]])
    heads = arrows(picture)
    for target, colour in [(0, "#00823c"), (1, "#c81e1e")]:
        assert heads[colour] == 2 * crossing[target] + 1  # the legend's
    assert crossing[0] and crossing[1]
    assert heads["#141414"] == (copies + 1 if copies else 0) and bool(copies) == bool(more)
    said = texts(picture)
    assert "sheet: frame 4, substep 1" in said
    assert f"planned: {1e3 * plan['end'].max():.3f} ms" in said
    assert plan["end"].max() == pytest.approx(frame["planned_makespan"] / 2)
    span = runs["end"].max() - runs["start"].min()
    assert (f"measured: {1e3 * span:.3f} ms from the first start to the last end; "
            f"{1e3 * frame['measured_makespan'] / 2:.3f} ms per substep") in said
    assert {"0 tbb/1", "1 opencl/1", "predict", "seams", "strips", "velocities"} <= set(said)


@pytest.mark.parametrize("solver", ["xpbd", "vbd", "sosd", "jpgd"])
def test_two_iterations_of_an_asynchronous_run(tmp_path, solver):
    """As the paper's figures 10 to 13: what both devices do in two iterations, and the exchanges."""
    trace = record(tmp_path, *two_devices()[:2], "--plan", "async", "--solver", solver,
                   "--iterations", "12")
    whole = draw(trace, tmp_path)
    picture = draw(trace, tmp_path, "--iterations", "4:5")
    assert inside(picture)
    names = [name for name, _, _, _ in bars(picture)]
    assert names and all(name.split()[1].split(".")[1] in "45" for name in names)
    shown = {name for name, _, _, _ in bars(whole) if name.split()[1].split(".")[1] in ("4", "5")}
    assert set(names) == shown
    assert len({y for _, _, y, _ in bars(picture)}) == 4  # two devices in each panel
    assert any("exchange" in name for name in names)
    heads = arrows(picture)
    assert heads["#00823c"] + heads["#c81e1e"] > 2  # more than those of the legend
    whole_heads = arrows(whole)
    assert whole_heads["#00823c"] > 1 and whole_heads["#c81e1e"] > 1  # to either device
    assert min(x for _, x, _, _ in bars(picture)) == pytest.approx(130.0)  # time begins with them
    assert "sheet: frame 7, substep 0, iterations 4 to 5" in texts(picture)


def test_iterations_are_read_as_frames_are(tmp_path):
    trace = made_up(tmp_path)
    one = draw(trace, tmp_path, "--iterations", "1")
    assert [t for t in texts(one) if t.endswith("iteration 1")]
    assert len(bars(draw(trace, tmp_path, "--iterations", "0:"))) == len(bars(draw(trace, tmp_path)))


def test_one_device_has_no_arrows(tmp_path):
    picture = draw(record(tmp_path, "--device", "cpu/1"), tmp_path)
    assert inside(picture) and bars(picture) and not arrows(picture)


def test_default_name_stands_beside_the_trace(tmp_path):
    made_up(tmp_path)
    result = weft("trace", "gantt", "made_up.h5", "--frame", 2, "--substep", 1, cwd=tmp_path)
    assert result.stdout == "made_up-frame2-substep1.svg\n"
    xml.parse(tmp_path / "made_up-frame2-substep1.svg")


@pytest.mark.parametrize("iterations, ending", [("0:1", "0-1"), ("1", "1-1"), (":1", "0-1")])
def test_pictures_of_some_iterations_have_names_of_their_own(tmp_path, iterations, ending):
    made_up(tmp_path)
    result = weft("trace", "gantt", "made_up.h5", "--iterations", iterations, cwd=tmp_path)
    assert result.stdout == f"made_up-frame5-substep0-iterations{ending}.svg\n", result.stderr


def png_pixels(path):
    """Rows of RGB bytes of a picture with 8 bits per channel; checks each chunk's sum."""
    data = path.read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    position, chunks = 8, collections.defaultdict(bytes)
    while position < len(data):
        length, kind = struct.unpack(">I4s", data[position:position + 8])
        body = data[position + 8:position + 8 + length]
        (crc,) = struct.unpack(">I", data[position + 8 + length:position + 12 + length])
        assert crc == zlib.crc32(kind + body)
        chunks[kind] += body
        position += 12 + length
    assert b"IEND" in chunks
    width, height, depth, colour = struct.unpack(">IIBB", chunks[b"IHDR"][:10])
    assert (depth, colour) == (8, 2)
    assert len(zlib.decompress(chunks[b"IDAT"])) == height * (1 + 3 * width)
    return width, height


def test_png(tmp_path):
    path = made_up(tmp_path)
    out = tmp_path / "picture.png"
    result = weft("trace", "gantt", path, "--out", out)
    if "built without cairo" in result.stderr:
        expect_error(result, 2, "write .svg instead")
        pytest.skip("built without cairo")
    assert result.returncode == 0, result.stderr
    width, height = png_pixels(out)
    picture = draw(path, tmp_path)
    assert (width, height) == (2 * float(picture.get("width")), 2 * float(picture.get("height")))
    import matplotlib.image
    pixels = (255 * matplotlib.image.imread(out)[..., :3]).round().astype(int)
    colours = {tuple(pixel) for pixel in pixels[::3, ::3].reshape(-1, 3)}
    kinds = {r.get("fill") for r in picture.iter(f"{SVG}rect") if r.find(f"{SVG}title") is not None}
    assert len(kinds) > 4
    for kind in kinds:  # the same colours as in SVG
        assert tuple(int(kind[i:i + 2], 16) for i in (1, 3, 5)) in colours


def test_killed_run(tmp_path):
    assert bars(draw(record_killed(tmp_path), tmp_path, "--frame", 2, "--substep", 39))


def test_old_trace_has_bars_and_copies(tmp_path):
    picture = draw(old(tmp_path), tmp_path)
    assert bars(picture) and arrows(picture)["#141414"] > 1


def test_names_are_no_markup(tmp_path):
    path = made_up(tmp_path)
    with h5py.File(path, "r+") as file:
        file["run"].attrs["scene_name"] = '<b> & "co"\x01'
    assert '<b> & "co" : frame 5, substep 0' in texts(draw(path, tmp_path))


def test_bad_traces(tmp_path):
    expect_unreadable_traces_refused(tmp_path, "trace", "gantt")


@pytest.mark.parametrize("arguments, part", [
    (["--frame", "99"], "made_up.h5: no frame 99; it has 0 to 5"),
    (["--substep", "4"], "made_up.h5: frame 5 has no substep 4; it has 0 to 3"),
    (["--substep", "-1"], "--substep"),
    (["--frame", "x"], "--frame"),
    (["--iterations", "2-3"], "--iterations 2-3: expected A:B, the first and the last iteration"),
    (["--iterations", "3:99"], "made_up.h5: frame 5 has no iteration 99"),
    (["--out", "picture.jpg"], "--out picture.jpg: expected a name that ends in .svg or .png"),
    (["--out", "none/picture.svg"], "none/picture.svg: cannot write: No such file"),
])
def test_bad_requests(tmp_path, arguments, part):
    result = weft("trace", "gantt", made_up(tmp_path).name, *arguments, cwd=tmp_path)
    expect_error(result, 2, part)
    assert [p.name for p in tmp_path.iterdir()] == ["made_up.h5"]


def test_damaged_records(tmp_path):
    path = made_up(tmp_path)
    with h5py.File(path, "r+") as file:
        executions = file["executions"][:]
        executions["task"] = 4000
        file["executions"][:] = executions
    for command in ["gantt", "perfetto"]:
        result = weft("trace", command, path, "--out", tmp_path / "out.svg")
        expect_error(result, 2, "made_up.h5: frame", "damaged")


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs /dev/full")
def test_full_disk(tmp_path):
    path = made_up(tmp_path)
    limit = ["bash", "-c", 'ulimit -f 2; exec "$@"', "bash"]
    result = weft("trace", "gantt", path, "--out", tmp_path / "p.svg", launcher=limit)
    expect_error(result, 1, "p.svg: cannot write: File too large")
    assert [p.name for p in tmp_path.iterdir()] == ["made_up.h5"]
