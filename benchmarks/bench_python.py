#!/usr/bin/env python3
"""What Python costs: a run of the command and of the module in turns, run(1) in a loop, views, the import.

    PYTHONPATH=build/release/python /usr/bin/python3 benchmarks/bench_python.py build/release/bzm
"""

import os
import subprocess
import sys
import tempfile
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


def cpu_seconds(command):
    """Of a program and its threads."""
    child = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    if status:
        sys.exit(f"{command} failed")
    return usage.ru_utime + usage.ru_stime


RUN = "import sys, boltzmann; boltzmann.load(sys.argv[1], steps=int(sys.argv[2])).run()"


def liquid(bzm, turns=7):
    """A Lennard-Jones liquid of 32,000 atoms: CPU seconds of 200 steps, as the difference of runs of 250 and of 50."""
    with tempfile.TemporaryDirectory() as folder:
        path = f"{folder}/liquid.toml"
        with open(path, "w", encoding="utf-8") as file:
            file.write(LIQUID)

        def of_command(steps):
            return cpu_seconds([bzm, "run", path, "--steps", str(steps), "--out", f"{folder}/out", "--force", "--quiet"])

        def of_python(steps):
            return cpu_seconds([sys.executable, "-c", RUN, path, str(steps)])

        ratios = []
        for _ in range(turns):
            command, python = of_command(250) - of_command(50), of_python(250) - of_python(50)
            ratios.append(python / command)
    print(f"liquid of 32,000, 200 steps, CPU time: Python / command {median(ratios):.3f} (of {turns} turns: {min(ratios):.3f} to {max(ratios):.3f})")


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
