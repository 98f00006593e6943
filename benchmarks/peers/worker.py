"""A system in a process of its own, on one core, that simulates only when it is told to.

`python worker.py` reads requests from its standard input, one JSON document a line, and answers so:

    {"make": name, "sheet": {...}, "weft": path, "core": n}   {"version": .., "units_per_frame": ..}
    {"advance": frames}                                       {"times": [seconds, ...]}
    {"look": true}                              {"mean_height": .., ...}   see sheet.Shape

or {"missing": reason} or {"error": text}. It ends when its input does.
"""

import dataclasses
import json
import os
import subprocess
import sys

from sheet import Sheet, look_at
from stack import Stack
from systems import ALL, STACKED, Missing

ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}


class Failed(Exception):
    """The system did not do what it was asked; the text is what it said."""


class Worker:
    """The other end: starts the process, and asks it."""

    def __init__(self, description, sheet, weft, core, log):
        self.description = description
        self._process = subprocess.Popen(
            [sys.executable, __file__], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=log,
            env=dict(os.environ, **ONE_THREAD), text=True)
        request = {"make": description.name, "sheet": dataclasses.asdict(sheet), "weft": str(weft),
                   "core": core}
        try:
            answer = self._ask(request)
        except BaseException:
            self.close()
            raise
        self.version = answer["version"]
        self.units_per_frame = answer["units_per_frame"]

    def advance(self, frames):
        return self._ask({"advance": frames})["times"]

    def look(self):
        return self._ask({"look": True})

    def close(self):
        self._process.stdin.close()
        self._process.wait()

    def _ask(self, request):
        try:
            self._process.stdin.write(json.dumps(request) + "\n")
            self._process.stdin.flush()
            line = self._process.stdout.readline()
        except BrokenPipeError:
            line = ""
        if not line:
            raise Failed(f"its process ended by itself (exit code {self._process.wait()})")
        answer = json.loads(line)
        if "missing" in answer:
            raise Missing(answer["missing"])
        if "error" in answer:
            raise Failed(answer["error"])
        return answer


def make(request):
    if request["core"] is not None:
        os.sched_setaffinity(0, {request["core"]})
    kind = Stack if "sheets" in request["sheet"] else Sheet
    sheet = kind(**request["sheet"])
    (description,) = [d for d in ALL + STACKED if d.name == request["make"]]
    return sheet, description.make(sheet, request["weft"])


def serve(requests, answers):
    sheet = system = None

    def answer_to(request):
        nonlocal sheet, system
        if "make" in request:
            sheet, system = make(request)
            return {"version": system.version, "units_per_frame": system.units_per_frame}
        if "advance" in request:
            return {"times": system.advance(request["advance"])}
        return dataclasses.asdict(look_at(sheet, *system.positions()))

    for line in requests:
        try:
            answer = answer_to(json.loads(line))
        except Missing as missing:
            answer = {"missing": str(missing)}
        except Exception as error:  # whatever a peer throws is a result of the comparison
            answer = {"error": f"{type(error).__name__}: {error}"}
        answers.write(json.dumps(answer) + "\n")
        answers.flush()


if __name__ == "__main__":
    # Packages talk on stdout as they please; what they say goes where stderr goes.
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    serve(sys.stdin, answers)
