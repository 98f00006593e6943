"""python -m weft_analysis makespan|energy TRACE -o out.png, surface GEOMETRY, sweep CSV, convergence SCENE"""

import argparse
import sys

from .trace import Trace, TraceError


def main(arguments=None):
    options = _parse(arguments)
    # Imported late: matplotlib takes a second, and a wrong path should not.
    import matplotlib
    matplotlib.use("Agg")
    from . import convergence, pictures, surface, sweep

    try:
        if options.command == "surface":
            figure = surface.surface(options.geometry, options.step)
            figure.savefig(options.output, dpi=150)
            return 0
        if options.command == "sweep":
            figure = sweep.plot(sweep.read(options.results), options.x, options.y, options.colour,
                                options.panel)
            figure.savefig(options.output, dpi=150)
            return 0
        if options.command == "convergence":
            figure = convergence.convergence(options.weft, options.scene, options.devices,
                                             options.iterations)
            figure.savefig(options.output, dpi=100)
            return 0
        with Trace(options.trace) as trace:
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
    swept = commands.add_parser("sweep", help="small multiples over the axes of a sweep",
                                description="Draws results.csv of weft batch --collect.")
    swept.add_argument("results", metavar="CSV", help="results.csv of a sweep")
    swept.add_argument("--x", required=True, help="column: an axis, as in solver.iterations")
    swept.add_argument("--y", required=True, help="column: a result, as in ms_per_frame")
    swept.add_argument("--colour", help="column: a colour per value")
    swept.add_argument("--panel", help="column: a panel per value")
    swept.add_argument("-o", "--output", required=True, help="picture: .png, .svg or .pdf")
    converged = commands.add_parser(
        "convergence", help="how asynchronous iterations converge: the paper's figures 4 and 7",
        description="Runs weft error and weft run, and draws the paper's figures 4 and 7 for a "
                    "scene; prints where each curve ends.")
    converged.add_argument("scene", metavar="SCENE", help="of cloth, with a ball as an obstacle")
    converged.add_argument("--weft", default="weft", help="the program (default: weft)")
    converged.add_argument("--devices", default="cpu/1+cpu/1",
                           help="two of one speed (default: cpu/1+cpu/1)")
    converged.add_argument("--iterations", type=int, default=100,
                           help="that curves go to (default: 100)")
    converged.add_argument("-o", "--output", required=True, help="picture: .png, .svg or .pdf")
    return parser.parse_args(arguments)


if __name__ == "__main__":
    sys.exit(main())
