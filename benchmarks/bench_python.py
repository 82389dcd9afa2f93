#!/usr/bin/env python3
"""What Python costs: a run of the command and of the module in turns, run(1) in a loop, views, the import.

    PYTHONPATH=build/release/python /usr/bin/python3 benchmarks/bench_python.py build/release/bzm
"""

import re
import subprocess
import sys
import time
import timeit

import boltzmann as bz

LIQUID = """
[units]
base = "reduced"
[box]
low = [0, 0, 0]
high = [33.592, 33.592, 33.592]
boundary = "periodic"
[run]
step = 0.005
steps = 200
cutoff = 2.5
threads = 1
[[ensembles]]
name = "atoms"
class = "Newton"
temperature = 1.44
load = { kind = "block", lattice = "fcc", number_density = 0.8442, counts = [20, 20, 20] }
[[influences]]
law = "lennard-jones"
on = "atoms"
depth = 1
r0 = 1.122462048309373
"""


def median(numbers):
    return sorted(numbers)[len(numbers) // 2]


def liquid(bzm, turns=7):
    """A Lennard-Jones liquid of 32,000 atoms: seconds of the steps, as each tells them."""
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        with open(f"{folder}/liquid.toml", "w", encoding="utf-8") as file:
            file.write(LIQUID)
        ratios = []
        for _ in range(turns):
            command = [bzm, "run", f"{folder}/liquid.toml", "--out", f"{folder}/out", "--force"]
            told = subprocess.run(command, capture_output=True, text=True, check=True).stdout
            of_command = float(re.search(r"([\d.]+) ns for a particle and step", told)[1])
            sim = bz.load(f"{folder}/liquid.toml")
            report = sim.run()
            ratios.append(report.seconds / 200 / 32000 * 1e9 / of_command)
    print(f"liquid of 32,000, 200 steps: Python / command {median(ratios):.3f} (of {turns} turns: {min(ratios):.3f} to {max(ratios):.3f})")


def steps_one_by_one():
    """run(1) in a loop, less what run(n) takes for a step."""
    for name in ("three-body", "copper"):
        sim = bz.load(name)
        sim.run(10)
        n = 20_000
        began = time.perf_counter()
        sim.run(n)
        whole = (time.perf_counter() - began) / n
        sim = bz.load(name)
        sim.run(10)
        began = time.perf_counter()
        for _ in range(n // 4):
            sim.run(1)
        single = (time.perf_counter() - began) / (n // 4)
        print(f"{name}: a step of run(n) {whole * 1e6:.2f} us, of run(1) in a loop {single * 1e6:.2f} us")


def views():
    atoms = bz.load("copper").atoms
    atoms.position
    each = median(timeit.repeat("atoms.position", globals=locals(), number=20_000, repeat=7)) / 20_000
    print(f"a view: {each * 1e6:.2f} us")


def imports():
    program = "import time; t = time.perf_counter(); import boltzmann; print(time.perf_counter() - t)"
    with_numpy = "import time, numpy; t = time.perf_counter(); import boltzmann; print(time.perf_counter() - t)"
    for what, code in (("with numpy", program), ("after numpy", with_numpy)):
        times = [float(subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout) for _ in range(9)]
        print(f"import {what}: {median(times):.3f} s")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    imports()
    views()
    steps_one_by_one()
    liquid(sys.argv[1])
