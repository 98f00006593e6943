"""Weft, as its users run it: the program, on one core, by its own clock.

Each turn is a run of its own that starts with the flat sheet, since the program cannot pause. The
number of operations of a frame does not depend on the sheet's shape. Start-up, calibration and
output are not in its time per frame; planning and the check of the state are.
"""

import json
import pathlib
import subprocess
import tempfile

import h5py

import sheet as problem

HEAD = """
[scene]
name = "sheet"
frames = {frames}
dt = {dt!r}
substeps = {sheet.substeps}
gravity = [0.0, {gravity}, 0.0]

[solver]
method = "{method}"
iterations = {sheet.iterations}

"""

CLOTH = """
[[cloth]]
name = "sheet"
grid = {{ size = [1.0, 1.0], resolution = [{sheet.resolution}, {sheet.resolution}] }}
density = {density}
stretch = {{ stiffness = {stretch} }}
{bend}
pins = {{ corners = ["x-z-", "x+z-"] }}
"""


def make(sheet, weft, method, bend):
    return Weft(sheet, weft, method, bend)


class Weft:
    def __init__(self, sheet, program, method, bend):
        self._program = program
        self._sheet = sheet
        self._folder = tempfile.TemporaryDirectory(prefix="weft-peers-")
        self._frames = problem.WARM_UP  # of the positions; Weft needs none itself
        self._scene = pathlib.Path(self._folder.name) / "sheet.toml"
        self._scene.write_text(self.scene(sheet, method, bend))
        self.version = self._call("--version").strip().removeprefix("weft ")
        elements = sheet.edge_count() + (sheet.hinge_count() if bend else 0)
        units = elements if method == "xpbd" else sheet.free_vertices()
        self.units_per_frame = units * sheet.sweeps_per_frame

    def scene(self, sheet, method, bend):
        return HEAD.format(sheet=sheet, frames=1, dt=problem.FRAME, gravity=-problem.GRAVITY,
                           method=method) + CLOTH.format(
            sheet=sheet, density=problem.DENSITY, stretch=problem.STRETCH,
            bend=f"bend = {{ stiffness = {problem.BEND} }}" if bend else "")

    def advance(self, frames):
        """The program says the median of its frames: that, as many times as there are frames."""
        self._frames += frames
        return [1e-3 * self._run(frames, "--no-geometry")["ms_per_frame"]] * frames

    def positions(self):
        """Of one more run of all frames so far, with its geometry written."""
        summary = self._run(self._frames)
        with h5py.File(summary["files"]["geometry"]) as file:
            count = int(file["VTKHDF/NumberOfPoints"][0])
            return file["VTKHDF/Points"][-count:], self._frames

    def _run(self, frames, *more, trace=False):
        return json.loads(self._call(
            "run", self._scene, "--device", "cpu/1", "--plan", "single", "--frames", frames,
            "--out", pathlib.Path(self._folder.name) / "out", "--force", "--json", "--quiet",
            *([] if trace else ["--no-trace"]), *more))

    def _call(self, *arguments):
        result = subprocess.run([self._program, *map(str, arguments)], capture_output=True,
                                text=True)
        if result.returncode != 0:
            raise RuntimeError(result.stderr.strip() or f"exit code {result.returncode}")
        return result.stdout
