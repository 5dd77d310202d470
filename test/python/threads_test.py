"""Test simulations in threads: the same bits, and only one thread at a time for each simulation."""

import concurrent.futures
import os
import signal
import threading
import time

import numpy
import pytest

import flexarm
from conftest import bits, example


def history(efforts):
    simulation = flexarm.Simulation(flexarm.read_scene(example("flexible_two_link_arm")))
    return bits(simulation.run(len(efforts), efforts, record=["*"]))


def test_threads_give_the_bits_of_one_after_the_other():
    random = numpy.random.default_rng(0)
    efforts = [random.normal(size=(150, 2)) for _ in range(4)]
    alone = [history(each) for each in efforts]
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        assert list(pool.map(history, efforts)) == alone


def long_run(simulation, outcome):
    try:
        simulation.run(10**9)
    except KeyboardInterrupt:
        outcome.append("interrupted")


def test_others_run_meanwhile_and_one_thread_has_a_simulation(pendulum):
    """A run without an end in the main thread, which Ctrl-C ends. Another thread watches it."""
    refusals, steps = [], []

    def look_on():
        begin = time.monotonic()
        while not refusals and time.monotonic() - begin < 60:
            try:
                pendulum.positions  # allowed until the run begins
            except RuntimeError as error:
                refusals.append(str(error))
        for work in (pendulum.step, pendulum.snapshot, pendulum.reset, lambda: pendulum.row()):
            with pytest.raises(RuntimeError, match="another thread"):
                work()
            steps.append(work)
        os.kill(os.getpid(), signal.SIGINT)

    onlooker = threading.Thread(target=look_on)
    onlooker.start()
    outcome = []
    long_run(pendulum, outcome)
    onlooker.join()
    assert outcome == ["interrupted"]
    assert "another thread is working on this simulation" in refusals[0]
    assert len(steps) == 4
    # The simulation still works.
    before = pendulum.time
    assert before > 0
    pendulum.step()
    assert pendulum.time > before
