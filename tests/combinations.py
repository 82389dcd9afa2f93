#!/usr/bin/env python3
"""Small scenarios by chance, in which whatever may act together does, are the same run in every way:

  tests/combinations.py build/release/bzm [TIMES] [SEED]     so many, from this seed on
  tests/combinations.py build/release/bzm print SEED         the scenario of a seed

On one rank of one thread; on three threads; on 2, 3 or 5 ranks; stopped and resumed on another number of ranks; and with
somebody who looks after each step. What a scenario has that does not go together is taken out where the message says.
Files are compared byte for byte; folders that differ are kept in ./combinations. Exit status 1 where there are some."""

import itertools
import json
import math
import os
import pathlib
import random
import re
import shutil
import subprocess
import sys
import tempfile

ENVIRONMENT = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
PATIENCE = 300  # seconds
RADII = {"lennard-jones": {"depth": 0.5, "r0": 0.9}, "morse": {"depth": 0.5, "r0": 0.9, "a": 4},
         "rydberg": {"depth": 0.5, "r0": 0.9, "a": 4}, "soft": {"repulsion": 20, "range": 1}}
MATERIALS = ({"kind": "ideal-gas", "gamma": 1.4}, {"kind": "ideal-gas", "gamma": 1.4, "conductivity": 0.1},
             {"kind": "tait", "reference_density": 1, "sound_speed": 5, "shear_viscosity": 0.1},
             {"kind": "stiffened-gas", "gamma": 3, "stiffness": 1}, {"kind": "quadratic-gas", "coefficient": 1},
             {"kind": "formula", "pressure": "0.4*density*specific_energy", "temperature": "specific_energy"})
MATTER = ["energies", "momentum", "angular-momentum", "temperature", "number", "pressure", "box", "energy-balance"]


def toml(value):
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{json.dumps(key)} = {toml(one)}" for key, one in value.items()) + " }"
    return "[" + ", ".join(map(toml, value)) + "]" if isinstance(value, list) else json.dumps(value)


class Scenario:
    """Tables by chance, of about so many particles at a density of 1."""

    def __init__(self, seed):
        self.chance = random.Random(seed)
        self.tables = [("units", {"base": "reduced"})]
        # Some runs are long enough for all that happens late: criteria that are looked at again every 64 calculations.
        self.steps = self.chance.randint(10, 40) * self.one(1, 1, 1, 4)
        self.chance.choices((self.atoms, self.matter, self.vortices, self.plasma), (10, 4, 3, 3))[0]()
        self.add("output", diagnoses=self.one(1, 2, 3, 7), trajectory=self.one(1, 4, 9), checkpoint=self.one(0, 5, 11))

    def text(self):
        lines = []
        for name, body in sorted(self.tables, key=lambda table: not table[0].startswith(("[box", "box", "units", "run"))):
            lines += [f"[{name}]", *(f"{key} = {toml(value)}" for key, value in body.items()), ""]
        return "\n".join(lines)

    def add(self, table, /, **body):
        self.tables.append((table, body))
        return body

    def maybe(self, chance):
        return self.chance.random() < chance

    def one(self, *what):
        return self.chance.choice(what)

    def number(self, low, high):
        return round(self.chance.uniform(low, high), 3)

    def vector(self, most):
        return [self.number(-most, most) for _ in range(self.dimension)]

    def place(self):
        return [round(low + self.chance.random() * length, 3) for low, length in zip(self.low, self.lengths)]

    def box(self, particles, ends, least):
        """Of one, two or three dimensions, each axis at least so long."""
        shape = [self.one(0.7, 1, 1.5) for _ in range(self.dimension)]
        size = (particles / math.prod(shape)) ** (1 / self.dimension)
        self.lengths = [round(max(size * part, least), 3) for part in shape]
        self.low = [self.one(0.0, 5.25) for _ in shape]
        self.ends = [self.one(*ends) for _ in shape] if self.maybe(0.6) else [self.one(*ends)] * self.dimension
        self.add("box", low=self.low, high=[round(a + b, 3) for a, b in zip(self.low, self.lengths)], boundary=self.ends)
        for axis, end in zip("xyz", self.ends):
            if end in ("reflecting", "mirror") and self.maybe(0.3):
                velocity = [0.1 if axis == other else 0 for other in "xyz"[:self.dimension]]
                self.add("[box.walls]", axis=axis, end="low", **self.one({"open": True}, {"velocity": velocity}))

    def load(self, particles):
        return self.one({"load": {"kind": "random", "minimum_distance": 0.6}, "number": particles},
                        {"load": {"kind": "fill", "number_density": particles / math.prod(self.lengths), "jitter": 0.2}})

    def diagnose(self, *kinds):
        for kind in self.chance.sample(kinds, min(len(kinds), self.chance.randint(0, 4))):
            more = {"bond-order": {"range": 1.3}, "extremes": {"quantity": "speed"}, "structure-factor": {"modes": 3},
                    "formula": {"label": "mean", "formula": "mean(norm(velocity))"}}.get(kind, {})
            self.add("[diagnoses]", kind=kind, **more)

    def happen(self, names, step):
        """Events at any time."""
        for _ in range(self.one(0, 0, 1, 2)):
            self.add("[events]", at=step * self.chance.randint(1, self.steps), on=self.one(*names), **self.one(
                {"temperature": 2}, {"scale": -1}, {"kick": self.vector(1)},
                {"add": {"number": 30, "load": {"kind": "random", "minimum_distance": 0.3}}}))

    def atoms(self):
        self.dimension = self.one(1, 2, 3, 3)
        cutoff, step = self.number(1.2, 2.4), self.one(0.002, 0.005)
        far = self.one(None, None, None, "mesh", "p3m", "multipole", "metal")
        self.box(self.chance.randint(1000, 1600), ["periodic"] if far == "p3m" else ["periodic", "open", "reflecting"],
                 2.05 * cutoff)
        if self.dimension > 1 and not far and self.maybe(0.2):
            self.tables[1][1]["shear"] = {"rate": 0.5}
        run = self.add("run", step=step, steps=self.steps, cutoff=cutoff, seed=self.chance.randint(1, 99))
        if self.maybe(0.3):
            run["skin"] = self.one(0.05, 0.6)
        names = ["a", "b", "c"][:self.chance.randint(1, 3)]
        charged, bath, own = far in ("mesh", "p3m", "multipole"), self.maybe(0.5), self.maybe(0.2)
        if own:
            self.add("[classes]", name="Own", base="Coulomb" if charged else "Newton", fields=[
                {"name": "spin", "period": 6.28}, {"name": "near", "sum": True}, {"name": "order", "neighbours": 1.3}],
                rate={"spin": "1 + 0.1*near"}, **self.one({}, {"diffusion": {"spin": "0.1"}}))
        for name in names:
            kind = "Own" if own else "Coulomb" if charged else self.one("Newton", "Meso", "Tethered")
            more = {"heat_capacity": 10, "internal_energy": {"temperature": 1}} if kind == "Meso" else {}
            if charged:
                more["charge"] = self.one(-1, 1)
            if not bath and self.maybe(0.4):
                more["integrator"] = self.one("rk2", "rk4", "symplectic-4", "reversible-leap-frog")
            if name == "a" and self.maybe(0.3):
                self.molecules(run, more)
            else:
                more.update(self.load(int(math.prod(self.lengths) / len(names))))
            self.add("[ensembles]", **{"name": name, "class": kind, "mass": self.one(1, 2),
                                       "temperature": self.one(0.3, 2, 6), **more})
        for _ in range(self.one(1, 2, 3)):
            law = self.one("lennard-jones", "soft", "morse", "rydberg")
            self.add("[influences]", **self.one({"law": law, **RADII[law]}, {
                "energy": "g*p.mass*q.mass*(1 - r/l)^3*step(l - r)", "parameters": {"g": 2, "l": 1.1}}, {
                "influence": "-g*dot(separation, velocity)*separation/r^2*(1 - r/l)*step(l - r)",
                "parameters": {"g": 2, "l": 1.1}}), **self.one({"among": names}, {"on": self.one(*names)}, {
                    "on": names[0], "by": names[-1]}), **self.one({}, {}, {"every": 3}, {"cutoff": 1.15}))
        if own:
            self.add("[influences]", changes="near", influence="1 - r/l", parameters={"l": cutoff}, on="a")
        if self.maybe(0.4):
            self.add("[influences]", on=self.one(*names), **self.one(
                {"law": "drag", "friction": 0.5}, {"law": "uniform-gravity", "acceleration": self.vector(1)},
                {"energy": "0.05*mass*dot(position, position)", "from_outside": True}))
        if charged:
            field = {"law": "coulomb", "k": 0.1, "background": True}
            self.add("multipole" if far == "multipole" else "mesh", **field, **{
                "p3m": {"accuracy": 1e-3}, "mesh": {"cells": self.one(8, 12)}, "multipole": {"tolerance": 1e-3}}[far])
        if far == "metal":
            self.add("embedded_atoms", potential="gupta", A=0.1, xi=1.2, p=10, q=2.3, r0=1.0, cutoff=1.8)
        if bath:
            kind = self.one("langevin", "velocity-rescaling", "nose-hoover", "dpd")
            how = {"convention": "fixed-temperature", "friction": 3, "range": 1.1, "corrector": self.maybe(0.4)}
            self.add("[dissipation]", kind=kind, temperature=1, **(
                {"on": names[0], **how} if kind == "dpd" else {"on": names, "rate": 5}))
            if self.maybe(0.4):
                self.add("barostat", pressure=1, temperature=1, compressibility=0.1, rate=3, every=self.one(1, 3),
                         axes=["xyz"[a] for a, end in enumerate(self.ends) if end == "periodic"],
                         **self.one({}, {"together": False}, {"method": "mtk"}))
        elif self.maybe(0.2):
            run["substeps"] = {"distance": 0.01}
        self.add("minimise", steps=40)
        if self.maybe(0.2):
            self.add("equilibrate", temperature=1, rate=3, time=5 * step)
        self.happen(names, step)
        self.diagnose(*MATTER, "bond-order", "diffusion", "radial-distribution", "structure-factor", "mean-profile",
                      "extremes", "formula", "velocity-autocorrelation")

    def molecules(self, run, ensemble):
        """On a lattice, each along x."""
        counts = [max(1, int(length)) for length in self.lengths]
        each, spacing = self.chance.randint(2, min(5, max(2, counts[0]))), [a / n for a, n in zip(self.lengths, counts)]
        counts[0] -= counts[0] % each
        places = [[round(low + (n + 0.5) * a, 3) for low, n, a in zip(self.low, cell[::-1], spacing)]
                  for cell in itertools.product(*map(range, counts[::-1]))]
        ensemble.update(load={"kind": "positions", "positions": places}, molecule=each, bonds="chain")
        if self.maybe(0.4):
            self.add("[rigid_bonds]", on="a", length=round(spacing[0], 3))
        else:
            self.add("[influences]", law="spring", on="a", connect="bonds", stiffness=40, rest_length=round(spacing[0], 3))
        if each > 2:
            self.add("[influences]", energy="1 + cos(angle)", on="a", angles="bonds")
        self.add("[influences]", **{"law": "soft", **RADII["soft"]}, on="a", bonded_factors=self.one([0], [0, 0.5]))

    def matter(self):
        self.dimension = self.one(1, 2, 2, 3)
        self.box(self.chance.randint(1000, 1400), ["periodic", "open", "mirror", "mirror"], 6.5)
        run = self.add("run", step=self.one("courant", {"courant": 0.4}), steps=self.steps)
        if self.maybe(0.15):
            run["substeps"] = {"courant": 0.3}
        self.add("smooth", weight=self.one("lucy", "wendland", "quintic-spline"), heating="own", **self.one(
            {}, {"density": "continuity"}, {"density": "volumes"}, {"variable_range": {"spacings": 3}},
            {"artificial_viscosity": {"alpha": 1, "beta": 2}}))
        middle = self.low[0] + self.lengths[0] / 2
        for name, side in (("f", "<"), ("g", ">"))[:self.one(1, 2, 2)]:
            self.add("[ensembles]", **{"name": name, "class": "Smooth", "density": 1, "range": self.one(2.6, 3),
                                       "specific_energy": 1.5, "material": self.one(*MATERIALS),
                                       "integrator": self.one("leap-frog", "leap-frog", "euler", "rk2", "rk4"),
                                       "load": {"kind": "fill", "spacing": 1, "where": f"x {side} {middle:.4f}"},
                                       "velocity_ripple": {"axis": "x", "mode": 1, "amplitude": self.one(0.1, 0.4)}})
        if self.maybe(0.4):
            self.add("[influences]", on="f", **self.one({"law": "drag", "friction": 0.3},
                                                        {"law": "uniform-gravity", "acceleration": self.vector(0.3)}))
        if self.maybe(0.4):
            self.add("[smooth.rezone]", every=self.one(2, 5), on="f", **self.one(
                {"split_above": 1.05, "smallest_mass": 0.3}, {"merge_below": 1.2, "largest_mass": 3}))
        self.diagnose(*MATTER, "entropy", "mean-profile", "extremes", "formula")

    def vortices(self):
        self.dimension = self.one(2, 2, 3)
        poles = self.maybe(0.5)
        self.box(self.chance.randint(700, 1100), ["open", "periodic", "mirror"] if poles else ["open"], 4)
        step, law = 0.02, self.one("biot-savart", "biot-savart-algebraic", "biot-savart-gaussian")
        self.add("run", step=step, steps=self.steps // 3 + 4)
        flow = "0.5*sin(x)*cos(y)" if self.dimension == 2 else ["0.3*sin(y)", "0.3*cos(z)", "0.1*x"]
        kind = self.one("Vortex", "Inviscid", "Viscous", "Diffusive", "Spreading")
        more = {} if kind in ("Vortex", "Inviscid") else {"viscosity": 0.1}
        self.add("[ensembles]", **{"name": "v", "class": kind, "core": self.one(0.5, 1.5), "formulas": {"vorticity": flow},
                                   **({"volume": 1} if kind == "Diffusive" else {}), **more, **self.load(600)})
        self.add("[ensembles]", **{"name": "d", "class": self.one("Tracer", "Dye"), **self.load(500)})
        if poles:
            self.add("multipole", law=law, on="v", test_particles="d", tolerance=1e-3, background=True)
        else:
            self.add("[influences]", law=law, on="v", precision=self.one("full", "single"))
            self.add("[influences]", law=law, on="d", by="v")
        if kind == "Diffusive":
            self.add("[influences]", law="vorticity-exchange", on="v", width=1, cutoff=4)
        if kind == "Spreading":
            self.add("[split_cores]", every=3, above=0.8, merge_within=0.3)
        if self.dimension == 2 and self.maybe(0.3):  # whose influences come after all others
            self.add("[bodies]", name="b", shape="circle", radius=0.3, panels=24, centre=self.place())
        if self.maybe(0.4):
            self.add("[influences]", law="uniform-flow", on="d", velocity=self.vector(1))
        if self.maybe(0.4):
            self.add("remesh", every=self.one(2, 3), on="v", spacing=1, threshold=0.01)
        if self.maybe(0.4):
            self.add("outflow", every=self.one(1, 3), direction=[1, 0.2, 0][:self.dimension], **{"from": self.place()})
        if self.maybe(0.4):
            self.add("[dye]", on="d", to=self.place(), places=9, every=self.one(1, 3), **{"from": self.place()})
        self.diagnose("vortex-invariants", "vortex-energy", "number")

    def plasma(self):
        self.dimension = self.one(1, 2, 3)
        self.box(1600, ["periodic", "periodic", "reflecting"], 3)
        names, step = ["e", "i"][:self.one(1, 2)], self.one(0.02, 0.1)
        run = self.add("run", step=step, steps=self.steps)
        for name, charge in zip(names, (-0.1, 0.1)):
            self.add("[ensembles]", **{"name": name, "class": "Coulomb", "number": 1200, "charge": charge,
                                       "mass": self.one(0.1, 1), "temperature": 0.3, "load": {"kind": "random"}})
        self.add("mesh", law="coulomb", k=0.1, cells=self.one(8, 16), precision=self.one("full", "single"),
                 assignment=self.one("ngp", "cic", "tsc"), background=True)
        if self.maybe(0.3):
            self.add("[influences]", law="uniform-electric-field", on="e", field=self.vector(1))
        if self.maybe(0.3):
            self.add("[influences]", law="drag", on="e", friction=0.1)
        if self.maybe(0.2):
            run["substeps"] = {"distance": 0.05}
        self.happen(names, step)
        self.diagnose(*MATTER, "field-energy", "mean-profile")


def bzm(*arguments, ranks=1, threads=1):
    """The status and what it says."""
    command = [sys.argv[1], *map(str, arguments), *(["--ranks", str(ranks)] if ranks > 1 else [])]
    environment = {**ENVIRONMENT, "OMP_NUM_THREADS": str(threads)}
    try:
        done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=PATIENCE, check=False)
    except subprocess.TimeoutExpired:
        return "no end", ""
    return done.returncode, done.stderr


def without(text, line):
    """What the message of that line complains of: a key, or the table that can't do without it."""
    lines = text.split("\n")
    begin = end = line
    if lines[line].startswith(("[", "class", "kind", "law", "load", "name", "on ")):
        while not lines[begin].startswith("["):
            begin -= 1
        end = begin + 1
        while end < len(lines) and not lines[end].startswith("["):
            end += 1
        return "\n".join(lines[:begin] + lines[end:])
    return "\n".join(lines[:line] + lines[line + 1:])


def valid(seed, path):
    """Writes the scenario of this seed, as far as it is one. Whether something is left."""
    text = Scenario(seed).text()
    for _ in range(20):
        path.write_text(text)
        said = bzm("check", path)[1]
        found = re.match(re.escape(str(path)) + r":(\d+):", said)
        if not found:
            return said == "" or said.startswith("warning")
        text = without(text, int(found[1]) - 1)
    return False


def differences(folder, other, names):
    def same(name):
        return all((place / name).exists() for place in (folder, other)) and (
            (folder / name).read_bytes() == (other / name).read_bytes())

    return [name for name in names if not same(name)]


def compare(path, place, chance):
    """Ways in which a run is not the one on one rank and thread, or None if that one fails."""
    steps = json.loads(re.search(r"(?m)^steps = (\d+)", path.read_text())[1])
    one = place / "one"
    status, _ = bzm("run", path, "--out", one, "--quiet")
    if status != 0:
        return None
    ranks, others, half = chance.choice((2, 3, 5)), chance.choice((1, 2, 3)), chance.randint(1, steps - 1)
    ways = {"3 threads": {"threads": 3}, f"{ranks} ranks": {"ranks": ranks}, "stopped": {"ranks": others}, "seen": {}}
    wrong = {}
    for name, how in ways.items():
        folder, files = place / name, ["trajectory.h5"]
        if name == "stopped":  # whose scenario has other numbers of steps
            status, said = bzm("run", path, "--steps", half, "--out", folder, "--quiet", ranks=ranks)
            if status == 0:
                status, said = bzm("resume", folder, "--steps", steps - half, "--quiet", **how)
            files += [file.name for file in one.glob("*.csv")]
        else:
            look = ["--set", "output.diagnoses=1"] if name == "seen" else []
            status, said = bzm("run", path, "--out", folder, "--quiet", *look, **how)
            if not look:
                files = [file.name for file in one.iterdir() if file.suffix in (".h5", ".csv", ".toml")]
        if status != 0:
            wrong[name] = f"status {status}: {said.strip()[-300:]}"
        elif different := differences(one, folder, files):
            wrong[name] = ", ".join(different)
    return wrong


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    if sys.argv[2:3] == ["print"]:
        return print(Scenario(int(sys.argv[3])).text())
    sys.argv[1] = os.path.abspath(sys.argv[1])
    times, first = (int(word) for word in (*sys.argv[2:], *("20", "1")[len(sys.argv) - 2:]))
    kept, count = pathlib.Path("combinations"), {"the same": 0, "failed": 0, "differ": 0}
    for seed in range(first, first + times):
        with tempfile.TemporaryDirectory() as folder:
            place = pathlib.Path(folder)
            path = place / "scenario.toml"
            wrong = compare(path, place, random.Random(seed)) if valid(seed, path) else None
            result = "failed" if wrong is None else "differ" if wrong else "the same"
            count[result] += 1
            print(f"{seed}: {result} {wrong or ''}", flush=True)
            if wrong:
                shutil.copytree(place, kept / str(seed), dirs_exist_ok=True)
    print(", ".join(f"{number} {result}" for result, number in count.items()))
    sys.exit(min(count["differ"], 1))


if __name__ == "__main__":
    main()
