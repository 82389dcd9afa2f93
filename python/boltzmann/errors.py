"""Exceptions, by kind. No error ends the interpreter."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable
from types import FrameType

_here = os.path.dirname(os.path.abspath(__file__))


class Error(ValueError):
    """Wrong input. The line has what was found, where, what is allowed, and the nearest right word."""


class ScenarioErrors(Error):
    """All mistakes of a scenario. ``lines`` has one line for each, with its place in Python or in its file."""

    def __init__(self, lines: str | Iterable[str]) -> None:
        self.lines = [lines] if isinstance(lines, str) else list(lines)
        super().__init__("\n".join(self.lines))

    def __reduce__(self) -> tuple[type[ScenarioErrors], tuple[list[str]]]:
        return (type(self), (self.lines,))


class PhysicsFailure(RuntimeError):
    """The physics failed during a run: something is not finite, a particle escaped, a step is too large. The line names
    the step and the particle."""


class RecordingFailure(OSError):
    """A file of a run could not be written. The line names the file, and the data that are intact."""


def caller() -> str:
    """``file:line`` of the call into this package; in a notebook the line number in the cell."""
    frame: FrameType | None = sys._getframe(1)
    while frame is not None and os.path.dirname(os.path.abspath(frame.f_code.co_filename)) == _here:
        frame = frame.f_back
    if frame is None:
        return "python"
    file = frame.f_code.co_filename
    if "ipykernel" in file or file.startswith("<ipython"):
        return f"cell:{frame.f_lineno}"
    return f"{os.path.basename(file)}:{frame.f_lineno}"


def unknown(kind: str, name: str, names: Iterable[str]) -> str:
    """One line for an unknown name: the nearest valid name first, then at most eight others."""
    from . import _core

    return f"there is no {kind} '{name}'" + _core.choices(name, list(names))
