"""Wrong calls give one clear line as a Python exception, change nothing, and never end the interpreter."""

import gc
import pickle
import re
import threading

import numpy as np
import pytest

import boltzmann as bz


def gas(**run):
    sim = bz.Simulation(
        units="reduced", run={"step": 0.005, "steps": 10, **run}, box=dict(low=[0, 0], high=[8, 8], boundary="periodic")
    )
    sim.ensemble("atoms", "Newton", load=dict(kind="block", lattice="square", spacing=1.6, counts=[5, 5]))
    sim.influence("lennard-jones", on="atoms", depth=1, r0=1.1, cutoff=2.5)
    return sim


def ready():
    sim = gas()
    sim.run(1)
    return sim


def raised_by(call):
    with pytest.raises((bz.Error, bz.PhysicsFailure, bz.RecordingFailure, AttributeError)) as raised:
        call()
    return str(raised.value)


WRONG = {
    # texts and names
    "an unknown scenario": (lambda: bz.load("coper"), "did you mean 'copper'"),
    "a scenario that is a number": (lambda: bz.load(5), "not int"),
    "a folder as a scenario": (lambda: bz.load("/tmp"), "directory"),
    "a text that is no TOML": (lambda: bz.load("[run\nstep = 1"), "line|text:1"),
    "an unknown key to set": (lambda: bz.load("copper", set={"run.stpe": 1}), "stpe.*did you mean 'step'"),
    "a unit of another kind": (lambda: bz.load("copper", set={"run.step": "5 kg"}), "mass.*time"),
    "a word for steps": (lambda: bz.load("copper", steps="many"), "whole number"),
    "a negative seed": (lambda: bz.load("copper", seed=-1), "seed: 0 or more"),
    "an unknown table": (lambda: bz.Simulation(boks=dict(low=[0], high=[1]), run=dict(step=1)).check(), "boks"),
    "an unknown key of a table": (lambda: bz.Simulation(run=dict(stpe=1)).check(), "did you mean 'step'"),
    "no box and no places": (lambda: bz.Simulation(run=dict(step=1)).check(), "ensembles"),
    "a step at the top": (lambda: bz.Simulation(step=1), r"run = dict\(step"),
    "an unknown base": (lambda: bz.Simulation(units="metrik", run=dict(step=1)).check(), "metrik"),
    "an unknown class": (lambda: gas_of_class("Neuton"), "did you mean 'Newton'"),
    "a class that is no text": (lambda: gas().ensemble("b", 3), "texts"),
    "an unknown law": (lambda: gas().influence("lenard-jones", on="atoms") or gas_check(), "lennard-jones"),
    "a law that is a function": (lambda: law_of(lambda r: 1 / r), "text"),
    "a formula that is none": (lambda: law_of("1/("), "energy"),
    "a formula of an unknown name": (lambda: law_of("1/R"), "R"),
    "an unknown ensemble of a law": (lambda: influence_on("atom"), "did you mean 'atoms'"),
    "an unknown kind of diagnosis": (lambda: ready().diagnosis("temprature"), "did you mean 'temperature'"),
    "an unknown key of a diagnosis": (lambda: ready().diagnosis("temperature", evry=3), "evry"),
    "a diagnosis every 0 steps": (lambda: ready().diagnosis("temperature", every=0), "1 or more"),
    "a diagnosis every half step": (lambda: ready().diagnosis("temperature", every=0.5), "whole number"),
    "a diagnosis that is none": (lambda: ready().measure("temperatur"), "did you mean 'temperature'"),
    "a law after the first step": (lambda: ready().influence("gravity", on="atoms"), "has begun"),
    "an ensemble after the first step": (lambda: ready().ensemble("b", "Newton", position=[[0, 0]]), "has begun"),
    "two boxes": (lambda: gas().add("box", low=[0], high=[1]), r"\[box\] already"),
    "an unknown table to add": (lambda: added("influenses", law="gravity"), "influences"),
    # arrays
    "positions of no shape": (lambda: placed(np.zeros((2, 2, 2))), "shape"),
    "positions in four dimensions": (lambda: placed(np.zeros((5, 4))), r"\(N, 3\)"),
    "no positions at all": (lambda: placed(np.zeros((0, 2))), "shape"),
    "positions that are not finite": (lambda: placed(np.array([[0, np.nan]])), "finite"),
    "positions of texts": (lambda: placed("here"), "numbers"),
    "ragged positions": (lambda: placed([[0, 0], [1]]), "array of numbers|numbers"),
    "positions in another space": (lambda: checked(placed_sim(np.zeros((3, 3)))), "2"),
    "positions and a loader": (lambda: gas().ensemble("b", "Newton", position=[[0, 0]], load=dict(kind="random")), "one of"),
    "masses of another length": (lambda: checked(placed_sim(np.eye(2), mass=np.ones(3))), "mass"),
    "masses that are complex": (lambda: checked(placed_sim(np.eye(2), mass=np.ones(2) * 1j)), "numbers"),
    "masses that are not finite": (lambda: checked(placed_sim(np.eye(2), mass=np.array([1, np.inf]))), "finite"),
    "a mass that is a set": (lambda: checked(placed_sim(np.eye(2), mass={1, 2})), "not set"),
    "an unknown field": (lambda: ready().atoms.velocty, "did you mean 'velocity'"),
    "an unknown field to set": (lambda: setattr(ready().atoms, "velocty", 0), "did you mean 'velocity'"),
    "a field of another shape": (lambda: setattr(ready().atoms, "velocity", np.zeros((3, 2))), r"\(25, 2\)"),
    "a field of texts": (lambda: setattr(ready().atoms, "velocity", "fast"), "velocity|fast"),
    "a field with a wrong unit": (lambda: setattr(bz.load("copper").atoms, "velocity", "5 kg"), "mass.*velocity|velocity"),
    "a unit among pure numbers": (lambda: setattr(ready().atoms, "velocity", "5 km/s"), "unit|pure"),
    "a field of objects": (lambda: setattr(ready().atoms, "mass", object()), "numbers"),
    "influences to set": (lambda: setattr(ready().atoms, "influence", 0), "read only"),
    "a field to delete": (lambda: delattr(ready().atoms, "mass"), "can't be taken away"),
    "an ensemble by a number": (lambda: ready()[0], "text"),
    "an unknown ensemble": (lambda: ready().atom, "did you mean 'atoms'"),
    "an attribute that is set": (lambda: setattr(ready(), "stepsize", 5), "did you mean 'step_size'"),
    "the step that is set": (lambda: setattr(ready(), "step", 5), "set|property"),
    "a negative size": (lambda: ready().atoms.resize(-1), "0 or more"),
    "a size of half a particle": (lambda: ready().atoms.resize(2.5), "number of particles"),
    "an added particle in 3D": (lambda: ready().atoms.add([1, 2, 3]), "2 numbers"),
    "an added field": (lambda: ready().atoms.add([1, 2], charge=3), "charge"),
    "added masses of another length": (lambda: ready().atoms.add([[1, 2], [3, 4]], mass=[1, 2, 3]), "one value for all"),
    # runs
    "no steps": (lambda: bz.Simulation(run=dict(step=1), units="reduced", box=dict(low=[0], high=[1])).run(), "ensembles"),
    "a run of unknown length": (lambda: unplanned().run(), "how many steps"),
    "more steps than there are": (lambda: ready().run(10**30), "at most"),
    "a step size of another kind": (lambda: setattr(bz.load("copper"), "step_size", "5 kg"), "mass, a time is needed"),
    "negative steps": (lambda: ready().run(-1), r"rewind\(\)"),
    "half a step": (lambda: ready().run(0.5), "whole number"),
    "steps and a time": (lambda: ready().run(3, time=1), "one of the two"),
    "a time of another kind": (lambda: bz.load("copper").run(time="5 kg"), "mass, a time is needed"),
    "a negative time": (lambda: ready().run(time=-1), "0 or more"),
    "no hours": (lambda: ready().run(5, hours=0), "positive"),
    "a step size of zero": (lambda: setattr(ready(), "step_size", 0), "zero"),
    "a step size that is a list": (lambda: setattr(ready(), "step_size", [1]), "quantity"),
    "threads that are a text": (lambda: setattr(ready(), "threads", "two"), "whole number"),
    "an observer that is none": (lambda: ready().every(5, 7), "function"),
    "an observer every 0 steps": (lambda: ready().every(0, print), "1 step or more"),
    "an observer that nobody knows": (lambda: ready().forget(print), "does not observe"),
    "a record of nothing": (lambda: ready().record("atoms"), "ensemble.field"),
    "a record of an unknown field": (lambda: ready().record("atoms.charge"), "charge"),
    "a record of an unknown component": (lambda: ready().record("atoms.position.z"), "z"),
    # pictures, tables, files
    "an unknown drawing": (lambda: ready().picture("cartezian"), "did you mean 'cartesian'"),
    "an unknown key of a picture": (lambda: ready().picture(color="speed"), "colour|color"),
    "a picture of another kind": (lambda: ready().picture().save("a.jpg"), "png"),
    "a picture that can't be written": (lambda: ready().picture().save("/nowhere/a.png"), "/nowhere"),
    "a picture of no size": (lambda: ready().picture().png(width=0), "size|16"),
    "an unknown column": (lambda: measured_gas().table["total enrgy"], "did you mean 'total energy'"),
    "an empty table to plot": (lambda: ready().table.plot(), "no columns"),
    "no stored run": (lambda: bz.open("/tmp/no-such-run"), "no folder"),
    "a folder without a run": (lambda: bz.open("/usr"), "no run|holds"),
    "nothing to resume": (lambda: bz.resume("/usr"), "no run"),
    "a file for results": (lambda: gas().run(1, out="/dev/null"), "/dev/null"),
    "results where nobody may write": (lambda: gas().run(1, out="/proc/run"), "/proc/run"),
    "a scenario's file of another kind": (lambda: gas().save("a.txt"), ".toml"),
    "a sweep of nothing": (lambda: bz.sweep(gas()), "vary|sweep"),
    "a sweep over a word": (lambda: bz.sweep(gas(), vary={"run.step": "fast"}), "list of values"),
    "a sweep over an unknown key": (lambda: bz.sweep(gas(), vary={"run.stpe": [1, 2]}), "stpe|diagnoses"),
    "a sweep of a run": (lambda: bz.sweep(ready(), vary={"run.step": [1]}), "has run"),
    # catalogues
    "an unknown page": (lambda: bz.show("morze"), "did you mean 'morse'"),
    "a page of a number": (lambda: bz.show(5), "text"),
    "an unknown law's page": (lambda: bz.laws["morze"], "did you mean 'morse'"),
    "a unit of nothing": (lambda: bz.load("copper").units.to("furlong", 1), "furlong"),
    "a quantity that is none": (lambda: bz.load("copper").units([5]), "quantity"),
}


def gas_of_class(name):
    sim = gas()
    sim.ensemble("b", name, load=dict(kind="random"), number=3)
    sim.check()


def gas_check():
    sim = gas()
    sim.influence("lenard-jones", on="atoms")
    sim.check()


def law_of(energy):
    sim = gas()
    sim.influence(energy=energy, on="atoms", cutoff=2)
    sim.check()


def influence_on(name):
    sim = gas()
    sim.influence("lennard-jones", on=name, depth=1, r0=1)
    sim.check()


def added(table, **keys):
    sim = gas()
    sim.add(table, **keys)
    sim.check()


def placed_sim(position, **fields):
    sim = gas()
    sim.ensemble("b", "Newton", position=position, **fields)
    return sim


def placed(position):
    placed_sim(position)


def checked(sim):
    sim.check()


def unplanned():
    sim = bz.Simulation(units="reduced", run=dict(step=1))
    sim.ensemble("a", "Newton", position=[[0.0, 0.0]])
    return sim


def measured_gas():
    sim = gas()
    sim.diagnosis("energies")
    sim.run(1)
    return sim


@pytest.mark.parametrize("what", WRONG)
def test_one_clear_line(what):
    call, expected = WRONG[what]
    told = raised_by(call)
    for line in told.split("\n"):  # of a scenario there may be several mistakes
        assert 10 < len(line) < 1000, line
        assert "object at 0x" not in line, line
    assert re.search(expected, told), told


def test_all_mistakes_at_once_each_at_its_line():
    sim = bz.Simulation(run=dict(stpe=0.1), box=dict(low=[0] * 3, high=["1 nm"] * 3))
    sim.ensemble("atoms", "Newton", mass="3.4 angstrom", load=dict(kind="block", spacing="2 angstrom", counts=[2] * 3))
    sim.influence("lennard-jones", on="atoms", depht="0.1 eV", r0="2 angstrom")
    with pytest.raises(bz.ScenarioErrors) as raised:
        sim.check()
    first = test_all_mistakes_at_once_each_at_its_line.__code__.co_firstlineno
    told = "\n".join(raised.value.lines)
    for line, what in ((1, "'stpe' in [run]"), (2, "'3.4 angstrom' is a length, a mass is needed"), (3, "'depht'")):
        assert re.search(rf"misuse_test.py:{first + line}: .*{re.escape(what)}", told), told


def test_what_was_wrong_is_said_again():
    sim = bz.Simulation(
        units="reduced", run={"step": 0.005, "steps": 10}, box=dict(low=[0, 0], high=[8, 8], boundary="periodic")
    )
    block = dict(kind="block", lattice="square", spacing=1.6, counts=[5, 5])
    law = dict(on="atoms", depth=1, r0=1.1, cutoff=2.5)
    sim.ensemble("atoms", "Neuton", load=block)
    sim.influence("lenard-jones", **law)
    sim.dissipation("langevin", on="atoms", temperature=1, rate=1)
    with pytest.raises(bz.ScenarioErrors, match="Neuton"):
        sim.check()
    sim.ensemble("atoms", "Newton", load=block)
    with pytest.raises(bz.ScenarioErrors, match="lenard-jones"):
        sim.check()  # nothing that was wrong is left out without a word
    sim.influence("lennard-jones", **law)
    sim.check()
    once = gas()
    once.dissipation("langevin", on="atoms", temperature=1, rate=1)
    once.run(10)
    with pytest.warns(UserWarning, match=r"\[\[influences\]\] already has this table, from .*misuse_test.py"):
        sim.influence("lennard-jones", **law)  # as by a cell that is run again
    sim.run(10)
    assert (sim.atoms.position == once.atoms.position).all()


def test_mistakes_of_a_file_stand_at_its_lines(tmp_path):
    path = tmp_path / "wrong.toml"
    path.write_text('[units]\nbase = "reduced"\n\n[run]\nstpe = 1\n')
    with pytest.raises(bz.ScenarioErrors) as raised:
        bz.load(path)
    assert any(re.match(rf"{re.escape(str(path))}:5:1: .*'stpe'", line) for line in raised.value.lines), raised.value.lines


def test_mistakes_of_values_that_are_set_stand_at_the_call():
    with pytest.raises(bz.ScenarioErrors) as raised:
        bz.load("copper", set={"run.step": "5 kg"})
    assert re.match(r"misuse_test.py:\d+: run.step.*", raised.value.lines[0]), raised.value.lines


def test_an_observer_that_raises_ends_the_run_after_its_step():
    sim = gas()

    @sim.every(3)
    def look():
        raise KeyError("mine")

    with pytest.raises(KeyError, match="mine"):
        sim.run(10)
    assert sim.step == 0  # it looks at the start
    sim.forget(look)
    sim.run(10)
    assert sim.step == 10


def test_a_run_inside_of_a_run_is_refused():
    sim = gas()
    seen = []

    @sim.every(5)
    def again(sim):
        with pytest.raises(bz.Error, match="while the simulation runs"):
            sim.run(1)
        with pytest.raises(bz.Error, match="while the simulation runs"):
            sim.step_size = 0.1
        with pytest.raises(bz.Error, match="observers change nothing"):
            sim.atoms.resize(3)
        with pytest.raises(bz.Error, match="observers change nothing"):
            sim.atoms.velocity = 0
        with pytest.raises(ValueError, match="read-only"):
            sim.atoms.velocity[0] = 1
        seen.append(sim.step)

    sim.run(10)
    assert seen == [0, 5, 10]


def test_a_failure_of_the_physics_names_step_and_particle():
    sim = gas(step=0.005)
    sim.run(1)
    sim.atoms.velocity[7] = 1e9
    with pytest.raises(bz.PhysicsFailure, match="step 2: particle 7 of 'atoms'"):
        sim.run(5)


def test_not_a_number_is_refused_when_the_run_goes_on():
    sim = ready()
    sim.atoms.position[3] = np.nan
    with pytest.raises((bz.Error, bz.PhysicsFailure), match="particle 3"):
        sim.run(1)


def test_a_field_outlives_everything():
    field = ready().atoms.position
    copy = field.copy()
    gc.collect()
    assert (field == copy).all()


def test_what_is_pickled_goes_on_and_what_can_t_be_says_so():
    sim = ready()
    again = pickle.loads(pickle.dumps(sim))
    sim.run(9), again.run(9)
    assert sim.digest() == again.digest()
    error = pickle.loads(pickle.dumps(bz.ScenarioErrors(["a", "b"])))
    assert error.lines == ["a", "b"]


def test_two_threads_can_t_run_one_simulation():
    sim = gas()
    told = []

    @sim.every(1)
    def look(sim):
        if sim.step == 2:
            def other():
                try:
                    sim.run(1)
                except bz.Error as error:
                    told.append(str(error))
            thread = threading.Thread(target=other)
            thread.start()
            thread.join()

    sim.run(5)
    assert len(told) == 1 and "while the simulation runs" in told[0]
