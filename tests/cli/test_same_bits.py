"""The shipped scenes, small and short, end in the same bits on every device, plan and memory."""

import pytest
from weft_program import CORES, SCENES, opencl_devices, weft_json

SHORT = ["--frames", "3", "--substeps", "4", "--iterations", "4", "--set", "scene.size=700",
         "--no-geometry", "--no-trace", "--quiet", "--force"]

ONE_CORE = {
    "opencl one unit": ["--device", "opencl:0/1"],
    "opencl": ["--device", "opencl:0"],
}
TWO_CORES = {
    "cpu two cores": ["--device", "cpu/2"],
    "mixture": ["--device", "cpu/1+opencl:0/1"],
    "mixture, always": ["--device", "cpu/1+opencl:0/1", "--plan", "exact"],
    "mixture, discrete": ["--device", "cpu/1+opencl:0/1", "--plan", "exact", "--memory", "discrete"],
    "mixture, mapped": ["--device", "cpu/1+opencl:0/1", "--plan", "exact", "--memory", "mapped"],
    "two parts of a device": ["--device", "opencl:0/1+opencl:0/1", "--plan", "exact"],
}


def state_hash(scene, folder, *arguments):
    return weft_json("run", SCENES / f"{scene}.toml", *SHORT, *arguments, cwd=folder)["state_hash"]


@pytest.fixture(scope="module")
def has_opencl():
    return bool(opencl_devices())


@pytest.mark.parametrize("scene", ["tablecloth", "flag", "skirt", "beams", "hammock"])
def test_state_hash(scene, tmp_path, has_opencl):
    variants = dict(ONE_CORE)
    if CORES >= 2:
        variants.update(TWO_CORES)
    expected = state_hash(scene, tmp_path, "--device", "cpu/1")
    for name, arguments in variants.items():
        if has_opencl or "opencl" not in " ".join(arguments):
            assert state_hash(scene, tmp_path, *arguments) == expected, name


@pytest.mark.skipif(CORES < 2, reason="a mixture needs two cores")
def test_every_cut(tmp_path, has_opencl):
    if not has_opencl:
        pytest.skip("a mixture needs OpenCL")
    count = weft_json("inspect", SCENES / "tablecloth.toml", "--set", "scene.size=700")["strips"]
    assert count > 2
    expected = state_hash("tablecloth", tmp_path, "--device", "cpu/1")
    for first in range(0, count + 1):
        strips = f"{first},{count - first}"
        arguments = ["--device", "cpu/1+opencl:0/1", "--strips", strips]
        assert state_hash("tablecloth", tmp_path, *arguments) == expected, strips
