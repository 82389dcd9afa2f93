"""The package has types: mypy finds no fault in it, and finds those of its users."""

import os
import subprocess
from pathlib import Path

import boltzmann

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = Path(boltzmann.__file__).parent

RIGHT = """
from __future__ import annotations
import numpy as np
import boltzmann as bz

sim = bz.load("copper", set={"run.step": "2 fs"}, seed=3)
report = sim.run(10)
steps: int = report.steps
x = sim.atoms.position[0] + np.zeros(2)
table = sim.table["total energy"]
total: float = sim.measure("energies")["total energy"]

@sim.every(5)
def look() -> None:
    print(sim.step)

run = bz.open("results/copper")
if isinstance(run, bz.StoredRun):
    frames = run.trajectory["atoms"].position[0]
s = bz.sweep("copper", vary={"run.step": [1, 2]}, seeds=2)
front: float = bz.exact.sedov_front(1.0).radius
sim.picture("cartesian", colour="speed").save("a.png")
"""

WRONG = {
    's = bz.load("copper"); s.runn(3)': "not callable",
    'bz.load("copper").run("many")': "incompatible type",
    'bz.load("copper").run(3).step.x': "no attribute",
    "bz.laod": "no attribute",
    'bz.load("copper", seeds=3)': "Unexpected keyword",
    'n: str = bz.load("copper").step': "Incompatible types",
    'bz.load("copper").table.plott()': "not callable",
}


def mypy(folder, *arguments):
    environment = {**os.environ, "MYPYPATH": str(PACKAGE.parent), "MYPY_CACHE_DIR": str(folder / "cache")}
    environment.pop("PYTHONPATH", None)
    return subprocess.run(["mypy", "--config-file", str(ROOT / "pyproject.toml"), *arguments], cwd=folder,
                          capture_output=True, text=True, env=environment)  # fmt: skip


def test_the_whole_package_is_strict(tmp_path):
    found = mypy(tmp_path, str(PACKAGE))
    assert found.returncode == 0, found.stdout + found.stderr


def test_right_programs_are_right(tmp_path):
    (tmp_path / "right.py").write_text(RIGHT)
    found = mypy(tmp_path, "right.py")
    assert found.returncode == 0, found.stdout + found.stderr


def test_wrong_programs_are_found(tmp_path):
    for k, (line, _) in enumerate(WRONG.items()):
        (tmp_path / f"wrong_{k}.py").write_text(f"import boltzmann as bz\n{line}\n")
    found = mypy(tmp_path, *(f"wrong_{k}.py" for k in range(len(WRONG))))
    for k, (line, told) in enumerate(WRONG.items()):
        assert any(one.startswith(f"wrong_{k}.py:2: error") and told in one for one in found.stdout.splitlines()), (
            line, found.stdout
        )
