"""What systems with contact do: a pile of sheets, the lowest of which hangs by its four corners."""

import dataclasses

import numpy

import sheet as problem

try:
    from igl.predicates import find_self_intersections
except ImportError:
    find_self_intersections = None

THICKNESS = 0.01  # where sheets begin to push each other [m]
SPACING = 0.03  # of sheets at the start [m]
LANDED = 0.15  # when the second sheet has met the lowest one, and moved with it [s]
STIFFNESS = 1.0e4  # of a contact, where a system has one [N/m]
TURN = 7.0  # of each sheet against the one below [degrees]


@dataclasses.dataclass(frozen=True)
class Stack(problem.Sheet):
    """Sheets as Sheet, one above the other, each turned a little, so that edges cross.

    The lowest one is the first.
    """

    sheets: int

    @property
    def heights(self):
        return SPACING * numpy.arange(self.sheets)

    @property
    def angles(self):
        """About the y axis, in degrees."""
        return TURN * numpy.arange(self.sheets)

    @property
    def pins(self):
        last = self.resolution**2 - 1
        return [0, self.resolution - 1, last - self.resolution + 1, last]

    def positions(self):
        flat = super().positions()
        return numpy.concatenate([_turned(flat, angle) + [0.0, height, 0.0]
                                  for angle, height in zip(self.angles, self.heights)])

    def triangles(self):
        one = super().triangles()
        return numpy.concatenate([one + n * self.resolution**2 for n in range(self.sheets)])

    def complaint(self, positions, frames, longest_edge):
        means = positions[:, 1].reshape(self.sheets, -1).mean(axis=1)
        below = numpy.flatnonzero(numpy.diff(means) <= 0.0)
        if below.size:
            return f"sheet {below[0] + 1} has got below the one that was under it"
        gap = means[1] - means[0]
        if frames * problem.FRAME > LANDED and gap > 0.9 * SPACING:
            return f"two sheets are {gap:.3g} m apart: the upper one has not come down"
        return self.complaint_of_edges(frames, longest_edge)

    def crossings(self, positions):
        """Pairs of triangles that cross, by exact predicates; None where libigl is not."""
        if find_self_intersections is None:
            return None
        return len(find_self_intersections(numpy.ascontiguousarray(positions), self.triangles())[1])


def _turned(positions, degrees):
    angle = numpy.radians(degrees)
    x, y, z = positions.T
    return numpy.stack([numpy.cos(angle) * x + numpy.sin(angle) * z, y,
                        numpy.cos(angle) * z - numpy.sin(angle) * x], axis=-1)
