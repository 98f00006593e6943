"""Nothing passes through anything, as ipctk and libigl see it: in no substep, and not on the way
from one to the next. WEFT_LONG=1 takes larger scenes, too."""

import json
import os
import pathlib
import subprocess

import pytest

import scenes

try:
    import oracle
except ImportError:
    oracle = None

pytestmark = pytest.mark.skipif(oracle is None, reason="needs ipctk and libigl from PyPI")

WEFT = os.environ["WEFT"]
CASES = [(name, text) for name, text in scenes.SHORT.items()]
CASES += [(f"{solver}_{name}", scenes.SHORT[name].replace('"vbd"', f'"{solver}"'))
          for solver, names in scenes.OTHER_SOLVERS.items() for name in names]
if os.environ.get("WEFT_LONG"):
    CASES += [(f"long_{name}", text) for name, text in scenes.LONG.items()]


def simulate(folder, text, *arguments):
    (folder / "scene.toml").write_text(text)
    (folder / "sphere.obj").write_text(scenes.sphere_mesh())
    result = subprocess.run([WEFT, "run", "scene.toml", "--device", "cpu/1", "--plan", "single",
                             "--no-trace", "--out", "out", "--json", *arguments],
                            cwd=folder, capture_output=True, text=True, timeout=1200)
    assert result.returncode == 0, result.stderr
    out = pathlib.Path(folder) / "out"
    return oracle.read_run(out), json.loads((out / "summary.json").read_text())


@pytest.mark.parametrize("text", [text for _, text in CASES], ids=[name for name, _ in CASES])
def test_nothing_passes(tmp_path, text):
    run, _ = simulate(tmp_path, text)
    crossing = oracle.frames_that_cross(run)
    assert crossing == [], oracle.crossing_pairs(run, run.positions[crossing[0]])
    assert oracle.steps_that_collide(run) == []
    if "sheet9" in text:  # a stack stays one
        assert oracle.are_in_order(run)


@pytest.mark.parametrize("name", scenes.TOO_FAST)
def test_what_is_led_too_fast_is_told(tmp_path, name):
    run, summary = simulate(tmp_path, scenes.TOO_FAST[name])
    first = min(oracle.frames_that_cross(run) + oracle.steps_that_collide(run), default=None)
    told = [int(text.split()[1].rstrip(":")) for text in summary["warnings"]
            if text.startswith("frame ") and "contact" in text]
    assert first is None or (told and min(told) <= first), summary["warnings"]


def test_the_oracle_sees_what_passes(tmp_path):
    """The same without contact."""
    text = scenes.SHORT["fast_sheets"]
    text = text[:text.index("[contact]")] + text[text.index("[[cloth]]"):]
    run, _ = simulate(tmp_path, text)
    assert oracle.steps_that_collide(run)
    crossing = oracle.frames_that_cross(run)
    assert crossing and len(oracle.crossing_pairs(run, run.positions[crossing[0]])) > 0
    assert not oracle.are_in_order(run)
