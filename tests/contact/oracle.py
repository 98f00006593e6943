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


def without_vertices(run, vertices):
    """The run without these, and without the triangles that have one of them."""
    kept = ~numpy.isin(run.triangles, list(vertices)).any(axis=1)
    used, triangles = numpy.unique(run.triangles[kept], return_inverse=True)
    return Run(triangles.reshape(-1, 3), [x[used] for x in run.positions], run.bodies[kept])


def crossings_but_of_sewn(run, positions, sewn):
    """Crossing pairs of triangles, save those that are sewn to each other. sewn: pairs of vertices"""
    partner = {v: u for u, v in sewn}
    knots = [{partner.get(int(v), int(v)) for v in t} for t in run.triangles]
    return [(a, b) for a, b in crossing_pairs(run, positions) if not knots[a] & knots[b]]


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


def heights(positions, triangles, lines):
    """Where vertical lines at these (x, z) meet a surface: a list of heights each."""
    a, b, c = (positions[triangles[:, k]] for k in range(3))
    u, v = (b - a)[:, [0, 2]], (c - a)[:, [0, 2]]
    area = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    found = []
    for line in lines:
        w = line - a[:, [0, 2]]
        with numpy.errstate(divide="ignore", invalid="ignore"):
            s = (w[:, 0] * v[:, 1] - w[:, 1] * v[:, 0]) / area
            t = (u[:, 0] * w[:, 1] - u[:, 1] * w[:, 0]) / area
        met = (s >= 0) & (t >= 0) & (s + t <= 1)
        found.append((a[:, 1] + s * (b - a)[:, 1] + t * (c - a)[:, 1])[met])
    return found


def are_in_order(run, lines=15):
    """Whether sheets that lie over each other still do, in the order of the start: wherever a
    vertical line meets two of them, however they have slid."""
    sheets = [run.triangles[run.bodies == body] for body in numpy.unique(run.bodies)]
    sheets.sort(key=lambda triangles: run.positions[0][triangles][..., 1].mean())
    last = run.positions[-1]
    of_sheets = last[numpy.concatenate(sheets[1:])]
    low, high = of_sheets.min(axis=(0, 1)), of_sheets.max(axis=(0, 1))
    places = numpy.array([(x, z) for x in numpy.linspace(low[0], high[0], lines + 2)[1:-1]
                          for z in numpy.linspace(low[2], high[2], lines + 2)[1:-1]])
    met = [heights(last, triangles, places) for triangles in sheets]
    pairs = [(met[i][k].max(), met[j][k].min()) for k in range(len(places))
             for i in range(len(sheets)) for j in range(i + 1, len(sheets))
             if len(met[i][k]) and len(met[j][k])]
    assert len(pairs) > lines, "they hardly lie over each other"
    return all(below < above for below, above in pairs)
