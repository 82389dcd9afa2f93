"""Catalogues of laws, classes, materials, diagnoses, ..., as printed by ``bzm list`` and ``bzm show``."""

from __future__ import annotations

from collections.abc import Iterator

from . import _core
from .errors import Error, unknown


class Page(str):
    """A page of text that displays itself."""

    def __repr__(self) -> str:
        return str(self)


class Catalogue:
    """The names of one kind with a line each; ``bz.laws["morse"]`` is the page of one."""

    def __init__(self, kind: str) -> None:
        self._kind = kind

    def _lines(self) -> dict[str, str]:
        return dict(_core.listed(self._kind))

    def __iter__(self) -> Iterator[str]:
        return iter(self._lines())

    def __len__(self) -> int:
        return len(self._lines())

    def __contains__(self, name: object) -> bool:
        return name in self._lines()

    def __getitem__(self, name: str) -> Page:
        if name not in self._lines():
            raise Error(unknown(f"name among {self._kind}", str(name), self._lines()))
        return Page(_core.page(name))

    def __repr__(self) -> str:
        lines = self._lines()
        width = max(map(len, lines), default=0)
        return "\n".join(f"{name:<{width}}  {doc}" for name, doc in lines.items())

    def _ipython_key_completions_(self) -> list[str]:
        return list(self)


def show(name: str) -> Page:
    """The page of a name: a scenario, a class, a law, a key, a unit, ..."""
    if not isinstance(name, str):
        raise Error(f"show: a name is a text, not {type(name).__name__}")
    return Page(_core.page(name))


scenarios, classes, laws, materials = (Catalogue(k) for k in ("scenarios", "classes", "laws", "materials"))
integrators, dissipations, loaders = (Catalogue(k) for k in ("integrators", "dissipations", "loaders"))
diagnoses, drawings, units = (Catalogue(k) for k in ("diagnoses", "drawings", "units"))
