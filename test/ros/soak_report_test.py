#!/usr/bin/python3
"""Tests that scripts/soak_report.py detects faults: memory leaks, crashes, failed steps, numbers that are not
finite."""

import os
import sys
import types
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../scripts"))
import soak_report  # noqa: E402

SECONDS = 600


def sample(wall, memory):
    return soak_report.Sample(wall=wall, memory=memory, simulated=wall, real_time_factor=1.0, paused=False, overruns=0,
                              iterations=2, halvings=0, other_guesses=0, energy=1.0, work=1.0, dissipated=0.0,
                              defect=0.0, error="")


def samples(memory):
    """Return one sample per second. memory: a function of the wall time."""
    return [sample(float(wall), memory(wall)) for wall in range(1, SECONDS + 1)]


def message(**fields):
    return types.SimpleNamespace(__slots__=list(fields), **fields)


def status(time, total, work=0.0, dissipated=0.0):
    return message(time=time, total_energy=total, work=work, dissipated=dissipated)


class Faults(unittest.TestCase):
    STEADY = samples(lambda wall: 20 + 10 * min(wall / 30, 1))

    def test_none_where_memory_grows_during_the_warm_up_only(self):
        self.assertEqual(soak_report.find_faults(self.STEADY, {}, [], died=False), [])

    def test_a_leak(self):
        lost = 64 * 100 / 2**20  # MiB per second: 64 bytes per message at 100 Hz
        leak = samples(lambda wall: 20 + lost * wall)
        (fault,) = soak_report.find_faults(leak, {}, [], died=False)
        self.assertIn("memory grew", fault)
        self.assertAlmostEqual(soak_report.trend(leak), 3600 * lost, delta=1e-9)

    def test_what_the_node_did(self):
        faults = soak_report.find_faults(self.STEADY, {"joint_states": 3}, ["no convergence"], died=True)
        self.assertEqual(len(faults), 3)
        self.assertTrue(soak_report.find_faults([], {}, [], died=False), "nothing was seen")


class Numbers(unittest.TestCase):
    def test_are_looked_for_everywhere_in_a_message(self):
        for value in (float("nan"), float("inf")):
            nested = message(name="arm", count=3, poses=[message(xyz=(0.0, 1.0)), message(xyz=(value, 1.0))])
            self.assertFalse(soak_report.is_finite(nested))
        self.assertTrue(soak_report.is_finite(message(name="nan", poses=[message(xyz=(0.0, 1.0))], none=[])))


class Account(unittest.TestCase):
    def test_counts_from_the_last_reset(self):
        account = soak_report.EnergyAccount()
        account.add(status(0.0, 5.0))
        account.add(status(1.0, 6.0, work=3.0, dissipated=2.5))  # half a joule of energy without a cause
        self.assertEqual(account.take_largest(), 0.5)
        account.add(status(0.0, 7.0))
        account.add(status(1.0, 8.0, work=1.0))
        self.assertEqual(account.take_largest(), 0.0)


if __name__ == "__main__":
    unittest.main()
