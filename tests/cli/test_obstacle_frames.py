"""Obstacles whose frames are a dataset of an HDF5 file: the same as files of them, and what is refused."""

import shutil

import h5py
import numpy
import pytest
from weft_program import SHEET, expect_error, weft, weft_json

FACES = "f 1 3 2\nf 2 3 4\n"
START = numpy.array([[-1, -0.1, -1], [1, -0.1, -1], [-1, -0.1, 1], [1, -0.1, 1]])
# The sheet falls onto it while it tilts and moves aside. float32 has other numbers than these.
POINTS = numpy.stack([START + [0.01 / 3 * i, 0, 0] + 0.003 * i * START[:, [1, 0, 2]]
                      for i in range(4)])
SCENE = SHEET.replace("frames = 3", "frames = 8").replace("substeps = 2", "substeps = 12") + """
[contact]
thickness = 0.02
[[obstacle]]
name = "body"
shape = "mesh"
mesh = "body.obj"
scale = 1.25
rotate = [0, 1, 0, 10]
translate = [0.05, 0.1, 0.0]
motion = { frames = "FRAMES", frame_time = 0.03 }
"""


def write_obj(path, points):
    path.write_text("".join("v %.17g %.17g %.17g\n" % tuple(p) for p in points) + FACES)


def write(path, **datasets):
    with h5py.File(path, "w") as file:
        for name, values in datasets.items():
            file[name.replace("__", "/")] = values


@pytest.fixture
def folder(tmp_path):
    write_obj(tmp_path / "body.obj", START)
    write(tmp_path / "body.h5", points=POINTS)
    return tmp_path


def run(folder, frames, *arguments):
    (folder / "scene.toml").write_text(SCENE.replace("FRAMES", frames))
    return weft("run", "scene.toml", "--device", "cpu/1", "--quiet", "--force", *arguments,
                cwd=folder)


def hash_of(folder, frames):
    result = run(folder, frames)
    assert result.returncode == 0, result.stderr
    assert "warning" not in result.stderr
    with h5py.File(folder / "out/sheet/trace.h5") as trace:
        return trace.attrs["state_hash"]


@pytest.mark.parametrize("kind", ["<f8", ">f8", "<f4", ">f4", "f2"])
def test_are_those_of_files(folder, kind):
    points = POINTS.astype(kind)
    write(folder / "body.h5", points=points)
    for number, positions in enumerate(points.astype("f8")):
        write_obj(folder / f"body_{number}.obj", positions)
    assert hash_of(folder, "body.h5") == hash_of(folder, "body_*.obj")


def test_are_found_by_shape_or_name(folder):
    same = hash_of(folder, "body.h5")
    shutil.copy(folder / "body.h5", folder / "BODY.HDF5")
    for frames in ["body.h5:points", "body.h5:/points", "BODY.HDF5", "BODY.HDF5:/points"]:
        assert hash_of(folder, frames) == same
    write(folder / "more.h5", body__points=POINTS, joints=numpy.zeros((4, 24, 3)), rate=24.0,
          faces=numpy.zeros((4, 4, 3), int))
    assert hash_of(folder, "more.h5") == same
    with h5py.File(folder / "packed.h5", "w") as file:  # three frames to a chunk, of which one is half full
        file.create_dataset("points", data=POINTS, chunks=(3, 2, 3), compression="gzip")
        file["link"] = h5py.SoftLink("/points")
    assert hash_of(folder, "packed.h5") == hash_of(folder, "packed.h5:/link") == same


def test_are_reached_after_frame_time_and_then_held(folder):
    (folder / "scene.toml").write_text(
        SCENE.replace("FRAMES", "body.h5").replace(", frame_time = 0.03", "")
        .replace("scale = 1.25\nrotate = [0, 1, 0, 10]\ntranslate = [0.05, 0.1, 0.0]\n", ""))
    result = weft("run", "scene.toml", "--device", "cpu/1", "--quiet", cwd=folder)
    assert result.returncode == 0, result.stderr
    with h5py.File(folder / "out/sheet/frames.vtkhdf") as file:
        bodies = file["VTKHDF/Points"][:].reshape(9, -1, 3)[:, -4:]
    expected = POINTS.astype("f4")[[0, 1, 2, 3, 3, 3, 3, 3, 3]]
    assert numpy.abs(bodies - expected).max() < 1e-6


def other(folder):
    return folder / "other.h5"


def cut(folder):
    bytes_of = (folder / "body.h5").read_bytes()
    other(folder).write_bytes(bytes_of[:len(bytes_of) - 100])


def damaged(folder):
    noise = numpy.random.default_rng(1).random((500, 4, 3))
    with h5py.File(other(folder), "w") as file:
        file.create_dataset("p", data=noise, chunks=(100, 4, 3), compression="gzip")
    content = bytearray(other(folder).read_bytes())
    middle = len(content) // 2
    content[middle:middle + 5000] = bytes(5000)
    other(folder).write_bytes(content)


def external(folder):
    with h5py.File(other(folder), "w") as file:
        file["p"] = h5py.ExternalLink("body.h5", "/points")


def virtual(folder):
    layout = h5py.VirtualLayout(POINTS.shape, float)
    layout[:] = h5py.VirtualSource("body.h5", "points", POINTS.shape)
    with h5py.File(other(folder), "w") as file:
        file.create_virtual_dataset("p", layout)


def unwritten(folder):
    with h5py.File(other(folder), "w") as file:
        file.create_dataset("p", (10**12, 4, 3), "f4", chunks=(100, 4, 3))


def unknown_filter(folder):
    with h5py.File(other(folder), "w") as file:
        file.create_dataset("p", data=POINTS, compression="lzf")


def changed(value):
    points = POINTS.copy()
    points[2, 1, 0] = value
    return points


def with_points(points):
    return lambda folder: write(other(folder), p=points)


FITTING = "expected (frames, 4, 3) of floats, as obstacle 'body' has 4 vertices"
MISTAKES = {
    "missing": ("other.h5", lambda folder: None, ["no such file"]),
    "pattern": ("other_*.h5", lambda folder: None, ["one HDF5 file with all frames", "without a *"]),
    "folder": ("other.h5", lambda folder: other(folder).mkdir(), ["that is no file"]),
    "other_format": ("body.npz", lambda folder: None, ["expected a *", "an HDF5 file (.h5)"]),
    "empty": ("other.h5", lambda folder: other(folder).touch(), ["cannot read it as HDF5"]),
    "text": ("other.h5", lambda folder: other(folder).write_text("v 0 0 0\n" * 99),
             ["cannot read it as HDF5", "signature"]),
    "truncated": ("other.h5", cut, ["cannot read it as HDF5", "truncated file"]),
    "damaged": ("other.h5", damaged, ["cannot read it as HDF5", "inflate"]),
    "mistyped": ("body.h5:/point", None, ["no dataset '/point'", "did you mean '/points'?"]),
    "unknown": ("body.h5:/body/xyz", None, ["no dataset '/body/xyz'", "it has /points"]),
    "nothing": ("other.h5", lambda folder: write(other(folder)), ["no dataset", FITTING]),
    "several": ("other.h5", lambda folder: write(other(folder), a=POINTS, g__b=POINTS),
                ["several that fit: '/a', '/g/b'", 'as in "other.h5:/a"']),
    "rank": ("other.h5", with_points(POINTS.reshape(-1, 3)),
             ["has '/p' (16, 3) of floats; " + FITTING]),
    "named_rank": ("other.h5:/p", with_points(POINTS.reshape(-1, 3)),
                   ["'/p' (16, 3) of floats; " + FITTING]),
    "vertices": ("other.h5", with_points(POINTS[:, :3]), ["'/p' (4, 3, 3) of floats; " + FITTING]),
    "order": ("other.h5", with_points(POINTS.transpose(0, 2, 1)), ["'/p' (4, 3, 4)", FITTING]),
    "no_frame": ("other.h5", with_points(POINTS[:0]), ["'/p' (0, 4, 3) of floats has no frame"]),
    "integers": ("other.h5", with_points(POINTS.astype(int)), ["(4, 4, 3) of integers; " + FITTING]),
    "texts": ("other.h5", with_points(POINTS.astype("S")), ["(4, 4, 3) of texts; " + FITTING]),
    "complex": ("other.h5", with_points(POINTS.astype(complex)), ["of no numbers; " + FITTING]),
    "single": ("other.h5", with_points(3.0), ["'/p' () of floats; " + FITTING]),
    "nan": ("other.h5", with_points(changed(numpy.nan)), ["'/p'[2, 1] = (nan, ", "must be finite"]),
    "infinite": ("other.h5", with_points(changed(numpy.inf)), ["'/p'[2, 1] = (inf, "]),
    "far": ("other.h5", with_points(changed(1e30)), ["= (1e+30, ", "within 1000000 m"]),
    "external": ("other.h5:/p", external, ["'/p' takes its values from other", "copy them"]),
    "virtual": ("other.h5", virtual, ["'/p' takes its values from other", "copy them"]),
    "filter": ("other.h5", unknown_filter, ["packed by the filter 'lzf'", "gzip and shuffle are"]),
    "unwritten": ("other.h5", unwritten, ["has no values"]),
}


@pytest.mark.parametrize("name", MISTAKES)
def test_mistakes(folder, name):
    """One line, without the library's own."""
    frames, make, parts = MISTAKES[name]
    if make is not None:
        make(folder)
    result = run(folder, frames)
    expect_error(result, 2, "scene.toml:27:21: ", f'motion.frames = "{frames}": ', *parts)
    assert len(result.stderr.splitlines()) == 1
    assert not (folder / "out").exists()
    expect_error(weft("inspect", "scene.toml", cwd=folder), 2, *parts)


def simulated(folder, text):
    """The geometry of a run of that scene."""
    (folder / "first.toml").write_text(text)
    weft_json("run", "first.toml", "--device", "cpu/1", "--quiet", "--out", "first", cwd=folder)
    return folder / "first/frames.vtkhdf"


def test_are_as_another_run_moved(folder):
    """Steps that are there but not counted do not count."""
    grid = "grid = { size = [1.0, 1.0], resolution = [12, 12] }"
    geometry = simulated(folder, SHEET.replace(grid, 'mesh = "body.obj"') + "pins = { vertices = [0] }\n")
    with h5py.File(geometry) as file:
        points = file["VTKHDF/Points"][:].reshape(4, 4, 3)
    assert len(numpy.unique(points[:, 3, 1])) == 4
    for steps in [4, 2]:
        with h5py.File(geometry, "r+") as file:
            file["VTKHDF/Steps"].attrs.modify("NSteps", numpy.int32(steps))
        write(other(folder), points=points[:steps])
        assert hash_of(folder, "first/frames.vtkhdf") == hash_of(folder, "other.h5")


def test_other_runs_that_do_not_fit(folder):
    geometry = simulated(folder, SHEET)
    expect_error(run(folder, "first/frames.vtkhdf"), 2, "first/frames.vtkhdf",
                 "the bodies in it have 144 vertices in step 0, and obstacle 'body' has 4")

    def expect_broken(change, *parts):
        shutil.copy(geometry, other(folder))
        with h5py.File(other(folder), "r+") as file:
            file["VTKHDF/NumberOfPoints"][0] = 4
            change(file["VTKHDF"])
        expect_error(run(folder, "other.h5"), 2, 'motion.frames = "other.h5": ', *parts)

    def put(name, value):
        def change(root):
            root[name][1] = value
        return change

    expect_broken(lambda root: root.pop("Steps"), "nothing in it moves")
    expect_broken(lambda root: root.pop("Points"), "open dataset '/VTKHDF/Points'")
    expect_broken(lambda root: root["Steps"].attrs.modify("NSteps", numpy.int32(0)), "no step yet")
    expect_broken(lambda root: root["Steps"].attrs.modify("NSteps", numpy.int32(9)), "read rows")
    for bad in [7, -1]:
        expect_broken(put("Steps/PartOffsets", bad), "step 1 is in several parts, or in none")
    expect_broken(put("Steps/NumberOfParts", 2), "step 1 is in several parts, or in none")
    for bad in [1 << 40, -4]:
        expect_broken(put("Steps/PointOffsets", bad), "read rows")
    expect_broken(put("Points", numpy.nan), "'/VTKHDF/Points'[0, 1] = (nan, ")


def test_long_lists_are_cut(folder):
    write(other(folder), **{f"d{i}": numpy.zeros(2) for i in range(100)})
    expect_error(run(folder, "other.h5"), 2, "'/d0' (2) of floats", "and 92 more; " + FITTING)


def test_are_seen_by_inspect(folder):
    run(folder, "body.h5")
    assert weft_json("inspect", "scene.toml", cwd=folder)["vertices"] == 144 + 4
