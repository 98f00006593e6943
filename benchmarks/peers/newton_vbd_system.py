"""Newton's VBD: vertices colour by colour, in float32, with or without hinges of dihedral angle.

stretch: `membrane`, neo-Hookean triangles, which is how Newton's users simulate cloth by VBD, or
`springs` as Weft has them; Newton goes over all springs once per colour.
"""

import newton_model
import sheet as problem
from newton_model import newton


def make(sheet, weft, stretch, bend):
    return NewtonVbd(sheet, stretch, bend)


class NewtonVbd(newton_model.Frames):
    version = newton.__version__

    def __init__(self, sheet, stretch, bend):
        builder = newton_model.builder()
        newton_model.add_mesh(builder, sheet,
                              membrane=problem.STRETCH if stretch == "membrane" else 0.0,
                              bend=problem.BEND if bend else 0.0)
        if stretch == "springs":
            newton_model.add_springs(builder, sheet, problem.STRETCH)
        builder.color(include_bending=bend)
        model = newton_model.finish(builder, sheet)
        self.units_per_frame = sheet.sweeps_per_frame * sheet.free_vertices()
        solver = newton.solvers.SolverVBD(model, iterations=sheet.iterations)
        super().__init__(sheet, model, solver)
