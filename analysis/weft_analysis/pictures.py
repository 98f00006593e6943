"""The pictures: functions from a Trace to a matplotlib Figure."""

import numpy
from matplotlib import pyplot
from matplotlib.patches import Patch

from .trace import TraceError

# Okabe and Ito's colours can be told apart by most colour-blind people; kinds beyond them repeat
# the colours with a hatch.
COLOURS = ["#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#D55E00", "#F0E442", "#999999"]
HATCHES = ["", "///", "...", "xxx"]

STYLE = {
    "font.size": 9, "axes.titlesize": 10, "axes.spines.top": False, "axes.spines.right": False,
    "axes.grid": True, "grid.color": "#e6e6e6", "axes.axisbelow": True, "legend.frameon": False,
    "hatch.linewidth": 0.5,
}


def schedule(trace, frame=None, substep=0):
    """One substep of a frame by device: as planned, and as it ran below it."""
    frame = _frame_number(trace, frame)
    plan = trace.table("plan", frame)
    executions = trace.table("executions", frame)
    executions = executions[executions["substep"] == substep]
    if len(executions) == 0:
        raise TraceError(f"{trace.path}: frame {frame} has no substep {substep}")
    kind_of = dict(zip(plan["task"], plan["kind"]))
    kinds = numpy.array([kind_of[task] for task in executions["task"]])
    transfers = trace.table("transfers", frame)
    if len(transfers):
        transfers = transfers[transfers["substep"] == substep]
    begin = executions["start"].min()

    devices = range(len(trace.devices))
    with pyplot.rc_context(STYLE):
        figure, axes = pyplot.subplots(2, 1, sharex=True, layout="constrained",
                                       figsize=(10, 1.6 + 0.9 * len(devices)))
        planned, measured = axes
        _bars(planned, plan["device"], plan["kind"], plan["start"], plan["end"])
        _bars(measured, executions["device"], kinds, executions["start"] - begin,
              executions["end"] - begin)
        if len(transfers):
            _arrows(measured, transfers, begin)
        for axis, label, end in ((planned, "planned", plan["end"].max()),
                                 (measured, "measured", executions["end"].max() - begin)):
            _device_axis(axis, trace)
            axis.set_title(f"{label}: {1e3 * end:.3f} ms", loc="left")
            axis.axvline(1e3 * end, color="#444444", linewidth=0.8, linestyle="--")
        measured.set_xlabel("time since the substep's start [ms]")
        measured.set_xlim(left=0)
        _kind_legend(measured, trace, plan["kind"], len(transfers) > 0)
        figure.suptitle(f"{trace.scene_name}: frame {frame}, substep {substep}", fontsize=11)
    return figure


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


def _frame_number(trace, frame):
    numbers = _some_frames(trace)["frame"]
    if frame is None:
        return numbers[-1]
    if frame not in numbers:
        raise TraceError(f"{trace.path}: no frame {frame}; it has {numbers[0]} to {numbers[-1]}")
    return frame


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


def _bars(axis, devices, kinds, start, end):
    """A row for each device. White edges part the tasks, but would hide the very short ones."""
    short = end - start < 0.004 * (end.max() - start.min())
    for kind in numpy.unique(kinds):
        for device in numpy.unique(devices):
            for edge, chosen in (("white", ~short), (_colour(kind), short)):
                chosen = chosen & (kinds == kind) & (devices == device)
                spans = numpy.column_stack((1e3 * start[chosen], 1e3 * (end - start)[chosen]))
                axis.broken_barh(spans, (device - 0.38, 0.76), facecolor=_colour(kind),
                                 hatch=_hatch(kind), edgecolor=edge, linewidth=0.5)


def _arrows(axis, transfers, begin):
    for row in transfers:
        axis.annotate("", xy=(1e3 * (row["end"] - begin), row["to"]),
                      xytext=(1e3 * (row["start"] - begin), row["from"]),
                      arrowprops={"arrowstyle": "-|>", "color": "black", "linewidth": 0.7,
                                  "shrinkA": 0, "shrinkB": 0, "mutation_scale": 7})


def _device_axis(axis, trace):
    count = len(trace.devices)
    axis.set_yticks(range(count), [trace.device_name(index) for index in range(count)])
    axis.set_ylim(count - 0.5, -0.5)
    axis.grid(axis="y", visible=False)
    axis.tick_params(axis="y", length=0)


def _kind_legend(axis, trace, kinds, with_transfers):
    handles = [Patch(facecolor=_colour(kind), hatch=_hatch(kind), edgecolor="white",
                     label=trace.kinds[kind]) for kind in numpy.unique(kinds)]
    if with_transfers:
        handles.append(pyplot.Line2D([], [], color="black", marker=">", markersize=4,
                                     linewidth=0.7, label="transfer"))
    # An axis' legend, not the figure's: matplotlib before 3.7 leaves no room for that one.
    axis.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, 0), borderaxespad=4.5,
                ncols=min(len(handles), 6))


def _colour(kind):
    return COLOURS[kind % len(COLOURS)]


def _hatch(kind):
    return HATCHES[kind // len(COLOURS) % len(HATCHES)]
