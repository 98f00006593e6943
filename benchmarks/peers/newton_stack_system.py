"""Newton's VBD with self-contact: membranes with hinges, as its users simulate garments.

Pairs are looked for once per step, where the thickness and as much again are near.
"""

import newton_model
import sheet as problem
import stack as pile
from newton_model import newton


def make(stack, weft):
    return NewtonStack(stack)


class NewtonStack(newton_model.Frames):
    version = newton.__version__

    def __init__(self, stack):
        builder = newton_model.builder()
        newton_model.add_mesh(builder, stack, membrane=problem.STRETCH, bend=problem.BEND)
        builder.color(include_bending=True)
        model = newton_model.finish(builder, stack)
        model.soft_contact_ke = pile.STIFFNESS
        model.soft_contact_kd = 0.0
        model.soft_contact_mu = 0.0
        self.units_per_frame = stack.sweeps_per_frame * stack.free_vertices()
        solver = newton.solvers.SolverVBD(
            model, iterations=stack.iterations, particle_enable_self_contact=True,
            particle_self_contact_margin=pile.THICKNESS, particle_self_contact_gap=pile.THICKNESS)
        super().__init__(stack, model, solver)
