"""The progress line of a run: on a terminal, or in a notebook's cell."""

from __future__ import annotations

import sys
from typing import Any


class ProgressLine:
    """Progress of a run: one line that is rewritten, on a terminal or in a notebook's cell."""

    def __init__(self, first: int, steps: int) -> None:
        self._first, self._steps, self._shown = first, steps, False
        self._handle: Any = None

    def show(self, step: int, seconds: float) -> None:
        done = abs(step - self._first)
        rate = done / max(seconds, 1e-9)
        left = (abs(self._steps) - done) / max(rate, 1e-9)
        line = f"{100 * done // max(abs(self._steps), 1):3d} %  step {step}, {rate:.3g} steps/s, {left:.0f} s left"
        self._shown = True
        if _in_notebook():
            from IPython.display import display

            content = {"text/plain": line}
            if self._handle is None:
                self._handle = display(content, raw=True, display_id=True)
            else:
                self._handle.update(content, raw=True)
        else:
            print(f"\r{line}\033[K", end="", file=sys.stderr, flush=True)

    def end(self) -> None:
        if not self._shown:
            return
        if self._handle is not None:
            self._handle.update({"text/plain": ""}, raw=True)
        else:
            print("\r\033[K", end="", file=sys.stderr, flush=True)


def _in_notebook() -> bool:
    shell = sys.modules.get("IPython")
    return shell is not None and type(shell.get_ipython()).__name__ == "ZMQInteractiveShell"


def wants_progress() -> bool:
    return (sys.stderr is not None and sys.stderr.isatty()) or _in_notebook()
