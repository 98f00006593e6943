"""The systems that are compared: their names, and how each is made.

A system is a class with

    Name(sheet, options)        sets everything up, first compilation and first frame included
    version                     text, of the package
    units_per_frame             constraint projections, or vertex updates, that a frame takes
    advance(frames)             simulates on; returns a list of times [s], for these frames
    positions()                 array (vertices, 3) after all frames so far, y up, and their number

It may use one core only, and must leave nothing running between two calls.
"""

import dataclasses
import importlib

PROJECTION = "projection"
VERTEX_UPDATE = "vertex update"


class Missing(Exception):
    """The system cannot be had on this machine; the text says why and what would help."""


@dataclasses.dataclass(frozen=True)
class Description:
    name: str
    module: str
    options: dict
    unit: str
    counterpart: str  # the system of Weft that does the same
    what: str  # in a few words, for the table's legend

    @property
    def family(self):
        return self.name.split("-")[0]

    def make(self, sheet, weft):
        """The system itself. Throws Missing, or whatever its package throws."""
        module = importlib.import_module(self.module)
        return module.make(sheet, weft=weft, **self.options)


def _weft(name, method, bend, what):
    unit = PROJECTION if method == "xpbd" else VERTEX_UPDATE
    return Description(name, "weft_system", {"method": method, "bend": bend}, unit, name, what)


def _newton_xpbd(name, bend, what):
    counterpart = "weft-xpbd-bend" if bend else "weft-xpbd"
    return Description(name, "newton_xpbd_system", {"bend": bend}, PROJECTION, counterpart, what)


def _newton_vbd(name, stretch, bend, what):
    counterpart = "weft-vbd-bend" if bend else "weft-vbd"
    return Description(name, "newton_vbd_system", {"stretch": stretch, "bend": bend},
                       VERTEX_UPDATE, counterpart, what)


def _pypbd(name, bend, what):
    counterpart = "weft-xpbd-bend" if bend else "weft-xpbd"
    return Description(name, "pypbd_system", {"bend": bend}, PROJECTION, counterpart, what)


ALL = [
    _weft("weft-xpbd", "xpbd", False, "springs"),
    _weft("weft-xpbd-bend", "xpbd", True, "springs, quadratic bending"),
    _weft("weft-vbd", "vbd", False, "springs"),
    _weft("weft-vbd-bend", "vbd", True, "springs, quadratic bending"),
    _newton_xpbd("newton-xpbd", False, "springs; Jacobi, soft"),
    _newton_xpbd("newton-xpbd-bend", True, "springs, dihedral bending; Jacobi, soft"),
    _newton_vbd("newton-vbd", "membrane", False, "membrane"),
    _newton_vbd("newton-vbd-bend", "membrane", True, "membrane, dihedral bending"),
    _newton_vbd("newton-vbd-springs-bend", "springs", True, "springs, dihedral bending"),
    _pypbd("pypbd-xpbd", False, "springs; float64"),
    _pypbd("pypbd-xpbd-bend", True, "springs, isometric bending; float64"),
]

# Those that do stacks, with contact.
STACKED = [
    Description("weft-vbd-stack", "weft_stack_system", {}, VERTEX_UPDATE, "weft-vbd-stack",
                "springs, quadratic bending; contact"),
    Description("newton-vbd-stack", "newton_stack_system", {}, VERTEX_UPDATE, "weft-vbd-stack",
                "membrane, dihedral bending; self-contact"),
]


def named(names, those=ALL):
    """Those of these names or families (`newton`), in their order; all if none.

    Throws KeyError with a name that is none.
    """
    known = {d.name for d in those} | {d.family for d in those}
    for name in names:
        if name not in known:
            raise KeyError(name)
    return [d for d in those if not names or d.name in names or d.family in names]
