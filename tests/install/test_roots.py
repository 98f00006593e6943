"""Weft as a library, in roots that have only the packages that it asks for: the scheduler with a compiler and CMake, the
examples with what docs/library.md names."""

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(os.environ["WEFT_ROOT"])
BUILD = Path(os.environ["WEFT_BIN"]).parent
TOOLS = ["g++", "cmake", "make"]
RUNTIME = ["libtbb-dev", "ocl-icd-opencl-dev", "opencl-headers", "pocl-opencl-icd", "libhdf5-dev"]
SIMULATION = ["libfmt-dev", "libdeflate-dev", "libtomlplusplus-dev"]

DPKG = Path("/var/lib/dpkg/info")


def why_not_here():
    if not shutil.which("bwrap") or not shutil.which("dpkg-query") or not DPKG.is_dir():
        return "needs bubblewrap and dpkg"
    if subprocess.run(["bwrap", "--ro-bind", "/", "/", "--unshare-all", "true"]).returncode != 0:
        return "bubblewrap may not make a root here"
    return ""


# Of each test, not of the module: pytest ends with an error where it finds no test at all.
pytestmark = pytest.mark.skipif(bool(why_not_here()), reason=why_not_here())


def installed_packages():
    """Package: the groups of alternatives that it needs; and who stands for a name that packages provide."""
    text = subprocess.run(["dpkg-query", "-W", "-f", "${Package}\t${Depends}, ${Pre-Depends}\t${Provides}\t${db:Status-Status}\n"],
                          check=True, text=True, capture_output=True).stdout
    needs, providers = {}, {}
    plain = lambda words: [re.split(r"[ (:]", word.strip())[0] for word in words if word.strip()]
    for line in text.splitlines():
        name, depends, provides, status = line.split("\t")
        if status != "installed":
            continue
        needs[name] = [plain(group.split("|")) for group in depends.split(",")]
        for provided in plain(provides.split(",")):
            providers.setdefault(provided, name)
    return needs, providers


def with_all_that_they_need(packages):
    needs, providers = installed_packages()
    wanted, left = set(), list(packages)
    while left:
        name = left.pop()
        name = name if name in needs else providers.get(name)
        if name is None or name in wanted:
            continue
        wanted.add(name)
        for group in needs[name]:
            left += [n for n in group if n in needs or n in providers][:1]
    return wanted


def make_root(folder, packages):
    missing = [p for p in packages if p not in installed_packages()[0]]
    if missing:
        pytest.skip("not installed: " + ", ".join(missing))
    files = set()
    for package in with_all_that_they_need([*packages, "bash", "coreutils", "dash", "grep", "libc-bin", "sed"]):
        for entry in DPKG.glob(f"{package}.list"), DPKG.glob(f"{package}:*.list"):
            for listing in entry:
                files |= set(listing.read_text().split("\n"))
    files = {f for f in files if len(f) > 2 and not f.startswith(("/usr/share/doc", "/usr/share/man", "/usr/share/locale"))}
    files |= {str(f) for f in Path("/etc/alternatives").iterdir()}
    files |= {str(f) for f in map(Path, ["/bin", "/sbin", "/lib", "/lib64", "/etc/ld.so.conf"]) if f.exists()}
    files |= {os.path.join("/usr/bin", f) for f in os.listdir("/usr/bin")
              if os.path.islink(f"/usr/bin/{f}") and os.readlink(f"/usr/bin/{f}").startswith("/etc/alternatives")}
    # Files whose folders are links (/bin, /lib) are given by where they really are.
    real = {os.path.join(os.path.realpath(os.path.dirname(f)), os.path.basename(f)) for f in files}
    names = "\n".join(sorted(f for f in real if os.path.lexists(f)))
    folder.mkdir()
    pack = subprocess.Popen(["tar", "-C", "/", "--no-recursion", "-cf", "-", "-T", "-", "--ignore-failed-read"],
                            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    unpack = subprocess.Popen(["tar", "-C", folder, "-xf", "-"], stdin=pack.stdout)
    pack.stdin.write(names.encode())
    pack.stdin.close()
    unpack.wait()
    for name in "tmp", "proc", "dev", "work", "weft", "prefix":
        (folder / name).mkdir(exist_ok=True)
    in_root(folder, "ldconfig")
    return folder


def in_root(root, *command, writable=None, read_only=()):
    binds = [word for source, place in read_only for word in ("--ro-bind", source, place)]
    if writable:
        binds += ["--bind", writable, "/work"]
    environment = ["--clearenv", "--setenv", "PATH", "/usr/sbin:/usr/bin:/sbin:/bin", "--setenv", "HOME", "/work",
                   # Which leaks are the drivers' stands in a file that is not there.
                   "--setenv", "ASAN_OPTIONS", "detect_leaks=0"]
    result = subprocess.run(["bwrap", "--bind", root, "/", "--proc", "/proc", "--ro-bind", "/sys", "/sys", "--dev", "/dev",
                             *binds, "--unshare-all",
                             *environment, "--", *command], text=True, capture_output=True)
    assert result.returncode == 0, result.stdout + result.stderr
    return result.stdout


def code_of(name):
    """The block of docs/library.md that stands behind a file's name."""
    text = (ROOT / "docs/library.md").read_text()
    return re.search(rf"`{re.escape(name)}`.*?\n```\w*\n(.*?)\n```", text, re.S)[1] + "\n"


def test_the_scheduler_with_a_compiler_and_cmake(tmp_path):
    root = make_root(tmp_path / "root", TOOLS)
    assert not (root / "usr/include/tbb").exists() and not (root / "usr/include/CL").exists()
    work = tmp_path / "work"
    work.mkdir()
    (work / "graph.cpp").write_text(code_of("graph.cpp"))
    (work / "CMakeLists.txt").write_text("cmake_minimum_required(VERSION 3.23)\nproject(graph LANGUAGES CXX)\n"
                                         "find_package(weft CONFIG REQUIRED COMPONENTS scheduler)\n"
                                         "add_executable(graph graph.cpp)\ntarget_link_libraries(graph PRIVATE weft::scheduler)\n")

    def run(*command):
        return in_root(root, *command, writable=work, read_only=[(ROOT, "/weft")])

    run("cmake", "-S", "/weft", "-B", "/work/weft", "-DWEFT_COMPONENTS=scheduler")
    run("cmake", "--build", "/work/weft", "-j", "2")
    run("cmake", "--install", "/work/weft", "--prefix", "/work/prefix")
    run("cmake", "-S", "/work", "-B", "/work/build", "-DCMAKE_PREFIX_PATH=/work/prefix")
    run("cmake", "--build", "/work/build")
    assert "all done at 2.75" in run("/work/build/graph")


def test_the_examples_with_their_packages(tmp_path):
    root = make_root(tmp_path / "root", [*TOOLS, *RUNTIME, *SIMULATION])
    assert not (root / "usr/include/eigen3").exists() and not (root / "usr/include/nlohmann").exists()
    prefix, work = tmp_path / "prefix", tmp_path / "work"
    subprocess.run(["cmake", "--install", BUILD, "--prefix", prefix, "--component", "development"], check=True, capture_output=True)
    shutil.copytree(ROOT / "examples", work / "examples")
    (work / "rod").mkdir()
    for name in "CMakeLists.txt", "rod.h", "main.cpp":
        (work / "rod" / name).write_text(code_of(name))

    def run(*command):
        return in_root(root, *command, writable=work, read_only=[(prefix, "/prefix")])

    for project in "examples", "rod":
        run("cmake", "-S", f"/work/{project}", "-B", f"/work/{project}/build", "-DCMAKE_PREFIX_PATH=/prefix")
        run("cmake", "--build", f"/work/{project}/build", "-j", "2")
    run("/work/examples/build/schedule")
    for program in "examples/build/heat", "examples/build/net", "examples/build/cloth", "rod/build/rod":
        states = {tuple(re.findall("state [0-9a-f]{32}", run(f"/work/{program}", devices)))
                  for devices in ("cpu/1", "opencl:0/1", "cpu/1+opencl:0/1")}
        assert len(states) == 1 and states != {()}, (program, states)
