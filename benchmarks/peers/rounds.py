"""One interleaved run: all systems take turns, so that a change of the machine's speed, which may
be as large as what is measured, meets all of them alike."""

import contextlib
import dataclasses
import random
import statistics

from systems import Description, Missing
from worker import Failed, Worker


@dataclasses.dataclass
class Measured:
    """A system and its turns."""

    description: Description
    version: str
    units_per_frame: int
    seconds: list = dataclasses.field(default_factory=list)  # per frame, of each round
    shape: dict = dataclasses.field(default_factory=dict)  # of its sheet at the end

    def ns_per_unit(self, round_number):
        return 1e9 * self.seconds[round_number] / self.units_per_frame


class Rounds:
    """Systems that take turns. One that is missing or fails is left out from there on."""

    def __init__(self, say):
        self.measured = {}  # by name; those that got to the end
        self.missing = {}  # name -> why it cannot be had here
        self.failed = {}  # name -> what went wrong
        self._workers = {}
        self._say = say

    def run(self, descriptions, sheet, weft, core, rounds, frames, log):
        try:
            for description in descriptions:
                self._say(f"setting up {description.name}")
                with self._leaving_out(description.name):
                    self._set_up(Worker(description, sheet, weft, core, log))
            order = random.Random(1)  # the same in each run
            for number in range(rounds):
                self._say(f"round {number + 1} of {rounds}")
                self._take_turns(order, lambda name, worker: self.measured[name].seconds.append(
                    statistics.median(worker.advance(frames))))
            self._take_turns(order, lambda name, worker: self.measured[name].shape.update(
                worker.look()))
        finally:
            for worker in self._workers.values():
                worker.close()

    def _set_up(self, worker):
        self._workers[worker.description.name] = worker
        self.measured[worker.description.name] = Measured(worker.description, worker.version,
                                                          worker.units_per_frame)

    def _take_turns(self, order, turn):
        names = list(self._workers)
        order.shuffle(names)
        for name in names:
            with self._leaving_out(name):
                turn(name, self._workers[name])

    @contextlib.contextmanager
    def _leaving_out(self, name):
        """What is done with this system; if it cannot be done, the system is out."""
        try:
            yield
        except Missing as missing:
            self.missing[name] = str(missing)
        except Failed as failure:
            self.failed[name] = str(failure)
        else:
            return
        self.measured.pop(name, None)
        if name in self._workers:
            self._workers.pop(name).close()
