"""Geometry files as VTK sees them: finished, growing, and after kill -9."""

import os
import pathlib
import subprocess
import sys
import xml.etree.ElementTree

import h5py
import numpy
import pytest
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOHDF import vtkHDFReader

FIXTURE = pathlib.Path(os.environ["WEFT_BIN"]) / "geometry_fixture"
GRID = 20
VERTICES = 2 * GRID * GRID
TRIANGLES = 4 * (GRID - 1) ** 2


def open_reader(path):
    reader = vtkHDFReader()
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    return reader


def step(reader, index):
    reader.SetStep(index)
    reader.Update()
    return reader.GetOutput()


def check_step(reader, index):
    """Positions follow the fixture's formula."""
    points = vtk_to_numpy(step(reader, index).GetPoints().GetData())
    assert points.dtype == numpy.float32
    body = numpy.repeat([0.0, 1.0], GRID * GRID)
    wave = 0.1 * numpy.sin(2 * numpy.pi * (points[:, 0].astype(float) + index / 60))
    assert numpy.allclose(points[:, 1], body + wave, atol=1e-6)


def start_run(path, steps, pause_ms, seen):
    process = subprocess.Popen([FIXTURE, path, str(steps), str(GRID), str(pause_ms)],
                               stdout=subprocess.PIPE)
    for _ in range(seen):
        process.stdout.readline()
    return process


@pytest.fixture(scope="module", params=["none", "fast", "small"])
def compression(request):
    return request.param


@pytest.fixture(scope="module")
def finished(tmp_path_factory, compression):
    path = tmp_path_factory.mktemp("geometry") / "frames.vtkhdf"
    subprocess.run([FIXTURE, path, "30", str(GRID), "0", compression], check=True)
    return path


def test_vtk_reads_all_steps(finished):
    reader = open_reader(finished)
    assert reader.GetNumberOfSteps() == 30
    for index in range(30):
        output = step(reader, index)
        assert output.GetNumberOfPoints() == VERTICES
        assert output.GetNumberOfPolys() == TRIANGLES == output.GetNumberOfCells()
        body = vtk_to_numpy(output.GetCellData().GetArray("body"))
        assert list(numpy.bincount(body)) == [TRIANGLES // 2, TRIANGLES // 2]
        check_step(reader, index)


def test_vtk_reads_the_times(finished):
    reader = open_reader(finished)
    steps = reader.GetOutputInformation(0).Get(reader.GetExecutive().TIME_STEPS())
    assert numpy.allclose(steps, numpy.arange(30) / 60)


def test_triangles_are_stored_once_and_positions_compressed(finished, compression):
    with h5py.File(finished) as file:
        assert file["VTKHDF/Polygons/Connectivity"].shape == (3 * TRIANGLES,)
        points = file["VTKHDF/Points"]
        assert points.dtype == numpy.float32
        assert points.compression == (None if compression == "none" else "gzip")
        assert (points.id.get_storage_size() < points.nbytes) == (compression != "none")
        assert list(file["weft/bodies"].asstr()) == ["lower", "upper & <last>"]


def test_xdmf_points_at_the_same_data(finished):
    """Its items name datasets with the extents that it says, relative to its own folder."""
    root = xml.etree.ElementTree.parse(finished.with_suffix(".xdmf")).getroot()
    grids = root.findall("./Domain/Grid/Grid")
    assert len(grids) == 30
    assert numpy.allclose([float(grid.find("Time").get("Value")) for grid in grids],
                          numpy.arange(30) / 60)
    with h5py.File(finished) as file:
        for index, grid in enumerate(grids):
            for item in grid.iter("DataItem"):
                name, dataset = item.text.split(":")
                assert name == "frames.vtkhdf"
                extents = [int(word) for word in item.get("Dimensions").split()]
                assert numpy.prod(extents) == file[dataset].size
            positions = file[grid.find("Geometry/DataItem").text.split(":")[1]][:]
            direct = file["VTKHDF/Points"][index * VERTICES:(index + 1) * VERTICES]
            assert numpy.array_equal(positions, direct)


def check_in_new_process(path, at_least):
    """A crash of VTK must fail one test, not end all of them."""
    code = (f"import test_geometry_files as t; r = t.open_reader({str(path)!r});"
            f"n = r.GetNumberOfSteps(); assert n >= {at_least}, n; t.check_step(r, n - 1)")
    subprocess.run([sys.executable, "-c", code], check=True, cwd=pathlib.Path(__file__).parent)


def test_vtk_reads_a_running_simulation(tmp_path):
    """Files are whole between steps. Who comes while one is being written comes again."""
    process = start_run(tmp_path / "frames.vtkhdf", 400, 40, seen=5)
    for attempt in range(5):
        try:
            check_in_new_process(tmp_path / "frames.vtkhdf", at_least=4)
            break
        except subprocess.CalledProcessError:
            if attempt == 4:
                raise
    assert process.poll() is None, "it was still running"
    process.kill()
    process.wait()


@pytest.mark.parametrize("seen", [1, 7, 41])
def test_vtk_reads_what_a_killed_run_left(tmp_path, seen):
    path = tmp_path / "frames.vtkhdf"
    process = start_run(path, 2000, 3, seen)
    process.kill()
    process.wait()
    handed_over = seen + len(process.stdout.read().splitlines())
    if handed_over > 1:
        check_in_new_process(path, at_least=handed_over - 1)
    xml.etree.ElementTree.parse(path.with_suffix(".xdmf"))
