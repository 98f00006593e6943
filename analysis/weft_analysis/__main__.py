"""python -m weft_analysis schedule|makespan|energy TRACE -o out.png, and surface GEOMETRY"""

import argparse
import sys

from .trace import Trace, TraceError


def main(arguments=None):
    options = _parse(arguments)
    # Imported late: matplotlib takes a second, and a wrong path should not.
    import matplotlib
    matplotlib.use("Agg")
    from . import pictures, surface

    try:
        if options.command == "surface":
            figure = surface.surface(options.geometry, options.step)
            figure.savefig(options.output, dpi=150)
            return 0
        with Trace(options.trace) as trace:
            if options.command == "schedule":
                figure = pictures.schedule(trace, options.frame, options.substep)
            else:
                figure = getattr(pictures, options.command)(trace)
        figure.savefig(options.output, dpi=150)
        pictures.close(figure)
    except (TraceError, OSError, ValueError) as error:
        print(f"weft_analysis: error: {error}", file=sys.stderr)
        return 2
    return 0


def _parse(arguments):
    parser = argparse.ArgumentParser(prog="python -m weft_analysis",
                                     description="Draws the trace of a run of Weft.")
    commands = parser.add_subparsers(dest="command", required=True)
    descriptions = {
        "schedule": "one substep by device: planned above measured",
        "makespan": "planned against measured makespan over the frames",
        "energy": "the energies over simulated time",
    }
    for name, description in descriptions.items():
        command = commands.add_parser(name, help=description, description=description)
        command.add_argument("trace", metavar="TRACE", help="trace.h5 of a run, finished or not")
        command.add_argument("-o", "--output", required=True, help="picture: .png, .svg or .pdf")
    drawn = commands.add_parser("surface", help="the cloth at one step of frames.vtkhdf",
                                description="Draws the cloth at one step of frames.vtkhdf.")
    drawn.add_argument("geometry", metavar="GEOMETRY", help="frames.vtkhdf of a run")
    drawn.add_argument("-o", "--output", required=True, help="picture: .png, .svg or .pdf")
    drawn.add_argument("--step", type=int, help="0 is the start; default: the last one")
    schedule = commands.choices["schedule"]
    schedule.add_argument("--frame", type=int, help="its number; default: the last complete one")
    schedule.add_argument("--substep", type=int, default=0, help="default: 0")
    return parser.parse_args(arguments)


if __name__ == "__main__":
    sys.exit(main())
