"""A simulation: defined by keywords, run and observed."""

from __future__ import annotations

import atexit
import inspect
import math
import os
import shutil
import sys
import tempfile
import threading
import time as clock
import warnings as python_warnings
import weakref
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeVar, overload

import numpy as np

from . import _core
from ._types import Array, Keys, Path
from .document import Document, plain, value
from .ensemble import Ensemble
from .errors import Error, ScenarioErrors, caller, unknown
from .measured import BoxEdges, Diagnosis, Measured, Mesh, Record, Report, Units
from .progress import ProgressLine, wants_progress
from .table import Picture, Table, from_rows, words

if TYPE_CHECKING:
    from ._core import Core
    from .notebook import Window

_T = TypeVar("_T")
_F = TypeVar("_F", bound=Callable[..., Any])

_simulations: weakref.WeakSet[Simulation] = weakref.WeakSet()  # that have been made


@atexit.register
def _end_runs() -> None:
    """End running simulations at exit, after their step: a thread inside the compiled module can't outlive the
    interpreter."""
    _core.end_sweeps()
    for sim in list(_simulations):
        built = sim._built
        while built is not None and built.running_elsewhere():
            built.stop()
            clock.sleep(0.001)


# Arrays of up to this many numbers are written into the text of a scenario, longer ones into a file beside it.
_numbers_in_text = 3000


class Simulation:
    """A simulation, defined table by table as in a scenario file. Keywords are the keys of the reference.

    ``Simulation(units="reduced", run=dict(step=0.005), box=dict(low=[0], high=[1]))`` sets top-level tables;
    ``ensemble``, ``influence``, ``dissipation``, ``diagnosis``, ``wall``, ``event``, ``view`` and ``add`` append
    one table of a kind. The simulation is built when it is first needed; all mistakes are then reported at once,
    each with its line. The next table of the same kind replaces a wrong one.
    """

    _document: Document
    _overrides: dict[str, Any]
    _name: str
    _folder: str
    _set_place: str
    _box_given: bool
    _planned: bool
    _built: Core | None
    _built_digest: str
    _begun: bool
    _files: dict[str, str]
    _temporary: tempfile.TemporaryDirectory[str] | None
    _functions: dict[int, tuple[Callable[..., Any], str, int, bool]]
    _attendants: dict[int, int]
    _next_function: int
    _ensembles: dict[str, Ensemble]
    _looking: bool
    _changing: bool
    _thread: threading.Thread | None
    _thread_failure: BaseException | None
    _progress_line: ProgressLine | None

    def __init__(self, title: str | None = None, **tables: Any) -> None:
        self._start(Document())
        place = caller()
        if title is not None:
            self._document.top("title", title, place)
        units = tables.get("units")
        if isinstance(units, str):
            tables["units"] = {"base": units}
        self._box_given = "box" in tables
        run = tables.get("run", {})
        if isinstance(run, dict) and "steps" not in run and "time" not in run:
            tables["run"] = {**run, "steps": 0}
            self._planned = False
        if "step" in tables:
            raise Error(f"{place}: step: it belongs in run = dict(step = ...)")
        for name, given in tables.items():
            self._table(plain(name), given, place)

    def _start(self, document: Document, **overrides: Any) -> None:
        put = object.__setattr__
        put(self, "_document", document)
        put(self, "_overrides", {"set": [], "steps": None, "seed": None, "threads": None, **overrides})
        put(self, "_name", "python")
        put(self, "_folder", "")
        put(self, "_set_place", "")
        put(self, "_box_given", True)
        put(self, "_planned", True)
        put(self, "_built", None)
        put(self, "_built_digest", "")
        put(self, "_begun", False)
        put(self, "_files", {})  # of arrays that are too long for a text: name and path
        put(self, "_temporary", None)
        put(self, "_functions", {})  # number: (function, kind, every, how many arguments)
        put(self, "_attendants", {})  # number: what the core calls it
        put(self, "_next_function", 0)
        put(self, "_ensembles", {})
        put(self, "_looking", False)
        put(self, "_changing", False)
        put(self, "_thread", None)
        put(self, "_thread_failure", None)
        put(self, "_progress_line", None)

    # ---- messages ----

    def _table(self, name: str, given: Any, place: str) -> None:
        if isinstance(given, dict):
            self._document.table(name, given, place)
        elif isinstance(given, (list, tuple)) and given and all(isinstance(one, dict) for one in given):
            for one in given:
                self._document.append(name, one, place)
        else:
            self._document.top(name, given, place)

    def _say(self, table: str, keys: Keys, positions: Array | None = None) -> None:
        if self._begun:
            raise Error(
                f"{caller()}: the run has begun; add interactions before its first step (diagnoses and observers may "
                "come at any time)"
            )
        again = self._document.append(table, keys, caller(), positions, once=True)  # by a cell that is run again
        if again:
            python_warnings.warn(f"[[{table}]] already has this table, from {again.place}; it is not added again", stacklevel=3)
        self._make_anew()

    def _make_anew(self) -> None:
        """Discard the built simulation, but keep values written into its rows."""
        if self._built is not None and self._built.running():
            raise Error("tables can't be added while the simulation runs")
        old, digest = self._built, self._built_digest
        self._built = None
        if old is None:
            return
        rows = {}
        if old.digest() != digest:
            for name in old.ensembles():
                rows[name] = (_core.layout(old, name), _core.size(old, name), bytes(_core.rows(old, name, True)))
        self._kept_rows = rows
        for name in old.ensembles():
            _core.resize(old, name, 0, False)  # views of it become NaN

    _kept_rows: dict[str, tuple[tuple[int, int, int, str], int, bytes]] = {}

    def ensemble(self, name: str, class_: str, *, position: Any = None, load: Any = None, **fields: Any) -> Ensemble:
        """[[ensembles]]: particles of a class, placed by ``load=dict(kind=...)`` or ``position=`` (N, D) numbers in
        base units. Fields are one value for all, or an array with one for each."""
        place = caller()
        if not isinstance(name, str) or not isinstance(class_, str):
            raise Error(f"{place}: ensemble: a name and a class are texts, \"atoms\", \"Newton\"")
        keys = {"name": name, "class": class_}
        places = None
        if position is not None:
            if load is not None:
                raise Error(f"{place}: position, load: give one of the two")
            load, fields, places = self._given_places(name, class_, position, fields, place)
        for field, given in fields.items():
            if isinstance(given, np.ndarray) and not np.isfinite(given).all():
                raise Error(f"{place}: {field}: some of its numbers are not finite")
        self._say("ensembles", {**keys, "load": load, **fields}, places)
        return self[name]

    def _given_places(
        self, name: str, class_: str, position: Any, fields: Keys, place: str
    ) -> tuple[Keys, Keys, Array | None]:
        if isinstance(position, (list, tuple)) and _has_texts(position):
            texts = [one if isinstance(one, (list, tuple)) else [one] for one in position]
            return {"kind": "positions", "positions": texts}, fields, None
        try:
            places = np.asarray(position, dtype=np.float64)
        except (TypeError, ValueError):
            raise Error(f"{place}: position: an array of numbers, one row for each particle, is needed") from None
        if places.ndim == 1 and places.size:
            places = places.reshape(-1, 1)
        if places.ndim != 2 or not 1 <= places.shape[1] <= 3 or not len(places):
            raise Error(f"{place}: position: an array of shape (N, 1), (N, 2) or (N, 3) is needed, not {np.shape(position)}")
        if not np.isfinite(places).all():
            raise Error(f"{place}: position: some of its numbers are not finite")
        arrays = {"position": places}
        others = {}
        for field, given in fields.items():
            array = given if isinstance(given, np.ndarray) else None
            if array is not None and array.ndim >= 1 and len(array) == len(places) and array.dtype.kind in "fiu":
                arrays[field] = np.ascontiguousarray(array, dtype=np.float64).reshape(len(places), -1)
            else:
                others[field] = given
        if sum(a.size for a in arrays.values()) <= _numbers_in_text:
            return {"kind": "positions", "positions": places}, fields, places
        path = os.path.join(self._temporary_folder(), f"{name}-{len(self._files)}.h5")
        _core.write_frame(
            path,
            name,
            places.shape[1],
            len(places),
            [(plain(f), a.shape[1], np.ascontiguousarray(a)) for f, a in arrays.items()],
        )
        self._files[path] = f"{name}-start.h5"
        return {"kind": "frame", "path": path}, others, places

    def _temporary_folder(self) -> str:
        if self._temporary is None:
            self._temporary = tempfile.TemporaryDirectory(prefix="boltzmann-")
        return self._temporary.name

    def influence(self, law: str | None = None, **keys: Any) -> None:
        """[[influences]]: a built-in law by name, or a formula, ``energy="..."`` or ``influence="..."``. Other keys
        are parameters of the formula."""
        if law is None:
            keys = _typed_law(keys)
        self._say("influences", {"law": law, **keys})

    def dissipation(self, kind: str, **keys: Any) -> None:
        """[[dissipation]]: friction and noise, thermostats."""
        self._say("dissipation", {"kind": kind, **keys})

    def wall(self, **keys: Any) -> None:
        """[[box.walls]]."""
        self._say("box.walls", keys)

    def event(self, at: Any, **keys: Any) -> None:
        """[[events]]: a change at a time, once or repeated."""
        self._say("events", {"at": at, **keys})

    def view(self, name: str, drawing: str = "cartesian", **keys: Any) -> None:
        """[[views]]: a named drawing for the window."""
        self._say("views", {"name": name, "drawing": drawing, **keys})

    def add(self, table: str, **keys: Any) -> None:
        """Append a table of any kind: ``sim.add("rigid_bonds", on="water", ...)`` adds [[rigid_bonds]]."""
        kinds = {name: heading for name, heading, _ in _core.tables()}
        name = plain(table)
        if name == "box":
            self._box_given = True
        if name in kinds and not kinds[name].startswith("[["):
            if self._begun:
                raise Error(f"{caller()}: the run has begun; add interactions before its first step")
            self._document.table(name, keys, caller())
            self._make_anew()
            return
        self._say(name, keys)

    def diagnosis(self, kind: str, every: int | None = None, **keys: Any) -> Diagnosis:
        """[[diagnoses]]: a measurement. Before the run it becomes part of the scenario and of its table. With
        ``every``, or once the run has begun, it samples at this interval and has its own table. (To set a kind's
        own key ``every``, use ``sim.add("diagnoses", kind=..., every=...)``.)"""
        place = caller()
        if every is None and not self._begun:
            self._say("diagnoses", {"kind": kind, **keys})
            return Diagnosis(self, kind, None)
        document = Document()
        document.append("diagnoses", {"kind": kind, **keys}, place)
        every = 1 if every is None else every
        if not isinstance(every, (int, np.integer)) or every < 1:
            raise Error(f"{place}: every: a whole number of steps, 1 or more, is needed, not {every!r}")
        core = self._core
        interval = int(every)
        number = self._located(document, lambda: core.watch(self._source(document), interval))
        return Diagnosis(self, kind, number)

    # ---- making it ----

    def _source(self, document: Document) -> _core.Source:
        return _core.Source(document.text(), document.file, self._name, self._folder)

    def _located(self, document: Document, function: Callable[[], _T]) -> _T:
        try:
            return function()
        except ScenarioErrors as errors:
            located = document.located(errors, self._set_place)
        raise located

    @property
    def _core(self) -> Core:
        built = self._built
        if built is None:
            built = self._build()
        return built

    def _build(self) -> Core:
        document = self._document
        if not self._box_given and not self._begun:
            document = document.copy()
            document.table("box", _box_around(document.positions()), caller())
        o = self._overrides
        core = self._located(
            document, lambda: _core.Core(self._source(document), o["set"], o["steps"], o["seed"], o["threads"])
        )
        digest = core.digest()
        for name, (layout, count, rows) in self._kept_rows.items():
            if name in core.ensembles() and _core.layout(core, name) == layout and _core.size(core, name) == count:
                if count:
                    np.frombuffer(_core.rows(core, name, False), dtype=np.uint8)[:] = np.frombuffer(rows, dtype=np.uint8)
        self._kept_rows = {}
        core.owner(self)
        _simulations.add(self)
        self._attendants = {}
        for number, (_, kind, every, _) in self._functions.items():
            self._attendants[number] = core.attend(every, number, kind == "change")
        self._document.made()
        self._built_digest, self._built = digest, core
        return core

    def check(self) -> Simulation:
        """Build the simulation. Raises ScenarioErrors with all mistakes. Warnings are Python warnings."""
        for line in self._core.warnings():
            if line.startswith("warning: "):
                python_warnings.warn(line.removeprefix("warning: "), stacklevel=3 if sys._getframe(1).f_globals is globals() else 2)
        return self

    @property
    def toml(self) -> str:
        """The scenario as text, as ``bzm run`` reads it."""
        return self._core.resolved()

    def save(self, path: Path) -> None:
        """Write the scenario to a file; long arrays are written to files next to it."""
        path = os.fspath(path)
        if not path.endswith(".toml"):
            raise Error(f"'{path}': a scenario's file ends in .toml")
        written = self.toml
        for file, name in self._files.items():
            beside = f"{os.path.splitext(os.path.basename(path))[0]}-{name}"
            shutil.copyfile(file, os.path.join(os.path.dirname(path) or ".", beside))
            written = written.replace(file, beside)
        with open(path, "w", encoding="utf-8") as out:
            out.write(written)

    # ---- running ----

    def run(
        self,
        steps: int | None = None,
        time: float | str | None = None,
        hours: float | None = None,
        out: Path | None = None,
        overwrite: bool = False,
        progress: bool | None = None,
    ) -> Report:
        """Run a number of steps, or a time (a number or "5 ps"); default: the planned length. ``out``: a folder for
        the files that ``bzm run`` writes, from now on. ``hours`` limits the wall-clock time. Ctrl-C finishes the
        step and raises KeyboardInterrupt; run() continues from there."""
        core = self._core
        if steps is None:
            steps = self._steps_of(core, time)
        elif time is not None:
            raise Error("steps, time: give one of the two")
        else:
            steps = _whole(steps, "steps")
        if steps < 0:
            raise Error(f"steps: 0 or more, not {steps}; rewind() goes back")
        return self._go(core, steps, hours, out, overwrite, progress)

    def _steps_of(self, core: Core, time: float | str | None) -> int:
        if time is None:
            if not self._planned or core.planned() == 0:
                raise Error("run: say how many steps, or a time: nothing is planned in run = dict(steps=...)")
            return max(core.planned() - core.step(), 0)
        length = self._time(time)
        if not length >= 0 or not math.isfinite(length):
            raise Error(f"time: a finite time, 0 or more, not {time!r}")
        return _whole(math.ceil(length / abs(core.step_size()) * (1 - 1e-12)), "time")

    def rewind(self, steps: int | None = None) -> Report:
        """Run with the negative step; default: back to step 0."""
        core = self._core
        steps = core.step() if steps is None else _whole(steps, "steps")
        if steps < 0:
            raise Error(f"steps: 0 or more, not {steps}")
        return self._go(core, -steps, None, None, False, None)

    def _go(
        self, core: Core, steps: int, hours: float | None, out: Path | None, overwrite: bool, progress: bool | None
    ) -> Report:
        folder = ""
        if out is not None:
            folder = self._prepare(core, os.fspath(out), overwrite)
        if hours is not None and not hours > 0:
            raise Error(f"hours: a positive number, not {hours!r}")
        if progress is None:
            progress = wants_progress()
        if progress:
            self._progress_line = ProgressLine(core.step(), steps)
        self._begun = True
        try:
            return Report(self, core.run(steps, folder, overwrite, 3600 * hours if hours else 0.0, progress))
        finally:
            if self._progress_line is not None:
                self._progress_line.end()
                self._progress_line = None

    def _prepare(self, core: Core, folder: str, overwrite: bool) -> str:
        """Write arrays next to the results, where the stored scenario finds them."""
        if core.folder() or not self._files:
            return folder
        os.makedirs(folder, exist_ok=True)
        for file, name in self._files.items():
            stored = os.path.join(os.path.abspath(folder), name)
            shutil.copyfile(file, stored)
            core.moved(file, stored)
        return folder

    def _progress(self, step: int, seconds: float) -> None:
        if self._progress_line is not None:
            self._progress_line.show(step, seconds)

    def stop(self) -> None:
        """End the present run after its step; callable from an observer or another thread. No effect between runs."""
        if self._built is not None:
            self._built.stop()

    def start(self, steps: int | None = None, **options: Any) -> Simulation:
        """Run in the background. Meanwhile arrays are copies, taken between two steps. wait() ends it."""
        if self._thread is not None and self._thread.is_alive():
            raise Error("start: the simulation runs already; wait() waits for its end")
        self._core  # raises for mistakes
        options.setdefault("progress", False)

        def go() -> None:
            try:
                self.run(steps, **options)
            except BaseException as failure:  # told by wait()
                self._thread_failure = failure

        self._thread_failure = None
        self._thread = threading.Thread(target=go, daemon=True)
        self._thread.start()
        while self._thread.is_alive() and not self.running:
            clock.sleep(0.0005)
        return self

    def wait(self) -> Simulation:
        """Wait for the end of the background run; raises the exception that ended it."""
        if self._thread is not None:
            while self._thread.is_alive():
                self._thread.join(0.1)
            self._thread = None
        failure, self._thread_failure = self._thread_failure, None
        if failure is not None:
            raise failure
        return self

    @property
    def running(self) -> bool:
        """Whether a run is in progress, in this or another thread."""
        return self._built is not None and self._built.running()

    # ---- observers ----

    @overload
    def every(self, steps: int, function: None = None) -> Callable[[_F], _F]: ...
    @overload
    def every(self, steps: int, function: _F) -> _F: ...
    def every(self, steps: int, function: Any = None) -> Any:
        """Register an observer: ``@sim.every(20)`` calls the function at steps that are multiples of 20. The
        function may take the simulation as its argument; its views are read-only. A function of the same name
        replaces the earlier one. An exception ends the run after its step and is raised by run()."""
        return self._attend("look", steps, function)

    @overload
    def change(self, steps: int, function: None = None) -> Callable[[_F], _F]: ...
    @overload
    def change(self, steps: int, function: _F) -> _F: ...
    def change(self, steps: int, function: Any = None) -> Any:
        """Register a function that changes particles, or their number, between steps. Such a run can't be reversed."""
        return self._attend("change", steps, function)

    def _attend(self, kind: str, steps: int, function: Any) -> Any:
        steps = _whole(steps, "every" if kind == "look" else "change")
        if steps < 1:
            raise Error(f"the interval of a function must be 1 step or more, not {steps}")
        if function is None:
            return lambda given: self._attend(kind, steps, given)
        if not callable(function):
            raise Error(f"a function is needed, not {type(function).__name__}")
        name = getattr(function, "__name__", "<lambda>")
        if name != "<lambda>":
            for number, (old, *_) in list(self._functions.items()):
                if getattr(old, "__name__", "") == name and getattr(old, "__module__", "") == function.__module__:
                    self._forget(number)
        number = self._next_function
        self._next_function += 1
        self._functions[number] = (function, kind, steps, _takes_argument(function))
        if self._built is not None:
            self._attendants[number] = self._built.attend(steps, number, kind == "change")
        return function

    def forget(self, function: Callable[..., Any]) -> None:
        """Remove an observer."""
        for number, (known, *_) in list(self._functions.items()):
            if known is function:
                self._forget(number)
                return
        raise Error("forget: this function does not observe the simulation")

    def _forget(self, number: int) -> None:
        del self._functions[number]
        attendant = self._attendants.pop(number, None)
        if attendant is not None and self._built is not None:
            self._built.forget(attendant)

    def _called(self, number: int) -> None:
        known = self._functions.get(number)
        if known is None:
            return
        function, kind, _, takes = known
        before = self._looking, self._changing
        self._looking, self._changing = kind == "look", kind == "change"
        try:
            function(self) if takes else function()
        finally:
            self._looking, self._changing = before

    def record(self, what: str, every: int = 1) -> Record:
        """Record copies of a field, "bodies.position", or of one component, "bodies.position.x"."""
        if not isinstance(what, str) or what.count(".") not in (1, 2):
            raise Error(f"record: a field is 'ensemble.field', such as 'bodies.position', not {what!r}")
        name, field, *component = what.split(".")
        ensemble = self[name]
        if field not in ensemble.fields and field != "influence":
            raise Error(unknown(f"field of '{name}' called", field, ensemble.fields))
        if component and component[0] not in ("x", "y", "z")[: ensemble.dimension]:
            raise Error(unknown("component", component[0], ("x", "y", "z")[: ensemble.dimension]))
        kept = Record()

        def look() -> None:
            array = getattr(ensemble, field)
            kept._copies.append((array[:, "xyz".index(component[0])] if component else array).copy())
            kept._steps.append(self.step)
            kept._times.append(self.time)

        look.__name__ = "<lambda>"
        self.every(every, look)
        return kept

    # ---- what is there ----

    def __getitem__(self, name: str) -> Ensemble:
        if not isinstance(name, str):
            raise Error(f"an ensemble is named by a text, not by {type(name).__name__}")
        if name not in self._ensembles:
            self._ensembles[name] = Ensemble(self, name)
        return self._ensembles[name]

    def __getattr__(self, name: str) -> Ensemble:
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            names = self._core.ensembles()
        except ScenarioErrors as errors:
            raise Error(str(errors)) from None
        if name in names:
            return self[name]
        raise AttributeError(unknown("ensemble", name, names))

    def __setattr__(self, name: str, given: Any) -> None:
        if name.startswith("_") or isinstance(getattr(type(self), name, None), property):
            object.__setattr__(self, name, given)
            return
        settable = [n for n in dir(type(self)) if isinstance(getattr(type(self), n), property)
                    and getattr(type(self), n).fset is not None]
        raise Error(f"a simulation has no '{name}' that can be set" + _core.choices(name, settable))

    @property
    def ensembles(self) -> dict[str, Ensemble]:
        """All ensembles by name."""
        return {name: self[name] for name in self._core.ensembles()}

    @property
    def step(self) -> int:
        """Number of steps done."""
        return self._core.step()

    @property
    def time(self) -> float:
        """Time in base units."""
        return self._core.time()

    @property
    def step_size(self) -> float:
        """Time step of the next steps, in base units; texts have units: ``sim.step_size = "5 fs"``."""
        return self._core.step_size()

    @step_size.setter
    def step_size(self, size: float | str) -> None:
        self._core.set_step_size(self._time(size))

    def _time(self, given: Any) -> float:
        return _core.time_of(self._core, given) if isinstance(given, str) else self.units(given)

    @property
    def threads(self) -> int:
        """Number of threads; results do not depend on it."""
        return self._core.threads()

    @threads.setter
    def threads(self, count: int) -> None:
        self._core.set_threads(_whole(count, "threads"))

    @property
    def seed(self) -> int:
        """Seed of the random numbers."""
        return self._core.seed()

    @property
    def title(self) -> str:
        """Title of the scenario."""
        return self._core.title()

    @property
    def description(self) -> str:
        """Description of the scenario."""
        return self._core.description()

    @property
    def box(self) -> BoxEdges:
        """The present box."""
        return BoxEdges(*self._core.box())

    @property
    def mesh(self) -> Mesh:
        """Present fields on the nodes of the mesh: ``sim.mesh.potential``, ``sim.mesh.x``."""
        core = self._core
        return Mesh(core.between_steps(lambda: _core.mesh_fields(core)))

    @property
    def units(self) -> Units:
        """Converts texts to base units, and base units to others."""
        return Units(self)

    @property
    def folder(self) -> str:
        """Folder of output files; empty: none."""
        return self._core.folder()

    @property
    def table(self) -> Table:
        """Measurements of the scenario's diagnoses so far, over time."""
        core = self._core
        return from_rows(*core.between_steps(core.rows))

    def measure(self, what: str, **keys: Any) -> Measured:
        """Measure the present state by a diagnosis, given its kind and keys: ``sim.measure("energies")["total
        energy"]``, ``float(sim.measure("temperature"))``. Units are those of ``sim.table``."""
        place = caller()
        document = Document()
        document.append("diagnoses", {"kind": what, **keys}, place)
        core = self._core
        header, numbers = core.between_steps(
            lambda: self._located(document, lambda: core.measure(self._source(document)))
        )
        return Measured(from_rows(header, numbers))

    @property
    def conserved(self) -> str:
        """Conserved quantities and their changes since the first step."""
        return "\n".join(self._core.conserved())

    def picture(self, drawing: str | None = None, **keys: Any) -> Picture:
        """Draw the present state; keys are those of [[output.pictures]]."""
        options = {plain(name): given for name, given in keys.items() if given is not None}
        if drawing is not None:
            options = {"drawing": drawing, **options}
        core = self._core
        place = caller()
        try:
            return Picture(core.between_steps(lambda: core.picture(words(options))))
        except ScenarioErrors as errors:
            located = ScenarioErrors([f"{place}: {line.removeprefix('--')}" for line in errors.lines])
        raise located

    def window(
        self, steps: int | None = None, port: int = 0, height: int = 600, play: bool = False, out: Path | None = None
    ) -> Window:
        """A live page in the notebook's cell, or at ``.address`` for a browser. ``steps``: planned steps; ``out``:
        a folder for files. ``close()`` ends it."""
        from .notebook import Window, check_port

        core = self._core
        core.refuse_while_running("a window can't be opened")
        if steps is None:
            steps = max(core.planned() - core.step(), 0) or 10**9
        steps, port = _from_zero(_whole(steps, "steps"), "steps") or 0, check_port(port)
        if out is not None:
            core.record(self._prepare(core, os.fspath(out), False))
        self._begun = True
        return Window(self, steps, port, height, play)

    def digest(self) -> str:
        """A checksum of step and particles, equal for bit-identical states."""
        core = self._core
        return str(core.between_steps(core.digest))

    def copy(self) -> Simulation:
        """A copy in memory, which continues with identical bits. Functions that change particles act on the copy;
        observers, later diagnoses and files are not copied."""
        core = self._core
        changes = [known for known in self._functions.values() if known[1] == "change"]
        if not all(takes for *_, takes in changes):
            raise Error("copy: a function of @sim.change without an argument changes the original; let it take the simulation")
        core.refuse_while_running("a simulation can't be copied")
        twin = Simulation.__new__(Simulation)
        twin._start(Document(core.resolved(), self._document.file))
        twin._name, twin._folder, twin._planned = self._name, self._folder, self._planned
        twin._files, twin._temporary = dict(self._files), self._temporary
        for function, _, every, _ in changes:
            twin.change(every, function)
        twin._core.copy_state(core)
        twin._begun = self._begun
        return twin

    def __getstate__(self) -> tuple[Any, ...]:
        core = self._core
        if core.running():
            raise Error("a simulation can't be pickled while it runs")
        if any(known[1] == "change" for known in self._functions.values()):
            raise Error("a simulation can't be pickled with functions that change its particles; forget() them")
        files = {}
        for path, name in self._files.items():
            with open(path, "rb") as file:
                files[path] = (name, file.read())
        return (core.resolved(), self._name, self._planned, self._begun, files, core.save())

    def __setstate__(self, state: tuple[Any, ...]) -> None:
        resolved, name, planned, begun, files, saved = state
        self._start(Document(resolved, name))
        self._name, self._planned = name, planned
        for path, (file, content) in files.items():
            here = os.path.join(self._temporary_folder(), file)
            with open(here, "wb") as out:
                out.write(content)
            self._files[here] = file
            self._document.source = self._document.source.replace(path, here)
        self._core.restore(saved)
        self._begun = begun

    def __dir__(self) -> list[str]:
        names = list(super().__dir__())
        try:
            names += self._core.ensembles()
        except Error:
            pass
        return [name for name in names if not name.startswith("_")]

    def __repr__(self) -> str:
        try:
            core = self._core
        except ScenarioErrors as errors:
            return f"<simulation with {len(errors.lines)} mistakes: check() tells them>"
        what = ", ".join(f"{_core.size(core, name)} {name}" for name in core.ensembles())
        return f"<simulation {core.title() or core.name()!r}: {what}; step {core.step()}>"

    def _repr_html_(self) -> str:
        from html import escape

        core = self._core
        rows = "".join(
            f"<tr><td>{escape(name)}</td><td>{escape(_core.layout(core, name)[3])}</td>"
            f"<td>{_core.size(core, name)}</td></tr>"
            for name in core.ensembles()
        )
        return (
            f"<p><b>{escape(core.title() or core.name())}</b>, step {core.step()}</p><table><thead><tr><th>ensemble</th>"
            f"<th>class</th><th>particles</th></tr></thead><tbody>{rows}</tbody></table>"
        )


def _whole(given: Any, name: str) -> int:
    if isinstance(given, float) and given.is_integer():
        given = int(given)
    if isinstance(given, bool) or not isinstance(given, (int, np.integer)):
        raise Error(f"{name}: a whole number is needed, not {given!r}")
    if not -(2**62) <= given <= 2**62:
        raise Error(f"{name}: at most 2^62, not {given}")
    return int(given)


def _from_zero(given: Any, name: str) -> int | None:
    if given is None:
        return None
    whole = _whole(given, name)
    if whole < 0:
        raise Error(f"{name}: 0 or more, not {whole}")
    return whole


def _takes_argument(function: Callable[..., Any]) -> bool:
    try:
        parameters = inspect.signature(function).parameters.values()
    except (TypeError, ValueError):
        return True
    return any(p.kind in (p.POSITIONAL_ONLY, p.POSITIONAL_OR_KEYWORD, p.VAR_POSITIONAL) and p.default is p.empty
               for p in parameters)


def _has_texts(given: Any) -> bool:
    return any(isinstance(one, str) or (isinstance(one, (list, tuple)) and _has_texts(one)) for one in given)


def _box_around(places: list[Array]) -> Keys:
    """An open box for pictures of unbounded space."""
    if not places:
        return {"low": [0.0, 0.0, 0.0], "high": [1.0, 1.0, 1.0]}
    everything = np.concatenate([p for p in places if p.shape[1] == places[0].shape[1]])
    low, high = everything.min(axis=0), everything.max(axis=0)
    half = max(float((high - low).max()), 1e-300) * 0.75 or 1.0
    middle = (low + high) / 2
    return {"low": middle - half, "high": middle + half}


def _typed_law(keys: Keys) -> Keys:
    """Keys that do not belong to the table are constants of the formula."""
    told = _core.keys("influences")
    known = {plain(name): given for name, given in keys.items() if plain(name) in told}
    numbers = {name: given for name, given in keys.items() if plain(name) not in told}
    if numbers:
        known["parameters"] = {**known.get("parameters", {}), **numbers}
    return known


def load(
    what: Path | Keys,
    set: Keys | None = None,
    steps: int | None = None,
    seed: int | None = None,
    threads: int | None = None,
) -> Simulation:
    """A Simulation from the name of a shipped scenario, the path of a file, a text, or a dict of tables.

    ``set`` changes values by path: {"run.step": "5 fs"}. Nothing runs yet.
    """
    place = caller()
    sim = Simulation.__new__(Simulation)
    assignments = [f"{path}={value(given, path)}" for path, given in (set or {}).items()]
    overrides = {
        "set": assignments,
        "steps": _from_zero(steps, "steps"),
        "seed": _from_zero(seed, "seed"),
        "threads": _from_zero(threads, "threads"),
    }
    if isinstance(what, dict):
        document = Document()
        sim._start(document, **overrides)
        for name, given in what.items():
            sim._table(name, given, place)
    elif isinstance(what, str) and "\n" in what:
        sim._start(Document(what, "text"), **overrides)
    elif isinstance(what, (str, os.PathLike)):
        try:
            path = _core.find_scenario(os.fspath(what))
        except Error as error:
            raise Error(f"{place}: {error}") from None
        try:
            with open(path, encoding="utf-8", newline="") as file:
                source = file.read()
        except (OSError, UnicodeDecodeError) as error:
            raise Error(f"{place}: '{path}' can't be read: {error}") from None
        sim._start(Document(source, os.fspath(what) if os.path.exists(os.fspath(what)) else os.path.basename(path)), **overrides)
        sim._name = os.path.splitext(os.path.basename(path))[0]
        sim._folder = os.path.dirname(os.path.abspath(path))
    else:
        raise Error(f"{place}: load: a name, a path, a text or a dict is needed, not {type(what).__name__}")
    sim._set_place = place
    sim.check()
    return sim
