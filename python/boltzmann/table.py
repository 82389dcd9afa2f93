"""Tables of measured numbers, and pictures."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from . import _core
from ._types import Array, Keys, Path
from .errors import Error, unknown

_with_unit = re.compile(r"^(.*?) \((.*)\)$")


def name_and_unit(title: str) -> tuple[str, str]:
    """"time (ps)" -> ("time", "ps")."""
    found = _with_unit.match(title)
    return (found[1], found[2]) if found else (title, "")


def from_rows(header: list[str], numbers: bytes) -> "Table":
    rows = np.frombuffer(numbers, dtype=np.float64).reshape(-1, max(len(header), 1))
    return Table(header, [rows[:, c].copy() for c in range(len(header))])


class Table:
    """Columns of numbers over the steps of a run: ``table["total energy"]`` is an array, ``table.units`` its units.

    A notebook displays it; ``plot()`` draws it, ``to_pandas()`` returns a data frame.
    """

    def __init__(self, titles: Sequence[str], columns: Sequence[Any]) -> None:
        self.titles = list(titles)
        self.units: dict[str, str] = {}
        self._columns: dict[str, Array] = {}
        for title, column in zip(titles, columns):
            name, unit = name_and_unit(title)
            self._columns[name] = np.asarray(column, dtype=float)
            self.units[name] = unit

    @property
    def names(self) -> list[str]:
        """Names of the columns, without units."""
        return list(self._columns)

    def __len__(self) -> int:
        return len(next(iter(self._columns.values()))) if self._columns else 0

    def __contains__(self, name: object) -> bool:
        return name in self._columns

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __getitem__(self, name: str) -> Array:
        if name in self._columns:
            return self._columns[name]
        raise Error(unknown("column", str(name), self._columns))

    def __getattr__(self, name: str) -> Array:
        if name.startswith("_"):
            raise AttributeError(name)
        for column in self._columns:
            if column == name or re.sub(r"\W+", "_", column).strip("_") == name:
                return self._columns[column]
        raise AttributeError(unknown("column", name, self._columns))

    def __dir__(self) -> list[str]:
        return list(super().__dir__()) + [re.sub(r"\W+", "_", name).strip("_") for name in self._columns]

    def _shown(self, most: int) -> list[int]:
        count = len(self)
        return list(range(count)) if count <= most else [*range(most // 2), -1, *range(count - most // 2, count)]

    def _cells(self, row: int) -> list[str]:
        return ["..." if row < 0 else f"{column[row]:.6g}" for column in self._columns.values()]

    def __repr__(self) -> str:
        lines = [self.titles] + [self._cells(row) for row in self._shown(10)]
        widths = [max(len(line[c]) for line in lines) for c in range(len(self.titles))]
        shown = ["  ".join(cell.rjust(width) for cell, width in zip(line, widths)) for line in lines]
        return "\n".join(shown + [f"{len(self)} rows"])

    def _repr_html_(self) -> str:
        from html import escape

        head = "".join(f"<th>{escape(title)}</th>" for title in self.titles)
        body = "".join(
            "<tr>" + "".join(f"<td>{cell}</td>" for cell in self._cells(row)) + "</tr>" for row in self._shown(10)
        )
        return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table><p>{len(self)} rows</p>"

    def to_pandas(self) -> Any:
        """A pandas data frame (pandas must be installed) with ``titles`` as columns."""
        import pandas

        return pandas.DataFrame(dict(zip(self.titles, self._columns.values())))

    def plot(self, *names: str, x: str = "", logarithmic: bool = False, title: str = "") -> "Picture":
        """Plot columns (default: all with the unit of the first) over another one, by default the time."""
        columns = [name for name in self._columns if name != "step"]
        if len(columns) < 2:
            raise Error("the table has no columns to plot: the scenario has no [[diagnoses]], or has not run")
        over = x or columns[0]
        if not names:
            first = next(name for name in columns if name != over)
            names = tuple(n for n in columns if n != over and self.units[n] == self.units[first])
        curves = [(name, np.ascontiguousarray(self[over]), np.ascontiguousarray(self[name])) for name in names]
        label = names[0] if len(names) == 1 else ""
        return Picture(
            _core.curves(curves, (over, self.units[over]), (label, self.units[names[0]]), logarithmic, title)
        )


class Picture:
    """A drawing. A notebook displays it; ``save("a.png")`` writes PNG, SVG or PDF."""

    def __init__(self, canvas: _core.Canvas) -> None:
        self._canvas = canvas

    def png(self, width: int = 1200, height: int = 900, scale: float = 1, dark: bool = False) -> bytes:
        """The bytes of a PNG of this width and height in pixels, times the scale."""
        return self._canvas.bytes("png", width, height, scale, dark)

    def svg(self, width: int = 1200, height: int = 900, dark: bool = False) -> str:
        """The text of an SVG."""
        return self._canvas.bytes("svg", width, height, 1, dark).decode()

    def save(self, path: Path, width: int = 1200, height: int = 900, scale: float = 1, dark: bool = False) -> None:
        """Write PNG, SVG or PDF, chosen by the extension."""
        import os

        self._canvas.write(os.fspath(path), width, height, scale, dark)

    def _repr_png_(self) -> bytes:
        return self.png(900, 675)

    def __repr__(self) -> str:
        return "<picture: .save('a.png') writes it, .png() and .svg() give it>"


def words(options: Keys) -> list[tuple[str, str]]:
    """Keys of a picture as options of the command."""
    from . import document

    return [(name, given if isinstance(given, str) else document.value(given, name)) for name, given in options.items()]
