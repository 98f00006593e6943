"""The results, as rows for JSON and as a table."""

import dataclasses
import os
import platform
import statistics


def rows(result):
    """A dictionary per measured system, in the order in which they were set up."""
    return [_row(measured, result.measured) for measured in result.measured.values()]


def _row(measured, all_measured):
    ms = [1e3 * seconds for seconds in measured.seconds]
    numbers = range(len(ms))
    row = {
        "system": measured.description.name,
        "version": measured.version,
        "what": measured.description.what,
        "ms_per_frame": statistics.median(ms),
        "ms_lowest": min(ms),
        "ms_highest": max(ms),
        "unit": measured.description.unit,
        "units_per_frame": measured.units_per_frame,
        "ns_per_unit": statistics.median(map(measured.ns_per_unit, numbers)),
        **measured.shape,
    }
    counterpart = all_measured.get(measured.description.counterpart)
    if counterpart and counterpart is not measured:
        ratios = [measured.ns_per_unit(n) / counterpart.ns_per_unit(n) for n in numbers]
        row |= {"counterpart": counterpart.description.name, "ratio": statistics.median(ratios),
                "ratio_lowest": min(ratios), "ratio_highest": max(ratios)}
    return row


def as_json(result, sheet, rounds, frames, core):
    return {
        "sheet": dataclasses.asdict(sheet),
        "rounds": rounds,
        "frames_per_turn": frames,
        "machine": {"processor": processor(), "core": core, "load": _load()},
        "systems": rows(result),
        "missing": [{"system": name, "why": why} for name, why in result.missing.items()],
        "failed": [{"system": name, "why": why} for name, why in result.failed.items()],
    }


def as_text(document):
    sheet = document["sheet"]
    stack = f"stack of {sheet['sheets']} sheets of " if "sheets" in sheet else ""
    head = (f"{stack}{sheet['resolution']} x {sheet['resolution']} particles, "
            f"{sheet['substeps']} substeps x {sheet['iterations']} iterations per frame, "
            f"one core of {_machine(document)}; "
            f"rounds: {document['rounds']}, of {document['frames_per_turn']} frames")
    lines = [head, "", _line("system", "ms/frame", "lowest..highest", "ns per", "", "x Weft",
                             "lowest..highest", "mean y", "longest edge", "crossings",
                             "what")]
    for row in document["systems"]:
        ratio, spread = "-", ""
        if "ratio" in row:
            ratio = f"{row['ratio']:.2f}"
            spread = f"{row['ratio_lowest']:.2f}..{row['ratio_highest']:.2f}"
        lines.append(_line(
            row["system"], f"{row['ms_per_frame']:.2f}",
            f"{row['ms_lowest']:.2f}..{row['ms_highest']:.2f}", f"{row['ns_per_unit']:.1f}",
            row["unit"], ratio, spread, _number(row["mean_height"], 3),
            _number(row["longest_edge"], 2), _number(row["crossings"], 0), row["what"]))
    lines += ["", "x Weft: ns per projection or vertex update over that of Weft's system with the "
              "same method, with", "bending if the peer has it, round by round. mean y [m] and "
              "longest edge (of its length at the", "start) are of the last frame, as are "
              "crossings: pairs of triangles, in a stack. Systems differ in their", "energies: see "
              "docs/measurements.md."]
    return "\n".join(lines)


def _line(*cells):
    widths = [23, 9, 17, 8, 13, 7, 15, 7, 12, 9, 0]
    left = {0, 4, 10}
    return "  ".join(f"{cell:<{width}}" if column in left else f"{cell:>{width}}"
                     for column, (cell, width) in enumerate(zip(cells, widths))).rstrip()


def _number(value, digits):
    return "-" if value is None else f"{value:.{digits}f}"


def _machine(document):
    machine = document["machine"]
    load = "" if machine["load"] is None else f" (load {machine['load']:.2f} at the end)"
    pinned = "" if machine["core"] is not None else ", not pinned to a core"
    return machine["processor"] + load + pinned


def _load():
    """How many processes wanted to run during the last minute; these measurements are one."""
    return os.getloadavg()[0] if hasattr(os, "getloadavg") else None


def processor():
    try:
        with open("/proc/cpuinfo") as file:
            for line in file:
                if line.startswith("model name"):
                    return line.split(":", 1)[1].strip()
    except OSError:
        pass  # not on Linux
    return platform.processor() or platform.machine()
