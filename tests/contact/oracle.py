"""Whether surfaces got through each other, as libraries see it that share nothing with Weft."""

import dataclasses

import h5py
import igl.predicates
import ipctk
import numpy


@dataclasses.dataclass
class Run:
    """The surfaces of a run in each of its frames."""

    triangles: numpy.ndarray  # [triangles, 3]
    positions: list           # [frames] of [vertices, 3]
    bodies: numpy.ndarray     # [triangles]


def read_run(folder):
    with h5py.File(folder / "frames.vtkhdf") as file:
        root = file["VTKHDF"]
        steps = int(root["Steps"].attrs["NSteps"])
        count = int(root["NumberOfPoints"][0])
        points = root["Points"][: steps * count].reshape(steps, count, 3).astype(float)
        triangles = root["Polygons/Connectivity"][:].reshape(-1, 3)
        return Run(triangles, list(points), root["CellData/body"][: len(triangles)])


def collision_mesh(run):
    edges = ipctk.edges(run.triangles)
    return ipctk.CollisionMesh(run.positions[0], edges, run.triangles)


def on_the_mesh(mesh, positions):
    """Vertices that belong to a triangle, as ipctk has them."""
    return numpy.asfortranarray(mesh.vertices(positions))


def crossing_pairs(run, positions):
    """Pairs of triangles, by exact predicates."""
    return igl.predicates.find_self_intersections(positions, run.triangles)[1]


def frames_that_cross(run):
    mesh = collision_mesh(run)
    return [frame for frame, x in enumerate(run.positions)
            if ipctk.has_intersections(mesh, on_the_mesh(mesh, x))]


def steps_that_collide(run):
    """Of runs with frames of one substep: those on whose straight way something is passed."""
    mesh = collision_mesh(run)
    points = [on_the_mesh(mesh, x) for x in run.positions]
    return [step for step, (before, after) in enumerate(zip(points, points[1:]))
            if not ipctk.is_step_collision_free(mesh, before, after)]


def are_in_order(run, axis=1):
    """Whether bodies that begin in the order of their means along an axis are still in it."""
    means = [[x[run.triangles[run.bodies == body]][..., axis].mean()
              for body in numpy.unique(run.bodies)] for x in (run.positions[0], run.positions[-1])]
    return list(numpy.argsort(means[0])) == list(numpy.argsort(means[1]))
