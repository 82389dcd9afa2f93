"""Results of a simulation: units, summary of a run, measurements and records, box and mesh."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._types import Array, Keys
from .errors import Error, unknown
from .table import Table, from_rows

if TYPE_CHECKING:
    from .simulation import Simulation


class Units:
    """Base units of the simulation, used by all arrays."""

    def __init__(self, simulation: Simulation) -> None:
        self._sim = simulation

    def __call__(self, quantity: Any) -> float:
        """The plain number of "5 fs"."""
        if isinstance(quantity, (int, float, np.number)):
            return float(quantity)
        if not isinstance(quantity, str):
            raise Error(f"a quantity is a number or a text such as '5 fs', not {type(quantity).__name__}")
        return _core.quantity(self._sim._core, quantity)

    def to(self, unit: str, numbers: npt.ArrayLike) -> Any:
        """Convert numbers from base units: ``sim.units.to("km/s", sim.atoms.velocity)``."""
        return np.asarray(numbers) / _core.base_of_unit(self._sim._core, unit)

    def of(self, unit: str, numbers: npt.ArrayLike) -> Any:
        """Convert numbers to base units."""
        return np.asarray(numbers) * _core.base_of_unit(self._sim._core, unit)


class Report:
    """Summary of a run, with the errors of conserved quantities."""

    def __init__(self, simulation: Simulation, told: Keys) -> None:
        self.steps: int = told["steps"]
        self.step: int = told["step"]
        self.seconds: float = told["seconds"]
        self.stopped: bool = told["stopped"]
        self.out_of_time: bool = told["out_of_time"]
        self.condition: str = told["condition"]
        self._sim = simulation

    def __repr__(self) -> str:
        sim = self._sim
        lines = [f"{self.steps} steps to step {self.step} in {self.seconds:.3g} s"]
        if self.condition:
            lines.append(f"ended by its condition: {self.condition}")
        elif self.stopped or self.out_of_time:
            lines.append("out of time" if self.out_of_time else "stopped before its last step")
        if sim._built is not None and sim.step == self.step and not sim._built.running():
            lines += sim._built.conserved()
            if sim._built.folder():
                lines.append(f"results in {sim._built.folder()}")
        return "\n".join(lines)


class Diagnosis:
    """A diagnosis: columns over time in ``rdf.table``, and averaged functions such as ``rdf.r, rdf.g``."""

    def __init__(self, simulation: Simulation, kind: str, number: int | None, titles: Iterable[str] = ()) -> None:
        self._sim, self.kind, self._number, self._titles = simulation, kind, number, list(titles)

    @property
    def table(self) -> Table:
        """Columns over time."""
        if self._number is None:
            return self._sim.table
        return from_rows(*self._sim._core.watched(self._number))

    @property
    def gathered(self) -> dict[str, Table]:
        """Functions of a distance, a time lag, ..., averaged over all samples so far, by name."""
        core = self._sim._core
        all_of = core.gathered() if self._number is None else core.watched_gathered(self._number)
        return {name: _gathered_table(columns) for name, columns in all_of.items()}

    def stop(self) -> None:
        """Stop measuring."""
        if self._number is not None:
            self._sim._core.unwatch(self._number)

    def __getattr__(self, name: str) -> Array:
        if name.startswith("_"):
            raise AttributeError(name)
        tables = self.gathered if self._number is not None or self._sim._built else {}
        for one in tables.values():
            try:
                return one.__getattr__(name)
            except AttributeError:
                continue
        names = [column for one in tables.values() for column in one.names]
        raise AttributeError(unknown(f"column of '{self.kind}' called", name, names))

    def __repr__(self) -> str:
        return f"<diagnosis {self.kind}>"


def _gathered_table(columns: dict[str, bytes]) -> Table:
    return Table(list(columns), [np.frombuffer(numbers, dtype=np.float64) for numbers in columns.values()])


class Record:
    """Copies of one field at steps of a run: shape (samples, N, D). ``.step``, ``.time``; NumPy accepts it as an
    array."""

    def __init__(self) -> None:
        self._copies: list[Array] = []
        self._steps: list[int] = []
        self._times: list[float] = []

    def __array__(self, dtype: npt.DTypeLike = None, copy: bool | None = None) -> npt.NDArray[Any]:
        stacked = np.array(self._copies)
        return stacked if dtype is None else stacked.astype(dtype)

    @property
    def step(self) -> Array:
        """Step of each sample."""
        return np.array(self._steps)

    @property
    def time(self) -> Array:
        """Time of each sample, in base units."""
        return np.array(self._times)

    @property
    def T(self) -> Array:
        """The axes in reverse order: components first, samples last."""
        return np.asarray(self).T

    @property
    def shape(self) -> tuple[int, ...]:
        """Samples, particles, components."""
        return np.asarray(self).shape

    def __getitem__(self, which: Any) -> Any:
        return np.asarray(self)[which]

    def __len__(self) -> int:
        return len(self._copies)


class Measured(dict[str, float]):
    """Values of the columns at one moment, by name; as a float it is the first of them."""

    def __init__(self, table: Table) -> None:
        super().__init__((name, float(table[name][0])) for name in table.names[2:])
        self.units = {name: table.units[name] for name in self}

    def __float__(self) -> float:
        return next(iter(self.values()))

    def __missing__(self, name: object) -> float:
        raise Error(unknown("column", str(name), self))

    def __repr__(self) -> str:
        return "\n".join(f"{name}  {number:.6g} {self.units[name]}".rstrip() for name, number in self.items())


class BoxEdges:
    """The box: ``low``, ``high``, ``length`` are arrays, ``boundary`` has a word for each axis."""

    def __init__(self, low: list[float], high: list[float], boundary: list[str]) -> None:
        self.low: Array = np.array(low)
        self.high: Array = np.array(high)
        self.boundary = list(boundary)

    @property
    def length(self) -> Array:
        """Length along each axis."""
        return np.subtract(self.high, self.low)

    @property
    def volume(self) -> float:
        """Product of the lengths: an area in 2D."""
        return float(np.prod(self.length))

    def __repr__(self) -> str:
        axes = ", ".join(
            f"{axis} {low:.6g} to {high:.6g} ({kind})"
            for axis, low, high, kind in zip("xyz", self.low, self.high, self.boundary)
        )
        return f"<box: {axes}>"


class Mesh:
    """Fields on the nodes of a mesh at the time of the call: ``density`` and ``potential`` of shape (nx, ny, nz)
    for the axes of space, ``field`` with the components last; ``x``, ``y``, ``z`` are the positions of the nodes,
    ``units`` the base units of the fields."""

    def __init__(self, fields: list[Any]) -> None:
        self._arrays: dict[str, Array] = {}
        self.units: dict[str, str] = {}
        for name, components, dimension, nodes, low, spacing, unit in fields:
            shape = tuple(reversed(nodes[:dimension]))
            arrays = [np.frombuffer(one, dtype=np.float64).reshape(shape).T for one in components]
            self._arrays[name] = arrays[0] if len(arrays) == 1 and name != "field" else np.stack(arrays, axis=-1)
            self.units[name] = unit
            for axis in range(dimension):
                self._arrays["xyz"[axis]] = low[axis] + spacing[axis] * np.arange(nodes[axis])

    @property
    def names(self) -> list[str]:
        return list(self.units)

    def __getitem__(self, name: str) -> Array:
        if name not in self._arrays:
            raise Error(unknown("field on the mesh called", str(name), self._arrays))
        return self._arrays[name]

    def __getattr__(self, name: str) -> Array:
        if name.startswith("_") or name not in self._arrays:
            raise AttributeError(unknown("field on the mesh called", name, () if name.startswith("_") else self._arrays))
        return self._arrays[name]

    def __dir__(self) -> list[str]:
        return list(super().__dir__()) + list(self._arrays)

    def __repr__(self) -> str:
        return "<mesh: " + ", ".join(f"{name} {self._arrays[name].shape}" for name in self.units) + ">"
