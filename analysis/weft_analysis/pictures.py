"""The pictures: functions from a Trace to a matplotlib Figure."""

import numpy
from matplotlib import pyplot

from .trace import TraceError

# Okabe and Ito's colours can be told apart by most colour-blind people.
COLOURS = ["#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#D55E00", "#F0E442", "#999999"]

STYLE = {
    "font.size": 9, "axes.titlesize": 10, "axes.spines.top": False, "axes.spines.right": False,
    "axes.grid": True, "grid.color": "#e6e6e6", "axes.axisbelow": True, "legend.frameon": False,
}


def makespan(trace):
    """Planned against measured makespan over the frames, and the relative error."""
    frames = _some_frames(trace)
    number = frames["frame"]
    planned, measured = frames["planned_makespan"], frames["measured_makespan"]
    with numpy.errstate(divide="ignore", invalid="ignore"):
        error = 100 * (measured - planned) / planned
    with pyplot.rc_context(STYLE):
        figure, (top, bottom) = pyplot.subplots(2, 1, sharex=True, layout="constrained",
                                                figsize=(10, 5.4), height_ratios=[2, 1])
        top.plot(number, 1e3 * measured, color=COLOURS[5], label="measured", linewidth=1.4)
        top.plot(number, 1e3 * planned, color=COLOURS[0], label="planned", linewidth=1.4)
        if numpy.any(frames["lower_bound"] > 0):
            top.plot(number, 1e3 * frames["lower_bound"], color="#777777", linestyle=":",
                     label="lower bound")
        top.set_ylim(bottom=0, top=1.15e3 * max(planned.max(), _most(measured)))
        top.set_ylabel("makespan of a frame [ms]")
        top.legend(loc="lower right", ncols=3)
        bottom.axhspan(-10, 10, color=COLOURS[2], alpha=0.12, linewidth=0)
        bottom.plot(number, error, color="#444444", linewidth=1.0)
        bottom.set_ylim(-_error_limit(error), _error_limit(error))
        bottom.set_ylabel("measured - planned [%]")
        bottom.set_xlabel("frame")
        if len(number) > 1:
            bottom.set_xlim(number[0], number[-1])
        top.set_title(_median_error(error), loc="left")
        figure.suptitle(f"{trace.scene_name}: planned against measured", fontsize=11)
    return figure


def energy(trace):
    """All energies over simulated time."""
    frames = _some_frames(trace)
    energies = trace.table("energies")[:len(frames)]
    time = frames["sim_time"][:len(energies)]
    names = [name for name in energies.dtype.names if name not in ("frame", "total")]
    with pyplot.rc_context(STYLE):
        figure, axis = pyplot.subplots(layout="constrained", figsize=(10, 4.2))
        for index, name in enumerate(names):
            axis.plot(time, energies[name], color=COLOURS[index % len(COLOURS)], label=name,
                      linewidth=1.4)
        axis.plot(time, energies["total"], color="black", label="total", linewidth=1.8)
        for name, style in (("work", ":"), ("dissipated", "--")):
            if name in frames.dtype.names:  # not in traces of earlier versions
                axis.plot(time, frames[name][:len(time)], color="black", label=name,
                          linewidth=1.0, linestyle=style)
        axis.set_xlabel("simulated time [s]")
        axis.set_ylabel("energy [J]")
        if len(time) > 1:
            axis.set_xlim(time[0], time[-1])
        axis.legend(loc="upper left", bbox_to_anchor=(1, 1))
        figure.suptitle(f"{trace.scene_name}: energies", fontsize=11)
    return figure


def close(figure):
    """Frees a picture; matplotlib keeps those that nobody closes."""
    pyplot.close(figure)


def _some_frames(trace):
    if len(trace.frames) == 0:
        raise TraceError(f"{trace.path}: the trace has no complete frame")
    return trace.frames


def _most(values):
    """The highest value that is no outlier: one slow frame must not flatten the picture."""
    return min(values.max(), 2 * numpy.quantile(values, 0.95))


def _median_error(error):
    """The first frames are planned with costs that are hardly known yet."""
    first = 5 if len(error) > 5 else 0
    after = " after the first 5 frames" if first else ""
    return f"median error {numpy.nanmedian(numpy.abs(error[first:])):.1f} %{after}"


def _error_limit(error):
    finite = numpy.abs(error[numpy.isfinite(error)])
    return numpy.clip(1.2 * numpy.quantile(finite, 0.95), 20, 100) if len(finite) else 20
