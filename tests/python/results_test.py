"""Tables, pictures, stored runs and catalogues, and files that h5py reads beside us."""

import os
import subprocess
import sys
import threading

import numpy as np
import pytest

import boltzmann as bz


@pytest.fixture(scope="module")
def stored(tmp_path_factory):
    folder = tmp_path_factory.mktemp("stored") / "run"
    sim = bz.load("copper", steps=60, set={"output.trajectory": 10, "output.diagnoses": 10})
    sim.run(out=folder)
    return sim, bz.open(folder)


def is_png(data):
    return data[:8] == b"\x89PNG\r\n\x1a\n"


def size_of(png):
    return int.from_bytes(png[16:20], "big"), int.from_bytes(png[20:24], "big")


def test_tables_name_their_columns_and_units(stored):
    sim, run = stored
    table = sim.table
    assert table.names[:2] == ["step", "time"] and table.units["time"] == "fs" and table.units["temperature"] == "K"
    assert (table["step"] == [0, 10, 20, 30, 40, 50, 60]).all() and len(table) == 7
    assert (table.total_energy == table["total energy"]).all()
    assert "total energy (eV)" in repr(table) and "<table>" in table._repr_html_()
    assert "total_energy" in dir(table) and "temperature" in table
    for column in table:
        assert np.array_equal(table[column], run.table[column])


def test_a_data_frame(stored):
    pandas = pytest.importorskip("pandas")
    frame = stored[0].table.to_pandas()
    assert isinstance(frame, pandas.DataFrame) and frame["time (fs)"].iloc[-1] == stored[0].table["time"][-1]


def test_pictures_are_png_svg_and_pdf(stored, tmp_path):
    sim, run = stored
    picture = sim.picture(colour="speed")
    assert is_png(picture._repr_png_()) and size_of(picture.png(400, 300, scale=2)) == (800, 600)
    assert picture.svg().startswith("<?xml") and picture.png() != picture.png(dark=True)
    for file in ("a.png", "a.svg", "a.pdf"):
        picture.save(tmp_path / file)
        assert (tmp_path / file).stat().st_size > 1000
    first, last = run.picture(frame=0).png(), run.picture().png()
    assert is_png(first) and first != last
    assert is_png(sim.picture("phase-space", x="position.x", y="velocity.x").png())
    assert is_png(run.picture("time-series", y="total energy").png())
    assert is_png(sim.table.plot("total energy").png()) and is_png(run.table.plot(logarithmic=True).png())


def test_frames_are_read_when_they_are_asked_for(stored):
    sim, run = stored
    trajectory = run.trajectory
    assert trajectory.ensembles == ["atoms"] and len(trajectory) == 7
    atoms = trajectory["atoms"]
    assert (trajectory.steps == np.arange(0, 61, 10)).all() and trajectory.times[-1] == pytest.approx(sim.time)
    assert atoms.position[-1] == pytest.approx(sim.atoms.position, rel=1e-14)  # files have other units
    assert atoms.velocity[2:5].shape == (3, 250, 2) and np.asarray(atoms.position).shape == (7, 250, 2)
    assert atoms.mass[0].shape == (250,) and len(list(atoms.position)) == 7
    with pytest.raises(bz.Error, match="there is no frame 7"):
        atoms.position[7]
    with pytest.raises(AttributeError, match="did you mean 'velocity'"):
        atoms.velocty
    with pytest.raises(bz.Error, match="did you mean 'atoms'"):
        trajectory["atom"]


def test_a_frame_is_a_start(stored):
    sim, run = stored
    again = bz.load("copper", set={"ensembles.atoms.load": run.frame(3)})
    assert again.atoms.position == pytest.approx(run.trajectory["atoms"].position[3], rel=1e-14)
    others = np.arange(250) != 60  # which the scenario sets
    assert again.atoms.velocity[others] == pytest.approx(run.trajectory["atoms"].velocity[3][others], rel=1e-14)
    with pytest.raises(bz.ScenarioErrors, match="7 frames, there is none of number 9"):
        bz.load("copper", set={"ensembles.atoms.load": {"kind": "frame", "path": os.path.join(run.folder, "trajectory.h5"), "frame": 9}})


def test_movies(stored, tmp_path):
    run = stored[1]
    import shutil

    if shutil.which("ffmpeg") is None:
        with pytest.raises(bz.Error, match="ffmpeg"):
            run.movie(tmp_path / "a.gif")
        return
    run.movie(tmp_path / "a.gif", colour="speed", scale=0.3)
    assert (tmp_path / "a.gif").read_bytes()[:4] == b"GIF8"
    with pytest.raises(bz.Error, match=".mp4, .webm or .gif"):
        run.movie(tmp_path / "a.avi")
    with pytest.raises(bz.Error, match="1 to 240"):
        run.movie(tmp_path / "a.gif", fps=0)


def test_what_diagnoses_gather_is_stored(tmp_path):
    sim = bz.load("argon", set={"equilibrate.time": 0.2}, steps=40)
    sim.run(out=tmp_path / "argon")
    gathered = bz.open(tmp_path / "argon").gathered
    assert "radial-distribution" in gathered
    assert len(gathered["radial-distribution"]["g"]) > 50


def test_catalogues():
    assert "lennard-jones" in bz.laws and "Newton" in bz.classes and "tait" in bz.materials
    assert len(bz.scenarios) > 60 and "copper" in list(bz.scenarios)
    assert "depth" in bz.laws["lennard-jones"] and "depth" in bz.show("lennard-jones")
    assert "lennard-jones" in repr(bz.laws)
    assert "eV" in bz.units and "leap-frog" in bz.integrators and "cartesian" in bz.drawings


def test_h5py_beside_a_run_that_writes(tmp_path):
    pytest.importorskip("h5py")
    program = """
import sys, threading, h5py, numpy as np, boltzmann as bz
sim = bz.load("copper", steps=3000, set={"output.trajectory": 1})
sim.start(out="run")
count = 0
while sim.running:
    with h5py.File("other.h5", "w") as file:
        for k in range(20):
            file[f"a{k}"] = np.arange(1000.0) + k
    with h5py.File("other.h5") as file:
        assert all((file[f"a{k}"][...] == np.arange(1000.0) + k).all() for k in range(20))
    count += 1
sim.wait()
frames = len(bz.open("run").trajectory)
print(frames, count > 2)
"""
    done = subprocess.run([sys.executable, "-c", program], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.stdout == "3001 True\n", f"{done.returncode}: {done.stderr[-2000:]}"


def test_reading_in_threads(stored):
    run = stored[1]
    right = [run.trajectory["atoms"].position[k] for k in range(7)]
    wrong = []

    def read():
        for _ in range(20):
            for k in range(7):
                if not (run.trajectory["atoms"].position[k] == right[k]).all():
                    wrong.append(k)

    threads = [threading.Thread(target=read) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not wrong
