"""PositionBasedDynamics: XPBD in float64, colours of constraints by OpenMP (one thread here)."""

import importlib.metadata
import time

import numpy

import sheet as problem
from systems import Missing

try:
    import pypbd
except ImportError as error:
    raise Missing(f"PositionBasedDynamics cannot be imported ({error}); "
                  "`pip install pypbd` in build/peers would bring it") from error

# As addClothConstraints and addBendingConstraints number them.
DISTANCE_XPBD = 4
ISOMETRIC_BENDING_XPBD = 3


def make(sheet, weft, bend):
    return Pypbd(sheet, bend)


class Pypbd:
    def __init__(self, sheet, bend):
        self.version = importlib.metadata.version("pypbd")
        simulation = pypbd.Simulation.getCurrent()
        simulation.initDefault()
        self._model = simulation.getModel()
        self._add_sheet(sheet, bend)
        self.units_per_frame = sheet.sweeps_per_frame * len(self._model.getConstraints())

        pypbd.TimeManager.getCurrent().setTimeStepSize(problem.FRAME)
        self._stepper = simulation.getTimeStep()
        controller = pypbd.TimeStepController
        self._stepper.setValueUInt(controller.NUM_SUB_STEPS, sheet.substeps)
        self._stepper.setValueUInt(controller.MAX_ITERATIONS, sheet.iterations)
        # Passes over all constraints for velocities, of which these constraints have none.
        self._stepper.setValueUInt(controller.MAX_ITERATIONS_V, 0)
        self._frames = 0
        self.advance(problem.WARM_UP)

    def _add_sheet(self, sheet, bend):
        mesh = self._model.addTriangleModel(sheet.positions().tolist(),
                                            sheet.triangles().ravel().tolist())
        particles = self._model.getParticles()
        for vertex in range(sheet.resolution**2):
            particles.setMass(vertex, sheet.particle_mass)
        for pin in sheet.pins:
            particles.setMass(pin, 0.0)
        # The first number is the stiffness; the others serve other methods than these.
        self._model.addClothConstraints(mesh, DISTANCE_XPBD, problem.STRETCH, problem.STRETCH,
                                        problem.STRETCH, problem.STRETCH, 0.3, 0.3, False, False)
        if bend:
            self._model.addBendingConstraints(mesh, ISOMETRIC_BENDING_XPBD, problem.BEND)

    def advance(self, frames):
        times = []
        for _ in range(frames):
            start = time.perf_counter()
            self._stepper.step(self._model)
            times.append(time.perf_counter() - start)
        self._frames += frames
        return times

    def positions(self):
        return numpy.array(self._model.getParticles().getVertices()), self._frames
