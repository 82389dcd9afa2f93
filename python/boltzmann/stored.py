"""Stored runs in folders: tables, frames and pictures; and resuming them."""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
from collections.abc import Callable, Iterable, Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._types import Array, Keys, Path
from .document import Document, plain
from .errors import Error, unknown
from .simulation import Simulation
from .table import Picture, Table, words

if TYPE_CHECKING:
    from .notebook import Replay
    from .sweeps import Sweep


def read_table(path: Path) -> Table:
    """A table of numbers from a .csv file of a run."""
    header, columns = _core.read_csv(os.fspath(path))
    return Table(header, [np.frombuffer(numbers, dtype=np.float64) for numbers in columns])


class Frames:
    """One field of an ensemble, frame by frame; a frame is read when it is asked for."""

    def __init__(self, stored: _core.Stored, ensemble: str, field: str, components: int, vector: bool) -> None:
        self._stored, self._ensemble, self._field = stored, ensemble, field
        self._components, self._vector = components, vector

    def __len__(self) -> int:
        return len(self._stored.steps())

    def __getitem__(self, which: Any) -> Array:
        frames = range(len(self))
        if isinstance(which, slice):
            return np.array([self._read(frame) for frame in frames[which]])
        try:
            return self._read(frames[which])
        except (IndexError, TypeError):
            raise Error(f"there is no frame {which!r}; there are 0 to {len(self) - 1}, or -1 to -{len(self)}") from None

    def _read(self, frame: int) -> Array:
        numbers = np.frombuffer(self._stored.read(frame, self._ensemble, self._field), dtype=np.float64)
        return numbers.reshape(-1, self._components) if self._vector else numbers

    def __iter__(self) -> Iterator[Array]:
        return (self._read(frame) for frame in range(len(self)))

    def __array__(self, dtype: npt.DTypeLike = None, copy: bool | None = None) -> npt.NDArray[Any]:
        everything = self[:]
        return everything if dtype is None else everything.astype(dtype)


class StoredEnsemble:
    """The particles of one ensemble in a trajectory: ``.position[frame]``, ``.velocity[-1]``, ..."""

    def __init__(self, stored: _core.Stored, name: str, class_name: str, dimension: int, fields: list[Any]) -> None:
        self._stored, self.name, self.class_name, self.dimension = stored, name, class_name, dimension
        self._fields: dict[str, Any] = {field[0]: field for field in fields}

    @property
    def fields(self) -> list[str]:
        """Names of the stored fields."""
        return list(self._fields)

    @property
    def units(self) -> dict[str, str]:
        """Base unit of each field."""
        return {name: field[3] for name, field in self._fields.items()}

    def __len__(self) -> int:
        return self._stored.size(0, self.name)

    def __getattr__(self, name: str) -> Frames:
        if name.startswith("_"):
            raise AttributeError(name)
        if name not in self._fields:
            raise AttributeError(unknown(f"field of '{self.name}' called", name, self._fields))
        components = self._fields[name][1]
        return Frames(self._stored, self.name, name, components, components > 1 or name in ("position", "velocity"))

    def __dir__(self) -> list[str]:
        return list(super().__dir__()) + self.fields


class Trajectory:
    """``trajectory["atoms"].position[frame]``; numbers are in the simulation's base."""

    def __init__(self, stored: _core.Stored) -> None:
        self._stored = stored
        self._ensembles = {e[0]: StoredEnsemble(stored, *e) for e in stored.ensembles()}

    @property
    def steps(self) -> Array:
        """Step of each frame."""
        return np.array(self._stored.steps())

    @property
    def times(self) -> Array:
        """Time of each frame, in base units."""
        return np.array(self._stored.times())

    @property
    def ensembles(self) -> list[str]:
        """Names of the ensembles."""
        return list(self._ensembles)

    def __len__(self) -> int:
        return len(self._stored.steps())

    def __getitem__(self, name: str) -> StoredEnsemble:
        if name not in self._ensembles:
            raise Error(unknown("ensemble", str(name), self._ensembles))
        return self._ensembles[name]


class StoredRun:
    """The run in a folder of results."""

    def __init__(self, folder: str) -> None:
        self.folder = folder
        self._stored = _core.Stored(folder)

    @property
    def title(self) -> str:
        """Title of the scenario."""
        return self._stored.title()

    @property
    def table(self) -> Table:
        """The table diagnoses.csv."""
        return read_table(os.path.join(self.folder, "diagnoses.csv"))

    @property
    def gathered(self) -> dict[str, Table]:
        """Functions averaged by diagnoses, by file name."""
        return {
            file[:-4]: read_table(os.path.join(self.folder, file))
            for file in sorted(os.listdir(self.folder))
            if file.endswith(".csv") and file != "diagnoses.csv"
        }

    @property
    def trajectory(self) -> Trajectory:
        """The frames of trajectory.h5."""
        return Trajectory(self._stored)

    def frame(self, number: int = -1) -> Keys:
        """A frame as initial positions: ``load=`` of an ensemble of the same name, or a value of
        "ensembles.NAME.load"."""
        return {"kind": "frame", "path": os.path.abspath(os.path.join(self.folder, "trajectory.h5")), "frame": int(number)}

    def picture(self, drawing: str | None = None, frame: int = -1, **keys: Any) -> Picture:
        """Draw a frame (default: the last), as ``bzm render`` does."""
        options = {plain(name): given for name, given in keys.items() if given is not None}
        if drawing is not None:
            options = {"drawing": drawing, **options}
        return Picture(self._stored.picture(int(frame), words(options)))

    def movie(self, path: Path, drawing: str | None = None, fps: int = 25, scale: float = 1, dark: bool = False, **keys: Any) -> None:
        """Write all frames as .mp4, .webm or .gif, with ffmpeg."""
        path = os.fspath(path)
        if os.path.splitext(path)[1] not in (".mp4", ".webm", ".gif"):
            raise Error(f"'{path}': a movie's file ends in .mp4, .webm or .gif")
        if not 1 <= fps <= 240:
            raise Error(f"fps: 1 to 240 frames a second, not {fps!r}")
        ffmpeg = shutil.which("ffmpeg")
        if ffmpeg is None:
            raise Error("a movie needs ffmpeg, which is not installed (Debian: apt install ffmpeg)")
        options = {plain(name): given for name, given in keys.items()}
        if drawing is not None:
            options = {"drawing": drawing, **options}
        with tempfile.TemporaryDirectory(prefix="boltzmann-") as folder:
            self._stored.write_all(folder, words(options), scale, dark)
            command = [ffmpeg, "-y", "-loglevel", "error", "-framerate", str(fps), "-i", f"{folder}/%06d.png"]
            if path.endswith(".mp4"):
                command += ["-c:v", "libx264", "-pix_fmt", "yuv420p"]
            done = subprocess.run([*command, path], capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise Error(f"ffmpeg could not write '{path}': {done.stderr.strip()}")

    def replay(self, views: Iterable[str] = (), frames: int = 100, megabytes: float = 8, height: int = 600) -> Replay:
        """The run as one page that plays without a server: in a notebook, on a web site, from a file. ``views``:
        names of pictures and views of the run; ``frames`` and ``megabytes`` are upper limits."""
        from .notebook import Replay

        return Replay(self.folder, list(views), int(frames), float(megabytes), height)

    def resume(self) -> Simulation:
        """Same as ``bz.resume`` of its folder."""
        return resume(self.folder)

    def __repr__(self) -> str:
        return f"<stored run {self.title!r} in {self.folder}>"


def open_run(folder: Path) -> StoredRun | Sweep:
    """Open a stored run, finished or not: ``bz.open("results/copper")``. The folder of a sweep gives a Sweep."""
    folder = os.fspath(folder)
    if not os.path.isdir(folder):
        raise Error(f"there is no folder '{folder}' with a run")
    if os.path.exists(os.path.join(folder, "sweep.toml")):
        from .sweeps import stored_sweep

        return stored_sweep(folder)
    return StoredRun(folder)


def resume(folder: Path, change: dict[int, Callable[..., Any]] | None = None) -> Simulation:
    """Continue a run of a scenario from its checkpoint, after Ctrl-C or a kill, in a new session: with identical
    bits and the same files. ``run()`` continues to the planned end. Functions that changed particles between steps
    are not stored; pass them again as ``change``: {100: cool} for ``@sim.change(100)``."""
    folder = os.fspath(folder)
    path = os.path.join(folder, "scenario.toml")
    if not os.path.exists(os.path.join(folder, "checkpoint.h5")) or not os.path.exists(path):
        raise Error(f"'{folder}' contains no run of a scenario that can be continued: no checkpoint.h5 with a scenario.toml")
    with open(path, encoding="utf-8") as file:
        text = file.read()
    sim = Simulation.__new__(Simulation)
    sim._start(Document(text, path))
    sim._name, sim._folder = os.path.basename(os.path.abspath(folder)), os.path.abspath(folder)
    for every, function in (change or {}).items():
        sim.change(every, function)
    sim._core.resume(folder)
    sim._begun = True
    return sim
