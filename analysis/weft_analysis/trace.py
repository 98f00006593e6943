"""Access to a trace: a finished one, one that is being written, or what a killed run left."""

import os
import pathlib

import h5py
import numpy

FORMAT = "weft-trace"
FORMAT_VERSION = 1


class TraceError(Exception):
    """A file that cannot be read as a trace; the message says why."""


class Trace:
    """A trace with its complete frames. Usable as a context manager.

    Tables come as numpy structured arrays; docs/trace-format.md documents their columns.
    """

    def __init__(self, path):
        self.path = pathlib.Path(path)
        self._file = _open(self.path)
        try:
            self._check_format()
            run = self._file["run"]
            self.kinds = list(run["kinds"].asstr())
            self.energies = list(run["energies"].asstr())
            self.devices = [_device(row) for row in run["devices"][:]]
            self.scene_name = run.attrs["scene_name"]
            self.command = run.attrs["command"]
            self.settings = dict(run["settings"].attrs)
            self.versions = dict(run["versions"].attrs)
            self.finished = bool(self._file.attrs["finished"])
            self.state_hash = self._file.attrs["state_hash"]
            self.frames = self._file["frames"][:]
        except (KeyError, OSError) as error:
            self.close()
            raise TraceError(f"{self.path}: cannot read the trace: {error}") from error
        except TraceError:
            self.close()
            raise

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        self._file.close()

    def table(self, name, frame=None):
        """Rows of a table, of all complete frames or of one; none if there is no such table.

        `divisions` and `dependencies` have rows by task graph: these are the graphs that the
        frames name. A frame without a recorded graph has none.
        """
        if name not in self._file:
            return numpy.empty(0, dtype=[("frame", numpy.uint32)])
        data = self._file[name]
        if "graph" in data.dtype.names and "frame" not in data.dtype.names:
            chosen = self.frames if frame is None else self.frames[self.frames["frame"] == frame]
            return data[numpy.isin(data.fields("graph")[:], chosen["graph"])]
        numbers = data.fields("frame")[:]
        if frame is None:
            last = self.frames["frame"][-1] if len(self.frames) else -1
            return data[:numpy.searchsorted(numbers, last, side="right")]
        begin, end = numpy.searchsorted(numbers, frame), numpy.searchsorted(numbers, frame, "right")
        return data[begin:end]

    def device_name(self, index):
        """Number, kind and units of a device, short enough for a picture."""
        device = self.devices[index]
        return f"{index}  {device['kind']}/{device['units']}"

    def _check_format(self):
        attributes = self._file.attrs
        if attributes.get("format") != FORMAT:
            raise TraceError(f"{self.path}: not a trace of Weft: its attribute 'format' is not "
                             f'"{FORMAT}"')
        if attributes["format_version"] != FORMAT_VERSION:
            raise TraceError(f"{self.path}: trace format version {attributes['format_version']}; "
                             f"this reader knows version {FORMAT_VERSION}")


def _open(path):
    if not path.is_file():
        raise TraceError(f"{path}: no such trace")
    if not h5py.is_hdf5(os.fspath(path)):
        raise TraceError(f"{path}: not a trace: it is not an HDF5 file")
    try:
        return h5py.File(path, "r")
    except OSError:
        pass  # it is being written, or its writer was killed
    try:
        return h5py.File(path, "r", swmr=True)
    except OSError as error:
        raise TraceError(f"{path}: cannot read the trace: {error}") from error


def _device(row):
    names = row.dtype.names
    return {name: row[name].decode() if isinstance(row[name], bytes) else row[name].item()
            for name in names}
