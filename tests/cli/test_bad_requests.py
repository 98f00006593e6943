"""Every mistake in a request: one message that says what and where, exit code 2, no output folder."""

import json
import os
import pathlib

import pytest
from weft_program import SHEET, expect_error, weft

GRID = 'grid = { size = [1.0, 1.0], resolution = [12, 12] }'


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "scene.toml").write_text(SHEET)
    return tmp_path


def run(folder, *arguments, **options):
    return weft("run", "scene.toml", "--device", "cpu/1", *arguments, cwd=folder, **options)


def expect_refused(folder, result, *parts):
    expect_error(result, 2, *parts)
    assert not (folder / "out").exists()


SCENE_MISTAKES = {
    "broken_toml": ("frames = 3", "frames = = 3", ["scene.toml:4:10", "not valid TOML"]),
    "unknown_key": ("frames = 3", "framez = 3", ["scene.toml:4:1", "did you mean 'frames'?"]),
    "wrong_type": ("frames = 3", 'frames = "three"', ["scene.toml:4:10", "expected an integer"]),
    "negative_density": ("density = 0.2", "density = -0.2", ["density = -0.2", "greater than 0"]),
    "negative_time_step": ("dt = 0.02", "dt = -0.02", ["scene.dt = -0.02", "greater than 0"]),
    "negative_stiffness": ("1.0e4", "-1.0e4", ["stiffness = -10000", "greater than 0"]),
    "zero_substeps": ("substeps = 2", "substeps = 0", ["scene.substeps = 0", "at least 1"]),
    "no_cloth": ("[[cloth]]", "[cloth]", ["scene.toml:"]),
}


@pytest.mark.parametrize("name", SCENE_MISTAKES)
def test_scene(folder, name):
    old, new, parts = SCENE_MISTAKES[name]
    assert old in SHEET
    (folder / "scene.toml").write_text(SHEET.replace(old, new))
    expect_refused(folder, run(folder), *parts)
    expect_error(weft("inspect", "scene.toml", cwd=folder), 2, *parts)


def test_missing_scene(folder):
    result = weft("run", "nowhere.toml", cwd=folder)
    expect_refused(folder, result, "nowhere.toml", "no such scene file")


MESHES = {
    "empty": ("", ["mesh.obj"]),
    "two_corners": ("v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nf 1 2\n", ["mesh.obj:5"]),
    "index_out_of_range": ("v 0 0 0\nv 1 0 0\nv 1 0 1\nf 1 2 4\n", ["mesh.obj:4", "4"]),
    "not_a_number": ("v 0 0 0\nv 1 nan 0\nv 1 0 1\nf 1 2 3\n", ["mesh.obj:2", "nan"]),
    "degenerate": ("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", ["mesh.obj", "area"]),
    "twice_the_same_vertex": ("v 0 0 0\nv 1 0 0\nv 2 0 1\nf 1 2 2\n", ["mesh.obj:4"]),
}


def use_mesh(folder, text):
    (folder / "mesh.obj").write_text(text)
    (folder / "scene.toml").write_text(SHEET.replace(GRID, 'mesh = "mesh.obj"'))


@pytest.mark.parametrize("name", MESHES)
def test_mesh(folder, name):
    text, parts = MESHES[name]
    use_mesh(folder, text)
    expect_refused(folder, run(folder), *parts)


def test_missing_mesh(folder):
    use_mesh(folder, "")
    (folder / "mesh.obj").unlink()
    expect_refused(folder, run(folder), "mesh.obj")


def test_unreferenced_vertex_is_only_a_warning(folder):
    use_mesh(folder, "v 0 0 0\nv 5 5 5\nv 1 0 0\nv 1 0 1\nf 1 3 4\n")
    result = run(folder)
    assert result.returncode == 0, result.stderr
    warnings = [line for line in result.stderr.splitlines() if "warning" in line]
    assert len(warnings) == 1 and warnings[0].startswith("weft: warning: ")
    assert "mesh.obj" in warnings[0] and "state hash" in result.stdout


SOLID = """
[scene]
name = "solid"
frames = 2
dt = 0.02
[[solid]]
mesh = "body.{ending}"
density = 1000.0
young = 1.0e5
poisson = 0.4
"""
MSH = """$MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
5
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
5 1 1 1
$EndNodes
$Elements
2
1 4 2 0 1 1 2 3 4
2 4 2 0 1 2 3 4 5
$EndElements
"""


def use_solid(folder, text, ending="msh"):
    (folder / f"body.{ending}").write_text(text)
    (folder / "scene.toml").write_text(SOLID.format(ending=ending))


SOLID_MESHES = {
    "empty": ("", ["body.msh", "is empty"]),
    "no_tetrahedra": (MSH.replace(" 4 2 0 1 ", " 2 2 0 1 "), ["body.msh", "no tetrahedra"]),
    "index_out_of_range": (MSH.replace("2 3 4 5\n", "2 3 4 6\n"), ["body.msh:15", "node 6"]),
    "not_a_number": (MSH.replace("5 1 1 1", "5 1 nan 1"), ["body.msh:10", "nan"]),
    "degenerate": (MSH.replace("5 1 1 1", "5 0 0.5 0.5"), ["body.msh", "no volume"]),
    "truncated": (MSH[:100], ["body.msh", "the file ends here"]),
    "binary": (MSH.replace("2.2 0 8", "2.2 1 8"), ["body.msh:2", "binary", "ASCII"]),
}


@pytest.mark.parametrize("name", SOLID_MESHES)
def test_solid_mesh(folder, name):
    text, parts = SOLID_MESHES[name]
    use_solid(folder, text)
    expect_refused(folder, run(folder), *parts)


def test_missing_solid_mesh_and_wrong_ending(folder):
    use_solid(folder, MSH)
    (folder / "body.msh").unlink()
    expect_refused(folder, run(folder), "scene.toml:", "body.msh", "no such mesh file")
    use_solid(folder, MSH, "stl")
    expect_refused(folder, run(folder), "body.stl", ".msh", ".vtk")


def test_oddities_of_solid_meshes_are_only_warnings(folder):
    text = MSH.replace("1 2 3 4\n", "1 2 4 3\n").replace("$Nodes\n5", "$Nodes\n6")
    text = text.replace("5 1 1 1\n", "5 1 1 1\n6 9 9 9\n")
    text = text.replace("$Elements\n2", "$Elements\n3").replace(
        "$EndElements", "3 4 2 0 1 5 4 3 2\n$EndElements")
    use_solid(folder, text)
    result = run(folder)
    assert result.returncode == 0, result.stderr
    warnings = [line for line in result.stderr.splitlines() if "warning" in line]
    assert len(warnings) == 3
    for warning, part in zip(warnings, ["repeat another", "are inverted", "belong to no"]):
        assert "body.msh" in warning and part in warning


COMMAND_LINES = {
    "unknown_device": (["--device", "cqu"], ["'cqu'", "unknown device", "a device is cpu"]),
    "device_zero_cores": (["--device", "cpu/0"], ["cpu/0", "at least 1"]),
    "too_many_cores": (["--device", "cpu/10000"], ["10000 cores"]),
    "unknown_plan": (["--plan", "exakt"], ["did you mean 'exact'?"]),
    "async_of_newton": (
        ["--plan", "async", "--solver", "newton"],
        ["--plan async", "no asynchronous form"],
    ),
    "async_setting": (["--plan", "async", "--async", "widnow=3"], ["--async widnow", "window"]),
    "async_of_exact": (
        ["--plan", "exact", "--async", "window=3"],
        ["--async window=3", "not for --plan exact"],
    ),
    "unknown_solver": (["--solver", "xpdb"], ["--solver xpdb", "did you mean 'xpbd'?"]),
    "unknown_math": (["--math", "quick"], ["--math", "'quick'"]),
    "unknown_option": (["--framez", "3"], ["--framez", "did you mean"]),
    "frames_no_number": (["--frames", "few"], ["--frames few", "expected an integer"]),
    "zero_substeps": (["--substeps", "0"], ["--substeps 0", "at least 1"]),
    "unknown_key": (["--set", "scene.framez=3"], ["--set scene.framez=3", "did you mean"]),
    "set_without_value": (["--set", "scene.frames"], ["--set scene.frames"]),
    "wrong_strips": (["--strips", "1,1"], ["2 devices", "there are 1 devices"]),
    "flag_with_a_value": (["--quiet=maybe"], ["--quiet: 'maybe': expected no value"]),
    "resume_and_force": (["--resume", "--force"], ["--resume", "--force"]),
}


@pytest.mark.parametrize("name", COMMAND_LINES)
def test_command_line(folder, name):
    arguments, parts = COMMAND_LINES[name]
    device = [] if "--device" in arguments else ["--device", "cpu/1"]
    result = weft("run", "scene.toml", *device, *arguments, cwd=folder)
    expect_refused(folder, result, *parts)


def test_opencl_without_a_platform(folder):
    nothing = dict(os.environ, OCL_ICD_VENDORS="/nonexistent")
    for device in ["opencl", "opencl:0", "cpu/1+opencl:0/1"]:
        result = weft("run", "scene.toml", "--device", device, cwd=folder, env=nothing)
        expect_refused(folder, result, device.split("+")[-1], "no OpenCL platform was found")


def test_hybrid_without_a_platform_is_the_cpu(folder):
    nothing = dict(os.environ, OCL_ICD_VENDORS="/nonexistent")
    result = weft("run", "scene.toml", cwd=folder, env=nothing)
    assert result.returncode == 0 and "tbb" in result.stdout


def test_output_folder_that_cannot_be_made(folder):
    (folder / "file").write_text("")
    expect_error(run(folder, "--out", "file/below"), 2, "--out file/below", "not a folder")
    expect_error(run(folder, "--out", "/proc/weft"), 2, "--out /proc/weft")


@pytest.mark.parametrize("name", ["", "--quiet"])
def test_output_folder_without_a_name(folder, name):
    """As it comes from a variable of a script that is not set."""
    expect_error(run(folder, f"--out={name}" if name else "--out=", "--no-trace"), 2, "--out",
                 "expected the name of a file or folder")
    assert not (folder / "--no-trace").exists()


@pytest.mark.parametrize("arguments", [["--help"], ["run", "--print-schema"]])
def test_help_that_cannot_be_written(folder, arguments):
    result = weft(*arguments, cwd=folder, launcher=["bash", "-c", '"$@" > /dev/full', "bash"])
    assert result.returncode == 1
    assert "standard output cannot be written" in result.stderr


def test_output_folder_whose_name_is_no_utf_8(folder):
    """Only what is written as JSON has to be, and there it is replaced."""
    name = os.fsdecode(b"out\xe9")
    result = run(folder, "--out", name, "--json", "--quiet")
    assert result.returncode == 0, result.stderr
    assert json.loads(result.stdout)["finished"]
    assert json.loads((folder / name / "summary.json").read_text())["finished"]


def test_names_of_any_alphabet_need_no_quotes(folder):
    result = run(folder, "--set", "scene.name=ünï", "--quiet")
    assert result.returncode == 0, result.stderr
    assert (folder / "out/ünï/summary.json").exists()


@pytest.mark.parametrize("place", ["scene.toml", "/proc/weft"])
def test_cache_folder_that_cannot_be_used(folder, place):
    result = run(folder, env={**os.environ, "WEFT_CACHE_DIR": place})
    assert result.returncode == 0, result.stderr
    warnings = [line for line in result.stderr.splitlines() if "warning" in line]
    assert len(warnings) == 1
    assert warnings[0].startswith(f"weft: warning: WEFT_CACHE_DIR={place} cannot be used (")
    summary = json.loads((folder / "out/sheet/summary.json").read_text())
    assert [f"weft: warning: {text}" for text in summary["warnings"]] == warnings


def test_more_states_than_geometry_has_room_for(folder):
    expect_refused(folder, run(folder, "--frames", "1000000"), "scene.toml", "1000001 states",
                   "--no-geometry")


def test_output_folder_whose_name_is_too_long(folder):
    expect_error(run(folder, "--out", 300 * "x"), 2, "--out xxx", "too long")


@pytest.mark.parametrize("option, value", [("--checkpoint", "-1"), ("--checkpoint", "nan"),
                                           ("--checkpoint", "inf")])
def test_numbers_that_are_none(folder, option, value):
    expect_error(run(folder, option, value), 2, option, f"'{value}'",
                 "expected a number, 0 or more")


@pytest.mark.parametrize("command, option", [
    ("run scene.toml", "--strips"),
    ("error scene.toml", "--frame"),
    ("error scene.toml", "--max-iterations"),
    ("error scene.toml --trajectory", "--sweep-substeps"),
    ("error scene.toml --trajectory", "--sweep-iterations"),
    ("error scene.toml --trajectory", "--max-work"),
    ("error scene.toml --trajectory", "--reference-substeps"),
    ("plan trace.h5", "--frame"),
    ("replay trace.h5", "--frames"),
    ("trace gantt trace.h5", "--frame"),
    ("trace gantt trace.h5", "--substep"),
])
@pytest.mark.parametrize("value", ["a", "1.5", "5000000000"])
def test_whole_numbers_that_are_none(folder, command, option, value):
    result = weft(*command.split(), option, value, cwd=folder)
    expect_error(result, 2, option, f"'{value}': expected a whole number",
                 ", at most 2147483647" if value > "2" and value != "a" else "")


def test_lists_of_whole_numbers(folder):
    expect_error(run(folder, "--strips", "3,b"), 2, "--strips: 'b': expected a whole number")


def test_warnings_of_the_start_of_a_quiet_run_that_fails(folder):
    (folder / "scene.toml").write_text(SHEET + """
[[obstacle]]
shape = "sphere"
center = [0.0, 0.0, 0.0]
radius = 5.0
[guard]
max_speed = 1.0
""")
    result = run(folder, "--quiet")
    assert result.returncode == 1
    assert result.stderr.count("start inside") == 1


def test_warnings_of_the_start_of_a_quiet_run(folder):
    (folder / "scene.toml").write_text(SHEET + 'pins = { corners = ["x-z-"] }\n')
    result = run(folder, "--quiet", "--json", "--set", "scene.size=4000", "--frames", 1)
    assert result.returncode == 0
    [warning] = json.loads(result.stdout)["warnings"]
    assert "too fine" in warning
    assert result.stderr == f"weft: warning: {warning}\n"


@pytest.mark.skipif(os.geteuid() == 0, reason="nothing is read-only for root")
def test_read_only_output_folder(folder):
    (folder / "locked").mkdir(mode=0o555)
    expect_error(run(folder, "--out", "locked"), 2, "--out locked", "cannot be written")


@pytest.mark.parametrize("left_out, name", [("--no-trace", "frames.vtkhdf"),
                                            ("--no-geometry", "trace.h5")])
def test_full_disk(folder, left_out, name):
    """A limit on file sizes stands for it: the same path through the program, and no root needed."""
    arguments = ["--frames", "500", "--set", "scene.size=4000", "--iterations", "20", left_out]
    result = run(folder, *arguments, launcher=["bash", "-c", 'ulimit -f 600; exec "$@"', "bash"])
    expect_error(result, 1, f"out/sheet/{name}: cannot write")
    assert not (folder / "out/sheet/summary.json").exists()
    assert (folder / "out/sheet" / name).stat().st_size <= 600 * 1024


@pytest.mark.skipif(not pathlib.Path("/dev/full").exists(), reason="needs /dev/full")
def test_full_disk_behind_stdout(folder):
    with open("/dev/full", "w") as full:
        result = weft("inspect", "scene.toml", cwd=folder, stdout=full)
    assert result.returncode == 1 and "standard output" in result.stderr
