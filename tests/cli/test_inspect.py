"""`weft inspect` against what a run really does: what a scene does not name is not there."""

import collections

import h5py
import pytest
from weft_program import SCENES, SHEET, weft, weft_json

EVERYTHING = SHEET + """
bend = { stiffness = 1.0e-4 }
damping = 0.1
pins = { corners = ["x-z-"], motion = { velocity = [0.1, 0.0, 0.0] } }
[[obstacle]]
shape = "sphere"
center = [0.0, -0.3, 0.0]
radius = 0.2
friction = 0.3
[[obstacle]]
shape = "plane"
point = [0.0, -1.0, 0.0]
"""

SOLID = """
[scene]
name = "solid"
frames = 2
dt = 0.02
[[solid]]
grid = { size = [1.0, 0.2, 0.2], resolution = [11, 3, 3] }
density = 1000.0
young = 1.0e5
poisson = 0.4
"""

ATTACHED = SOLID + """
[[cloth]]
name = "film"
grid = { size = [0.5, 0.5], resolution = [6, 6] }
density = 0.2
membrane = { young = 1.0e6, poisson = 0.3, thickness = 1.0e-3 }
[[attachment]]
a = "film"
b = "solid0"
corners = ["x-z-"]
stiffness = 100.0
"""

BARE_KERNELS = ["predict", "project_springs", "update_velocities"]
BARE_BUFFERS = {"positions", "previous", "velocities", "gravity", "strips", "springs.vertices",
                "springs.material", "springs.multipliers", "springs.segments"}


def names(entries, key="name"):
    return [entry[key] for entry in entries]


@pytest.fixture
def inspect(tmp_path):
    def inspect_text(text, *arguments):
        (tmp_path / "scene.toml").write_text(text)
        return weft_json("inspect", "scene.toml", *arguments, cwd=tmp_path)
    return inspect_text


def test_bare_scene_has_nothing_that_it_does_not_name(inspect):
    found = inspect(SHEET)
    assert names(found["kernels"]) == BARE_KERNELS
    assert set(names(found["buffers"])) == BARE_BUFFERS
    assert {launch["kernel"] for task in found["tasks"] for launch in task["launches"]} == set(
        BARE_KERNELS)
    energies = next(d for d in found["datasets"] if d["name"] == "energies")
    assert energies["columns"] == ["frame", "kinetic", "gravity", "stretch", "total"]

    left_out = {entry["what"]: entry for entry in found["left_out"]}
    assert {"bending", "obstacles", "friction", "pins", "moving pins", "damping"} <= set(left_out)
    assert left_out["bending"]["kernels"] == [
        "couple_curved_hinges", "couple_hinges", "gather_bending", "gather_bending_gradients",
        "hinge_terms", "project_hinges"]
    assert left_out["solids"]["kernels"] == [
        "block_tetrahedra", "gather_tetrahedra", "gather_tetrahedra_gradients", "project_tetrahedra",
        "solve_tetrahedron_stencils", "tetrahedron_terms"]
    assert left_out["membranes"]["kernels"] == [
        "gather_membrane_gradients", "gather_membranes", "membrane_terms", "project_membranes",
        "solve_membrane_stencils"]
    assert "attachments" in left_out
    assert left_out["moving pins"]["kernels"] == ["move_pins"]
    assert "push_out_of_sphere" in left_out["obstacles"]["kernels"]


def test_everything_named_is_there(inspect):
    found = inspect(EVERYTHING)
    kernels = names(found["kernels"])
    assert {"project_hinges", "move_pins", "update_damped_velocities", "push_out_of_sphere",
            "push_out_of_plane"} <= set(kernels)
    assert not {"push_out_of_box", "update_velocities"} & set(kernels)
    assert {"obstacles", "pins.motions", "hinges.weights"} <= set(names(found["buffers"]))
    assert not {"bending", "obstacles", "pins", "damping"} & set(names(found["left_out"], "what"))


def test_solids_alone_need_nothing_of_cloth(inspect):
    found = inspect(SOLID)
    assert names(found["kernels"]) == ["predict", "project_tetrahedra", "update_velocities"]
    buffers = names(found["buffers"])
    assert {"tetrahedra.shape", "tetrahedra.multipliers.volume"} <= set(buffers)
    assert not [name for name in buffers if name.startswith(("springs", "membranes", "hinges"))]
    left_out = {entry["what"]: entry for entry in found["left_out"]}
    assert left_out["springs"]["kernels"] == [
        "couple_springs", "couple_stitches", "gather_spring_gradients", "gather_springs",
        "project_springs", "solve_spring_stencils", "spring_terms"]
    energies = next(d for d in found["datasets"] if d["name"] == "energies")
    assert energies["columns"] == ["frame", "kinetic", "gravity", "solid", "total"]
    assert found["triangles"] == 2 * 2 * (10 * 2 + 10 * 2 + 2 * 2)


def test_stencils_are_of_the_elements_that_are_there(inspect):
    def stencils(text):
        found = inspect(text, "--solver", "sosd")
        return [name for name in names(found["kernels"]) if name.endswith("_stencils")]

    assert stencils(SHEET) == ["solve_spring_stencils"]
    assert stencils(SOLID) == ["solve_tetrahedron_stencils"]
    assert set(stencils(ATTACHED)) >= {"solve_membrane_stencils", "solve_tetrahedron_stencils"}


def test_attachments_are_springs(inspect):
    found = inspect(ATTACHED)
    launches = {launch["kernel"]: launch["items"] for task in found["tasks"]
                for launch in task["launches"] if task["kind"] == "strips"}
    seams = {launch["kernel"]: launch["items"] for task in found["tasks"]
             for launch in task["launches"] if task["kind"] == "seams"}
    assert launches["project_springs"] + seams.get("project_springs", 0) == 1
    assert not {"solids", "membranes", "attachments"} & set(names(found["left_out"], "what"))


def test_every_kernel_is_used_or_left_out(inspect):
    known = []
    for text in [SHEET, EVERYTHING, SOLID, ATTACHED]:
        found = inspect(text)
        kernels = names(found["kernels"])
        kernels += [kernel for entry in found["left_out"] for kernel in entry["kernels"]]
        assert len(kernels) == len(set(kernels))
        known.append(set(kernels))
    assert all(kernels == known[0] for kernels in known)


@pytest.mark.parametrize("text", [SHEET, EVERYTHING], ids=["bare", "everything"])
def test_trace_holds_what_was_said(text, inspect, tmp_path):
    found = inspect(text)
    result = weft("run", "scene.toml", "--device", "cpu/1", "--frames", "1", cwd=tmp_path)
    assert result.returncode == 0, result.stderr
    with h5py.File(tmp_path / "out/sheet/trace.h5") as trace:
        datasets = {}

        def note(name, entry):
            if isinstance(entry, h5py.Dataset):
                is_table = entry.dtype.names and not name.startswith("run/")
                datasets[name] = list(entry.dtype.names) if is_table else []
        trace.visititems(note)
        kinds = trace["run/kinds"].asstr()[:]
        planned = collections.Counter(kinds[row["kind"]] for row in trace["plan"])
    assert datasets == {entry["name"]: entry["columns"] for entry in found["datasets"]}
    assert planned == {task["kind"]: task["per_substep"] for task in found["tasks"]}


def test_sizes_follow_the_scene(inspect):
    small, large = inspect(SHEET), inspect(SHEET, "--set", "scene.size=40000")
    assert small["vertices"] == 144 and small["triangles"] == 242
    assert abs(large["vertices"] - 40000) < 400

    def bytes_of(found, name):
        return next(b["bytes"] for b in found["buffers"] if b["name"] == name)
    for found in [small, large]:
        assert bytes_of(found, "positions") == 16 * found["vertices"]


def test_text_names_all_parts():
    result = weft("inspect", SCENES / "skirt.toml")
    assert result.returncode == 0 and result.stderr == ""
    for part in ["tasks", "kernels", "buffers", "datasets", "left out", "push_out_of_capsule"]:
        assert part in result.stdout


def test_contact_is_left_out_where_there_is_none(inspect):
    left_out = {entry["what"]: entry for entry in inspect(SHEET)["left_out"]}
    assert left_out["contact"]["kernels"]
    touching = inspect(SHEET.replace('"xpbd"', '"vbd"') + "\n[contact]\n")
    assert "contact" not in {entry["what"] for entry in touching["left_out"]}
    for found, expected in [(inspect(SHEET), False), (touching, True)]:
        assert any("contact" in kernel["file"] for kernel in found["kernels"]) == expected
