"""`./dev peers`: Weft beside the simulators that people would use instead, on one core, in turn."""

import argparse
import json
import os
import pathlib
import sys
import tempfile

import report
from rounds import Rounds
from sheet import Sheet
from stack import Stack
from systems import ALL, STACKED, named

PROJECT = pathlib.Path(__file__).resolve().parents[2]

EPILOG = """\
Every system simulates the same sheet in a process of its own, and they take turns, so that a change
of the machine's speed meets all alike; nobody else runs meanwhile. A package that is not installed
is named, and left out. Exit codes: 0 done; 1 a system failed, or what it computed is no hanging
cloth; 2 the request was wrong.

systems: {systems};
with --stack: {stacked}

Examples:
  ./dev peers --resolution 200 --rounds 3 --only weft,newton-vbd-bend
  ./dev peers --stack 5 --resolution 20"""


class Parser(argparse.ArgumentParser):
    def error(self, message):
        fail(2, message)


def fail(code, message):
    print(f"peers: error: {message}", file=sys.stderr)
    sys.exit(code)


def say(text):
    print(f"peers: {text}", file=sys.stderr, flush=True)


def at_least(lowest):
    def number(text):
        value = int(text)
        if value < lowest:
            raise argparse.ArgumentTypeError(f"{value} is less than {lowest}")
        return value

    number.__name__ = "integer"
    return number


def arguments():
    parser = Parser(prog="./dev peers", description=__doc__.split(": ", 1)[1],
                    formatter_class=argparse.RawDescriptionHelpFormatter,
                    epilog=EPILOG.format(systems=names(ALL), stacked=names(STACKED)))
    parser.add_argument("--stack", type=at_least(2), metavar="N",
                        help="N sheets in contact, the lowest held by its corners, where else one "
                             "sheet hangs by two; crossings are counted")
    parser.add_argument("--resolution", type=at_least(4), metavar="N",
                        help="N x N particles (100; in a stack 30)")
    parser.add_argument("--substeps", type=at_least(1), default=10, metavar="N",
                        help="steps per frame of 1/60 s (10)")
    parser.add_argument("--iterations", type=at_least(1), default=8, metavar="N",
                        help="iterations per substep (8)")
    parser.add_argument("--rounds", type=at_least(1), metavar="N",
                        help="turns of each system (7; of a stack 1)")
    parser.add_argument("--frames", type=at_least(1), metavar="N",
                        help="frames per turn, of which the median counts (3; of a stack 15)")
    parser.add_argument("--only", default="", metavar="NAMES",
                        help="systems or families of them (weft, newton, pypbd), with commas")
    parser.add_argument("--weft", type=pathlib.Path, metavar="PATH",
                        default=PROJECT / "build/release/bin/weft", help="the program")
    parser.add_argument("--json", action="store_true", help="print one JSON document")
    parser.add_argument("--quiet", action="store_true", help="say nothing but results and errors")
    return with_defaults(parser.parse_args())


def with_defaults(options):
    """Frames of a stack differ, as contacts come: one long turn says more of them than many."""
    defaults = (30, 1, 15) if options.stack else (100, 7, 3)
    for name, value in zip(("resolution", "rounds", "frames"), defaults):
        if getattr(options, name) is None:
            setattr(options, name, value)
    return options


def names(descriptions):
    return ", ".join(description.name for description in descriptions)


def chosen_systems(only, those):
    try:
        return named([name for name in only.split(",") if name], those)
    except KeyError as unknown:
        fail(2, f"--only: there is no system {unknown}; there are: {names(those)}")


def chosen_problem(options):
    size = (options.resolution, options.substeps, options.iterations)
    return Stack(*size, options.stack) if options.stack else Sheet(*size)


def core_to_use():
    """The last core that this process may use; None where processes cannot be pinned."""
    return max(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else None


def main():
    options = arguments()
    systems = chosen_systems(options.only, STACKED if options.stack else ALL)
    if not options.weft.is_file():
        fail(2, f"--weft: there is no program {options.weft}; `./dev weft --version` builds it")
    sheet = chosen_problem(options)
    core = core_to_use()
    with tempfile.TemporaryFile() as log:
        result = Rounds((lambda text: None) if options.quiet else say)
        result.run(systems, sheet, options.weft.resolve(), core, options.rounds, options.frames,
                   log)
    document = report.as_json(result, sheet, options.rounds, options.frames, core)
    print(json.dumps(document, indent=2) if options.json else report.as_text(document))
    for name, why in result.missing.items():
        say(f"left out {name}: {why}")
    for row in document["systems"]:
        if row["complaint"]:
            result.failed[row["system"]] = f"this is no hanging cloth: {row['complaint']}"
    for name, why in result.failed.items():
        print(f"peers: error: {name}: {why}", file=sys.stderr)
    sys.exit(1 if result.failed else 0)


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        sys.exit(130)
