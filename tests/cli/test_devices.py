"""`weft devices`, and that OpenCL is not touched unless a device asks for it."""

import os
import pathlib

import pytest
from weft_program import SHEET, weft, weft_json

WIRE = pathlib.Path(os.environ["WEFT_BIN"]) / "opencl_tripwire.so"


def test_every_device_is_measured():
    found = weft_json("devices")
    assert found["devices"][0]["device"] == "cpu"
    for device in found["devices"]:
        assert {"name", "kind", "driver", "units", "memory", "strict", "lanes"} <= set(device)
        # Not which is less: on a busy machine, either may be.
        assert 0 < device["launch_us"] < 1e5
        assert 0 < device["batch_us"] < 1e5
        assert (device["to_device"] is None) == (device["memory"] == "host")


def test_discrete_memory_has_transfer_costs():
    devices = weft_json("devices", "--memory", "discrete")["devices"]
    for device in devices[1:]:
        for way in ["to_device", "to_host"]:
            assert device[way]["latency_us"] > 0 and device[way]["gb_per_s"] > 0.01


def test_without_a_platform_the_cpu_is_left():
    result = weft("devices", env=dict(os.environ, OCL_ICD_VENDORS="/nonexistent"))
    assert result.returncode == 0
    assert "TBB" in result.stdout and "hybrid, the default, is cpu here" in result.stdout
    assert "no OpenCL device was found" in result.stderr


@pytest.fixture
def wired(tmp_path):
    """A folder and an environment in which OpenCL has one platform, which leaves a mark if loaded."""
    if not WIRE.exists():
        pytest.skip("OpenCL has no loader of platforms here")
    vendors = tmp_path / "vendors"
    vendors.mkdir()
    (vendors / "wire.icd").write_text(f"{WIRE}\n")
    (tmp_path / "scene.toml").write_text(SHEET)
    mark = tmp_path / "loaded"
    return tmp_path, mark, dict(os.environ, OCL_ICD_VENDORS=str(vendors), WEFT_TRIPWIRE=str(mark))


@pytest.mark.parametrize("arguments", [["run", "scene.toml", "--device", "cpu"],
                                       ["run", "scene.toml", "--device", "cpu/1"],
                                       ["inspect", "scene.toml"]], ids=" ".join)
def test_opencl_is_left_alone(wired, arguments):
    folder, mark, environment = wired
    result = weft(*arguments, cwd=folder, env=environment)
    assert result.returncode == 0, result.stderr
    assert not mark.exists()


def test_the_wire_trips(wired):
    folder, mark, environment = wired
    weft("devices", cwd=folder, env=environment)
    assert mark.exists()
