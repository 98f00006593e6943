"""The bundle, unpacked on a machine that has nothing: a root with /proc, /dev and a folder to work in."""

import json
import os
import platform
import re
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(os.environ["WEFT_ROOT"])
BUILD = Path(os.environ["WEFT_BIN"]).parent
TOOLS = ["bwrap", "patchelf", "ld", "cc"]

missing = [tool for tool in TOOLS if not shutil.which(tool)]
if platform.system() != "Linux" or platform.machine() != "x86_64":
    missing.append("x86-64 Linux")
pytestmark = pytest.mark.skipif(bool(missing), reason="missing: " + ", ".join(missing))


@pytest.fixture(scope="module")
def bundle(tmp_path_factory):
    folder = tmp_path_factory.mktemp("bundle") / "weft"
    subprocess.run([ROOT / "cmake/bundle/make_bundle.sh", BUILD, folder, "0"], check=True)
    return folder


# Which leaks are the drivers' stands in a file that is not there.
NO_LEAKS = ["--setenv", "ASAN_OPTIONS", "detect_leaks=0"]


@pytest.fixture
def in_empty_root(bundle, tmp_path):
    """Runs a command of the bundle where nothing else is; its folder is /work there."""
    work = tmp_path / "work"
    work.mkdir()
    shutil.copy(ROOT / "scenes/tablecloth.toml", work)

    def run(*arguments):
        sandbox = ["bwrap", "--ro-bind", bundle, "/opt/weft", "--bind", work, "/work", "--proc", "/proc",
                   "--dev", "/dev", "--unshare-all", "--clearenv", *NO_LEAKS, "--chdir", "/work"]
        return subprocess.run([*sandbox, "/opt/weft/bin/weft", *arguments], text=True, capture_output=True)

    if subprocess.run(["bwrap", "--ro-bind", "/", "/", "--unshare-all", "true"]).returncode != 0:
        pytest.skip("bubblewrap may not make a root here")
    run.work = work
    return run


def state_hash(folder):
    return json.loads((folder / "summary.json").read_text())["state_hash"]


@pytest.mark.parametrize("device", ["cpu/1", "opencl:0/1"])
def test_same_bits_in_an_empty_root(in_empty_root, device, tmp_path):
    options = ["tablecloth.toml", "--frames", "2", "--device", device, "--out", "out", "--quiet"]
    inside = in_empty_root("run", *options)
    assert inside.returncode == 0, inside.stderr
    assert inside.stderr == ""
    subprocess.run([os.environ["WEFT"], "run", *options], check=True, cwd=shutil.copytree(
        in_empty_root.work, tmp_path / "here", ignore=shutil.ignore_patterns("out")), capture_output=True)
    assert state_hash(in_empty_root.work / "out") == state_hash(tmp_path / "here/out")


def test_pictures_have_letters_without_fonts_on_the_machine(in_empty_root):
    in_empty_root("run", "tablecloth.toml", "--frames", "1", "--device", "cpu/1", "--out", "out", "--quiet")
    drawn = in_empty_root("trace", "gantt", "out/trace.h5", "--out", "gantt.png")
    assert drawn.returncode == 0, drawn.stderr
    assert "ontconfig" not in drawn.stderr
    assert (in_empty_root.work / "gantt.png").read_bytes().startswith(b"\x89PNG")


def test_runs_with_the_libraries_of_this_machine(bundle):
    found = subprocess.run([bundle / "bin/weft", "devices", "--json"], text=True, capture_output=True)
    assert found.returncode == 0, found.stderr
    # PoCL is registered here as well, and must not come twice.
    names = re.findall(r'"name": "(pthread-[^"]*)"', found.stdout)
    assert len(names) == len(set(names)) <= 1


def test_says_whose_everything_is(bundle):
    licenses = {file.name for file in (bundle / "licenses").iterdir()}
    assert {"weft", "libllvm15", "libpocl2", "libtbb12", "libc6"} <= licenses
    assert all((bundle / "licenses" / name).stat().st_size > 0 for name in licenses)
