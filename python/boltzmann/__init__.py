"""Boltzmann: particle simulations.

``bz.load("copper").run()`` runs a shipped scenario. ``bz.Simulation(...)`` defines one table by table. See
docs/reference/python.md.
"""

try:
    import numpy as _numpy
except ImportError as _missing:
    raise ImportError("boltzmann needs numpy (Debian: apt install python3-numpy)") from _missing

from .errors import Error, PhysicsFailure, RecordingFailure, ScenarioErrors
from . import _core

_core.exceptions(Error, ScenarioErrors, PhysicsFailure, RecordingFailure)

from . import exact
from .catalogue import (
    classes, diagnoses, dissipations, drawings, integrators, laws, loaders, materials, scenarios, show, units,
)  # fmt: skip
from .simulation import Simulation, load
from .stored import StoredRun, open_run as open, read_table, resume
from .sweeps import Sweep, sweep
from .table import Picture, Table

__version__ = _core.version
__all__ = [
    "Error", "PhysicsFailure", "Picture", "RecordingFailure", "ScenarioErrors", "Simulation", "StoredRun", "Sweep",
    "Table", "classes", "diagnoses", "dissipations", "drawings", "exact", "integrators", "laws", "load", "loaders",
    "materials", "open", "read_table", "resume", "scenarios", "show", "sweep", "units",
]  # fmt: skip
