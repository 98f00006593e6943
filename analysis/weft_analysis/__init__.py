"""Reads and draws the traces of Weft."""

from .trace import Trace, TraceError

__all__ = ["Trace", "TraceError"]
