"""The window in a notebook's cell: live, or a stored run as one page."""

from __future__ import annotations

import atexit
import html
import threading
import weakref
from typing import TYPE_CHECKING

from . import _core
from ._types import Path
from .errors import Error

if TYPE_CHECKING:
    from .simulation import Simulation


_windows: weakref.WeakSet[Window] = weakref.WeakSet()


@atexit.register
def _close_windows() -> None:
    """End running threads at exit: a thread inside the compiled module can't outlive the interpreter."""
    for window in list(_windows):
        window._end()


class Window:
    """A live page of a simulation with the buttons PLAY, STEP, REWD, STOP and QUIT. A notebook shows it in the
    cell; otherwise open ``address`` in a browser. While it is open, arrays of the simulation are copies, and
    assignments take effect between two steps."""

    def __init__(self, simulation: Simulation, steps: int, port: int, height: int, play: bool) -> None:
        self._sim, self._height = simulation, height
        self._failure: BaseException | None = None
        self._window = _core.LiveWindow(simulation._core, port)
        self.address: str = self._window.address()
        started = threading.Event()

        def serve() -> None:
            started.set()
            try:
                self._window.serve(steps, play)
            except BaseException as failure:  # told by wait()
                self._failure = failure

        self._thread = threading.Thread(target=serve, daemon=True)
        self._thread.start()
        started.wait()
        _windows.add(self)

    @property
    def open(self) -> bool:
        return self._thread.is_alive()

    def wait(self) -> None:
        """Wait until QUIT is pressed; raises the exception that ended the run."""
        while self._thread.is_alive():
            self._thread.join(0.1)
        failure, self._failure = self._failure, None
        if failure is not None:
            raise failure

    def close(self) -> None:
        """End the run after its step, and close the page."""
        self._end()
        self.wait()

    def _end(self) -> None:
        while self._thread.is_alive():
            self._window.close()
            self._thread.join(0.05)

    def __enter__(self) -> "Window":
        return self

    def __exit__(self, *failure: object) -> None:
        self.close()

    def _repr_html_(self) -> str:
        return (
            f'<iframe src="{html.escape(self.address)}" width="100%" height="{self._height}" style="border:0"></iframe>'
        )

    def __repr__(self) -> str:
        return f"<window: {self.address}>" if self.open else "<window, closed>"


class Replay:
    """A stored run as one HTML text, which plays without a server. ``save("run.html")`` writes it."""

    def __init__(self, folder: str, views: list[str], frames: int, megabytes: float, height: int) -> None:
        self.html, self.frames, self.stored_frames, self.message = _core.replay_page(folder, views, frames, megabytes)
        self._height = height

    def save(self, path: Path) -> None:
        with open(path, "w", encoding="utf-8") as file:
            file.write(self.html)

    def _repr_html_(self) -> str:
        return (
            f'<iframe srcdoc="{html.escape(self.html)}" width="100%" height="{self._height}" style="border:0" '
            'sandbox="allow-scripts allow-downloads"></iframe>'
        )

    def __repr__(self) -> str:
        said = f"; {self.message}" if self.message else ""
        return f"<replay of {self.frames} of {self.stored_frames} frames, {len(self.html) / 1e6:.2g} MB{said}>"


def check_port(port: object) -> int:
    if isinstance(port, bool) or not isinstance(port, int) or not 0 <= port <= 65535:
        raise Error(f"port: a whole number from 0 (a free one) to 65535, not {port!r}")
    return port
