#!/usr/bin/env python3
"""Long tests of runs over ranks, not part of the suite (results: docs/how-to/run-on-a-cluster.md and docs/explanation/performance.md):

  tests/ranks.py build/release/bzm shipped [SCENARIO ...]  20 steps of each on 2 threads, 4 and 8 ranks beside 1
  tests/ranks.py build/release/bzm resume [SCENARIO ...]   runs of 1, 2, 3, 8 ranks are resumed by 1, 2, 3, 8
  tests/ranks.py build/release/bzm kill [TIMES] [SEED]     kill -9 of any of three ranks at any moment

Files are compared byte for byte; folders that a kill has changed are kept where one is. Exit status 1 where something differs, or a launcher outlives its ranks by 10 s."""

import filecmp
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

ALLOWED = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
ENVIRONMENT = {**os.environ, **ALLOWED}
RANKS = (1, 2, 3, 8)
# Lists, friction between pairs, smooth particles, a mesh, baths, three bodies; the steps of each half.
SHIPPED = {"copper-3d": 60, "dpd-fluid": 60, "pvdf-shock-3d": 40, "dam-break": 60, "two-stream": 60, "silicon": 60}
# What is stopped at random has files of every kind to lose.
MELT = """title = "A melt"
[units]
base = "reduced"
[box]
low = [0, 0, 0]
high = [16.8, 16.8, 16.8]
boundary = "periodic"
[run]
step = 0.004
steps = 1200
cutoff = 2.5
[[ensembles]]
name = "atoms"
class = "Newton"
load = { kind = "fill", number_density = 0.8442 }
temperature = 1.44
[[influences]]
law = "lennard-jones"
on = "atoms"
depth = 1
r0 = 1.122462
[[dissipation]]
kind = "langevin"
on = "atoms"
temperature = 1.2
rate = 0.5
[[diagnoses]]
kind = "energies"
[output]
diagnoses = 20
trajectory = 20
checkpoint = 100
"""


def bzm(*arguments, ranks=1, threads=1):
    many = ["--ranks", str(ranks)] if ranks > 1 else []
    command = [sys.argv[1], *map(str, arguments), *many, "--quiet"]
    environment = {**ENVIRONMENT, "OMP_NUM_THREADS": str(threads)}
    return subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)


def finish(process):
    said = process.communicate()[1]
    if process.returncode != 0:
        sys.exit(f"{' '.join(process.args)}: status {process.returncode}\n{said}")


def differences(folder, other):
    """Names of the files that differ, pictures and what is kept to go on from an earlier checkpoint apart."""
    names = {path.name for place in (folder, other) for path in place.iterdir() if path.is_file()}
    compared = sorted(name for name in names if not name.endswith((".png", ".previous", ".undo", ".h5md")))
    return [name for name in compared if name not in filecmp.cmpfiles(folder, other, [name], shallow=False)[0]]


def shipped(place, scenarios):
    wrong = 0
    folder = pathlib.Path(__file__).resolve().parent.parent / "scenarios"
    for name in scenarios or sorted(path.stem for path in folder.glob("*.toml")):
        folders = {}
        for ranks, threads in ((1, 1), (1, 2), (4, 1), (8, 1)):
            folders[ranks, threads] = place / f"{name}-{ranks}-{threads}"
            arguments = ("run", name, "--steps", 20, "--no-sweep", "--out", folders[ranks, threads])
            finish(bzm(*arguments, ranks=ranks, threads=threads))
        one = folders.pop((1, 1))
        different = {key: files for key, folder in folders.items() if (files := differences(one, folder))}
        wrong += len(different)
        print(f"{name}: {different or 'the same'}", flush=True)
        for folder in (one, *folders.values()):
            shutil.rmtree(folder)
    return wrong


def resume(place, scenarios):
    wrong = 0
    for name in scenarios or SHIPPED:
        steps = SHIPPED.get(name, 60)
        first = None
        for began in RANKS:
            half = place / f"{name}-{began}"
            finish(bzm("run", name, "--steps", steps, "--no-sweep", "--out", half, ranks=began))
            for goes_on in RANKS:
                whole = place / f"{name}-{began}-{goes_on}"
                shutil.copytree(half, whole)
                finish(bzm("resume", whole, "--steps", steps, ranks=goes_on))
                first = first or whole
                different = differences(first, whole)
                wrong += bool(different)
                print(f"{name}: begun by {began}, resumed by {goes_on}: {', '.join(different) or 'the same'}", flush=True)
    return wrong


def ranks_of(folder):
    found = []
    for entry in pathlib.Path("/proc").iterdir():
        if not entry.name.isdigit():
            continue
        try:
            words = (entry / "cmdline").read_bytes().split(b"\0")
            if os.fsencode(folder) in words and b"OMPI_COMM_WORLD_RANK=" in (entry / "environ").read_bytes():
                found.append(int(entry.name))
        except OSError:  # it has ended, or is somebody else's
            pass
    return sorted(found)


def kill(place, times, seed):
    chance = random.Random(seed)
    scenario = place / "melt.toml"
    scenario.write_text(MELT)
    undisturbed = place / "undisturbed"
    began = time.monotonic()
    finish(bzm("run", scenario, "--out", undisturbed, ranks=3))
    whole, wrong = time.monotonic() - began, 0
    for turn in range(times):
        folder = place / f"killed-{turn}"
        run = bzm("run", scenario, "--out", folder, ranks=3)
        while len(found := ranks_of(folder)) < 3 or not (folder / "checkpoint.h5").exists():
            if run.poll() is not None:
                sys.exit(f"turn {turn}: it has ended by itself: {run.communicate()[1]}")
            time.sleep(0.01)
        time.sleep(chance.uniform(0, 0.6 * whole))
        victim = chance.choice(found)
        try:
            os.kill(victim, signal.SIGKILL)
        except ProcessLookupError:
            print(f"turn {turn}: it had ended before")
        since = time.monotonic()
        run.communicate()
        took = time.monotonic() - since
        goes_on = chance.choice((1, 2, 3, 4))
        if run.returncode != 0:
            finish(bzm("resume", folder, ranks=goes_on))
        different = differences(undisturbed, folder)
        wrong += bool(different) or took > 10
        if different:
            shutil.copytree(folder, f"killed-{turn}", dirs_exist_ok=True)
            shutil.copytree(undisturbed, "undisturbed", dirs_exist_ok=True)
        print(f"turn {turn}: process {found.index(victim)} killed, over after {took:.1f} s, status {run.returncode}, "
              f"resumed by {goes_on}: {', '.join(different) or 'the same'}", flush=True)
    return wrong


def main():
    if len(sys.argv) < 3 or sys.argv[2] not in ("shipped", "resume", "kill"):
        sys.exit(__doc__)
    sys.argv[1] = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        place = pathlib.Path(folder)
        if sys.argv[2] == "kill":
            wrong = kill(place, *(int(word) for word in (*sys.argv[3:], *("20", "1")[len(sys.argv) - 3:])))
        else:
            wrong = {"shipped": shipped, "resume": resume}[sys.argv[2]](place, sys.argv[3:])
    print("nothing differs" if wrong == 0 else f"{wrong} differ")
    sys.exit(min(wrong, 1))


main()
