"""Weft with contact: the stack as a scene of its own. A turn is a run of all frames so far, and the
trace has the times of its last ones, since contacts differ from frame to frame."""

import h5py

import sheet as problem
import stack as pile
import weft_system

CONTACT = """
[contact]
thickness = {thickness}
"""

CLOTH = """
[[cloth]]
name = "sheet{number}"
grid = {{ size = [1.0, 1.0], resolution = [{resolution}, {resolution}] }}
rotate = [0.0, 1.0, 0.0, {angle}]
translate = [0.0, {height}, 0.0]
density = {density}
stretch = {{ stiffness = {stretch} }}
bend = {{ stiffness = {bend} }}
"""

PINS = 'pins = { corners = ["x-z-", "x+z-", "x-z+", "x+z+"] }\n'


def make(stack, weft):
    return WeftStack(stack, weft)


class WeftStack(weft_system.Weft):
    def __init__(self, stack, program):
        super().__init__(stack, program, "vbd", bend=True)

    def advance(self, frames):
        self._frames += frames
        run = self._run(self._frames, "--no-geometry", trace=True)
        with h5py.File(run["files"]["trace"]) as file:
            rows = file["frames"][-frames:]
        return (rows["end"] - rows["start"]).tolist()

    def scene(self, stack, method, bend):
        head = weft_system.HEAD.format(sheet=stack, frames=1, dt=problem.FRAME,
                                       gravity=-problem.GRAVITY, method=method)
        return (head + CONTACT.format(thickness=pile.THICKNESS)
                + "".join(self._cloth(stack, number) for number in range(stack.sheets)))

    def _cloth(self, stack, number):
        return CLOTH.format(
            number=number, resolution=stack.resolution, angle=stack.angles[number],
            height=stack.heights[number], density=problem.DENSITY, stretch=problem.STRETCH,
            bend=problem.BEND) + (PINS if number == 0 else "")
