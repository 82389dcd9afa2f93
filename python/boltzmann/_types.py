"""Types of arguments and results of the package."""

from __future__ import annotations

import os
from typing import Any, Union

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
Path = Union[str, "os.PathLike[str]"]
Keys = dict[str, Any]
"""Keys of a table of a scenario, with their values."""
