"""Draws the surface at one step of frames.vtkhdf. For a real look, open the file in ParaView."""

import h5py
import numpy
from matplotlib import pyplot
from matplotlib.colors import LightSource


def surface(path, step=None, elevation=20.0, azimuth=-60.0):
    """A figure of one step (default: the last), y up."""
    with h5py.File(path, "r") as file:
        root = file["VTKHDF"]
        steps = int(root["Steps"].attrs["NSteps"])
        if steps == 0:
            raise ValueError(f"{path}: no step has been written yet")
        step = steps - 1 if step is None else step
        if not 0 <= step < steps:
            raise ValueError(f"{path}: there is no step {step}; steps are 0 to {steps - 1}")
        first = int(root["Steps/PointOffsets"][step])
        count = int(root["NumberOfPoints"][0])
        points = root["Points"][first:first + count]
        triangles = root["Polygons/Connectivity"][:].reshape(-1, 3)
    figure = pyplot.figure(figsize=(7, 5))
    axes = figure.add_axes([0, 0, 1, 1], projection="3d")
    x, y, z = points[:, 0], points[:, 2], points[:, 1]  # matplotlib's z is up
    axes.plot_trisurf(x, y, z, triangles=triangles, color="#c8553d", linewidth=0, antialiased=False,
                      lightsource=LightSource(azdeg=315, altdeg=45))
    middle = numpy.array([(a.min() + a.max()) / 2 for a in (x, y, z)])
    half = max(a.max() - a.min() for a in (x, y, z)) / 2
    axes.set_xlim(middle[0] - half, middle[0] + half)
    axes.set_ylim(middle[1] - half, middle[1] + half)
    axes.set_zlim(middle[2] - half, middle[2] + half)
    axes.set_box_aspect((1, 1, 1), zoom=1.4)
    axes.view_init(elev=elevation, azim=azimuth)
    axes.set_axis_off()
    return figure
