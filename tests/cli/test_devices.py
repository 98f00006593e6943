"""`weft devices`, and that OpenCL is not touched unless a device asks for it."""

import json
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


@pytest.fixture
def with_bad_driver(tmp_path):
    """Makes an environment with one more platform, a bad one of some kind, beside the machine's own."""
    driver = pathlib.Path(os.environ["WEFT_BIN"]) / "bad_driver.so"
    if not driver.exists():
        pytest.skip("OpenCL has no loader of platforms here")

    def make(kind):
        vendors = tmp_path / "vendors"
        vendors.mkdir()
        own = pathlib.Path(os.environ.get("OCL_ICD_VENDORS", "/etc/OpenCL/vendors"))
        for icd in own.glob("*.icd"):
            (vendors / icd.name).write_text(icd.read_text())
        (vendors / "a_bad_one.icd").write_text(f"{driver}\n")
        (tmp_path / "scene.toml").write_text(SHEET)
        # Sanitizers leave the crash alone, which is not theirs to report.
        return dict(os.environ, OCL_ICD_VENDORS=str(vendors), WEFT_BAD_DRIVER=kind,
                    ASAN_OPTIONS="handle_segv=0")

    return make


@pytest.mark.parametrize("kind", ["crash", "missing"])
def test_a_driver_that_dies_is_left_out(with_bad_driver, tmp_path, kind):
    usual = weft_json("devices")["devices"]
    environment = with_bad_driver(kind)
    result = weft("devices", "--json", env=environment)
    assert result.returncode == 0, result.stderr
    assert [d["name"] for d in json.loads(result.stdout)["devices"]] == [d["name"] for d in usual]
    result = weft("devices", env=environment)
    assert result.returncode == 0, result.stderr
    assert result.stderr.count("the OpenCL platform 'Bad driver' is left out") == 1
    assert "Segmentation fault" in result.stderr
    for devices in ["hybrid", "opencl"] if len(usual) > 1 else ["hybrid"]:
        result = weft("run", "scene.toml", "--device", devices, "--frames", "1", "--force",
                      cwd=tmp_path, env=environment)
        assert result.returncode == 0, result.stderr
        assert "'Bad driver' is left out" in result.stderr


def test_a_loader_that_dies_leaves_the_cpu(with_bad_driver, tmp_path):
    environment = with_bad_driver("load")
    result = weft("devices", env=environment)
    assert result.returncode == 0, result.stderr
    assert "TBB" in result.stdout and "all OpenCL drivers are left out" in result.stderr
    result = weft("run", "scene.toml", "--device", "opencl", cwd=tmp_path, env=environment)
    assert result.returncode == 2
    assert "all OpenCL drivers are left out" in result.stderr
