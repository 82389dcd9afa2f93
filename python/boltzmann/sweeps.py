"""One scenario for several values and seeds: ``bz.sweep``."""

from __future__ import annotations

import csv
import os
import tempfile
from typing import Any

from . import _core
from ._types import Array, Keys, Path
from .document import value
from .errors import Error, ScenarioErrors, caller, unknown
from .simulation import Simulation, load
from .stored import StoredRun, read_table
from .table import Table


def _number(cell: str) -> float | str:
    try:
        return float(cell)
    except (TypeError, ValueError):
        return cell


class Sweep:
    """The table of means over the seeds, ``s["shock speed"]``, with their standard errors, ``s.error("shock speed")``."""

    def __init__(self, folder: str, failed: int, keep: tempfile.TemporaryDirectory[str] | None = None) -> None:
        self.folder, self.failed, self._keep = folder, failed, keep
        self.table = read_table(os.path.join(folder, "sweep.csv"))

    def __getitem__(self, name: str) -> Array:
        return self.table[name]

    def error(self, name: str) -> Array:
        """Standard error of a column's mean over the seeds."""
        for column in (f"{name} error", f"error of {name}", f"{name} +-"):
            if column in self.table:
                return self.table[column]
        raise Error(f"there is no error of '{name}': " + unknown("column", name, self.table.names))

    @property
    def fits(self) -> list[dict[str, float | str]]:
        """Straight-line fits of the scenario's pictures: the rows of fits.csv."""
        path = os.path.join(self.folder, "fits.csv")
        if not os.path.exists(path):
            return []
        with open(path, encoding="utf-8", newline="") as file:
            return [{key: _number(cell) for key, cell in row.items()} for row in csv.DictReader(file)]

    @property
    def series(self) -> Table:
        """Means over the seeds over time, for all values."""
        return read_table(os.path.join(self.folder, "series.csv"))

    @property
    def runs(self) -> list[StoredRun]:
        """All runs, in the order of their folders."""
        folders = sorted(f for f in os.listdir(self.folder) if f[:1].isdigit())
        return [StoredRun(os.path.join(self.folder, f)) for f in folders]

    def __repr__(self) -> str:
        return repr(self.table)

    def _repr_html_(self) -> str:
        return self.table._repr_html_()


def stored_sweep(folder: str) -> Sweep:
    """Open the sweep in a folder of results. Error if some of its runs are not finished."""
    if not os.path.exists(os.path.join(folder, "sweep.csv")):
        raise Error(f"the sweep in '{folder}' has not been finished; 'bzm resume {folder}' does the rest of its runs")
    with open(os.path.join(folder, "runs.csv"), encoding="utf-8", newline="") as file:
        failed = sum(row["state"] == "failed" for row in csv.DictReader(file))
    return Sweep(folder, failed)


def sweep(
    what: Simulation | Path | Keys,
    vary: dict[str, Any] | None = None,
    seeds: int | None = None,
    table: list[str] | None = None,
    set: Keys | None = None,
    threads: int | None = None,
    out: Path | None = None,
    overwrite: bool = False,
    quiet: bool = True,
) -> Sweep:
    """Run a scenario (a name, a path, a text or a Simulation) for values of its keys, {"run.step": [0.1, 0.2]},
    which vary in step, each with several seeds. ``table``: columns of the result. Results stay in ``out``; default:
    a temporary folder, removed with the Sweep."""
    place = caller()
    sim = what if isinstance(what, Simulation) else load(what)
    if sim._begun:
        raise Error(f"{place}: sweep: this simulation has run; a sweep starts from the beginning")
    assignments = list(sim._overrides["set"]) + [f"{path}={value(given, path)}" for path, given in (set or {}).items()]
    if table is not None:
        assignments.append(f"sweep.table={value(list(table), 'table')}")
    varied = []
    for path, values in (vary or {}).items():
        if isinstance(values, str) or not hasattr(values, "__len__"):
            raise Error(f"{place}: vary: {path}: a list of values is needed, not {values!r}")
        varied.append(f"{path}={value(values, path)}")
    keep = None
    if out is None:
        keep = tempfile.TemporaryDirectory(prefix="boltzmann-sweep-")
        folder = os.path.join(keep.name, "sweep")
    else:
        folder = os.fspath(out)
    try:
        failed, interrupted = _core.sweep(
            sim._source(sim._document), assignments, varied, seeds, threads, folder, overwrite, quiet, out is not None
        )
    except ScenarioErrors as errors:
        located = sim._document.located(errors, place)
    else:
        if interrupted:
            raise KeyboardInterrupt
        return Sweep(folder, failed, keep)
    raise located
