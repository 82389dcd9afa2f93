"""A scenario built from Python: tables of keywords become TOML, and each line remembers its place in the Python
code."""

from __future__ import annotations

import keyword
import math
import os
import re
from typing import Any

import numpy as np

from ._types import Array, Keys
from .errors import Error, ScenarioErrors

_bare = re.compile(r"^[A-Za-z0-9_-]+$")


def key(name: str) -> str:
    """A key as TOML has it."""
    return name if _bare.match(name) else text(name)


def text(value: str) -> str:
    """A text in quotation marks."""
    escapes = {"\\": "\\\\", '"': '\\"', "\n": "\\n", "\t": "\\t", "\r": "\\r", "\b": "\\b", "\f": "\\f"}
    return '"' + "".join(escapes.get(c, c if c >= " " and c != "\x7f" else f"\\u{ord(c):04x}") for c in value) + '"'


def number(value: float) -> str:
    if math.isnan(value):
        return "nan"
    if math.isinf(value):
        return "inf" if value > 0 else "-inf"
    return repr(value)


def value(given: Any, name: str) -> str:
    """A Python value as TOML: numbers, texts, lists, dicts, arrays of numpy, quantities with .magnitude and .units."""
    if isinstance(given, (bool, np.bool_)):
        return "true" if given else "false"
    if isinstance(given, str):
        return text(given)
    if isinstance(given, os.PathLike):
        return text(os.fspath(given))
    if isinstance(given, (int, np.integer)):
        return str(int(given))
    if isinstance(given, (float, np.floating)):
        return number(float(given))
    if hasattr(given, "magnitude") and hasattr(given, "units"):
        return quantity(given, name)
    if isinstance(given, dict):
        inside = ", ".join(f"{key(plain(k))} = {value(v, k)}" for k, v in given.items() if v is not None)
        return "{ " + inside + " }" if inside else "{}"
    if isinstance(given, np.ndarray):
        if given.dtype.kind not in "biuf":
            raise Error(f"{name}: an array of numbers is needed, not one of {given.dtype}")
        given = given.tolist()
        if not isinstance(given, list):
            return value(given, name)
    if isinstance(given, (list, tuple, range)):
        return "[" + ", ".join(value(one, name) for one in given) + "]"
    raise Error(
        f"{name}: a number, a text, a list, a dict or an array is needed, not {type(given).__name__}"
        + (" (the law or formula stands in a text)" if callable(given) else "")
    )


def quantity(given: Any, name: str) -> str:
    """Text of a quantity of a library of units, such as pint."""
    try:
        unit = format(given.units, "~C")
    except (ValueError, TypeError):
        unit = str(given.units)
    unit = unit.replace("**", "^").replace("*", " ")
    magnitude = np.asarray(given.magnitude)
    if magnitude.ndim == 0:
        return text(f"{number(float(magnitude))} {unit}".strip())

    def each(numbers: list[Any]) -> list[Any]:
        return [each(one) if isinstance(one, list) else f"{number(float(one))} {unit}".strip() for one in numbers]

    return value(each(magnitude.tolist()), name)


def plain(name: str) -> str:
    """``class_`` and ``from_`` stand for keys that are reserved words of Python."""
    return name[:-1] if name.endswith("_") and keyword.iskeyword(name[:-1]) else name


class Said:
    """A table: its lines, and the mistakes found in it."""

    __slots__ = ("heading", "lines", "place", "positions", "wrong")

    def __init__(self, heading: str, lines: list[str], place: str, positions: Array | None = None) -> None:
        self.heading, self.lines, self.place, self.positions = heading, [heading, *lines], place, positions
        self.wrong = False  # some of it is a mistake


class Document:
    """The tables so far, on top of the text of a file, if there is one."""

    def __init__(self, source: str = "", file: str = "python") -> None:
        self.source, self.file = source, file
        self._said: list[Said] = []  # behind the source
        self._top: list[tuple[str, str]] = []

    def top(self, name: str, given: Any, place: str) -> None:
        """A key outside of all tables: the title."""
        self._top.append((f"{key(name)} = {value(given, name)}", place))

    def table(self, name: str, keys: Keys, place: str) -> None:
        """The table [name], which exists once."""
        said = self._new(f"[{name}]", keys, place)
        if any(one.heading == said.heading for one in self._said):
            raise Error(f"{place}: there is a table [{name}] already")
        self._said.append(said)

    def append(self, name: str, keys: Keys, place: str, positions: Array | None = None, once: bool = False) -> Said | None:
        """Add a table [[name]]. With ``once``, an equal earlier table is returned instead."""
        said = self._new(f"[[{name}]]", keys, place, positions)
        for one in self._said if once else ():
            if one.lines == said.lines:
                return one
        self._said.append(said)
        return None

    def _new(self, heading: str, keys: Keys, place: str, positions: Array | None = None) -> Said:
        """A new table. It replaces wrong tables of its kind."""
        pairs = [(plain(name), given) for name, given in keys.items() if given is not None]
        said = Said(heading, [f"{key(name)} = {value(given, name)}" for name, given in pairs], place, positions)
        self._said = [one for one in self._said if not (one.wrong and one.heading == heading)]
        return said

    def positions(self) -> list[Array]:
        """Arrays of positions, of the ensembles that have some."""
        return [one.positions for one in self._said if one.positions is not None]

    def made(self) -> None:
        """Mark all tables as correct."""
        for one in self._said:
            one.wrong = False

    def text(self) -> str:
        top = "".join(line + "\n" for line, _ in self._top)
        source = self.source if not self.source or self.source.endswith("\n") else self.source + "\n"
        return top + source + "".join(line + "\n" for one in self._said for line in one.lines)

    def _place(self, line: int) -> str | None:
        """The Python place of a wrong line of text(); None: the line is in the file, at this distance from its
        start."""
        if line <= len(self._top):
            return self._top[line - 1][1]
        line -= len(self._top) + len(self.source.splitlines())
        if line < 1:
            return None
        for one in self._said:
            if line <= len(one.lines):
                one.wrong = True
                return one.place
            line -= len(one.lines)
        return None

    def located(self, errors: ScenarioErrors, set_place: str = "") -> ScenarioErrors:
        """The same mistakes with their places in Python."""
        pattern = re.compile(rf"^{re.escape(self.file)}:(\d+):(\d+): (.*)$", re.S)
        lines = []
        self.made()
        for one in errors.lines:
            if one.startswith("--") and set_place:
                lines.append(f"{set_place}: {re.sub(r'^--(set )?', '', one)}")
                continue
            found = pattern.match(one)
            if not found:
                lines.append(one)
                continue
            place = self._place(int(found[1]))
            below = int(found[1]) - len(self._top)
            lines.append(f"{place}: {found[3]}" if place else f"{self.file}:{below}:{found[2]}: {found[3]}")
        return ScenarioErrors(list(dict.fromkeys(lines)))  # elements of one array may have the same message

    def copy(self) -> "Document":
        other = Document(self.source, self.file)
        other._said, other._top = list(self._said), list(self._top)
        return other
