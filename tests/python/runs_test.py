"""Runs from Python: the same bits as the command's, observers, changes, interrupts, background, copies, resumes."""

import os
import pickle
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import boltzmann as bz

BZM = os.environ.get("BOLTZMANN_BZM")


def gas(**run):
    sim = bz.Simulation(
        units="reduced", run={"step": 0.005, "cutoff": 2.5, "steps": 200, **run},
        box=dict(low=[0, 0], high=[12, 12], boundary="periodic"),
    )  # fmt: skip
    sim.ensemble(
        "atoms", "Newton", temperature=1, load=dict(kind="block", lattice="square", spacing=1.2, counts=[10, 10])
    )
    sim.influence("lennard-jones", on="atoms", depth=1, r0=1.12)
    sim.diagnosis("energies")
    return sim


SCENARIOS = ["copper", "sod", "cold-beams", "dpd-fluid", "three-body", "vortex-pair", "active-matter", "argon"]
SHORTER = {"equilibrate.time": 0.2}  # ten steps of dpd-fluid, twenty of argon


@pytest.mark.parametrize("name", SCENARIOS)
def test_the_same_bits_as_the_command(name, tmp_path):
    steps = 6
    changes = SHORTER if name in ("dpd-fluid", "argon") else {}
    words = [word for key, number in changes.items() for word in ("--set", f"{key}={number}")]
    command = tmp_path / "command"
    subprocess.run(
        [BZM, "run", name, "--steps", str(steps), "--out", str(command), "--quiet", *words], check=True, capture_output=True
    )
    python = tmp_path / "python"
    sim = bz.load(name, set=changes, steps=steps, threads=1)
    sim.run(out=python)
    for file in ("diagnoses.csv", "trajectory.h5"):
        if (command / file).exists():
            assert (command / file).read_bytes() == (python / file).read_bytes(), file
    silent = bz.load(name, set=changes, steps=steps, threads=2)
    silent.run()
    assert silent.digest() == sim.digest()
    assert silent.table.names == bz.open(command).table.names
    for column in silent.table:
        assert np.array_equal(silent.table[column], bz.open(command).table[column], equal_nan=True), column


def test_observers_look_at_multiples_of_their_steps():
    sim = gas()
    seen, energies = [], []

    @sim.every(50)
    def look(sim):
        seen.append(sim.step)
        energies.append(sim.measure("energies")["total energy"])

    @sim.every(100)
    def quiet():
        seen.append("quiet")

    report = sim.run()
    assert seen == [0, "quiet", 50, 100, "quiet", 150, 200, "quiet"]
    assert np.ptp(energies) < 0.02 * abs(energies[0])
    assert report.steps == 200 and report.step == 200 and "energy" in repr(report)


def test_a_function_of_the_same_name_replaces_the_former():
    sim = gas()
    seen = []
    for cell in (1, 2):

        @sim.every(100)
        def look(cell=cell):
            seen.append(cell)

    sim.run()
    assert seen == [2, 2, 2]


def test_looking_changes_no_bit():
    watched, alone = gas(), gas()
    watched.every(1, lambda sim: sim.atoms.position.sum())
    watched.record("atoms.velocity", every=7)
    watched.diagnosis("temperature", every=3)
    watched.run(), alone.run()
    assert watched.digest() == alone.digest()


def test_steps_one_by_one_are_the_same_run():
    one, all_ = gas(), gas()
    for _ in range(200):
        one.run(1)
    all_.run(200)
    assert one.digest() == all_.digest()
    assert (one.table["total energy"] == all_.table["total energy"]).all()


def test_changes_act_between_steps():
    sim = gas()

    @sim.change(10)
    def cool(sim):
        sim.atoms.velocity *= 0.5

    sim.run()
    assert sim.measure("energies")["kinetic energy"] < 20
    with pytest.raises(bz.Error, match="backwards"):
        sim.rewind(5)


def test_a_run_with_changes_goes_on_only_with_them(tmp_path):
    def cool(sim):
        sim.atoms.velocity *= 0.9

    sim, straight = gas(), gas()
    for one in (sim, straight):
        one.change(10, cool)
    sim.run(80, out=tmp_path / "run")
    twin = sim.copy()
    with pytest.raises(bz.Error, match="it has an adaptation that this simulation lacks"):
        bz.resume(tmp_path / "run")
    told = subprocess.run([BZM, "resume", str(tmp_path / "run")], capture_output=True, text=True, check=False)
    assert told.returncode == 2 and "an adaptation that this simulation lacks" in told.stderr
    with pytest.raises(bz.Error, match="pickled"):
        pickle.dumps(sim)
    again = bz.resume(tmp_path / "run", change={10: cool})
    for one in (again, straight, twin):
        one.run(200 - one.step)
    assert again.digest() == straight.digest() == twin.digest()


def test_particles_may_come_and_go_in_a_change():
    sim = gas()

    @sim.change(20)
    def rain(sim):
        sim.atoms.resize(len(sim.atoms) - 1)

    sim.run()
    assert len(sim.atoms) == 90


def test_an_observer_stops_the_run():
    sim = gas()

    @sim.every(1)
    def enough(sim):
        if sim.step == 33:
            sim.stop()

    report = sim.run()
    assert sim.step == 33 and report.stopped
    sim.forget(enough)
    sim.run()
    assert sim.step == 200
    straight = gas()
    straight.run()
    assert sim.digest() == straight.digest()


def test_another_thread_stops_the_run():
    sim = gas()
    threading.Timer(0.2, sim.stop).start()
    report = sim.run(10**9)
    assert 0 < report.steps < 10**9


def test_a_run_by_time_and_by_hours():
    sim = gas()
    sim.run(time=0.5)
    assert sim.step == 100 and sim.time == pytest.approx(0.5)
    began = time.monotonic()
    report = sim.run(10**9, hours=0.3 / 3600)
    assert report.out_of_time and 0.1 < time.monotonic() - began < 1.5


def test_a_condition_ends_the_run():
    sim = gas(stop="time > 0.25")
    sim.add("output", diagnoses=10)
    report = sim.run()
    assert sim.step == 60 and report.condition == "time > 0.25"


INTERRUPTED = """
import os, signal, threading, time, boltzmann as bz
signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell that starts us in the background has it ignored
sim = bz.load("three-body")
threading.Timer(0.4, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
began = time.monotonic()
try:
    sim.run(10**9)
except KeyboardInterrupt:
    step = sim.step
    assert 0.2 < time.monotonic() - began < 1.5, time.monotonic() - began
    sim.run(100)
    assert sim.step == step + 100
    straight = bz.load("three-body")
    straight.run(sim.step)
    print("goes on" if straight.digest() == sim.digest() else "other bits")
"""


def test_ctrl_c_finishes_the_step_and_the_run_goes_on():
    done = subprocess.run([sys.executable, "-c", INTERRUPTED], capture_output=True, text=True, check=False)
    assert done.stdout == "goes on\n", done.stderr


def test_other_threads_run_meanwhile():
    sim = gas()
    pauses, over = [], threading.Event()

    def tick():
        last = time.monotonic()
        while not over.is_set():
            time.sleep(0.001)
            now = time.monotonic()
            pauses.append(now - last)
            last = now

    ticking = threading.Thread(target=tick)
    ticking.start()
    sim.run(20_000)
    over.set()
    ticking.join()
    assert len(pauses) > 10 and np.median(pauses) < 0.05


def test_in_the_background():
    sim = gas()
    sim.start(10**9)
    assert sim.running
    with pytest.raises(bz.Error, match="while the simulation runs"):
        sim.run(1)
    first = sim.atoms.position
    with pytest.raises(ValueError, match="read-only"):
        first[0] = 0
    time.sleep(0.05)
    assert np.abs(sim.atoms.position - first).max() > 0  # it moves on
    assert np.isfinite(sim.atoms.rows["velocity"]).all()
    energies = sim.measure("energies")
    assert np.isfinite(energies["total energy"])
    sim.atoms.velocity = 0  # between two steps
    sim.picture().png(width=200, height=150)
    sim.stop()
    sim.wait()
    assert not sim.running and sim.step > 0
    with pytest.raises(bz.Error, match="how many steps"):
        unplanned = bz.Simulation(units="reduced", run=dict(step=1))
        unplanned.ensemble("a", "Newton", position=[[0.0]])
        unplanned.start().wait()


def test_what_fails_in_the_background_is_told_by_wait():
    sim = gas()
    sim.every(1, lambda sim: 1 / (5 - sim.step))
    sim.start(100)
    with pytest.raises(ZeroDivisionError):
        sim.wait()


def test_copies_and_pickles_go_on_with_the_same_bits():
    sim = gas()
    sim.run(77)
    twin, pickled = sim.copy(), pickle.loads(pickle.dumps(sim))
    assert twin.step == 77 and twin.digest() == sim.digest()
    for one in (sim, twin, pickled):
        one.run(50)
    assert twin.digest() == sim.digest() == pickled.digest()
    twin.atoms.velocity = 0
    assert twin.digest() != sim.digest()


def test_a_copy_before_the_first_step_begins_as_the_simulation_does():
    sim = bz.load("argon", set=SHORTER, steps=5)  # which is equilibrated first
    twin = sim.copy()
    sim.run(), twin.run()
    assert twin.digest() == sim.digest()


def test_there_and_back():
    sim = gas()
    start = sim.atoms.position.copy()
    sim.run(100)
    sim.rewind()
    assert sim.step == 0
    assert np.abs((sim.atoms.position - start + 6) % 12 - 6).max() < 1e-6


def test_files_go_on_over_several_runs(tmp_path):
    pieces, whole = gas(), gas()
    for one in (pieces, whole):
        one.add("output", diagnoses=5, trajectory=10)
    for _ in range(4):
        pieces.run(50, out=tmp_path / "pieces")
    whole.run(200, out=tmp_path / "whole")
    for file in ("diagnoses.csv", "trajectory.h5"):
        assert (tmp_path / "pieces" / file).read_bytes() == (tmp_path / "whole" / file).read_bytes(), file
    with pytest.raises(bz.Error, match="records in"):
        pieces.run(1, out=tmp_path / "other")
    with pytest.raises(bz.Error, match="already"):
        gas().run(1, out=tmp_path / "whole")
    gas().run(1, out=tmp_path / "whole", overwrite=True)


def test_resumed_runs_have_the_same_bits(tmp_path):
    sim = gas()
    sim.run(80, out=tmp_path / "run")
    del sim
    again = bz.resume(tmp_path / "run")
    assert again.step == 80
    again.run()
    straight = gas()
    straight.run()
    assert again.step == 200 and again.digest() == straight.digest()
    assert len(bz.open(tmp_path / "run").table) == len(straight.table)


def test_a_full_disk_is_one_line(tmp_path):
    program = """
import resource, boltzmann as bz
sim = bz.load("copper", steps=2000, set={"output.trajectory": 1})
resource.setrlimit(resource.RLIMIT_FSIZE, (3_000_000, 3_000_000))
import signal; signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
try:
    sim.run(out="run")
except bz.RecordingFailure as failure:
    print(len(str(failure).splitlines()), "intact" in str(failure) or "checkpoint" in str(failure))
"""
    done = subprocess.run([sys.executable, "-c", program], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.stdout == "1 True\n", done.stdout + done.stderr


def test_a_forked_process_runs_on_its_own():
    sim = gas()
    sim.run(10)
    child = os.fork()
    if child == 0:
        try:
            sim.run(10)
            os._exit(0 if sim.step == 20 else 1)
        except BaseException:
            os._exit(2)
    deadline = time.monotonic() + 20
    while time.monotonic() < deadline:
        done, status = os.waitpid(child, os.WNOHANG)
        if done:
            assert status == 0
            return
        time.sleep(0.01)
    os.kill(child, signal.SIGKILL)
    pytest.fail("the child hangs")


def test_tables_that_come_later_keep_what_was_written():
    sim = gas()
    sim.atoms.velocity = [1, 0]
    view = sim.atoms.velocity
    sim.influence("gravity", on="atoms", G=1e-9) if "gravity" in bz.laws and False else None
    sim.diagnosis("temperature")
    assert (sim.atoms.velocity == [1, 0]).all()
    assert np.isnan(view).all()
    sim.run(1)
    assert "temperature" in sim.table


def test_the_scenario_as_text_is_the_same_simulation(tmp_path):
    sim = gas()
    sim.save(tmp_path / "gas.toml")
    again, third = bz.load(tmp_path / "gas.toml"), bz.load(sim.toml)
    fourth = bz.load(
        dict(
            units=dict(base="reduced"), run=dict(step=0.005, cutoff=2.5, steps=200),
            box=dict(low=[0, 0], high=[12, 12], boundary="periodic"),
            ensembles=[{"name": "atoms", "class": "Newton", "temperature": 1,
                        "load": dict(kind="block", lattice="square", spacing=1.2, counts=[10, 10])}],
            influences=[dict(law="lennard-jones", on="atoms", depth=1, r0=1.12)], diagnoses=[dict(kind="energies")],
        )
    )  # fmt: skip
    for one in (sim, again, third, fourth):
        one.run()
    assert sim.digest() == again.digest() == third.digest() == fourth.digest()
