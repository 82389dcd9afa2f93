"""The particles of one ensemble, as arrays of numpy that look into the rows themselves."""

from __future__ import annotations

import numpy as np

from . import _core
from .errors import Error, unknown


class Ensemble:
    """``atoms.position``, ``atoms.velocity``, ... are views of the rows, of shape (N, D) or (N,): what one changes in
    them the next run takes. They stay valid memory for ever; when the number of particles changes, they turn into NaN.
    ``atoms.velocity = a`` copies into the rows. While another thread runs the simulation they are copies."""

    __slots__ = ("_sim", "_name", "_made", "_fields", "_layout", "_particles", "_places")

    def __init__(self, simulation, name: str):
        put = object.__setattr__
        put(self, "_sim", simulation)
        put(self, "_name", name)
        put(self, "_made", None)

    def _core(self):
        """The compiled simulation, and what its rows are like; read again if it has been made anew."""
        core = self._sim._core
        if self._made is not core:
            put = object.__setattr__
            put(self, "_layout", _core.layout(core, self._name))
            put(self, "_fields", {f[0]: f for f in _core.fields(core, self._name)})
            put(self, "_particles", _core.Particles(core, self._name))
            put(self, "_places", {name: self._place(f) for name, f in self._fields.items()})
            put(self, "_made", core)
        return core

    @property
    def name(self) -> str:
        """What the scenario calls it."""
        return self._name

    @property
    def class_name(self) -> str:
        """Of its particles."""
        self._core()
        return self._layout[3]

    @property
    def dimension(self) -> int:
        """Of its space: 1, 2 or 3."""
        self._core()
        return self._layout[0]

    @property
    def fields(self) -> list[str]:
        """The names of the fields of the class, the position first."""
        self._core()
        return list(self._fields)

    @property
    def units(self) -> dict[str, str]:
        """Of each field the unit of the base in which its numbers are."""
        self._core()
        return {name: f[6] for name, f in self._fields.items()}

    def __len__(self) -> int:
        return _core.size(self._core(), self._name)

    def __bool__(self) -> bool:
        return True

    def _place(self, field) -> tuple:
        """Of a field in the rows: the shape behind the number of particles, offset, and strides, in bytes."""
        dimension, stride, *_ = self._layout
        _, offset, components, vector, *_ = field
        if components == 1 and not vector:
            return (), 8 * offset, (8 * stride,)
        if components == dimension * dimension and dimension > 1 and not vector:
            return (dimension, dimension), 8 * offset, (8 * stride, 8 * dimension, 8)
        return (components,), 8 * offset, (8 * stride, 8)

    def _view(self, name: str, readonly: bool) -> np.ndarray | None:
        """None while another thread runs the simulation."""
        looked = self._particles.look(readonly)
        if looked is None:
            return None
        memory, count = looked
        shape, offset, strides = self._places[name]
        if count == 0:
            return np.empty((0, *shape))
        return np.ndarray((count, *shape), np.float64, memory, offset, strides)

    def _influence(self, core) -> np.ndarray:
        shape = (_core.size(core, self._name), self._layout[2])
        return np.ndarray(shape, np.float64, _core.influences(core, self._name)) if shape[0] else np.empty(shape)

    def _array(self, name: str) -> np.ndarray:
        view = self._view(name, self._sim._looking) if name != "influence" else None
        if view is not None:
            return view
        core = self._made
        if name == "influence" and not core.running_elsewhere():
            return self._influence(core)
        look = (lambda: self._influence(core)) if name == "influence" else (lambda: self._view(name, True))
        copied = core.between_steps(lambda: look().copy())
        copied.flags.writeable = False
        return copied

    def __getattr__(self, name: str) -> np.ndarray:
        if name.startswith("__"):
            raise AttributeError(name)
        if self._made is None or self._made is not self._sim._built:
            self._core()
        if name in self._places or (name == "influence" and self._layout[2] > 0):
            return self._array(name)
        raise AttributeError(unknown(f"field of '{self._name}' (class {self._layout[3]}) called", name, self._fields))

    def __getitem__(self, name: str) -> np.ndarray:
        try:
            return getattr(self, name)
        except (AttributeError, TypeError) as error:
            raise Error(str(error)) from None

    def __setattr__(self, name: str, given) -> None:
        core = self._core()
        if name == "influence":
            raise Error("influence: it is what the laws have summed up, and is read only")
        if name not in self._fields:
            raise Error(unknown(f"field of '{self._name}' (class {self._layout[3]}) called", name, self._fields))
        if self._sim._looking:
            raise Error(f"{name}: observers change nothing; @sim.change(n) is for what changes particles")
        numbers = self._numbers(core, name, given)

        def put():
            view = self._view(name, False)
            try:
                view[...] = numbers
            except ValueError:
                raise Error(
                    f"{name}: an array of shape {view.shape} is needed, or one that can be spread over it, "
                    f"not {np.shape(numbers)}"
                ) from None

        core.between_steps(put)

    def __setitem__(self, name: str, given) -> None:
        setattr(self, name, given)

    def _numbers(self, core, name: str, given):
        """Plain numbers of the base: texts with units, and quantities of a library of units, are converted."""
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
        if isinstance(given, (list, tuple)) and any(isinstance(one, (str, list, tuple)) for one in given):
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
    def rows(self) -> np.ndarray:
        """All fields together, as an array of records: ``rows["mass"]``, ``rows[60]``."""
        core = self._core()
        _, stride, _, _ = self._layout
        names, formats, offsets = [], [], []
        for name, offset, components, vector, *_ in self._fields.values():
            names.append(name)
            formats.append(np.dtype(np.float64) if components == 1 and not vector else (np.float64, (components,)))
            offsets.append(8 * offset)
        kind = np.dtype({"names": names, "formats": formats, "offsets": offsets, "itemsize": 8 * stride})
        count = _core.size(core, self._name)
        if count == 0:
            return np.empty(0, kind)
        readonly = self._sim._looking
        if core.running_elsewhere():
            return core.between_steps(lambda: np.ndarray(count, kind, _core.rows(core, self._name, True)).copy())
        return np.ndarray(count, kind, _core.rows(core, self._name, readonly))

    def resize(self, count: int) -> None:
        """Takes the last particles away, or adds some whose fields are zero (and mass one). Between runs, or in a
        function of ``@sim.change``. Views that were made before turn into NaN."""
        if not isinstance(count, (int, np.integer)) or isinstance(count, bool) or count < 0:
            raise Error(f"resize: a number of particles is needed, 0 or more, not {count!r}")
        core = self._core()
        if self._sim._looking:
            raise Error("resize: observers change nothing; @sim.change(n) is for what changes particles")
        _core.resize(core, self._name, int(count), self._sim._changing)

    def add(self, position, **fields) -> None:
        """One more particle, or several: positions of shape (D,) or (n, D), and other fields, one for all or one each."""
        core = self._core()
        dimension = self._layout[0]
        for name in fields:
            if name not in self._fields:
                raise Error(unknown(f"field of '{self._name}' (class {self._layout[3]}) called", name, self._fields))
        places = np.asarray(self._numbers(core, "position", position), dtype=np.float64)
        if places.ndim < 2:
            places = places.reshape(1, -1)
        if places.shape[1] != dimension:
            raise Error(f"position: {dimension} numbers are needed for each particle, not {places.shape[1]}")
        values = {name: self._numbers(core, name, given) for name, given in fields.items()}
        first = len(self)
        self.resize(first + len(places))
        self._view("position", False)[first:] = places
        try:
            for name, numbers in values.items():
                self._view(name, False)[first:] = numbers
        except ValueError:
            self.resize(first)
            raise Error(f"{name}: one value for all, or one for each of {len(places)} particles, is needed") from None

    def __dir__(self):
        self._core()
        return [n for n in super().__dir__() if not n.startswith("_")] + list(self._fields) + ["influence"]

    def __repr__(self) -> str:
        return f"<{len(self)} particles of '{self._name}', class {self.class_name}: {', '.join(self.fields)}>"
