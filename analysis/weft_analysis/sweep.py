"""Results of a sweep (results.csv of `weft batch --collect`): small multiples over its axes."""

import csv
import math

import matplotlib.pyplot as plt

_MARKS = "osD^v<>Px*"


def read(path):
    """A dict per run that is finished, with numbers where a cell is one."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    if not rows or "state" not in rows[0]:
        raise ValueError(f"{path}: no results of a sweep; 'weft batch SWEEP --collect' writes them")
    rows = [{key: _value(cell) for key, cell in row.items()} for row in rows
            if row["state"] == "finished"]
    if not rows:
        raise ValueError(f"{path}: no run is finished yet")
    return rows


def plot(rows, x, y, colour=None, panel=None):
    """A figure with one panel per value of `panel`, one colour per value of `colour`, and `y` over
    `x`. Runs that share all of these, such as repeats, are a mark each, and their median the line."""
    for name in filter(None, (x, y, colour, panel)):
        if name not in rows[0]:
            raise ValueError(f"there is no column '{name}'; there is {', '.join(rows[0])}")
    panels = _values(rows, panel)
    columns = min(len(panels), 4)
    figure, axes = plt.subplots(math.ceil(len(panels) / columns), columns, squeeze=False,
                                sharex=True, sharey=True, layout="constrained",
                                figsize=(3.2 * columns + 1.5, 3.0 * math.ceil(len(panels) / columns)))
    colours = _values(rows, colour)
    for axis, name in zip(axes.flat, panels):
        for number, value in enumerate(colours):
            chosen = [row for row in rows if (panel is None or row[panel] == name)
                      and (colour is None or row[colour] == value)]
            _draw(axis, chosen, x, y, number, value)
        if panel is not None:
            axis.set_title(f"{panel} = {name}", fontsize=9)
        axis.grid(alpha=0.3)
    for axis in axes.flat[len(panels):]:
        axis.set_visible(False)
    _scales(axes, rows, x, y)
    figure.supxlabel(x, fontsize=10)
    figure.supylabel(y, fontsize=10)
    if colour is not None:
        handles, labels = axes.flat[0].get_legend_handles_labels()
        figure.legend(handles, labels, title=colour, loc="outside right upper", fontsize=8)
    return figure


def _value(cell):
    try:
        return float(cell)
    except ValueError:
        return cell


def _values(rows, column):
    """Different values in the order in which they come; one for no column."""
    return [None] if column is None else list(dict.fromkeys(row[column] for row in rows))


def _draw(axis, rows, x, y, number, label):
    points = [(row[x], row[y]) for row in rows if row[x] != "" and isinstance(row[y], float)]
    if not points:
        return
    groups = {}
    for px, py in points:
        groups.setdefault(px, []).append(py)
    numeric = all(isinstance(px, float) for px in groups)
    places = sorted(groups) if numeric else list(groups)
    medians = [sorted(groups[px])[len(groups[px]) // 2] for px in places]
    style = {"color": f"C{number}", "marker": _MARKS[number % len(_MARKS)]}
    axis.plot(places, medians, markersize=4, linewidth=1.2, label=str(label), **style)
    if len(points) > len(groups):
        axis.scatter(*zip(*points), s=8, alpha=0.4, **style)


def _scales(axes, rows, x, y):
    """Logarithmic where all values are positive and lie apart by more than a power of ten."""
    for name, choose in ((x, "set_xscale"), (y, "set_yscale")):
        values = [row[name] for row in rows if row[name] != ""]
        if all(isinstance(v, float) and v > 0 for v in values) and max(values) > 10 * min(values):
            for axis in axes.flat:
                getattr(axis, choose)("log")
