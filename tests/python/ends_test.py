"""Kind of fault: a stop is lost, or a program can't end. Siblings: a run in the background that is stopped at once, from the
same and from another thread, a window, a sweep; a program that ends, with and without an exception, while one of them goes on."""

import subprocess
import sys
import threading
import time

import pytest

import boltzmann as bz


def ends_within(seconds, call):
    done = []
    thread = threading.Thread(target=lambda: done.append(call()), daemon=True)
    thread.start()
    thread.join(seconds)
    return bool(done)


@pytest.mark.parametrize("time_before_stop", [0, 0, 0, 0, 0, 0, 0, 0, 0.001, 0.01])
def test_a_run_that_is_stopped_right_after_its_start_ends(time_before_stop):
    sim = bz.load("copper").start(10**9)
    time.sleep(time_before_stop)
    sim.stop()
    assert ends_within(20, lambda: sim.wait() or True)
    step = sim.step
    sim.run(2)  # the stop was of the run before
    assert sim.step == step + 2


def test_a_stop_between_two_runs_does_nothing():
    sim = bz.load("copper")
    sim.stop()
    assert sim.run(3).steps == 3
    sim.stop()
    assert sim.run(3).steps == 3


def test_a_stop_by_an_observer_of_the_start_ends_the_run():
    sim = bz.load("copper")
    sim.every(1, lambda: sim.stop())
    assert sim.run(1000).steps <= 1


def test_two_threads_stop():
    sim = bz.load("copper").start(10**9)
    stops = [threading.Thread(target=sim.stop) for _ in range(4)]
    for one in stops:
        one.start()
    for one in stops:
        one.join()
    assert ends_within(20, lambda: sim.wait() or True)


PROGRAMS = {
    "the end of the program": "sim = bz.load('copper').start(10**9)",
    "the end after a while": "sim = bz.load('copper').start(10**9)\ntime.sleep(0.3)",
    "sys.exit": "sim = bz.load('copper').start(10**9)\nsys.exit(0)",
    "several": "sims = [bz.load('copper').start(10**9) for _ in range(3)]",
    "a thread of one's own": "sim = bz.load('copper')\nthreading.Thread(target=sim.run, args=(10**9,), daemon=True).start()\n"
    "while not sim.running: time.sleep(0.01)",
    "an observer": "sim = bz.load('copper')\nsim.every(1, lambda: None)\nsim.start(10**9)",
    "a window": "sim = bz.load('copper')\nw = sim.window(play=True)\ntime.sleep(0.5)",
    "a window at once": "sim = bz.load('copper')\nw = sim.window(play=True)",
    "a sweep": "threading.Thread(target=lambda: bz.sweep('copper', vary={'run.seed': list(range(1, 400))}), daemon=True).start()\n"
    "time.sleep(1.5)",
}


@pytest.mark.parametrize("what", PROGRAMS)
def test_a_program_ends_while_something_runs(what):
    program = f"import sys, threading, time\nimport boltzmann as bz\n{PROGRAMS[what]}\nprint('end')\n"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=90)
    assert done.returncode == 0, done.stderr
    assert "terminate" not in done.stderr and "Fatal" not in done.stderr


def test_a_program_that_fails_says_why_and_ends():
    program = "import boltzmann as bz\nsim = bz.load('copper').start(10**9)\nraise KeyError('mine')\n"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=90)
    assert done.returncode == 1 and "KeyError: 'mine'" in done.stderr and "terminate" not in done.stderr
