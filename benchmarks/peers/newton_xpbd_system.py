"""Newton's XPBD: all springs, then all hinges, from the same positions (Jacobi), in float32."""

import newton_model
import sheet as problem
from newton_model import newton


def make(sheet, weft, bend):
    return NewtonXpbd(sheet, bend)


class NewtonXpbd(newton_model.Frames):
    version = newton.__version__

    def __init__(self, sheet, bend):
        builder = newton_model.builder()
        if bend:
            newton_model.add_mesh(builder, sheet, membrane=0.0, bend=problem.BEND)
        else:
            newton_model.add_particles(builder, sheet)
        newton_model.add_springs(builder, sheet, holding_stiffness(sheet))
        model = newton_model.finish(builder, sheet)
        self.units_per_frame = sheet.sweeps_per_frame * (
            sheet.edge_count() + (sheet.hinge_count() if bend else 0))
        solver = newton.solvers.SolverXPBD(model, iterations=sheet.iterations)
        super().__init__(sheet, model, solver)


def holding_stiffness(sheet):
    """The stiffness of springs [N/m] with which this solver does not diverge.

    It adds up the corrections of a vertex's six springs without relaxation, which explodes with
    compliances / dt^2 below about the inverse mass. The work is the same for any stiffness.
    """
    return sheet.particle_mass / (4.0 * sheet.substep**2)
