"""What Newton's solvers have in common: the sheet as a model, and frames replayed on one core."""

import time

import numpy

import sheet as problem
from systems import Missing

try:
    import newton
    import warp
except ImportError as error:
    raise Missing(f"Newton cannot be imported ({error}); "
                  "`pip install newton` in build/peers would bring it") from error


def builder():
    warp.set_device("cpu")  # which has one thread
    return newton.ModelBuilder(up_axis=newton.Axis.Y, gravity=(0.0, -problem.GRAVITY, 0.0))


def add_particles(model, sheet):
    positions = sheet.positions()
    count = len(positions)
    model.add_particles([warp.vec3(*p) for p in positions], [warp.vec3()] * count,
                        [sheet.particle_mass] * count, [0.0] * count)


def add_mesh(model, sheet, membrane, bend):
    """The triangles as elements: stiff as a membrane, along their edges in bending, or not (0)."""
    model.add_cloth_mesh(pos=warp.vec3(), rot=warp.quat_identity(), scale=1.0, vel=warp.vec3(),
                         vertices=[warp.vec3(*p) for p in sheet.positions()],
                         indices=sheet.triangles().ravel().tolist(), density=problem.DENSITY,
                         tri_ke=membrane, tri_ka=membrane, tri_kd=0.0, edge_ke=bend, edge_kd=0.0,
                         particle_radius=0.0)


def add_springs(model, sheet, stiffness):
    for i, j in sheet.edges().tolist():
        model.add_spring(i, j, stiffness, 0.0, 0.0)


def finish(model, sheet):
    """The model, ready for a solver: pinned, without a grid that looks for contacts."""
    for pin in sheet.pins:
        model.particle_mass[pin] = 0.0
    model = model.finalize(device="cpu")
    model.particle_grid = None
    return model


class Frames:
    """Frames of a solver, recorded once and replayed (Warp's graphs): Newton's fastest way.

    Warp compiles what it needs in the frames of the warm-up.
    """

    def __init__(self, sheet, model, solver):
        self._sheet = sheet
        self._solver = solver
        self._control = model.control()
        self._state, self._next = model.state(), model.state()
        self._step_frame()
        with warp.ScopedCapture() as capture:
            self._step_frame()
        self._graph = capture.graph
        self._frames = 1
        self.advance(problem.WARM_UP - 1)

    def advance(self, frames):
        times = []
        for _ in range(frames):
            start = time.perf_counter()
            warp.capture_launch(self._graph)
            times.append(time.perf_counter() - start)
        self._frames += frames
        return times

    def positions(self):
        return numpy.array(self._state.particle_q.numpy()), self._frames

    def _step_frame(self):
        for _ in range(self._sheet.substeps):
            self._state.clear_forces()
            self._solver.step(self._state, self._next, self._control, None, self._sheet.substep)
            self._state, self._next = self._next, self._state
        if self._sheet.substeps % 2 == 1:  # a replayed frame has to start where it ended
            self._next.assign(self._state)
            self._state, self._next = self._next, self._state
