"""The eight programs of the design, as they should read, with their numbers."""

import os
import subprocess
import sys

import numpy as np
import pytest

import boltzmann as bz


def test_liquid_and_its_structure():
    sim = bz.Simulation(
        units="reduced", run=dict(step=0.005, cutoff=2.5), box=dict(low=[0] * 3, high=[16.796] * 3, boundary="periodic")
    )
    sim.ensemble(
        "atoms", "Newton", temperature=1.44,
        load=dict(kind="block", lattice="fcc", number_density=0.8442, counts=[10] * 3),
    )  # fmt: skip
    sim.influence("lennard-jones", on="atoms", depth=1, r0=2 ** (1 / 6))
    sim.run(400)
    rdf = sim.diagnosis("radial-distribution", to=4, every=10)
    sim.run(200)
    peak = rdf.distance[np.argmax(rdf.g)]
    # Verlet, Phys. Rev. 165, 201 (1968): near the triple point the first shell stands at 1.07 to 1.09 and is 2.6 to 3 high.
    assert 1.04 < peak < 1.12
    assert 2.4 < rdf.g.max() < 3.1
    assert abs(rdf.g[rdf.distance > 3.5].mean() - 1) < 0.05


def test_three_bodies_come_back():
    x = np.array([[0.97000436, -0.24308753, 0], [-0.97000436, 0.24308753, 0], [0, 0, 0]])
    v = np.array([[0.466203685, 0.43236573, 0], [0.466203685, 0.43236573, 0], [-0.93240737, -0.86473146, 0]])
    sim = bz.Simulation(units="reduced", run=dict(step=6.32591398e-3))
    sim.ensemble("bodies", "Kepler", position=x, velocity=v, integrator="rk4")
    sim.influence("gravity", on="bodies", G=1)
    track = sim.record("bodies.position", every=5)
    sim.run(1000)
    assert track.shape == (201, 3, 3)
    assert np.abs(sim.bodies.position - x).max() < 1e-5  # one period of the 8
    sim.rewind(1000)
    assert sim.step == 0
    assert np.abs(sim.bodies.position - x).max() < 1e-8  # rk4 goes back to its order


def test_two_streams_grow_as_theory_says():
    sim = bz.load("cold-beams")
    sim.run()
    t, energy = sim.table["time"], sim.table["field energy"]
    grows = (energy > 1e-5 * energy.max()) & (energy < energy.max() / 10)
    rate = np.polyfit(t[grows], np.log(energy[grows]), 1)[0] / 2
    assert rate == pytest.approx(8**-0.5, rel=0.01)


def test_sods_tube():
    sim = bz.load("sod", set={"ensembles.gas.load.spacing": 1 / 400})
    sim.run()
    exact = bz.exact.sod(sim.gas.position[:, 0], sim.time)
    assert np.abs(sim.gas.density - exact.density).mean() < 0.008
    assert np.abs(sim.gas.velocity[:, 0] - exact.velocity).mean() < 0.03


def test_sweep_over_values_and_seeds():
    sim = bz.Simulation(
        units="reduced", run=dict(step=0.01, steps=600), box=dict(low=[0, 0], high=[30, 30], boundary="periodic")
    )
    sim.ensemble("gas", "Newton", number=400, temperature=1, load=dict(kind="random"))
    sim.dissipation("langevin", on="gas", temperature=1, rate=5)
    sim.diagnosis("temperature")
    temperatures = [1, 2, 4]
    s = bz.sweep(sim, vary={"dissipation.0.temperature": temperatures}, seeds=4, table=["temperature"],
                 set={"sweep.from": 2, "sweep.pictures": [dict(x="dissipation.0.temperature", y="temperature", fit="line")]})  # fmt: skip
    assert len(s.runs) == 12 and s.failed == 0
    # Of 800 degrees of freedom, some 20 times independent: 0.8 % an average, 0.4 % the mean of four.
    assert s["temperature"] == pytest.approx(temperatures, rel=0.03)
    line = s.fits[0]
    assert any(isinstance(v, float) and abs(v - 1) < 0.03 for v in line.values()), line  # the slope
    assert (s.error("temperature") > 0).all() and (s.error("temperature") < 0.03 * s["temperature"]).all()


def test_a_law_of_ones_own():
    sim = bz.Simulation(
        units=dict(base="custom", length="1 angstrom", mass="1 amu", time="1 ps"), run=dict(step="1 fs"),
        box=dict(low=[0] * 3, high=["4 nm"] * 3),
    )  # fmt: skip
    rng = np.random.default_rng(1)
    places = np.stack(np.meshgrid(*[np.arange(4) * 8.0 + 6] * 3), -1).reshape(-1, 3) + rng.normal(0, 0.3, (64, 3))
    sim.ensemble("ions", "Coulomb", position=places, mass="40 amu", charge="1 e")
    sim.influence(
        energy="g*p.charge*q.charge*exp(-r/l)/r", on="ions", g="14.4 eV angstrom/e^2", l="1 nm", cutoff="6 nm"
    )
    sim.diagnosis("energies")
    sim.check()
    sim.run(0)
    r = np.linalg.norm(places[:, None] - places[None], axis=-1)[np.triu_indices(64, 1)]
    expected = (14.4 * (np.exp(-r / 10) / r - np.exp(-6) / 60)).sum()  # less its value at the cut-off, as run.shifted says
    assert sim.units.to("eV", sim.measure("energies")["potential energy"]) == pytest.approx(expected, rel=1e-9)
    start = sim.measure("energies")["total energy"]
    sim.run(200)
    assert sim.measure("energies")["total energy"] == pytest.approx(start, rel=1e-5)


KILLED = """
import sys, boltzmann as bz
sim = bz.load("copper", steps=4000, set={"output.checkpoint": 50, "output.trajectory": 100})
@sim.every(1)
def look(sim):
    if sim.step == 730:
        import os, signal
        os.kill(os.getpid(), signal.SIGKILL)
sim.run(out=sys.argv[1])
"""


def test_after_a_kill(tmp_path):
    folder = str(tmp_path / "melt")
    died = subprocess.run([sys.executable, "-c", KILLED, folder], check=False)
    assert died.returncode == -9
    sim = bz.resume(folder)
    assert sim.step == 700
    sim.run()
    assert sim.step == 4000
    straight = bz.load("copper", steps=4000)
    straight.run()
    assert sim.digest() == straight.digest()
    assert len(bz.open(folder).table) == len(straight.table)
    assert os.path.exists(os.path.join(folder, "picture.png"))
