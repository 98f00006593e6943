"""A garment that was exported with two vertices along its seams, welded."""

import json
import random
import signal

import pytest
from weft_program import CORES, expect_error, opencl_devices, start_weft, wait_for_frames, weft
from weft_program import weft_json

SIDE = 26
SCENE = """
[scene]
name = "shirt"
frames = 6
dt = 0.02
substeps = 4
[solver]
method = "{solver}"
iterations = 4
[[cloth]]
name = "shirt"
mesh = "{mesh}.obj"
density = 0.2
stretch = {{ stiffness = 1.0e3 }}
bend = {{ stiffness = 1.0e-4 }}
pins = {{ vertices = [0, 25] }}
{weld}
[[obstacle]]
shape = "sphere"
center = [0.5, -0.25, 0.5]
radius = 0.2
"""


def shirt(is_cut):
    """An irregular sheet of two parts; cut: the right one has vertices of its own along the seam."""
    chance = random.Random(3)
    step = 1.0 / (SIDE - 1)
    vertices = [tuple(c + 0.3 * step * (chance.random() - 0.5) for c in (i * step, 0.0, k * step))
                for k in range(SIDE) for i in range(SIDE)]
    parts = {"left": [], "right": []}
    for k in range(SIDE - 1):
        for i in range(SIDE - 1):
            a = k * SIDE + i
            part = parts["left" if i < SIDE // 2 + k % 4 else "right"]
            corners = (a, a + SIDE, a + SIDE + 1, a + 1)
            if chance.random() < 0.5:
                part += [corners[:3], (corners[0], *corners[2:])]
            else:
                part += [(corners[0], corners[1], corners[3]), corners[1:]]
    if is_cut:
        left = {v for triangle in parts["left"] for v in triangle}
        right = {v for triangle in parts["right"] for v in triangle}
        own = {v: len(vertices) + n for n, v in enumerate(sorted(left & right))}
        vertices += [vertices[v] for v in own]
        parts["right"] = [tuple(own.get(v, v) for v in triangle) for triangle in parts["right"]]
    lines = ["v {:.9g} {:.9g} {:.9g}".format(*v) for v in vertices]
    for name, triangles in parts.items():
        lines += [f"g {name}"] + ["f {} {} {}".format(*(v + 1 for v in t)) for t in triangles]
    return "\n".join(lines) + "\n"


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "whole.obj").write_text(shirt(False))
    (tmp_path / "cut.obj").write_text(shirt(True))
    for solver in ("xpbd", "vbd", "sosd", "jpgd", "newton"):
        for mesh, weld in (("whole", ""), ("cut", "weld = true")):
            (tmp_path / f"{mesh}_{solver}.toml").write_text(
                SCENE.format(solver=solver, mesh=mesh, weld=weld))
    return tmp_path


def state_hash(folder, scene, *arguments):
    return weft_json("run", f"{scene}.toml", "--quiet", "--force", *arguments,
                     cwd=folder)["state_hash"]


@pytest.mark.parametrize("solver", ["xpbd", "vbd", "sosd", "jpgd", "newton"])
def test_is_the_whole_mesh_on_all_devices(folder, solver):
    expected = state_hash(folder, f"whole_{solver}", "--device", "cpu/1")
    lists = [["--device", "cpu/1"]]
    if opencl_devices():
        lists.append(["--device", "opencl:0/1"])
        if CORES >= 2:
            mixture = ["--device", "cpu/1+opencl:0/1", "--plan", "exact"]
            lists += [mixture, mixture + ["--memory", "discrete"]]
    for arguments in lists:
        assert state_hash(folder, f"cut_{solver}", *arguments) == expected, arguments


def test_is_replayed(folder):
    recorded = state_hash(folder, "cut_xpbd", "--device", "cpu/1", "--out", "recorded")
    replayed = weft_json("replay", "recorded/trace.h5", "--quiet", cwd=folder)
    assert replayed["equal"] and replayed["state_hash"] == recorded


def test_goes_on_where_it_was_stopped(folder):
    scene = folder / "cut_xpbd.toml"
    text = scene.read_text()
    scene.write_text(text.replace("frames = 6", "frames = 20").replace("substeps = 4",
                                                                      "substeps = 60"))
    whole = state_hash(folder, "cut_xpbd", "--device", "cpu/1", "--out", "whole")
    process = start_weft("run", scene, "--device", "cpu/1", "--checkpoint", "0", "--out", "parts",
                         cwd=folder)
    wait_for_frames(folder / "parts/trace.h5", 3, process)
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=60)
    assert not json.loads((folder / "parts/summary.json").read_text())["finished"]
    resumed = weft_json("run", scene, "--device", "cpu/1", "--out", "parts", "--resume", "--quiet",
                        cwd=folder)
    assert resumed["finished"] and resumed["state_hash"] == whole


def test_what_is_apart_is_refused(folder):
    seam = """
[[seam]]
a = { cloth = "shirt", vertices = [1] }
b = { cloth = "shirt", vertices = [40] }
weld = true
"""
    (folder / "apart.toml").write_text((folder / "whole_xpbd.toml").read_text() + seam)
    result = weft("run", "apart.toml", "--quiet", cwd=folder)
    expect_error(result, 2, "apart.toml:", "vertex 1 of cloth 'shirt' is", "m away from vertex 40",
                 "Leave weld out")
