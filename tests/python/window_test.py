"""The window that a notebook shows: live, and as one page of a stored run."""

import json
import re
import time
import urllib.request

import pytest

import boltzmann as bz


def gas(steps=100_000):
    sim = bz.Simulation(
        units="reduced", run=dict(step=0.005, cutoff=2.5, steps=steps),
        box=dict(low=[0, 0], high=[12, 12], boundary="periodic"),
    )  # fmt: skip
    sim.ensemble(
        "atoms", "Newton", temperature=1, load=dict(kind="block", lattice="square", spacing=1.2, counts=[10, 10])
    )
    sim.influence("lennard-jones", on="atoms", depth=1, r0=1.12)
    return sim


def test_a_live_page_that_python_steers_too():
    sim = gas()
    with sim.window() as window:
        assert re.match(r"http://127.0.0.1:\d+/\?token=", window.address)
        assert window.address.split("?")[0] in window._repr_html_().replace("&amp;", "&")
        page = urllib.request.urlopen(window.address).read()
        assert b"<html" in page and len(page) > 100_000
        assert sim.running and sim.step == 0
        with pytest.raises(bz.Error, match="while the simulation runs"):
            sim.run(1)
        with pytest.raises(bz.Error, match="while the simulation runs"):
            sim.window()
        sim.atoms.velocity = [3, 0]  # nothing moves yet: between two steps
        assert (sim.atoms.velocity == [3, 0]).all()
        with pytest.raises(ValueError, match="read-only"):
            sim.atoms.velocity[0] = 1
    assert not sim.running and not window.open
    sim.run(10)
    assert sim.step == 10


def test_a_page_that_plays_by_itself_ends_by_itself():
    sim = gas(steps=300)
    window = sim.window(play=True)
    window.wait()
    straight = gas(steps=300)
    straight.run()
    assert sim.step == 300 and sim.digest() == straight.digest()


def test_observers_are_called_and_what_they_raise_comes_out(tmp_path):
    sim = gas(steps=300)

    @sim.every(100)
    def look(sim):
        if sim.step == 200:
            raise KeyError("mine")

    window = sim.window(play=True, out=tmp_path / "run")
    with pytest.raises(KeyError, match="mine"):
        deadline = time.monotonic() + 20
        while window.open and sim.step < 200 and time.monotonic() < deadline:
            time.sleep(0.01)
        window.close()
    assert (tmp_path / "run" / "checkpoint.h5").exists()


def test_wrong_windows():
    with pytest.raises(bz.Error, match="65535"):
        gas().window(port=70000)
    with pytest.raises(bz.Error, match="whole number"):
        gas().window(steps=0.5)
    with gas().window() as window:
        taken = int(re.search(r":(\d+)/", window.address)[1])
        with pytest.raises(bz.Error, match=str(taken)):
            gas().window(port=taken)


def test_a_stored_run_as_one_page(tmp_path):
    sim = bz.load("copper", steps=60, set={"output.trajectory": 5})
    sim.run(out=tmp_path / "run")
    replay = bz.open(tmp_path / "run").replay(frames=5)
    assert replay.frames == 5 and replay.stored_frames == 13
    shown = replay._repr_html_()
    assert shown.startswith("<iframe srcdoc=") and "allow-scripts" in shown
    found = re.search(r'<script type="application/json" id="recording">(.*?)</script>', replay.html, re.S)
    assert found and json.loads(found[1])
    replay.save(tmp_path / "run.html")
    assert (tmp_path / "run.html").read_text(encoding="utf-8") == replay.html
    with pytest.raises(bz.Error):
        bz.open(tmp_path / "run").replay(views=["nothing like it"])
    with pytest.raises(bz.Error):
        bz.open(tmp_path / "run").replay(megabytes=0.001)
