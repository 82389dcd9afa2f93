"""The particles of one ensemble, as NumPy arrays that view the particle data."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._types import Array
from .errors import Error, unknown

if TYPE_CHECKING:
    from ._core import Core
    from .simulation import Simulation

    _Place = tuple[tuple[int, ...], int, tuple[int, ...]]


class Ensemble:
    """``atoms.position``, ``atoms.velocity``, ... are views of the particle data, of shape (N, D) or (N,). The next
    run uses what you write into them. They stay valid memory; if the number of particles changes, they turn into
    NaN. ``atoms.velocity = a`` copies into the data. ``atoms.influence`` and derived fields (such as the density of
    smooth particles) are read-only copies, calculated when you read them. While another thread runs the simulation,
    all arrays are copies."""

    __slots__ = ("_sim", "_name", "_made", "_fields", "_layout", "_particles", "_places", "_derived")
    _sim: Simulation
    _name: str
    _made: Core | None
    _fields: dict[str, Any]
    _layout: tuple[int, int, int, str]
    _particles: _core.Particles
    _places: dict[str, _Place]
    _derived: set[str]

    def __init__(self, simulation: Simulation, name: str) -> None:
        put = object.__setattr__
        put(self, "_sim", simulation)
        put(self, "_name", name)
        put(self, "_made", None)

    def _core(self) -> Core:
        """The compiled simulation and the layout of its rows; read again after the simulation was rebuilt."""
        core = self._sim._core
        if self._made is not core:
            put = object.__setattr__
            put(self, "_layout", _core.layout(core, self._name))
            put(self, "_fields", {f[0]: f for f in _core.fields(core, self._name)})
            put(self, "_particles", _core.Particles(core, self._name))
            put(self, "_places", {name: self._place(f) for name, f in self._fields.items()})
            put(self, "_derived", {"influence", *_core.derived_fields(core, self._name)})
            put(self, "_made", core)
        return core

    @property
    def name(self) -> str:
        """Name of the ensemble in the scenario."""
        return self._name

    @property
    def class_name(self) -> str:
        """Number of particles."""
        self._core()
        return self._layout[3]

    @property
    def dimension(self) -> int:
        """Dimension of space: 1, 2 or 3."""
        self._core()
        return self._layout[0]

    @property
    def fields(self) -> list[str]:
        """Names of the fields of the class, the position first."""
        self._core()
        return list(self._fields)

    @property
    def units(self) -> dict[str, str]:
        """Base unit of each field."""
        self._core()
        return {name: f[6] for name, f in self._fields.items()}

    def __len__(self) -> int:
        return _core.size(self._core(), self._name)

    def __bool__(self) -> bool:
        return True

    def _place(self, field: Any) -> _Place:
        """Layout of a field in the rows: shape of one particle's value, offset, and strides, in bytes."""
        dimension, stride, *_ = self._layout
        _, offset, components, vector, *_ = field
        if components == 1 and not vector:
            return (), 8 * offset, (8 * stride,)
        if components == dimension * dimension and dimension > 1 and not vector:
            return (dimension, dimension), 8 * offset, (8 * stride, 8 * dimension, 8)
        return (components,), 8 * offset, (8 * stride, 8)

    def _view(self, name: str, readonly: bool) -> Array | None:
        """The data; None while another thread runs the simulation."""
        looked = self._particles.look(readonly)
        if looked is None:
            return None
        memory, count = looked
        shape, offset, strides = self._places[name]
        if count == 0:
            return np.empty((0, *shape))
        return np.ndarray((count, *shape), np.float64, memory, offset, strides)

    def _rows_of(self, name: str) -> Array:
        view = self._view(name, False)
        if view is None:
            raise Error("particles can't be added while the simulation runs")
        return view

    def _influence(self, core: Core) -> Array:
        shape = (_core.size(core, self._name), self._layout[2])
        return np.ndarray(shape, np.float64, _core.influences(core, self._name)) if shape[0] else np.empty(shape)

    def _array(self, name: str) -> Array:
        core = self._core()
        if name in self._derived:
            return self._copy(core, name, True)
        view = self._view(name, self._sim._looking)
        return self._copy(core, name, False) if view is None else view

    def _copy(self, core: Core, name: str, derived: bool) -> Array:
        """A read-only copy, taken between two steps if another thread runs the simulation. Derived fields are
        calculated now."""

        def look() -> Array:
            if derived:
                core.refresh()
            found = self._influence(core) if name == "influence" else self._view(name, True)
            assert found is not None  # here the run of another thread waits
            return found.copy()

        copied: Array = core.between_steps(look)
        copied.flags.writeable = False
        return copied

    def __getattr__(self, name: str) -> Array:
        if name.startswith("__"):
            raise AttributeError(name)
        if self._made is None or self._made is not self._sim._built:
            self._core()
        if name in self._places or (name == "influence" and self._layout[2] > 0):
            return self._array(name)
        raise AttributeError(unknown(f"field of '{self._name}' (class {self._layout[3]}) called", name, self._fields))

    def __getitem__(self, name: str) -> Array:
        try:
            found: Array = getattr(self, name)
            return found
        except (AttributeError, TypeError) as error:
            raise Error(str(error)) from None

    def __setattr__(self, name: str, given: Any) -> None:
        core = self._core()
        if name == "influence":
            raise Error("influence: it is what the laws have summed up, and is read only")
        if name not in self._fields:
            raise Error(unknown(f"field of '{self._name}' (class {self._layout[3]}) called", name, self._fields))
        if self._sim._looking:
            raise Error(f"{name}: observers change nothing; @sim.change(n) is for what changes particles")
        numbers = self._numbers(core, name, given)
        self._check(name, numbers)

        def put() -> None:
            view = self._view(name, False)
            assert view is not None  # here the run of another thread waits
            try:
                view[...] = numbers
            except ValueError:
                raise Error(
                    f"{name}: an array of shape {view.shape} is needed, or one that can be spread over it, "
                    f"not {np.shape(numbers)}"
                ) from None

        core.between_steps(put)

    def __setitem__(self, name: str, given: Any) -> None:
        setattr(self, name, given)

    def _check(self, name: str, numbers: Any) -> None:
        """Raise the errors that a scenario would raise."""
        flat = np.asarray(numbers, dtype=np.float64).ravel() if _is_regular(numbers) else np.empty(0)
        for wrong in flat[~np.isfinite(flat)][:1]:
            raise Error(f"{name}: {wrong} is not a finite number")
        if name == "mass" or (name in ("density", "range") and "sound_speed" in self._fields):
            for wrong in flat[flat <= 0][:1]:
                raise Error(f"{name}: {wrong:g} is out of range; it must be positive")

    def _numbers(self, core: Core, name: str, given: Any) -> Any:
        """Plain numbers in base units, from texts with units and quantities of a library of units."""
        if isinstance(given, str):
            number = _core.number_of(core, self._name, name, given)
            if self._places[name][0] not in ((), (1,)) and number != 0:
                raise Error(f"{name}: a vector has {self._places[name][0][0]} components, such as ['{given}', 0]")
            return number
        if hasattr(given, "magnitude") and hasattr(given, "units"):
            from .document import quantity

            one = type(given)(1.0, given.units) if np.ndim(given.magnitude) else given
            unit = quantity(one, name).strip('"')
            factor = _core.number_of(core, self._name, name, unit)
            return np.asarray(given.magnitude) * factor if np.ndim(given.magnitude) else factor
        if given is None:
            raise Error(f"{name}: numbers are needed, not None")
        if isinstance(given, (list, tuple)) and any(one is None or isinstance(one, (str, list, tuple)) for one in given):
            return [
                _core.number_of(core, self._name, name, one) if isinstance(one, str) else self._numbers(core, name, one)
                for one in given
            ]
        try:
            numbers = np.asarray(given, dtype=np.float64)
        except (TypeError, ValueError):
            raise Error(f"{name}: numbers are needed, not {type(given).__name__}") from None
        return numbers

    def __delattr__(self, name: str) -> None:
        raise Error(f"{name}: fields of a class can't be taken away")

    @property
    def rows(self) -> npt.NDArray[Any]:
        """All fields together as a record array: ``rows["mass"]``, ``rows[60]``."""
        core = self._core()
        _, stride, _, _ = self._layout
        names: list[str] = []
        formats: list[Any] = []
        offsets: list[int] = []
        for name, offset, components, vector, *_ in self._fields.values():
            names.append(name)
            formats.append(np.dtype(np.float64) if components == 1 and not vector else (np.float64, (components,)))
            offsets.append(8 * offset)
        kind = np.dtype({"names": names, "formats": formats, "offsets": offsets, "itemsize": 8 * stride})
        count = _core.size(core, self._name)
        if count == 0:
            return np.empty(0, kind)
        readonly = self._sim._looking
        if self._derived - {"influence"}:
            core.between_steps(core.refresh)
        if core.running_elsewhere():
            copied: npt.NDArray[Any] = core.between_steps(
                lambda: np.ndarray(count, kind, _core.rows(core, self._name, True)).copy()
            )
            return copied
        return np.ndarray(count, kind, _core.rows(core, self._name, readonly))

    def resize(self, count: int) -> None:
        """Remove the last particles, or add some whose fields are zero (and mass one). Call it between runs or in a
        function of ``@sim.change``. Earlier views turn into NaN."""
        if not isinstance(count, (int, np.integer)) or isinstance(count, bool) or count < 0:
            raise Error(f"resize: a number of particles is needed, 0 or more, not {count!r}")
        if count > 2**62:
            raise Error(f"resize: at most 2^62 particles, not {count}")
        core = self._core()
        if self._sim._looking:
            raise Error("resize: observers change nothing; @sim.change(n) is for what changes particles")
        _core.resize(core, self._name, int(count), self._sim._changing)

    def add(self, position: Any, **fields: Any) -> None:
        """Add one or several particles: positions of shape (D,) or (n, D); other fields are one value for all or
        one for each."""
        core = self._core()
        dimension = self._layout[0]
        for name in fields:
            if name not in self._fields:
                raise Error(unknown(f"field of '{self._name}' (class {self._layout[3]}) called", name, self._fields))
        given_places = self._numbers(core, "position", position)
        self._check("position", given_places)
        try:
            places = np.asarray(given_places, dtype=np.float64)
        except ValueError:
            raise Error("position: one row of numbers is needed for each particle") from None
        if places.ndim < 2:
            places = places.reshape(1, -1)
        if places.shape[1] != dimension:
            raise Error(f"position: {dimension} numbers are needed for each particle, not {places.shape[1]}")
        values = {name: self._numbers(core, name, given) for name, given in fields.items()}
        for name, numbers in values.items():
            self._check(name, numbers)
        first = len(self)
        self.resize(first + len(places))
        self._rows_of("position")[first:] = places
        try:
            for name, numbers in values.items():
                self._rows_of(name)[first:] = numbers
        except ValueError:
            self.resize(first)
            raise Error(f"{name}: one value for all, or one for each of {len(places)} particles, is needed") from None

    def __dir__(self) -> list[str]:
        self._core()
        return [n for n in super().__dir__() if not n.startswith("_")] + list(self._fields) + ["influence"]

    def __repr__(self) -> str:
        return f"<{len(self)} particles of '{self._name}', class {self.class_name}: {', '.join(self.fields)}>"


def _is_regular(numbers: Any) -> bool:
    """Whether nested lists have the shape of an array."""
    try:
        np.asarray(numbers, dtype=np.float64)
    except (TypeError, ValueError):
        return False
    return True
