"""The work that every system does: a square sheet of cloth that hangs by two corners."""

import dataclasses

import numpy

GRAVITY = 9.81  # [m/s^2], along -y
FRAME = 1.0 / 60.0  # [s]
DENSITY = 0.2  # [kg/m^2]
STRETCH = 1.0e4  # of an edge [N/m]
BEND = 1.0e-4  # as a scene's cloth.bend.stiffness
WARM_UP = 2  # frames that a system does when it is set up


@dataclasses.dataclass(frozen=True)
class Sheet:
    """resolution x resolution particles, 1 m x 1 m, flat in the plane y = 0 at the start.

    Vertices, triangles and pins are those of Weft's `grid` with the corners x-z- and x+z- pinned.
    """

    resolution: int
    substeps: int
    iterations: int

    @property
    def substep(self):
        return FRAME / self.substeps

    @property
    def sweeps_per_frame(self):
        return self.substeps * self.iterations

    @property
    def particle_mass(self):
        return DENSITY / self.resolution**2

    @property
    def pins(self):
        return [0, self.resolution - 1]

    def positions(self):
        across = numpy.linspace(-0.5, 0.5, self.resolution)
        z, x = numpy.meshgrid(across, across, indexing="ij")
        return numpy.stack([x, numpy.zeros_like(x), z], axis=-1).reshape(-1, 3)

    def _cells(self):
        """The corners of all cells: two of one row, two of the next one."""
        index = numpy.arange(self.resolution**2).reshape(self.resolution, self.resolution)
        return index[:-1, :-1], index[:-1, 1:], index[1:, :-1], index[1:, 1:]

    def triangles(self):
        a, b, c, d = self._cells()
        both = numpy.stack([numpy.stack([a, c, b], -1), numpy.stack([b, c, d], -1)], axis=2)
        return both.reshape(-1, 3)

    def edges(self):
        pairs = numpy.sort(self.triangles()[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        return numpy.unique(pairs, axis=0)

    def edge_count(self):
        """Edges of the triangles, each a spring."""
        return len(self.edges())

    def hinge_count(self):
        """Edges inside the sheet, with a triangle on both sides."""
        return 3 * len(self.triangles()) - self.edge_count()

    def free_vertices(self):
        return len(self.positions()) - len(self.pins)

    def free_fall(self, frames):
        """[m]; symplectic Euler falls a little further than the parabola."""
        time = frames * FRAME
        return 0.5 * GRAVITY * time * (time + self.substep)

    def complaint(self, positions, frames, longest_edge):
        """Why these are no positions of such a sheet after so many frames; empty if they may be."""
        mean_height = positions[:, 1].mean()
        free_fall = self.free_fall(frames)
        # After half a second the sheet has swung down, and may swing up again.
        least = 0.2 * min(free_fall, 0.25)
        if mean_height > -least:
            time = frames * FRAME
            return f"its mean height is {mean_height:.3g} m after {time:.2f} s: it has not fallen"
        if mean_height < -1.05 * free_fall - 1.0e-3:
            return f"its mean height is {mean_height:.3g} m: it fell faster than a stone"
        return self.complaint_of_edges(frames, longest_edge)

    def complaint_of_edges(self, frames, longest_edge):
        """If nothing but pins held it, all the rest would fall, and stretch the edges there."""
        if longest_edge > max(2.0, 0.5 * self.free_fall(frames) * (self.resolution - 1)):
            return f"an edge is {longest_edge:.3g} times as long as at the start"
        return ""

    def crossings(self, positions):
        """How often surfaces cross each other; None where nobody looks."""
        return None


@dataclasses.dataclass(frozen=True)
class Shape:
    """How a sheet looks: enough to see that somebody has really simulated it."""

    mean_height: float | None  # [m], 0 at the start
    longest_edge: float | None  # over its length at the start
    complaint: str  # why this is no hanging cloth; empty if it may be one
    crossings: int | None = None  # see Sheet


def look_at(sheet, positions, frames):
    """The Shape after so many frames.

    Bounds are wide: solvers that have not converged stretch a sheet to several times its
    length near the pins. What they catch is a sheet that stands still, falls, or explodes.
    """
    positions = numpy.asarray(positions, dtype=float)
    start = sheet.positions()
    if positions.shape != start.shape or not numpy.isfinite(positions).all():
        return Shape(None, None, "it has no finite positions")
    edges = sheet.edges()

    def lengths(x):
        return numpy.linalg.norm(x[edges[:, 0]] - x[edges[:, 1]], axis=1)

    mean_height = (positions - start)[:, 1].mean()
    longest_edge = (lengths(positions) / lengths(start)).max()
    moved = numpy.abs(positions[sheet.pins] - start[sheet.pins]).max()
    return Shape(mean_height, longest_edge,
                 _complaint_of_pins(moved) or sheet.complaint(positions, frames, longest_edge),
                 sheet.crossings(positions))


def _complaint_of_pins(moved):
    return f"a pinned corner has moved by {moved:.3g} m" if moved > 1.0e-4 else ""
